//! `solid check`, from the outside.

#![allow(clippy::unwrap_used, reason = "a test that can't go on shall stop")]

mod harness;

use harness::{BOX, Desk, HEADER};
use serde_json::json;

/// Two boxes, of which `b` comes from the right, enters `a` in frames 2 and 3, and leaves.
fn passing() -> Desk {
    let rows: String = [5.0, 3.0, 1.5, -1.5, -3.0]
        .iter()
        .enumerate()
        .map(|(frame, x)| format!("{frame},b,{x},0,0,0,0,0,1\n"))
        .collect();
    Desk::with_boxes().file("p.csv", format!("{HEADER}{rows}"))
}

#[test]
fn objects_apart_make_status_0() {
    let desk = Desk::with_boxes().file("p.csv", format!("{HEADER}0,b,9,0,0,0,0,0,1\n"));
    let run = desk.run("check a.obj b.obj --placements p.csv");
    run.assert_status(0);
    assert!(
        run.stdout.starts_with("no collisions\n2 objects, 24 triangles, 1 frame, 0 tests, "),
        "{}",
        run.stdout
    );
    assert_eq!(run.stderr, "");
}

#[test]
fn collisions_make_status_1_and_a_table() {
    let run = passing().run("check a.obj b.obj --placements p.csv --fps 10");
    run.assert_status(1);
    let lines: Vec<&str> = run.stdout.lines().collect();
    let words = |line: &str| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(words(lines[0]), ["a", "b", "first", "[s]", "last", "[s]", "frames", "where"]);
    assert_eq!(words(lines[1])[..5], ["a", "b", "0.200", "0.300", "2"]);
    assert!(lines[1].contains('('), "{}", lines[1]);
    assert_eq!(lines[2..4], ["", "1 pair collides, in 2 of 5 frames"]);
    assert!(lines[4].starts_with("2 objects, 24 triangles, 5 frames, 2 tests, "), "{}", lines[4]);
    assert!(run.stdout.is_ascii(), "no rules are drawn into a pipe");
}

#[test]
fn json_is_the_documented_format() {
    let run = passing().run("check a.obj b.obj --placements p.csv --fps 10 --json - --response simple");
    run.assert_status(1);
    assert_eq!(run.stderr, "");
    let clash = json!([{"a": "a", "b": "b", "point": null, "normal": null}]);
    let expected = json!({
        "scene": ["a.obj", "b.obj"],
        "objects": [
            {"id": 0, "name": "a", "kind": "mesh", "primitives": 12},
            {"id": 1, "name": "b", "kind": "mesh", "primitives": 12},
        ],
        "frames": [
            {"frame": 0, "time": 0.0, "collisions": []},
            {"frame": 1, "time": 0.1, "collisions": []},
            {"frame": 2, "time": 0.2, "collisions": clash},
            {"frame": 3, "time": 0.3, "collisions": clash},
            {"frame": 4, "time": 0.4, "collisions": []},
        ],
        "summary": {"frames": 5, "colliding_frames": 2, "collisions": 2, "pairs": 1},
    });
    assert_eq!(run.json(), expected);
}

#[test]
fn witness_has_a_point_and_smart_a_normal_too() {
    let desk = passing();
    let collision = |response: &str, frame: usize| {
        let run = desk.run(&format!("check a.obj b.obj --placements p.csv --json - --response {response}"));
        run.json()["frames"][frame]["collisions"][0].clone()
    };
    let witness = collision("witness", 2);
    assert!(witness["point"].is_array() && witness["normal"].is_null(), "{witness}");
    // b was at the right of a, a gap of 1 between them.
    let smart = collision("smart", 2);
    assert_eq!(smart["normal"], json!([-1.0, 0.0, 0.0]), "{smart}");
    assert!((smart["point"][0].as_f64().unwrap() - 1.5).abs() < 1e-9, "{smart}");
    // They collided in the frame before: the way out.
    assert!(collision("smart", 3)["normal"].is_array());
}

