//! `--clearance`, `--response depth` and `--response contacts`, from the outside.

#![allow(clippy::unwrap_used, reason = "a test that can't go on shall stop")]

mod harness;

use harness::{Desk, HEADER};
use serde_json::{Value, json};

/// Two boxes, 2 in size: `b` is right of `a` by 1, then by a quarter, a half, and then in it by a half.
fn passing() -> Desk {
    let row = |frame: u32, x: f64| format!("{frame},b,{x},0.5,0,0,0,0,1\n");
    let rows: String = (0..).zip([3.0, 2.25, 2.5, 1.5]).map(|(frame, x)| row(frame, x)).collect();
    Desk::with_boxes().file("p.csv", format!("{HEADER}{rows}"))
}

/// The same without the collision.
fn apart() -> Desk {
    Desk::with_boxes()
        .file("p.csv", format!("{HEADER}0,b,3,0,0,0,0,0,1\n1,b,2.25,0,0,0,0,0,1\n2,b,2.5,0,0,0,0,0,1\n"))
}

const CHECK: &str = "check a.obj b.obj --placements p.csv --fps 10";

fn is(value: &Value, expected: f64) -> bool {
    value.as_f64().is_some_and(|x| (x - expected).abs() < 1e-12)
}

#[test]
fn what_comes_nearer_is_told_with_when_and_where() {
    let run = apart().run(&format!("{CHECK} --clearance 0.5"));
    let lines: Vec<_> = run.assert_status(1).stdout.lines().collect();
    assert!(lines[0].starts_with("a  b  first [s]  last [s]  frames  nearest  at [s]  on a"), "{run:?}");
    let row: Vec<_> = lines[1].split_whitespace().take(7).collect();
    assert_eq!(row, ["a", "b", "0.100", "0.100", "1", "0.25", "0.100"]);
    assert!(lines[1].contains("(1, ") && lines[1].contains("(1.25, "), "{run:?}");
    let last = [
        "no collisions",
        "1 pair is nearer than the clearance, in 1 of 3 frames; the least distance is 0.25",
    ];
    assert_eq!(lines[3..5], last);
}

#[test]
fn what_keeps_its_clearance_is_clean() {
    let run = apart().run(&format!("{CHECK} --clearance 0.25"));
    assert!(
        run.assert_status(0).stdout.contains("\nin no frame is anything nearer than its clearance\n"),
        "{run:?}"
    );
    // What collides has no clearance at all.
    passing().run(&format!("{CHECK} --clearance 0")).assert_status(1);
    // Also where the ways between frames are tested for collisions.
    let desk = Desk::with_boxes().file("p.csv", format!("{HEADER}0,b,-9,0,0,0,0,0,1\n1,b,9,0,0,0,0,0,1\n"));
    let run = desk.run(&format!("{CHECK} --continuous --clearance 1"));
    assert!(run.assert_status(1).stdout.contains("\nin no frame is anything nearer"), "{run:?}");
    let help = desk.run("check --help").stdout;
    assert!(help.contains("Clearances are those at the frames: also with --continuous"), "{help}");
    let run = apart().run(CHECK);
    assert!(!run.assert_status(0).stdout.contains("nearer"), "{run:?}");
}

#[test]
fn json_has_what_is_near_beside_what_collides() {
    let desk = passing();
    let json = desk.run(&format!("{CHECK} --clearance 0.75 --json - --solid *")).assert_status(1).json();
    let frames = json["frames"].as_array().unwrap();
    let counts =
        frames.iter().map(|f| [&f["near"], &f["collisions"]].map(|list| list.as_array().unwrap().len()));
    assert_eq!(counts.collect::<Vec<_>>(), [[0, 0], [1, 0], [1, 0], [1, 1]]);
    let near = &frames[1]["near"][0];
    assert_eq!((&near["a"], &near["b"]), (&json!("a"), &json!("b")));
    assert!(is(&near["distance"], 0.25) && is(&near["normal"][0], -1.0), "{near}");
    assert!(is(&near["point_a"][0], 1.0) && is(&near["point_b"][0], 1.25), "{near}");
    assert!(is(&frames[3]["near"][0]["distance"], -0.5), "{json}");
    let summary = &json["summary"];
    assert_eq!((&summary["near_frames"], &summary["near_pairs"]), (&json!(3), &json!(1)));
    assert!(is(&summary["least_distance"], -0.5), "{summary}");
    assert_eq!(summary["collisions"], 1);

    let json = desk.run(&format!("{CHECK} --json -")).json();
    assert!(json["frames"][1].get("near").is_none() && json["summary"].get("near_pairs").is_none(), "{json}");
}

