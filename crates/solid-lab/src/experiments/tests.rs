use std::fs;

use super::*;

/// Small samples in a folder of its own.
fn settings(name: &str) -> Settings {
    let out_dir = std::env::temp_dir().join(format!("solid-lab-{name}-{}", std::process::id()));
    fs::create_dir_all(&out_dir).unwrap();
    Settings { quick: true, seed: 1, out_dir }
}

fn experiment(name: &str) -> &'static Experiment {
    all().iter().find(|experiment| experiment.name == name).unwrap()
}

#[test]
fn an_experiment_writes_its_charts_and_the_same_counts_each_time() {
    let run = |folder: &str| {
        let settings = settings(folder);
        let report = (experiment("bounding-volumes").run)(&settings).unwrap();
        for (file, _) in &report.charts {
            assert!(fs::read_to_string(settings.out_dir.join(file)).unwrap().contains("<svg"), "{file}");
        }
        let table = fs::read_to_string(settings.out_dir.join("bounding-volumes.csv")).unwrap();
        fs::remove_dir_all(settings.out_dir).unwrap();
        table
    };
    assert_eq!(run("first"), run("second"));
}

#[test]
fn what_no_machine_changes_is_as_in_the_thesis() {
    for name in ["operations", "termination"] {
        let settings = settings(name);
        let report = (experiment(name).run)(&settings).unwrap();
        fs::remove_dir_all(settings.out_dir).unwrap();
        assert!(report.claims.iter().any(|claim| claim.agrees() == Some(true)), "{name}");
        for claim in &report.claims {
            assert_ne!(claim.agrees(), Some(false), "{claim:?}");
        }
    }
}