#[test]
fn curve_has_the_lines_in_which_surfaces_meet() {
    // A corner of b is in the middle of a.
    let desk = Desk::with_boxes().file("p.csv", format!("{HEADER}0,b,1,1,1,0,0,0,1\n"));
    let run = desk.run("check a.obj b.obj --placements p.csv --json - --response curve");
    let collision = run.assert_status(1).json()["frames"][0]["collisions"][0].clone();
    let polylines: Vec<Vec<[f64; 3]>> = serde_json::from_value(collision["curve"].clone()).unwrap();
    assert_eq!(polylines.len(), 1, "{collision}");
    let path = &polylines[0];
    assert_eq!(path.first(), path.last(), "it is closed");
    let length: f64 =
        path.windows(2).map(|p| (0..3).map(|k| (p[1][k] - p[0][k]).powi(2)).sum::<f64>().sqrt()).sum();
    assert_eq!(length, 6.0);
    assert_eq!((&collision["point"], &collision["normal"]), (&json!(path[0]), &json!(null)));

    // The same by rules; the point is that of the table and of CSV.
    let desk = desk.file("r.toml", "default = \"curve\"\n");
    let run = desk.run("check a.obj b.obj --placements p.csv --rules r.toml --csv -");
    let row = run.stdout.lines().nth(1).unwrap().to_owned();
    let point: Vec<f64> = row.split(',').skip(4).take(3).map(|field| field.parse().unwrap()).collect();
    assert_eq!(point, path[0], "{row}");
    // Other responses have no curve in JSON.
    let run = desk.run("check a.obj b.obj --placements p.csv --json -");
    assert!(run.json()["frames"][0]["collisions"][0].get("curve").is_none());
    assert!(desk.run("check --help").stdout.contains("--response curve"));
}

#[test]
fn csv_has_a_row_per_collision() {
    let desk = passing();
    let run = desk.run("check a.obj b.obj --placements p.csv --fps 10 --csv - --response simple");
    run.assert_status(1);
    let expected = "frame,time,a,b,px,py,pz,nx,ny,nz\n2,0.2,a,b,,,,,,\n3,0.3,a,b,,,,,,\n";
    assert_eq!(run.stdout, expected);
    desk.run("check a.obj b.obj --placements p.csv --csv out.csv").assert_status(1);
    let row = desk.read("out.csv").lines().nth(1).unwrap().to_owned();
    let fields: Vec<&str> = row.split(',').collect();
    assert!(fields.len() == 10 && fields[4].parse::<f64>().is_ok() && fields[7].is_empty(), "{row}");
}

#[test]
fn a_table_and_files_can_be_had_together() {
    let desk = passing();
    let run = desk.run("check a.obj b.obj --placements p.csv --json out.json --csv out.csv --stats");
    run.assert_status(1);
    assert!(run.stdout.contains("1 pair collides") && run.stdout.contains("\nbox tests"), "{}", run.stdout);
    serde_json::from_str::<serde_json::Value>(&desk.read("out.json")).unwrap();
    let piped = desk.run("check a.obj b.obj --placements p.csv --json - --stats");
    piped.json();
    assert!(piped.stderr.contains("candidates"), "{}", piped.stderr);
}

#[test]
fn output_is_the_same_every_time() {
    let desk = passing();
    let run = || desk.run("check a.obj b.obj --placements p.csv --json - --response smart").stdout;
    assert_eq!(run(), run());
}

#[test]
fn a_static_scene_has_one_frame() {
    let run = Desk::with_boxes().run("check a.obj b.obj --json -");
    run.assert_status(1);
    assert_eq!(
        run.json()["summary"],
        json!({"frames": 1, "colliding_frames": 1, "collisions": 1, "pairs": 1})
    );
}

#[test]
fn from_and_to_choose_the_frames() {
    let desk = Desk::with_boxes();
    let run = desk.run("check a.obj b.obj --from 1 --to 2 --fps 4 --json -");
    let times: Vec<_> = run.json()["frames"]
        .as_array()
        .unwrap()
        .iter()
        .map(|frame| frame["time"].as_f64().unwrap())
        .collect();
    assert_eq!(times, [1.0, 1.25, 1.5, 1.75, 2.0]);
    desk.run("check a.obj --from 2 --to 1").assert_fails(&["--from is 2", "at 1"]);
}