#[test]
fn csv_tells_near_pairs_by_their_distance() {
    let run = passing().run(&format!("{CHECK} --clearance 0.5 --csv - --response simple --solid *"));
    let mut rows = run.assert_status(1).stdout.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = rows.next().unwrap();
    assert_eq!(header[9..], ["nz", "distance", "depth", "ax", "ay", "az", "bx", "by", "bz"]);
    let rows: Vec<_> = rows.collect();
    assert!(rows.iter().all(|row| row.len() == header.len()), "{run:?}");
    let frames_and_kinds: Vec<_> = rows.iter().map(|row| (row[0], row[10].is_empty())).collect();
    assert_eq!(frames_and_kinds, [("1", false), ("3", true), ("3", false)]);
    let number = |text: &str| text.parse::<f64>().unwrap();
    assert!(
        (number(rows[0][10]) - 0.25).abs() < 1e-12 && (number(rows[0][12]) - 1.0).abs() < 1e-12,
        "{run:?}"
    );
    assert!((number(rows[2][10]) + 0.5).abs() < 1e-12, "{run:?}");
}

#[test]
fn rules_may_set_it_for_all_and_for_a_pair() {
    let status = |rules: &str, more: &str, status: i32| {
        let run = apart().file("r.toml", rules).run(&format!("{CHECK} --rules r.toml {more}"));
        run.assert_status(status);
    };
    let pair = |response: &str, more: &str| {
        format!("[[pair]]\na = \"b\"\nb = \"a\"\nresponse = \"{response}\"\n{more}\n")
    };
    status("clearance = 0.5", "", 1);
    status("clearance = 0.25", "", 0);
    status("clearance = 0.25", "--clearance 0.5", 1);
    status("clearance = 1", "--clearance 0", 0);
    status(&pair("simple", "clearance = 0.5"), "", 1);
    status(&format!("clearance = 5\n{}", pair("simple", "clearance = 0.1")), "", 0);
    status(&format!("{}{}", pair("simple", "clearance = 0.5"), pair("simple", "clearance = 0.2")), "", 0);
    status(&pair("simple", "clearance = 0.1"), "--clearance 5", 0);
    // What is ignored is not looked at.
    status(&format!("clearance = 5\n{}", pair("ignore", "")), "", 0);
}

#[test]
fn what_is_no_length_is_refused() {
    for value in ["-1", "nan", "inf", "x"] {
        apart()
            .run(&format!("{CHECK} --clearance {value}"))
            .assert_fails(&["--clearance", "a length from 0"]);
    }
    let desk = apart().file("r.toml", "solid = []\nclearance = -1.0");
    desk.run(&format!("{CHECK} --rules r.toml"))
        .assert_fails(&["r.toml:2: clearance is -1; expected a length"]);
}

