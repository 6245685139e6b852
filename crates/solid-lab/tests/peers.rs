//! The whole comparison once, on tiny inputs: benchmarks that do not run rot.
#![allow(clippy::print_stdout, reason = "a seed is printed")]

use solid_lab::inputs::SEED;
use solid_lab::peers::{Effort, Kind, Peer, TARGETS, draw, run, shortfalls, table};

#[test]
fn every_case_runs_and_every_target_has_its_row() {
    println!("seed {SEED}");
    let report = run(Effort::Smoke, SEED, &[], |_| {});

    for row in &report.rows {
        let figures = [row.ours, row.theirs].into_iter().flatten();
        assert!(figures.clone().count() > 0 && figures.clone().all(|x| x.is_finite() && x >= 0.0), "{row:?}");
        assert_eq!(row.peer == Peer::Nobody, row.theirs.is_none(), "{row:?}");
        assert!(row.peer != Peer::Ours && !row.work.is_empty() && !row.unit.is_empty(), "{row:?}");
        assert_eq!(row.ours_quartiles.is_some(), row.kind == Kind::Time && row.ours.is_some(), "{row:?}");
        assert!(row.kind != Kind::Wrong || row.ours == Some(0.0), "a wrong answer of ours: {row:?}");
    }
    for kind in [Kind::Time, Kind::Count, Kind::Memory, Kind::Wrong] {
        assert!(report.rows.iter().any(|row| row.kind == kind), "there is no row of {kind:?}");
    }
    for target in TARGETS {
        let has_row = report.rows.iter().any(|row| {
            row.peer == target.peer && row.target == Some(target.ratio) && row.work.starts_with(target.work)
        });
        assert!(has_row, "nothing measures {target:?}");
    }

    let json = serde_json::to_value(&report).expect("a report has a form in JSON");
    let row = &json["rows"][0];
    for key in ["work", "peer", "ours", "theirs", "unit", "ratio", "target", "met"] {
        assert!(row.get(key).is_some(), "no {key} in {row}");
    }
    assert!(table(&report).contains("I-COLLIDE, 10,000 polyhedra"));
    let missed = report.rows.iter().filter(|row| row.target.is_some() && row.met == Some(false)).count();
    assert_eq!(shortfalls(&report).lines().count(), missed + 2, "a head of two lines, and a line each");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let chart = folder.path().join("peers.svg");
    draw(&report, &chart).expect("there is something to draw");
    assert!(std::fs::read_to_string(&chart).expect("it was written").contains("parry3d-f64"));
}