/// No message and no table tells a number in hundreds of digits.
#[test]
fn times_of_any_size_are_legible() {
    let desk = Desk::with_boxes();
    desk.run("check a.obj --to 1e300").assert_fails(&[
        "1e300 seconds at 30.0 frames per second",
        "(--to)",
        "(--fps)",
    ]);
    desk.run("check a.obj --from 2e300 --to 1e300")
        .assert_fails(&["--from is 2e300, after the end at 1e300"]);
    let run = desk.run("check a.obj b.obj --from 1e300 --to 1e300");
    assert!(run.assert_status(1).stdout.contains(" 1.000e300 "), "{}", run.stdout);
}

#[test]
fn split_makes_each_group_an_object() {
    let desk = Desk::new().file("two.obj", "g left\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\ng right\nf 3 2 1\n");
    let names = |run: harness::Run| -> Vec<String> {
        let objects = run.json()["objects"].as_array().unwrap().clone();
        objects.iter().map(|object| object["name"].as_str().unwrap().to_owned()).collect()
    };
    assert_eq!(names(desk.run("check two.obj --json -")).len(), 1);
    assert_eq!(names(desk.run("check two.obj --split --json -")), ["left", "right"]);
    let desk = desk.file(
        "triangle.stl",
        "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n",
    );
    for command in ["check", "info"] {
        desk.run(&format!("{command} triangle.stl --split")).assert_fails(&["--split divides an OBJ file"]);
        assert_ne!(desk.run(&format!("{command} triangle.stl two.obj --split")).status, 2);
    }
}

#[test]
fn one_file_twice_makes_two_objects() {
    let run = Desk::with_boxes().run("check a.obj a.obj --json -");
    run.assert_status(1);
    let json = run.json();
    assert_eq!((&json["objects"][0]["name"], &json["objects"][1]["name"]), (&json!("a"), &json!("a#2")));
}

#[test]
fn usage_errors_make_status_2() {
    let desk = Desk::with_boxes();
    for arguments in [
        "",
        "check",
        "chekc a.obj",
        "check a.obj --fps 0",
        "check a.obj --fps -3",
        "check a.obj --fps nan",
        "check a.obj --fps 1e999",
        "check a.obj --from -1",
        "check a.obj --to inf",
        "check a.obj --response ignore",
        "check a.obj --placements p.csv --from 1",
        "check a.obj --json - --csv -",
        "check a.obj --to 1e9",
        "check a.obj --to 1e308 --fps 1e308",
        "info",
    ] {
        let run = desk.run(arguments);
        assert_eq!((run.status, run.stdout.as_str()), (2, ""), "{arguments}: {run:?}");
        assert!(!run.stderr.is_empty(), "{arguments}");
    }
}

#[test]
fn help_and_version_make_status_0() {
    let desk = Desk::new();
    for arguments in ["--help", "--version", "check --help", "info --help", "help check"] {
        let run = desk.run(arguments);
        assert_eq!((run.status, run.stderr.as_str()), (0, ""), "{arguments}");
    }
    let help = desk.run("check --help").stdout;
    assert!(help.contains("[[pair]]") && help.contains("frame,object,tx,ty,tz,qx,qy,qz,qw"), "{help}");
    assert!(help.contains("[default: 30]"), "{help}");
    for key in ["default", "solid", "decompose", "clearance"] {
        assert!(help.contains(&format!("    {key} = ")), "{key}");
    }
}

#[test]
fn bad_scenes_are_named() {
    let desk = Desk::with_boxes()
        .file("bad.obj", "v 0 0 0\nv 1 0 x\n")
        .file("none.xyz", "")
        .file("binary.obj", [0xff, 0xfe, 0x00, 0x80]);
    desk.run("check a.obj missing.obj").assert_fails(&["missing.obj"]);
    desk.run("check bad.obj").assert_fails(&["bad.obj:2", "x"]);
    desk.run("check none.xyz").assert_fails(&["none.xyz", "expected"]);
    desk.run("check .").assert_fails(&["."]);
    let run = desk.run("check binary.obj");
    assert!(matches!(run.status, 0 | 2), "{run:?}");
}

