//! `--solid` and `--decompose`, from the outside.

#![allow(clippy::unwrap_used, reason = "a test that can't go on shall stop")]

mod harness;

use harness::{BOX, Desk, HEADER};

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

/// An L, one thick, with a foot to the right that is two long, and a block of a fifth, which a placement puts somewhere.
fn notched() -> Desk {
    let outline = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 3), (0, 3)];
    let vertices: String =
        [0, 1].iter().flat_map(|z| outline.map(|(x, y)| format!("v {x} {y} {z}\n"))).collect();
    let sides: String =
        (1..7).map(|i| format!("f {i} {j} {k} {l}\n", j = i % 6 + 1, k = i % 6 + 7, l = i + 6)).collect();
    let caps = "f 1 3 2\nf 1 4 3\nf 1 6 4\nf 4 6 5\nf 7 8 9\nf 7 9 10\nf 7 10 12\nf 10 11 12\n";
    let places = format!(
        "{HEADER}0,block,1.5,2,0.5,0,0,0,1\n1,block,1.5,0.5,0.5,0,0,0,1\n2,block,1.5,1.05,0.5,0,0,0,1\n"
    );
    let block: String = BOX
        .lines()
        .map(|line| line.replace('1', if line.starts_with('v') { "0.1" } else { "1" }) + "\n")
        .collect();
    Desk::new().file("l.obj", vertices + &sides + caps).file("block.obj", block).file("places.csv", places)
}

#[test]
fn convex_pieces_have_an_inside_and_a_depth() {
    let desk = notched();
    let frames = |options: &str| -> Vec<Vec<f64>> {
        let run = desk.run(&format!(
            "check l.obj block.obj --placements places.csv --response depth --json - {options}"
        ));
        let json = run.json();
        let frames = json["frames"].as_array().unwrap().iter();
        frames
            .map(|frame| {
                let collisions = frame["collisions"].as_array().unwrap().iter();
                collisions.map(|collision| collision["depth"].as_f64().unwrap()).collect()
            })
            .collect()
    };
    // In the notch, which is in the hull; in the foot; and on it, half in.
    let [notch, inside, half] = &frames("--decompose l")[..] else { panic!() };
    assert!(notch.is_empty() && inside.len() == 1 && half.len() == 1);
    assert!((inside[0] - 0.6).abs() < 1e-9 && (half[0] - 0.05).abs() < 1e-9, "{inside:?}, {half:?}");
    // As a solid it counts as its hull, and as a surface what is inside does not collide.
    let of_hull = frames("--solid l");
    assert!(of_hull[0].is_empty() && of_hull[2][0] > 0.1, "{of_hull:?}");
    assert!(frames("")[1].is_empty());
    assert_eq!(frames("--solid l --decompose l")[1].len(), 1);
    let rules = desk.file("r.toml", "decompose = [\"l\"]\n");
    rules.run("check l.obj block.obj --rules r.toml --placements places.csv").assert_status(1);
}

#[test]
fn what_cannot_be_decomposed_is_refused_with_the_reason() {
    let desk = Desk::new()
        .file("a.obj", BOX)
        .file("ball.wrl", "#VRML V2.0 utf8\nDEF ball Transform { children Shape { geometry Sphere {} } }\n");
    let run = desk.run("check a.obj ball.wrl --decompose ball");
    run.assert_fails(&[
        "ball.wrl: object \"ball\" cannot be decomposed: a sphere cannot be",
        "only meshes can",
    ]);
    // A pattern is for the meshes that it matches.
    desk.run("check a.obj ball.wrl --decompose * --strict").assert_status(1);
    let run = desk.run("check a.obj ball.wrl --solid b*");
    assert_eq!(run.stderr, "warning: --solid: \"b*\" matches no mesh\n");
    let run = desk.run("check a.obj ball.wrl --decompose bal");
    assert_eq!(run.stderr, "warning: --decompose: \"bal\" matches no object; did you mean \"ball\"?\n");
}
