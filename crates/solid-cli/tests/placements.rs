//! `--placements`, from the outside.

#![allow(clippy::unwrap_used, reason = "a test that can't go on shall stop")]

mod harness;

use harness::{Desk, HEADER, Run};

fn run(csv: &str) -> Run {
    Desk::with_boxes().file("p.csv", csv).run("check a.obj b.obj --placements p.csv --json -")
}

/// The frames with collisions.
fn colliding(csv: &str) -> Vec<usize> {
    let json = run(csv).json();
    let frames = json["frames"].as_array().unwrap();
    (0..frames.len()).filter(|&frame| !frames[frame]["collisions"].as_array().unwrap().is_empty()).collect()
}

#[test]
fn a_row_holds_until_the_next() {
    let csv = format!("{HEADER}6,b,9,0,0,0,0,0,1\n0,b,9,0,0,0,0,0,1\n3,b,0,0,0,0,0,0,1\n");
    assert_eq!(colliding(&csv), [3, 4, 5]);
}

#[test]
fn objects_stay_at_time_0_until_placed() {
    assert_eq!(colliding(&format!("{HEADER}2,b,9,0,0,0,0,0,1\n")), [0, 1]);
}

#[test]
fn rotation_and_scale_count() {
    let scaled = HEADER.replace("qw", "qw,sx,sy,sz");
    assert_eq!(colliding(&format!("{scaled}0,b,3.5,0,0,0,0,0,1,1,1,1\n1,b,3.5,0,0,0,0,0,1,3,1,1\n")), [1]);
    // A corner of a box turned by 45 degrees reaches out to the root of 2.
    assert_eq!(
        colliding(&format!("{HEADER}0,b,2.3,0,0,0,0,0,5\n1,b,2.3,0,0,0,0,0.38268343,0.92387953\n")),
        [1]
    );
}

#[test]
fn mistakes_name_file_line_and_expectation() {
    for (body, parts) in [
        ("0,c,0,0,0,0,0,0,1\n", &["p.csv:2: ", "no object \"c\"", "did you mean"][..]),
        ("0,b,0,0,0,0,0,0,1\n\n1,b,0,0,0,0,0,0,0\n", &["p.csv:4: ", "quaternion", "zero"]),
        ("0,b,0,0,0,0,nan,0,1\n", &["p.csv:2: ", "qy is \"nan\"", "finite"]),
        ("0,b,0,x,0,0,0,0,1\n", &["p.csv:2: ", "ty is \"x\""]),
        ("-1,b,0,0,0,0,0,0,1\n", &["p.csv:2: ", "frame is \"-1\""]),
        ("0,b,0,0,0,0,0\n", &["p.csv:2: ", "7 fields", "expected 9"]),
        ("4000000000,b,0,0,0,0,0,0,1\n", &["p.csv:2: ", "4000000000", "10000000"]),
        ("18446744073709551615,b,0,0,0,0,0,0,1\n", &["p.csv:2: ", "10000000"]),
        ("0,b,1e300,0,0,0,0,0,1\n", &["p.csv:2: ", "object \"b\"", "placement"]),
    ] {
        let run = run(&format!("{HEADER}{body}"));
        run.assert_fails(parts);
    }
}

#[test]
fn a_bad_header_says_what_was_expected() {
    for csv in ["", "frame,object,x,y,z\n", "0,b,0,0,0,0,0,0,1\n"] {
        run(csv).assert_fails(&["p.csv:1: ", "expected the header frame,object,tx,ty,tz,qx,qy,qz,qw"]);
    }
    let desk = Desk::with_boxes().file("p.csv", [0xff, 0x00, 0xfe]);
    desk.run("check a.obj b.obj --placements p.csv").assert_fails(&["p.csv"]);
    desk.run("check a.obj b.obj --placements q.csv").assert_fails(&["q.csv"]);
}

#[test]
fn a_singular_placement_stops_the_check() {
    let header = HEADER.replace("qw", "qw,sx,sy,sz");
    run(&format!("{header}0,b,9,0,0,0,0,0,1,1,1,1\n5,b,9,0,0,0,0,0,1,1,0,1\n")).assert_fails(&[
        "p.csv:3: ",
        "object \"b\"",
        "0.167 s",
        "singular",
    ]);
    run(&format!("{header}0,b,9,0,0,0,0,0,1,0,0,0\n")).assert_fails(&["p.csv:2: ", "0.000 s", "singular"]);
}

/// The later row holds, and it is said that there are two.
#[test]
fn an_object_that_is_placed_twice_is_warned_of() {
    let rows = "3,b,9,0,0,0,0,0,1\n0,b,9,0,0,0,0,0,1\n3,a,0,0,0,0,0,0,1\n3,b,0,0,0,0,0,0,1\n";
    let csv = format!("{HEADER}{rows}");
    assert_eq!(colliding(&csv), [3]);
    let warning =
        "warning: p.csv:5: object \"b\" is placed in frame 3 again, after line 2; the later row holds";
    assert_eq!(run(&csv).stderr, format!("{warning}\n"));
    let run_of_three = run(&format!("{csv}3,b,0,0,0,0,0,0,1\n"));
    assert_eq!(run_of_three.stderr, format!("{warning}; there is 1 more such row\n"));
    let csv = format!("{csv}0,b,9,0,0,0,0,0,1\n3,b,0,0,0,0,0,0,1\n");
    let warning = "warning: p.csv:6: object \"b\" is placed in frame 0 again, after line 3; the later row holds; \
                   there are 2 more such rows\n";
    assert_eq!(run(&csv).stderr, warning);
    let help = Desk::new().run("check --help").stdout;
    assert!(help.contains("of two for one frame and object the later holds"), "{help}");
}

#[test]
fn a_file_without_rows_is_warned_of() {
    let run = run(HEADER);
    assert_eq!(run.status, 1, "the boxes collide where they are");
    assert!(run.stderr.starts_with("warning: p.csv: there are no rows"), "{}", run.stderr);
}