/// Whatever names and files hold, messages leave the terminal as it is.
#[test]
fn control_characters_of_names_are_escaped_in_messages() {
    let desk = Desk::with_boxes()
        .file("a\u{1b}[2J.ply", "ply\n")
        .file("r\u{1b}[2J.toml", "[[object]]\nname = \"x\"\nresponse = \"ignore\"\n");
    let runs = [
        desk.run("check gone\u{1b}[2J.obj"),
        desk.run("check a\u{1b}[2J.ply"),
        desk.run("check a.obj --rules gone\u{1b}[2J.toml"),
        desk.run("check a.obj --placements gone\u{1b}[2J.csv"),
        desk.run("check a.obj b.obj --csv no\u{1b}[2J/out.csv"),
        desk.run("check a.obj b.obj --rules r\u{1b}[2J.toml"),
    ];
    for run in runs {
        assert!(run.stderr.contains("\\u{1b}[2J") && !run.stderr.contains('\u{1b}'), "{run:?}");
    }
}

/// As some editors save text.
#[test]
fn text_in_utf16_is_named() {
    let utf16 = |text: &str, bytes: fn(u16) -> [u8; 2]| -> Vec<u8> {
        "\u{feff}".encode_utf16().chain(text.encode_utf16()).flat_map(bytes).collect()
    };
    for (name, text) in [
        ("a.obj", "v 0 0 0\n"),
        ("a.wrl", "#VRML V2.0 utf8\n"),
        ("a.stl", "solid\nendsolid\n"),
        ("a.ply", "ply\n"),
        ("a.gltf", "{}"),
    ] {
        for bytes in [u16::to_le_bytes, u16::to_be_bytes] {
            let run = Desk::new().file(name, utf16(text, bytes)).run(&format!("check {name}"));
            run.assert_fails(&[&format!(
                "{name}: is text in UTF-16; expected UTF-8, so save it as that first"
            )]);
        }
    }
    let desk = Desk::with_boxes().file("r", utf16("default = \"ignore\"\n", u16::to_le_bytes));
    desk.run("check a.obj --rules r").assert_fails(&["r: is text in UTF-16"]);
    desk.run("check a.obj --placements r").assert_fails(&["r: is text in UTF-16"]);
}

/// As a clone has them where Git LFS is not set up.
#[test]
fn pointers_of_git_lfs_are_named() {
    let pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:0123\nsize 100\n";
    let buffers = r#"{"asset":{"version":"2.0"},"buffers":[{"byteLength":100,"uri":"a.bin"}]}"#;
    let mut desk = Desk::new().file("a.bin", pointer).file("of_buffer.gltf", buffers);
    for name in ["a.obj", "a.wrl", "a.stl", "a.ply", "a.gltf", "a.glb"] {
        desk = desk.file(name, pointer);
        desk.run(&format!("check {name}")).assert_fails(&[&format!("{name}: is a pointer of Git LFS")]);
    }
    let run = desk.run("check of_buffer.gltf");
    run.assert_fails(&["of_buffer.gltf: buffer 0: `a.bin` is a pointer of Git LFS", "git lfs pull"]);
    // The file is named also when it is short.
    let desk = desk.file("a.bin", "short");
    desk.run("check of_buffer.gltf").assert_fails(&["buffer 0: `a.bin` has 5 bytes; it should have 100"]);
}

