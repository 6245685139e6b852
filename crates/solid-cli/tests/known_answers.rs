//! Placed pairs of meshes with known answers, from the folder that the environment variable SOLID_DATA names.

#![allow(clippy::unwrap_used, reason = "a test that can't go on shall stop")]

mod harness;

use std::path::Path;

use harness::{Desk, HEADER, data};

/// Checks the rows of `rigid/NAME.csv`: A stays at the identity, B takes a placement a frame.
fn check(name: &str, a: &str, b: &str, object_b: &str) {
    let Some(data) = data() else {
        return;
    };
    let (csv, expected) = placements(&data.join("rigid").join(name).with_extension("csv"), object_b);
    let hits = expected.iter().filter(|&&hit| hit).count();
    assert!(hits * 10 > expected.len() * 2 && hits * 10 < expected.len() * 8, "the rows are representative");
    let desk = Desk::new().file("p.csv", csv);
    let models = data.join("models");
    let mut command = desk.command("check --placements p.csv --response simple --json -");
    let run = harness::Run::of(command.arg(models.join(a)).arg(models.join(b)).output().unwrap());
    run.assert_status(1);
    let json = run.json();
    let found: Vec<bool> = json["frames"]
        .as_array()
        .unwrap()
        .iter()
        .map(|frame| !frame["collisions"].as_array().unwrap().is_empty())
        .collect();
    let wrong: Vec<usize> = (0..expected.len()).filter(|&row| found[row] != expected[row]).collect();
    assert_eq!((found.len(), wrong), (expected.len(), vec![]), "{name}");
}

/// The rows as a file of placements, and whether each collides.
fn placements(path: &Path, object: &str) -> (String, Vec<bool>) {
    let mut csv = HEADER.to_owned();
    let mut expected = Vec::new();
    for (frame, record) in csv::Reader::from_path(path).unwrap().records().enumerate() {
        let record = record.unwrap();
        let [qw, qx, qy, qz, tx, ty, tz, collide] = std::array::from_fn(|i| &record[i + 2]);
        csv.push_str(&format!("{frame},{object},{tx},{ty},{tz},{qx},{qy},{qz},{qw}\n"));
        expected.push(collide == "1");
    }
    (csv, expected)
}

#[test]
fn ship_and_ship() {
    check("ship_ship", "craft_speederD.obj", "craft_speederD.obj", "craft_speederD#2");
}

#[test]
fn teapot_and_teapot() {
    check("teapot_teapot", "teapot.obj", "teapot.obj", "teapot#2");
}

#[test]
fn torus_and_torus() {
    check("torus_torus", "torus.STL", "torus.STL", "torus#2");
}

#[test]
fn bunny_and_torus() {
    check("bunny_torus", "bunny5k.ply", "ipc_torus.obj", "ipc_torus");
}

#[test]
fn environment_and_robot() {
    check("fcl_env_rob", "fcl_env.obj", "fcl_rob.obj", "fcl_rob");
}
