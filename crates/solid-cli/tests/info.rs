//! `solid info`, from the outside.

mod harness;

use harness::{BOX, Desk};

fn row(stdout: &str, name: &str) -> String {
    let line = stdout.lines().find(|line| line.split_whitespace().next() == Some(name));
    let words: Vec<_> = line.unwrap_or_else(|| panic!("no {name} in {stdout}")).split_whitespace().collect();
    words.join(" ")
}

#[test]
fn objects_are_listed_with_what_they_are() {
    let open: String = BOX.lines().take(13).map(|line| format!("{line}\n")).collect();
    let desk =
        Desk::with_boxes().file("open.obj", open).file("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    let run = desk.run("info a.obj open.obj flat.obj");
    run.assert_status(0);
    assert_eq!(row(&run.stdout, "a"), "a mesh 12 yes 0 a.obj");
    assert_eq!(row(&run.stdout, "open"), "open mesh 10 no, 4 open edges 0 open.obj");
    assert_eq!(row(&run.stdout, "flat"), "flat mesh 1 no, 3 open edges 1 flat.obj");
    assert_eq!(row(&run.stdout, "a.obj"), "a.obj unspecified 1");
    assert!(run.stdout.contains("3 objects, 23 triangles, no animation\n"), "{}", run.stdout);
}

/// An edge may be one of several pairs of triangles.
#[test]
fn closed_is_what_can_be_solid() {
    let corners = "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\n";
    let tetrahedra = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 1 5 2\nf 1 2 6\nf 2 5 6\nf 5 1 6\n";
    let desk = Desk::with_boxes().file("two.obj", format!("{corners}{tetrahedra}"));
    let run = desk.run("info two.obj");
    assert_eq!(row(&run.stdout, "two"), "two mesh 8 yes 0 two.obj");
    assert!(desk.run("check two.obj a.obj --solid two").stderr.is_empty());
}

#[test]
fn what_is_not_there_at_time_0_is_told() {
    let flat = "#VRML V2.0 utf8\nDEF sheet Transform { children Shape { geometry Box {} } }\n\
                DEF clock TimeSensor {}\nDEF path PositionInterpolator { key [0 1] keyValue [1 0 1, 1 1 1] }\n\
                ROUTE clock.fraction_changed TO path.set_fraction\nROUTE path.value_changed TO sheet.set_scale\n";
    let run = Desk::with_boxes().file("flat.wrl", flat).run("info a.obj flat.wrl");
    let warning = "warning: flat.wrl: object \"sheet\" is scaled to nothing, or flat, at 0.000 s; it is not there in such frames\n";
    assert!(run.assert_status(0).stdout.ends_with(warning), "{run:?}");
}

/// Neither what moves the cursor nor what turns the text around it reaches the terminal.
#[test]
fn names_are_shown_escaped() {
    let named = BOX.replacen('v', "o a\u{202e}b\u{1b}[2J\nv", 1);
    let run = Desk::new().file("named.obj", named).run("info named.obj --split");
    assert!(run.assert_status(0).stdout.contains(r"a\u{202e}b\u{1b}[2J"), "{run:?}");
    let broken = r#"{"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
        "meshes": [{"name": "a\u202eb\u001b[2J", "primitives": [{"attributes": {"POSITION": 7}}]}]}"#;
    let run = Desk::new().file("broken.gltf", broken).run("info broken.gltf");
    run.assert_fails(&[r"mesh 0 (`a\u{202e}b\u{1b}[2J`)"]);
}

#[test]
fn bad_files_make_status_2() {
    Desk::new().run("info missing.obj").assert_fails(&["missing.obj"]);
}