/// Where a scene is empty, the warnings say why.
#[test]
fn an_empty_scene_tells_its_warnings() {
    let desk = Desk::new()
        .file("inline.wrl", "#VRML V2.0 utf8\nInline { url \"http://nowhere/part.wrl\" }\n")
        .file("unknown.wrl", "#VRML V2.0 utf8\nFoo { a 1 }\n")
        .file("itself.wrl", "#VRML V2.0 utf8\nPROTO P [] { P {} }\nP {}\n")
        .file("hollow.gltf", HOLLOW);
    for command in ["check", "info"] {
        for (name, reason) in [
            ("inline.wrl", "only local files are read"),
            ("unknown.wrl", "Foo"),
            ("itself.wrl", "P"),
            ("hollow.gltf", "mesh 0 (`m`) has no geometry"),
        ] {
            let run = desk.run(&format!("{command} {name}"));
            assert_eq!(run.status, 2, "{run:?}");
            let [warning, error] = run.stderr.lines().collect::<Vec<_>>()[..] else { panic!("{run:?}") };
            assert!(
                warning.starts_with(&format!("warning: {name}: ")) && warning.contains(reason),
                "{warning}"
            );
            assert_eq!(error, format!("error: {name}: there is no geometry; expected a node with a shape"));
        }
    }
}

/// A glTF file with a mesh without positions.
const HOLLOW: &str = r#"{"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
"meshes": [{"name": "m", "primitives": [{"attributes": {}}]}]}"#;

#[test]
fn an_empty_file_among_others_is_warned_of() {
    let desk = Desk::with_boxes().file("hollow.gltf", HOLLOW).file("empty.wrl", "#VRML V2.0 utf8\n");
    let run = desk.run("check empty.wrl a.obj hollow.gltf");
    let expected = "warning: hollow.gltf: mesh 0 (`m`) has no geometry\n\
                    warning: empty.wrl: there is no geometry\nwarning: hollow.gltf: there is no geometry\n\
                    warning: there is one object alone, so that nothing can collide; \
                    --split makes each object and group of an OBJ file one\n";
    assert_eq!(run.assert_status(0).stderr, expected);
    // Where it was split already there is nothing to do about it.
    let expected = "warning: there is one object alone, so that nothing can collide\n";
    assert_eq!(desk.run("check a.obj --split").stderr, expected);
}

#[test]
fn a_folder_is_said_to_be_one() {
    let desk = Desk::new();
    for name in ["scenes", "scenes.obj"] {
        std::fs::create_dir(desk.path(name)).unwrap();
        desk.run(&format!("check {name}")).assert_fails(&[name, "is a folder; expected a file"]);
    }
}

/// They may have no end, or keep us waiting for ever.
#[cfg(unix)]
#[test]
fn devices_and_pipes_are_no_scenes() {
    let desk = Desk::new();
    for extension in ["wrl", "gltf", "glb", "obj", "stl", "ply"] {
        let name = format!("device.{extension}");
        std::os::unix::fs::symlink("/dev/null", desk.path(&name)).unwrap();
        desk.run(&format!("check {name}")).assert_fails(&[&name, "is not a regular file"]);
    }
}

#[test]
fn an_output_that_cannot_be_written_is_an_error() {
    let desk = Desk::with_boxes();
    let run = desk.run("check a.obj b.obj --json nowhere/out.json");
    run.assert_fails(&["nowhere/out.json: can't be written: there is no folder nowhere\n"]);
    desk.run("check a.obj b.obj --csv .").assert_fails(&[".: can't be written"]);
}

#[test]
fn what_is_read_is_not_overwritten() {
    let desk = Desk::with_boxes();
    desk.run("check a.obj b.obj --json b.obj").assert_fails(&["b.obj", "overwritten"]);
    desk.run("check a.obj b.obj --csv ./a.obj").assert_fails(&["a.obj", "overwritten"]);
    desk.run("check a.obj --json same --csv same").assert_fails(&["same", "different"]);
    desk.run("check a.obj --json same --csv ./same").assert_fails(&["both write to same", "different"]);
    desk.run("check a.obj b.obj").assert_status(1);
}

