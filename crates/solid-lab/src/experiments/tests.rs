use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use super::*;

/// Samples of some size in a folder of its own.
fn settings(name: &str, effort: Effort) -> Settings {
    let out_dir = std::env::temp_dir().join(format!("solid-lab-{name}-{}", std::process::id()));
    fs::create_dir_all(&out_dir).unwrap();
    Settings { effort, seed: 1, out_dir }
}

fn experiment(name: &str) -> &'static Experiment {
    all().iter().find(|experiment| experiment.name == name).unwrap()
}

/// Whether a column of a table depends on the clock.
fn is_time(column: &str) -> bool {
    let ratios_of_times = ["sorted_to_straightforward", "exact_ratio"];
    column.contains("seconds") || column.ends_with("_ns") || ratios_of_times.contains(&column)
}

/// The tables of a folder by name, without the times.
fn counts(folder: &Path) -> BTreeMap<String, Vec<Vec<String>>> {
    let tables = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    tables
        .filter(|path| path.extension().is_some_and(|extension| extension == "csv"))
        .map(|path| {
            let mut table = csv::Reader::from_path(&path).unwrap();
            let header = table.headers().unwrap().clone();
            let kept: Vec<usize> = (0..header.len()).filter(|&i| !is_time(&header[i])).collect();
            let of = |row: csv::StringRecord| kept.iter().map(|&i| row[i].to_owned()).collect();
            let rows = table.records().map(|row| of(row.unwrap())).collect();
            (path.file_name().unwrap().to_string_lossy().into_owned(), rows)
        })
        .collect()
}

/// What an experiment counts with a seed; its charts are looked at too.
fn counts_of(experiment: &Experiment, run: &str, seed: u64) -> BTreeMap<String, Vec<Vec<String>>> {
    let folder = format!("{}-{run}", experiment.name);
    let settings = Settings { seed, ..settings(&folder, Effort::Least) };
    let report = (experiment.run)(&settings).unwrap();
    assert!(!report.charts.is_empty(), "{}", experiment.name);
    for (file, _) in &report.charts {
        assert!(fs::read_to_string(settings.out_dir.join(file)).unwrap().contains("<svg"), "{file}");
    }
    let counts = counts(&settings.out_dir);
    fs::remove_dir_all(settings.out_dir).unwrap();
    assert!(counts.values().any(|rows| !rows.is_empty()), "{}", experiment.name);
    counts
}

/// Table 5.1 counts operations without random numbers, and Table 5.6 is of times alone.
const SAME_FOR_EVERY_SEED: [&str; 2] = ["operations", "deformable"];

/// The same seed gives the same counts, another one others.
fn counts_follow_the_seed(experiments: &[&str]) {
    for name in experiments {
        let experiment = experiment(name);
        let first = counts_of(experiment, "first", 1);
        assert_eq!(first, counts_of(experiment, "second", 1), "{name}");
        let other = counts_of(experiment, "other", 2);
        assert_eq!(first == other, SAME_FOR_EVERY_SEED.contains(name), "{name}");
    }
}

/// All experiments, in parts of about the same work: tests run beside each other.
const PARTS: [&[&str]; 3] = [
    &["trees", "operations"],
    &["convex-speed", "termination"],
    &["polygons", "solids", "bounding-volumes", "broad-phase", "deformable"],
];

#[test]
fn the_counts_of_trees_follow_the_seed() {
    counts_follow_the_seed(PARTS[0]);
}

#[test]
fn the_counts_of_searches_follow_the_seed() {
    counts_follow_the_seed(PARTS[1]);
}

#[test]
fn the_counts_of_the_other_experiments_follow_the_seed() {
    counts_follow_the_seed(PARTS[2]);
}

#[test]
fn every_experiment_is_held_to_its_seed() {
    let [mut held, mut named]: [Vec<&str>; 2] =
        [PARTS.concat(), all().iter().map(|experiment| experiment.name).collect()];
    held.sort_unstable();
    named.sort_unstable();
    assert_eq!(held, named);
}

#[test]
fn what_no_machine_changes_is_as_in_the_thesis() {
    for name in ["operations", "termination", "solids"] {
        let settings = settings(name, Effort::Quick);
        let report = (experiment(name).run)(&settings).unwrap();
        fs::remove_dir_all(settings.out_dir).unwrap();
        assert!(report.claims.iter().any(|claim| claim.agrees() == Some(true)), "{name}");
        for claim in &report.claims {
            assert_ne!(claim.agrees(), Some(false), "{claim:?}");
        }
    }
}
