//! `--ray` and rays of rules, from the outside.

#![allow(clippy::unwrap_used, reason = "a test that can't go on shall stop")]

mod harness;

use harness::{Desk, HEADER};
use serde_json::json;

/// A box at the origin and one that is behind it along x, then beside, then nearer.
fn desk() -> Desk {
    let rows = format!("{HEADER}0,b,6,0,0,0,0,0,1\n1,b,6,9,0,0,0,0,1\n2,b,4,0,0,0,0,0,1\n");
    Desk::with_boxes().file("p.csv", rows)
}

const CHECK: &str = "check a.obj b.obj --placements p.csv --fps 10";
const RAY: &str = "--ray -3,0.5,0.25 2,0,0";

#[test]
fn the_table_tells_what_a_ray_meets_and_when() {
    let run = desk().run(&format!("{CHECK} {RAY}"));
    let lines: Vec<_> = run.assert_status(0).stdout.lines().collect();
    let words = |line: &str| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    assert!(
        lines[0].starts_with("ray  object  first [s]  last [s]  frames  nearest  at [s]  where"),
        "{run:?}"
    );
    assert_eq!(words(lines[1])[..7], ["1", "a", "0.000", "0.200", "3", "2", "0.000"]);
    assert_eq!(words(lines[2])[..7], ["1", "b", "0.000", "0.200", "2", "6", "0.200"]);
    assert!(lines[2].contains("(3, 0.5, 0.25)") && lines[2].contains("(-1, 0, 0)"), "{run:?}");
    assert_eq!(lines[4..6], ["no collisions", "1 ray meets something, in 3 of 3 frames"]);
    let run = desk().run(&format!("{CHECK} --ray 0,5,0 0,1,0 --ray 0,5,0 0,0,-1"));
    assert!(run.assert_status(0).stdout.contains("\n2 rays meet nothing\n"), "{run:?}");
}

#[test]
fn json_has_object_triangle_point_normal_and_distance() {
    let json = desk().run(&format!("{CHECK} {RAY} --json -")).json();
    let of = |frame: usize| json["frames"][frame]["rays"].as_array().unwrap().clone();
    assert_eq!([of(0).len(), of(1).len(), of(2).len()], [2, 1, 2]);
    let hit = &of(0)[0];
    assert_eq!((&hit["ray"], &hit["object"], &hit["distance"]), (&json!("1"), &json!("a"), &json!(2.0)));
    assert_eq!((&hit["point"], &hit["normal"]), (&json!([-1.0, 0.5, 0.25]), &json!([-1.0, 0.0, 0.0])));
    // The face at x = -1 is the last of six, of two triangles each.
    assert!(matches!(hit["primitive"].as_u64(), Some(10 | 11)), "{hit}");
    assert_eq!(of(2)[1]["distance"], 6.0);
    assert_eq!((&json["summary"]["ray_frames"], &json["summary"]["ray_meetings"]), (&json!(3), &json!(2)));
    // Without rays there is nothing of them.
    let json = desk().run(&format!("{CHECK} --json -")).json();
    assert!(json["frames"][0].get("rays").is_none() && json["summary"].get("ray_frames").is_none(), "{json}");
}

#[test]
fn csv_tells_sightings_by_their_ray() {
    let run = desk().run(&format!("{CHECK} {RAY} --continuous --csv -"));
    let rows: Vec<Vec<_>> = run.stdout.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(
        rows[0][10..],
        ["distance", "depth", "ax", "ay", "az", "bx", "by", "bz", "ray", "primitive", "contact_time"]
    );
    assert!(rows.iter().all(|row| row.len() == rows[0].len()), "{run:?}");
    let told: Vec<_> = rows[1..].iter().map(|row| (row[0], row[2], row[3], row[10], row[18])).collect();
    let expected = [("0", "a", "2"), ("0", "b", "8"), ("1", "a", "2"), ("2", "a", "2"), ("2", "b", "6")];
    for ((frame, object, distance), told) in expected.into_iter().zip(&told) {
        assert_eq!((told.0, told.1, told.2, told.4), (frame, object, "", "1"), "{run:?}");
        assert_eq!(told.3.parse::<f64>().unwrap(), distance.parse::<f64>().unwrap(), "{run:?}");
    }
    assert_eq!(told.len(), expected.len(), "{run:?}");
}