/// What a file of the scene names is read, too.
#[test]
fn what_the_scene_brings_with_it_is_not_overwritten() {
    let triangle: Vec<u8> =
        [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|x| x.to_le_bytes()).collect();
    let gltf = json!({
        "asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": "my%20buffer.bin"}],
    });
    let ball = "#VRML V2.0 utf8\nShape { geometry Sphere {} }\n";
    let proto = "#VRML V2.0 utf8\nPROTO P [] { Shape { geometry Sphere {} } }\n";
    let whole = "#VRML V2.0 utf8\nEXTERNPROTO P [] \"proto.wrl\"\nP {}\nInline { url \"part.wrl\" }\n";
    let desk = Desk::new().file("s.gltf", gltf.to_string()).file("my buffer.bin", &triangle);
    let desk = desk.file("whole.wrl", whole).file("part.wrl", ball).file("proto.wrl", proto);
    for (scene, part) in
        [("s.gltf", "my buffer.bin"), ("whole.wrl", "part.wrl"), ("whole.wrl", "./proto.wrl")]
    {
        for option in ["--json", "--csv"] {
            let mut command = desk.command("check");
            let run = harness::Run::of(command.args([scene, option, part]).output().unwrap());
            run.assert_fails(&[&format!("{part}: would be overwritten, but is read")]);
        }
    }
    assert_eq!(std::fs::read(desk.path("my buffer.bin")).unwrap(), triangle);
    assert_eq!((desk.read("part.wrl"), desk.read("proto.wrl")), (ball.to_owned(), proto.to_owned()));
}

/// A file is what a link leads to, also while that is not there. Another name of the same file is another file: it is left as it is.
#[cfg(unix)]
#[test]
fn links_lead_to_what_is_read_and_written() {
    use std::os::unix::fs::symlink;
    let desk = Desk::with_boxes();
    symlink("a.obj", desk.path("to_a")).unwrap();
    symlink("to_new", desk.path("to_to_new")).unwrap();
    symlink("new", desk.path("to_new")).unwrap();
    symlink(".", desk.path("here")).unwrap();
    symlink("loop", desk.path("loop")).unwrap();
    desk.run("check a.obj b.obj --json to_a").assert_fails(&["to_a: would be overwritten"]);
    for [json, csv] in
        [["to_new", "new"], ["new", "to_to_new"], ["new", "here/new"], ["here/to_new", "to_to_new"]]
    {
        desk.run(&format!("check a.obj b.obj --json {json} --csv {csv}")).assert_fails(&["both write to"]);
    }
    desk.run("check a.obj b.obj --json loop").assert_fails(&["loop: can't be written"]);
    desk.run("check a.obj b.obj --csv to_to_new").assert_status(1);
    assert!(desk.path("to_to_new").is_symlink() && desk.path("to_new").is_symlink());
    assert!(desk.read("new").starts_with("frame,"));
    std::fs::hard_link(desk.path("a.obj"), desk.path("same")).unwrap();
    desk.run("check a.obj b.obj --csv same").assert_status(1);
    assert_eq!(desk.read("a.obj"), BOX);
    // Devices may be named twice.
    desk.run("check a.obj b.obj --csv /dev/null --json here/../../../../dev/null");
    desk.run("check a.obj b.obj --json - --csv ./-").assert_status(1);
    assert!(desk.read("-").starts_with("frame,"));
}

