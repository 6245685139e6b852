//! Animated scenes, from the outside.

#![allow(clippy::unwrap_used, reason = "a test that can't go on shall stop")]

mod harness;

use harness::{Desk, Run, data};

const VRML: &str = "#VRML V2.0 utf8\n";

/// A box of size 2 under a transform, which is named and placed by a field.
fn block(name: &str, field: &str) -> String {
    format!("DEF {name} Transform {{ {field} children Shape {{ geometry Box {{ size 2 2 2 }} }} }}\n")
}

/// Drives a field of a node with an interpolator over 2 seconds.
fn drive(interpolator: &str, values: &str, target: &str) -> String {
    format!(
        "DEF clock TimeSensor {{ cycleInterval 2 loop TRUE }}\n\
         DEF path {interpolator} {{ key [0 1] keyValue [{values}] }}\n\
         ROUTE clock.fraction_changed TO path.set_fraction\nROUTE path.value_changed TO {target}\n"
    )
}

/// A box that moves from 10 to 2 in 2 seconds, with respect to one at the origin.
fn approach() -> String {
    let blocks = block("mover", "") + &block("goal", "");
    format!("{VRML}{blocks}{}", drive("PositionInterpolator", "10 0 0, 2 0 0", "mover.set_translation"))
}

/// The frames with collisions.
fn colliding(run: &Run) -> Vec<usize> {
    let json = run.json();
    let frames = json["frames"].as_array().unwrap();
    (0..frames.len()).filter(|&frame| !frames[frame]["collisions"].as_array().unwrap().is_empty()).collect()
}

#[test]
fn the_animation_plays_from_start_to_end() {
    let desk = Desk::new().file("s.wrl", approach());
    let run = desk.run("check s.wrl --fps 4 --json -");
    // They touch at the very end, which is included.
    assert_eq!((colliding(&run), run.json()["frames"].as_array().unwrap().len()), (vec![8], 9));
    let run = desk.run("check s.wrl --fps 4 --to 1.75 --json -");
    run.assert_status(0);
    assert_eq!(run.json()["frames"].as_array().unwrap().len(), 8);
    let info = desk.run("info s.wrl").stdout;
    assert!(info.contains("animation of 2.000 s") && info.contains("solid"), "{info}");
}

/// Where the end is between two frames, the last step is shorter, and all that is told is of the frames as they are.
#[test]
fn the_end_is_a_frame_at_any_rate() {
    let desk = Desk::new().file("s.wrl", approach());
    for (options, times) in [
        ("--fps 0.75", [0.0, 4.0 / 3.0, 2.0].as_slice()),
        ("--fps 0.75 --continuous", &[0.0, 4.0 / 3.0, 2.0]),
        ("--fps 1 --from 0.5", &[0.5, 1.5, 2.0]),
        ("--fps 0.4 --to 2", &[0.0, 2.0]),
    ] {
        let run = desk.run(&format!("check s.wrl {options} --json -"));
        let told: Vec<f64> = run.assert_status(1).json()["frames"]
            .as_array()
            .unwrap()
            .iter()
            .map(|frame| frame["time"].as_f64().unwrap())
            .collect();
        assert_eq!((colliding(&run), told.as_slice()), (vec![times.len() - 1], times), "{options}");
        assert_eq!(run.json()["summary"]["frames"], times.len());
        let csv = desk.run(&format!("check s.wrl {options} --csv -")).stdout;
        let row = csv.lines().nth(1).unwrap();
        assert!(row.starts_with(&format!("{},2.0,mover,goal,", times.len() - 1)), "{row}");
        let table = desk.run(&format!("check s.wrl {options}")).stdout;
        assert!(table.contains(&format!("in 1 of {} frames", times.len())), "{table}");
    }
    // Before they touch.
    let run = desk.run("check s.wrl --fps 1 --to 1.9 --json -");
    assert_eq!(run.assert_status(0).json()["frames"][2]["time"], 1.9);
}