#[test]
fn depth_tells_how_deep_and_which_way_out() {
    let desk = passing();
    let json = desk.run(&format!("{CHECK} --response depth --solid * --json -")).assert_status(1).json();
    let hit = &json["frames"][3]["collisions"][0];
    assert!(is(&hit["depth"], 0.5) && is(&hit["normal"][0], -1.0), "{hit}");
    assert!(is(&hit["point_a"][0], 1.0) && is(&hit["point_b"][0], 0.5), "{hit}");
    assert!(is(&hit["point"][0], 0.75), "{hit}");

    // By rules, in the table and in CSV.
    let desk = desk.file("r.toml", "default = \"depth\"\nsolid = [\"*\"]");
    let run = desk.run(&format!("{CHECK} --rules r.toml"));
    assert!(run.stdout.starts_with("a  b  first [s]  last [s]  frames  deepest  where"), "{run:?}");
    assert_eq!(run.stdout.lines().nth(1).unwrap().split_whitespace().nth(5), Some("0.5"));
    let run = desk.run(&format!("{CHECK} --rules r.toml --csv -"));
    let row: Vec<_> = run.stdout.lines().nth(1).unwrap().split(',').collect();
    assert!(row[10].is_empty() && (row[11].parse::<f64>().unwrap() - 0.5).abs() < 1e-12, "{run:?}");
    // Other responses have none.
    let json = desk.run(&format!("{CHECK} --json -")).json();
    assert!(json["frames"][3]["collisions"][0].get("depth").is_none(), "{json}");
}

#[test]
fn contacts_are_all_told_and_the_deepest_twice() {
    let desk = passing();
    let json = desk.run(&format!("{CHECK} --response contacts --json -")).assert_status(1).json();
    let hit = &json["frames"][3]["collisions"][0];
    let regions = hit["contacts"].as_array().unwrap();
    assert!(regions.len() == 1 && is(&regions[0]["normal"][0], -1.0), "{hit}");
    let points = regions[0]["points"].as_array().unwrap();
    assert_eq!(points.len(), 4, "{hit}");
    for point in points {
        // Face on face, as deep at all corners of what they have in common.
        assert!(is(&point["depth"], 0.5) && is(&point["point_a"][0], 1.0), "{point}");
        assert!(is(&point["point_b"][0], 0.5), "{point}");
        let features = point["features"].as_array().unwrap();
        let known =
            |feature: &Value| ["vertex", "edge", "face"].iter().any(|kind| feature.get(kind).is_some());
        assert!(features.len() == 2 && features.iter().all(known), "{point}");
        assert_eq!(point["primitives"].as_array().unwrap().len(), 2, "{point}");
    }
    assert!(is(&hit["depth"], 0.5) && is(&hit["normal"][0], -1.0) && is(&hit["point"][0], 0.75), "{hit}");

    // By rules, in the table and in CSV.
    let desk = desk.file("r.toml", "default = \"contacts\"");
    let run = desk.run(&format!("{CHECK} --rules r.toml"));
    assert!(run.stdout.starts_with("a  b  first [s]  last [s]  frames  contacts  deepest  where"), "{run:?}");
    let row: Vec<_> = run.stdout.lines().nth(1).unwrap().split_whitespace().collect();
    assert_eq!(row[5..7], ["4", "0.5"]);
    let run = desk.run(&format!("{CHECK} --rules r.toml --csv -"));
    let row: Vec<_> = run.stdout.lines().nth(1).unwrap().split(',').collect();
    let expected = [(7, -1.0), (11, 0.5), (12, 1.0), (15, 0.5)];
    for (column, value) in expected {
        assert!((row[column].parse::<f64>().unwrap() - value).abs() < 1e-12, "{run:?}");
    }
    // Other responses have none.
    let json = desk.run(&format!("{CHECK} --json -")).json();
    assert!(json["frames"][3]["collisions"][0].get("contacts").is_none(), "{json}");
}

#[test]
fn the_help_and_the_statistics_tell_of_it() {
    let desk = passing();
    let help = desk.run("check --help").stdout;
    assert!(help.contains("--clearance <DISTANCE>") && help.contains("--response depth"), "{help}");
    assert!(help.contains("--response contacts"), "{help}");
    let stats = desk.run(&format!("{CHECK} --stats")).stdout;
    assert!(stats.lines().any(|line| line.starts_with("examined  ")), "{stats}");
}