#[test]
fn a_run_that_fails_on_the_way_leaves_what_was_there() {
    let placements = "frame,object,tx,ty,tz,qx,qy,qz,qw\n0,b,0,0,0,0,0,0,1\n5,b,1e101,0,0,0,0,0,1\n";
    let desk =
        Desk::with_boxes().file("p.csv", placements).file("out.json", "before").file("out.csv", "before");
    let run = "check a.obj b.obj --placements p.csv --json out.json --csv";
    desk.run(&format!("{run} out.csv")).assert_fails(&["p.csv:3: ", "1e101"]);
    assert_eq!(["out.json", "out.csv"].map(|name| desk.read(name)), ["before", "before"]);
    desk.run(&format!("{run} new.csv")).assert_fails(&["p.csv:3: "]);
    assert!(!desk.path("new.csv").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    let desk = Desk::with_boxes();
    desk.run("check a.obj b.obj --json /dev/full").assert_fails(&["/dev/full: "]);
    desk.run("check a.obj b.obj --csv /dev/full").assert_fails(&["/dev/full: "]);
    let full = std::fs::File::create("/dev/full").unwrap();
    let output = desk.command("check a.obj b.obj").stdout(full).output().unwrap();
    harness::Run::of(output).assert_fails(&["standard output: "]);
}

#[test]
fn a_reader_that_leaves_is_no_error() {
    let desk = Desk::with_boxes();
    for format in ["--json", "--csv"] {
        let mut child = desk.command(&format!("check a.obj b.obj --to 200 {format} -")).spawn().unwrap();
        drop(child.stdout.take());
        let run = harness::Run::of(child.wait_with_output().unwrap());
        assert_eq!((run.status, run.stderr.as_str()), (1, ""), "{format}");
    }
    for arguments in ["check a.obj b.obj", "info a.obj", "--help"] {
        let mut child = desk.command(arguments).spawn().unwrap();
        drop(child.stdout.take());
        drop(child.stderr.take());
        assert!(child.wait().unwrap().code().is_some_and(|status| status < 2), "{arguments}");
    }
}

/// A pair takes the more memory, the more is wanted of it, so that of fewer the boxes may overlap.
#[test]
fn how_many_pairs_are_too_many_depends_on_the_response() {
    let crowd = |objects: u32| {
        let group = |i| format!("g {i}\nf 1 2 3\n");
        format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{}", (0..objects).map(group).collect::<String>())
    };
    let rule = "[[object]]\nname = \"1\"\nresponse = \"contacts\"\n";
    let desk = Desk::new()
        .file("some.obj", crowd(448))
        .file("many.obj", crowd(1415))
        .file("r.toml", rule)
        .file("simple.toml", "default = \"simple\"\n");
    for options in ["--response contacts", "--response curve", "--rules r.toml"] {
        let run = desk.run(&format!("check some.obj --split {options}"));
        run.assert_fails(&["more than 100000 pairs"]);
    }
    for options in ["", "--response depth", "--rules simple.toml"] {
        let run = desk.run(&format!("check many.obj --split {options}"));
        run.assert_fails(&["more than 1000000 pairs"]);
    }
    desk.run("check some.obj --split --rules r.toml --max-pairs 7").assert_fails(&["more than 7 pairs"]);
}

#[test]
fn too_many_pairs_are_refused_before_they_take_all_memory() {
    let desk = Desk::with_boxes().file("c.obj", BOX);
    let check = "check a.obj b.obj c.obj --max-pairs";
    desk.run(&format!("{check} 3")).assert_status(1);
    desk.run(&format!("{check} 2")).assert_fails(&[
        "at 0.000 s the boxes of more than 2 pairs of objects overlap",
        "are objects in one place that should not be",
        "--max-pairs allows more",
    ]);
    // In a later frame; by boxes that are grown for a clearance; on the way between two frames.
    let apart: String =
        (0..).zip(["b", "c"]).map(|(i, b)| format!("0,{b},{},0,0,0,0,0,1\n", 5 + 5 * i)).collect();
    let met = format!("{HEADER}{apart}3,b,0,0,0,0,0,0,1\n3,c,0,0,0,0,0,0,1\n");
    let desk = desk.file("met.csv", met).file("apart.csv", format!("{HEADER}{apart}"));
    let run = desk.run(&format!("{check} 2 --placements met.csv --fps 10"));
    run.assert_fails(&["at 0.300 s the boxes of more than 2 pairs"]);
    desk.run(&format!("{check} 0 --placements apart.csv")).assert_status(0);
    desk.run(&format!("{check} 0 --placements apart.csv --clearance 4")).assert_fails(&["more than 0 pairs"]);
    let passing = format!("{HEADER}0,b,5,0,0,0,0,0,1\n0,c,90,0,0,0,0,0,1\n1,b,-5,0,0,0,0,0,1\n");
    let desk = desk.file("passing.csv", passing);
    desk.run(&format!("{check} 0 --placements passing.csv")).assert_status(0);
    desk.run(&format!("{check} 0 --placements passing.csv --continuous"))
        .assert_fails(&["more than 0 pairs"]);
}