#[test]
fn smart_response_sees_the_previous_frame() {
    let run = Desk::new().file("s.wrl", approach()).run("check s.wrl --fps 4 --response smart --json -");
    let collision = run.json()["frames"][8]["collisions"][0].clone();
    let normal: Vec<f64> =
        collision["normal"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    assert!((normal[0] - 1.0).abs() < 1e-9, "from the goal, the second, to the mover: {collision}");
}

#[test]
fn placements_replace_the_animation() {
    let placements = format!("{}0,goal,0,50,0,0,0,0,1\n9,goal,10,0,0,0,0,0,1\n", harness::HEADER);
    let desk = Desk::new().file("s.wrl", approach()).file("p.csv", placements);
    let run = desk.run("check s.wrl --placements p.csv --json -");
    assert_eq!(colliding(&run), [9], "the mover stays where it is at time 0");
}

#[test]
fn a_deformation_is_seen() {
    let sheet = "Shape { geometry IndexedFaceSet { coord DEF points Coordinate { point [9 0 0, 9 1 0, 9 0 1] } \
                 coordIndex [0 1 2 -1] } }\n";
    let moved =
        drive("CoordinateInterpolator", "9 0 0, 9 1 0, 9 0 1, 0 0 0, 9 1 0, 9 0 1", "points.set_point");
    let text = format!("{VRML}{}DEF sheet Transform {{ children {sheet} }}\n{moved}", block("goal", ""));
    let run = Desk::new().file("s.wrl", text).run("check s.wrl --fps 4 --json -");
    assert_eq!(run.status, 1, "{run:?}");
    // The corner is at 9 - 4.5 t, so it reaches 1 after 1.78 s.
    assert_eq!(colliding(&run), [8]);
}

/// A triangle under a node, which holds a node with the same triangle.
const NESTED: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"name":"hull","mesh":0,"children":[1]},{"name":"turret","mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;

#[test]
fn nodes_on_one_root_path_are_not_tested_unless_a_rule_says_so() {
    let pair = |a: &str, b: &str| format!("[[pair]]\na = \"{a}\"\nb = \"{b}\"\nresponse = \"simple\"\n");
    let object = "[[object]]\nname = \"*\"\nresponse = \"simple\"\n";
    let desk = Desk::new().file("s.gltf", NESTED).file("object.toml", object);
    let desk = desk.file("pair.toml", pair("tur*", "hull")).file("all.toml", pair("*", "*"));
    let run = desk.run("check s.gltf --json -");
    run.assert_status(0);
    assert_eq!(run.json()["objects"].as_array().unwrap().len(), 2);
    desk.run("check s.gltf --rules object.toml").assert_status(0);
    desk.run("check s.gltf --rules pair.toml").assert_status(1);
    desk.run("check s.gltf --rules all.toml").assert_status(1);
    let twice = desk.run("check s.gltf s.gltf --json -").json();
    assert_eq!(twice["summary"]["pairs"], 4, "files are apart");
}

/// A box `mover` under a scale and a translation of three keys, at 0 s, 1 s and 2 s, and one at the origin.
fn hiding(scales: &str, translations: &str) -> Desk {
    let interpolator = |name: &str, values: &str| {
        format!("DEF {name} PositionInterpolator {{ key [0 0.5 1] keyValue [{values}] }}\n")
    };
    let route = |name: &str, field: &str| {
        format!(
            "ROUTE clock.fraction_changed TO {name}.set_fraction\nROUTE {name}.value_changed TO mover.{field}\n"
        )
    };
    let nodes =
        block("mover", "") + &block("goal", "") + "DEF clock TimeSensor { cycleInterval 2 loop TRUE }\n";
    let paths = interpolator("size", scales) + &interpolator("place", translations);
    let routes = route("size", "set_scale") + &route("place", "set_translation");
    Desk::new().file("s.wrl", format!("{VRML}{nodes}{paths}{routes}"))
}

const HERE: &str = "0 0 0, 0 0 0, 0 0 0";

/// What the command says of the mover, if it is first absent at a time.
fn absence(time: &str) -> String {
    format!(
        "warning: s.wrl: object \"mover\" is scaled to nothing, or flat, at {time} s; it is not there in such frames\n"
    )
}

/// Animators hide objects by a scale of 0.
#[test]
fn what_is_scaled_to_nothing_is_not_there() {
    for nothing in ["0 0 0", "1 0 1", "1 1 1e-200"] {
        let desk = hiding(&format!("1 1 1, {nothing}, 1 1 1"), HERE);
        let check = "check s.wrl --fps 2 --clearance 0.1 --ray -9,0,0 1,0,0";
        for more in ["", "--continuous", "--response smart", "--response contacts"] {
            let run = desk.run(&format!("{check} {more} --json -"));
            assert_eq!((run.status, run.stderr.as_str()), (1, absence("1.000").as_str()), "{nothing} {more}");
            assert_eq!(colliding(&run), [0, 1, 3, 4], "{nothing} {more}");
            let json = run.json();
            let count = |frame: usize, list: &str| json["frames"][frame][list].as_array().unwrap().len();
            assert_eq!([1, 2, 3].map(|frame| count(frame, "near")), [1, 0, 1], "{json}");
            assert_eq!([1, 2, 3].map(|frame| count(frame, "rays")), [2, 1, 2], "{json}");
        }
        // Whether a frame is there does not decide over the others.
        assert_eq!(desk.run("check s.wrl --fps 1.5").stderr, "");
    }
}

#[test]
fn what_is_absent_from_the_start_comes_later() {
    let desk = hiding("0 0 0, 0 0 0, 1 1 1", HERE);
    let run = desk.run("check s.wrl --fps 1 --json -");
    assert_eq!((colliding(&run), run.stderr), (vec![2], absence("0.000")));
    // And what is never there never collides.
    let desk = hiding("0 0 0, 0 0 0, 0 0 0", HERE);
    assert_eq!(desk.run("check s.wrl --from 1").assert_status(0).stderr, absence("1.000"));
    let placements = format!("{}0,goal,0,0,0,0,0,0,1\n3,goal,1,0,0,0,0,0,1\n", harness::HEADER);
    let run = desk.file("p.csv", placements).run("check s.wrl --placements p.csv");
    assert_eq!(run.assert_status(0).stderr, absence("0.000"));
}

/// However many are absent in one place.
#[test]
fn what_is_absent_does_not_crowd() {
    let blocks = ["a", "b", "c"].map(|name| block(name, "")).concat();
    let routes = ["b", "c"].map(|name| format!("ROUTE path.value_changed TO {name}.set_scale\n")).concat();
    let scale = drive("PositionInterpolator", "0 0 0, 0 0 0", "a.set_scale");
    let desk = Desk::new().file("s.wrl", format!("{VRML}{blocks}{scale}{routes}"));
    desk.run("check s.wrl --max-pairs 0 --clearance 1").assert_status(0);
}

/// There is no way from where it was before it was absent.
#[test]
fn what_comes_again_is_new() {
    let shown_elsewhere = "-10 0 0, -10 0 0, 10 0 0";
    let status = |scales: &str, translations: &str| {
        hiding(scales, translations).run("check s.wrl --fps 1 --continuous").status
    };
    assert_eq!(status("1 1 1, 1 1 1, 1 1 1", shown_elsewhere), 1);
    assert_eq!(status("1 1 1, 0 0 0, 1 1 1", shown_elsewhere), 0);
    assert_eq!(status("0 0 0, 0 0 0, 1 1 1", shown_elsewhere), 0);
    let desk = hiding("1 1 1, 0 0 0, 1 1 1", "-10 0 0, -10 0 0, 0.5 0 0");
    let run = desk.run("check s.wrl --fps 1 --continuous --response smart --json -");
    let collision = run.assert_status(1).json()["frames"][2]["collisions"][0].clone();
    assert_eq!(collision["contact_time"], 2.0, "{collision}");
    assert_eq!(collision["normal"][0], 1.0, "the way out, not that from where it was: {collision}");
}

#[test]
fn an_animation_can_be_chosen() {
    let Some(data) = data() else {
        return;
    };
    let fox = data.join("gltf").join("Fox.glb");
    let run = |animation: &str| {
        let desk = Desk::new();
        let mut command = desk.command("info");
        Run::of(command.args(["--animation", animation]).arg(&fox).output().unwrap())
    };
    assert_eq!(run("Walk").assert_status(0).stdout, run("1").stdout);
    assert_ne!(run("Walk").stdout, run("0").stdout);
    run("Fly").assert_fails(&["Fox.glb", "Fly"]);
}