#[test]
fn rules_name_rays_and_segments() {
    let rules = "[[ray]]\nname = \"beam\"\norigin = [-3, 0, 0]\ndirection = [1, 0, 0]\n\
                 [[ray]]\nname = \"barrier\"\norigin = [-3, 0, 0]\nto = [2, 0, 0]\n";
    let json = desk().file("r.toml", rules).run(&format!("{CHECK} --rules r.toml --json -")).json();
    let rays = json["frames"][0]["rays"].as_array().unwrap();
    let met: Vec<_> =
        rays.iter().map(|hit| (hit["ray"].as_str().unwrap(), hit["object"].as_str().unwrap())).collect();
    assert_eq!(met, [("beam", "a"), ("beam", "b"), ("barrier", "a")]);
}

#[test]
fn mistakes_say_what_is_expected() {
    let desk = desk();
    for (arguments, expected) in [
        ("--ray 0,0 1,0,0", "three finite numbers X,Y,Z"),
        ("--ray 0,0,0 1,0,nan", "three finite numbers X,Y,Z"),
        ("--ray 0,0,0", "2 values required"),
        ("--ray 0,0,0 0,0,0", "--ray 1: ray.direction is (0.0, 0.0, 0.0)"),
        ("--ray 1e101,0,0 1,0,0", "--ray 1: ray.origin is"),
    ] {
        desk.run(&format!("{CHECK} {arguments}")).assert_fails(&[expected]);
    }
    let desk = desk.file("r.toml", "[[ray]]\nname = \"x\"\norigin = [0, 0, 0]\n");
    desk.run(&format!("{CHECK} --rules r.toml")).assert_fails(&["r.toml:2: a ray needs a direction"]);
    let twin = "[[ray]]\nname = \"1\"\norigin = [0, 0, 0]\nto = [1, 0, 0]\n";
    let desk = desk.file("r.toml", twin).file("twins.toml", twin.repeat(2));
    for (arguments, expected) in [
        (
            "--rules twins.toml",
            "twins.toml:6: the ray at twins.toml:2 has the name \"1\", too; expected a name of its own",
        ),
        ("--ray 0,0,0 1,0,0 --rules r.toml", "r.toml:2: the ray at --ray 1 has the name \"1\", too"),
    ] {
        desk.run(&format!("{CHECK} {arguments}")).assert_fails(&[expected]);
    }
    assert!(desk.run("check --help").stdout.contains("--ray <ORIGIN> <DIRECTION>"));
}

/// What begins inside of a solid meets no surface of it there: there is no triangle and no normal to tell.
#[test]
fn a_ray_from_the_inside_of_a_solid_tells_no_triangle() {
    let desk = Desk::with_boxes();
    let json = desk.run("check a.obj --solid a --ray 0,0,0 1,0,0 --json -").json();
    let hit = &json["frames"][0]["rays"][0];
    assert_eq!((&hit["distance"], &hit["point"]), (&json!(0.0), &json!([0.0, 0.0, 0.0])), "{hit}");
    assert_eq!((&hit["primitive"], &hit["normal"]), (&json!(null), &json!(null)), "{hit}");
    let csv = desk.run("check a.obj --solid a --ray 0,0,0 1,0,0 --csv -").stdout;
    assert!(csv.ends_with("\n0,0.0,a,,0.0,0.0,0.0,,,,0.0,,,,,,,,1,\n"), "{csv}");
}

/// With a ray there is something to find of one object, too.
#[test]
fn one_object_is_enough_for_a_ray() {
    let run = |more: &str| Desk::with_boxes().run(&format!("check a.obj {more}")).stderr;
    assert_eq!(run(RAY), "");
    assert!(run("").starts_with("warning: there is one object alone"), "{}", run(""));
}

/// Of several rays each has its own, the nearest first.
#[test]
fn rays_come_one_after_the_other() {
    let json = desk().run(&format!("{CHECK} {RAY} --ray 9,0.5,0.25 -1,0,0 --json -")).json();
    let rays = json["frames"][0]["rays"].as_array().unwrap();
    let met: Vec<_> = rays.iter().map(|hit| [hit["ray"].as_str(), hit["object"].as_str()]).collect();
    let expected = [["1", "a"], ["1", "b"], ["2", "b"], ["2", "a"]];
    assert_eq!(met, expected.map(|pair| pair.map(Some)));
}
