//! `--solid`, from the outside.

#![allow(clippy::unwrap_used, reason = "a test that can't go on shall stop")]

mod harness;

use harness::{BOX, Desk};

/// A box, and one of a tenth of the size inside it.
fn desk() -> Desk {
    let small: String = BOX
        .lines()
        .map(|line| line.replace('1', if line.starts_with('v') { "0.1" } else { "1" }) + "\n")
        .collect();
    Desk::new().file("tank.obj", BOX).file("fish.obj", small)
}

#[test]
fn what_is_inside_collides_when_the_mesh_is_solid() {
    desk().run("check tank.obj fish.obj").assert_status(0);
    desk().run("check tank.obj fish.obj --solid tank").assert_status(1);
    desk().run("check tank.obj fish.obj --solid t*k --solid tank").assert_status(1);
    desk().run("check tank.obj fish.obj --solid fish").assert_status(0);
    let rules = desk().file("r.toml", "solid = [\"tank\"]\n");
    rules.run("check tank.obj fish.obj --rules r.toml").assert_status(1);
}

#[test]
fn a_mesh_that_is_not_closed_is_refused_with_its_open_edges() {
    let open = BOX.lines().take(13).map(|line| format!("{line}\n")).collect::<String>();
    let run = desk().file("tank.obj", open).run("check tank.obj fish.obj --solid tank");
    run.assert_fails(&[
        "tank.obj: object \"tank\" cannot be solid: mesh is not closed: of its edges, 4 must",
    ]);
}

#[test]
fn a_pattern_that_matches_nothing_is_warned_of() {
    let run = desk().run("check tank.obj fish.obj --solid tanc");
    assert_eq!(run.stderr, "warning: --solid: \"tanc\" matches no object; did you mean \"tank\"?\n");
}
