//! `--continuous`, from the outside.

#![allow(clippy::unwrap_used, reason = "a test that can't go on shall stop")]

mod harness;

use harness::{Desk, HEADER};

/// A box, the wall, and another, the bullet, that is before it in one frame and behind it in the next.
fn bullet() -> Desk {
    let rows: String = [-9.0, -4.0, 6.0, 16.0]
        .iter()
        .enumerate()
        .map(|(frame, x)| format!("{frame},b,{x},0.5,0,0,0,0,1\n"))
        .collect();
    Desk::with_boxes().file("p.csv", format!("{HEADER}{rows}"))
}

#[test]
fn a_bullet_that_passes_a_wall_between_two_frames_is_found() {
    let command = "check a.obj b.obj --placements p.csv --fps 10";
    bullet().run(command).assert_status(0);
    let run = bullet().run(&format!("{command} --continuous"));
    run.assert_status(1);
    // From -4 at 0.1 s to 6 at 0.2 s; they touch at -2.
    let words: Vec<&str> = run.stdout.lines().nth(1).unwrap().split_whitespace().collect();
    assert_eq!(words[..5], ["a", "b", "0.120", "0.200", "1"]);
    assert!(run.stdout.contains("1 pair collides, in 1 of 4 frames"), "{}", run.stdout);
}

#[test]
fn json_and_csv_have_the_time_and_the_place_of_the_first_contact() {
    let command = "check a.obj b.obj --placements p.csv --fps 10 --continuous";
    let json = bullet().run(&format!("{command} --json -")).json();
    let collision = &json["frames"][2]["collisions"][0];
    let time = collision["contact_time"].as_f64().unwrap();
    assert!(time <= 0.12 && time > 0.12 - 1e-6, "{collision}");
    assert!((collision["point"][0].as_f64().unwrap() + 1.0).abs() < 1e-6, "{collision}");
    for frame in [0, 1, 3] {
        assert_eq!(json["frames"][frame]["collisions"].as_array().unwrap().len(), 0);
    }
    let csv = bullet().run(&format!("{command} --csv -")).stdout;
    let lines: Vec<&str> = csv.lines().collect();
    assert!(lines.len() == 2 && lines[0].ends_with(",nz,contact_time"), "{csv}");
    assert_eq!(lines[1].split(',').next_back().unwrap().parse::<f64>().unwrap(), time);
    let plain = bullet().run("check a.obj b.obj --placements p.csv --csv -").stdout;
    assert_eq!(plain, "frame,time,a,b,px,py,pz,nx,ny,nz\n");
}

/// What stays in touch touches from the previous frame on, and what was there at the start from the start.
#[test]
fn a_contact_that_lasts_has_the_time_of_the_previous_frame() {
    let rows: String = [3.0, 1.0, 0.5, 5.0]
        .iter()
        .enumerate()
        .map(|(frame, x)| format!("{frame},b,{x},0,0,0,0,0,1\n"))
        .collect();
    let desk = Desk::with_boxes().file("p.csv", format!("{HEADER}{rows}"));
    let json = desk.run("check a.obj b.obj --placements p.csv --fps 10 --continuous --json -").json();
    let times: Vec<Option<f64>> =
        (0..4).map(|frame| json["frames"][frame]["collisions"][0]["contact_time"].as_f64()).collect();
    assert!((times[1].unwrap() - 0.05).abs() < 1e-6, "{times:?}");
    // In the last frame they part, having touched until then.
    assert_eq!([times[0], times[2], times[3]], [None, Some(0.1), Some(0.2)], "{times:?}");
    let still = Desk::with_boxes().run("check a.obj b.obj --continuous --json -").json();
    assert_eq!(still["frames"][0]["collisions"][0]["contact_time"], 0.0);
}

/// Of a turning object only what its points pass counts: the way of the whole, which is tested first, encloses more.
#[test]
fn what_only_seems_to_meet_is_left_out() {
    // A quarter turn about y of a blade from -8 to 8 along x: one half sweeps where x is positive and z negative, the other the
    // opposite; the hull of both ends has all four quarters.
    let blade = "v -8 0 0\nv 8 0 0\nv 8 0.1 0\nf 1 2 3\n";
    let turn =
        format!("{HEADER}0,blade,0,0,0,0,0,0,1\n1,blade,0,0,0,0,0.7071067811865476,0,0.7071067811865476\n");
    let mote =
        |x: f64, z: f64| format!("v {x} 0.01 {z}\nv {x} 0.02 {z}\nv {x} 0.02 {}\nf 1 2 3\n", z + 0.001);
    let run = |x: f64, z: f64| {
        let desk = Desk::new().file("blade.obj", blade).file("mote.obj", mote(x, z)).file("p.csv", &turn);
        desk.run("check blade.obj mote.obj --placements p.csv --continuous").status
    };
    assert_eq!(run(2.0, -2.0), 1);
    assert_eq!(run(2.0, 2.0), 0);
}

#[test]
fn what_meets_on_the_way_has_a_point_only_where_the_response_tells_one() {
    let command = "check a.obj b.obj --placements p.csv --fps 10 --continuous --response simple --json -";
    let json = bullet().run(command).json();
    let collision = &json["frames"][2]["collisions"][0];
    assert!(collision["contact_time"].is_number() && collision["point"].is_null(), "{collision}");
}

/// The first frame has no way to it, wherever the animation begins.
#[test]
fn nothing_is_on_its_way_to_the_first_frame() {
    // A triangle that rises from below a ball to above it.
    let text = "#VRML V2.0 utf8
        DEF ball Shape { geometry Sphere { radius 0.5 } }
        DEF sheet Shape { geometry IndexedFaceSet { coordIndex [ 0 1 2 ]
          coord DEF points Coordinate { point [ -9 -2 -9, 9 -2 -9, 0 -2 9 ] } } }
        DEF clock TimeSensor { cycleInterval 2 }
        DEF path CoordinateInterpolator { key [ 0 1 ]
          keyValue [ -9 -2 -9, 9 -2 -9, 0 -2 9, -9 2 -9, 9 2 -9, 0 2 9 ] }
        ROUTE clock.fraction_changed TO path.set_fraction
        ROUTE path.value_changed TO points.set_point";
    let desk = Desk::new().file("s.wrl", text);
    desk.run("check s.wrl --from 2 --continuous").assert_status(0);
    desk.run("check s.wrl --fps 0.5 --continuous").assert_status(1);
}
