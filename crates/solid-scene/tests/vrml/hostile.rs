//! Files that mean harm: an error or a scene, never a panic or a hang.

use std::time::{Duration, Instant};

use proptest::prelude::*;
use solid_scene::Scene;

use crate::files::{Folder, error, load, load_file, scene, warnings};

/// A file with some of everything.
const EVERYTHING: &str = r#"#VRML V2.0 utf8
# A comment with { brackets [ and "quotes".
PROTO P [ field SFVec3f size 1 1 1 exposedField MFNode children [] eventIn SFFloat in ] {
  DEF T Transform { children [ Shape { geometry Box { size IS size } } Group { children IS children } ] }
  DEF I PositionInterpolator { set_fraction IS in key [ 0, 1 ] keyValue [ 0 0 0, 1 2 3 ] }
  ROUTE I.value_changed TO T.set_translation
}
DEF A P { size 1 2 3 children DEF S Shape { appearance Appearance { texture PixelTexture { image 1 1 3 0xFF00FF } }
  geometry IndexedFaceSet { convex FALSE coord DEF C Coordinate { point [ 0 0 0, 2 0 0, .5 .5 0, 0 2 0 ] }
    coordIndex [ 0 1 2 3 -1 0 1 2 ] } } }
Transform { rotation 0 1 0 1e-1 scale 1 -2 3 children [ USE S, Switch { whichChoice 0 choice USE S } ] }
DEF Clock TimeSensor { cycleInterval 2.5 loop TRUE }
DEF D CoordinateInterpolator { key [ 0 1 ] keyValue [ 0 0 0, 2 0 0, .5 .5 0, 0 2 0, 0 0 1, 2 0 1, .5 .5 1, 0 2 1 ] }
ROUTE Clock.fraction_changed TO D.set_fraction ROUTE D.value_changed TO C.set_point
ROUTE Clock.fraction_changed TO A.in
Shape { geometry Extrusion { spine [ 0 0 0, 1 0 0, 1 1 0, 0 0 0 ] scale [ 1 1, 2 2, 1 1, 1 1 ] } }
Shape { geometry ElevationGrid { xDimension 2 zDimension 2 height [ 0 1 2 -3e-1 ] } }
Inline { url [ "gone.wrl" "\"\\" ] } WorldInfo { info [ "é" ] }
"#;

fn load_bytes(bytes: &[u8]) -> bool {
    load_file(&Folder::new().write_bytes("a.wrl", bytes)).is_ok()
}

#[test]
fn a_file_cut_anywhere_does_not_panic() {
    let folder = Folder::new();
    let whole = load_file(&folder.write_bytes("a.wrl", EVERYTHING.as_bytes())).expect("it loads");
    assert_eq!(whole.objects().len(), 6);
    let loaded = (0..EVERYTHING.len())
        .filter(|&end| load_file(&folder.write_bytes("a.wrl", &EVERYTHING.as_bytes()[..end])).is_ok());
    let loaded = loaded.count();
    assert!(loaded > 20 && loaded < EVERYTHING.len() / 4, "{loaded} cuts are between statements");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn bytes_that_are_changed_do_not_panic(changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
        let mut bytes = EVERYTHING.as_bytes().to_vec();
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        load_bytes(&bytes);
    }

    #[test]
    fn words_that_are_shuffled_do_not_panic(picks in prop::collection::vec(any::<prop::sample::Index>(), 0..60)) {
        let words: Vec<&str> = EVERYTHING.split_whitespace().skip(2).collect();
        let text: Vec<&str> = picks.iter().map(|pick| *pick.get(&words)).collect();
        let _ = load(&text.join(" "));
    }

    #[test]
    fn words_that_are_exchanged_do_not_panic(from in any::<prop::sample::Index>(), to in any::<prop::sample::Index>()) {
        let mut words: Vec<&str> = EVERYTHING.split(' ').collect();
        let word = *from.get(&words);
        let at = to.index(words.len());
        words[at] = word;
        load_bytes(words.join(" ").as_bytes());
    }
}

#[track_caller]
fn refused(text: &str, part: &str) {
    let start = Instant::now();
    let (_, message) = error(text);
    assert!(message.contains(part), "{message}");
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
}

#[test]
fn a_node_inside_of_itself_is_an_error() {
    refused("DEF A Group { children USE A }", "Group A: holds itself, by way of USE");
    refused("DEF A Group { children Transform { children [ Group {} USE A ] } }", "holds itself");
}

#[test]
fn deep_nesting_is_an_error() {
    let text = |depth: usize| format!("{}{}", "Group { children [ ".repeat(depth), "] }".repeat(depth));
    assert!(load(&text(128)).is_ok());
    refused(&text(129), "brackets nest deeper than 256");
    refused(&"[".repeat(1_000_000), "brackets nest deeper than 256");
    let uses = |i: usize| format!("DEF G{} Group {{ children USE G{i} }}\n", i + 1);
    let chain: String = (0..1000).map(uses).collect();
    refused(&format!("DEF G0 Group {{}} {chain}"), "nodes nest deeper than 512");
}

#[test]
fn use_by_the_billion_is_an_error() {
    let level =
        |i: usize| format!("DEF G{} Group {{ children [ {} ] }}\n", i + 1, format!("USE G{i} ").repeat(10));
    let levels: String = (0..12).map(level).collect();
    refused(&format!("DEF G0 Shape {{ geometry Box {{}} }} {levels}"), "more than 1000000 nodes");
}

#[test]
fn protos_by_the_billion_are_an_error() {
    let level = |i: usize| {
        format!("PROTO P{} [] {{ Group {{ children [ {} ] }} }}\n", i + 1, format!("P{i} {{}} ").repeat(10))
    };
    let levels: String = (0..12).map(level).collect();
    refused(&format!("PROTO P0 [] {{ Group {{}} }} {levels} P12 {{}}"), "more than 1000000 nodes");
}

#[test]
fn routes_by_the_billion_are_an_error() {
    let level = |i: usize| {
        let inner = format!("P{i} {{ at IS at }} ").repeat(10);
        format!("PROTO P{} [ eventIn SFVec3f at ] {{ Group {{ children [ {inner} ] }} }}\n", i + 1)
    };
    let levels: String = (0..5).map(level).collect();
    let base = "PROTO P0 [ eventIn SFVec3f at ] { Transform { translation IS at } }";
    refused(
        &format!(
            "{base} {levels} DEF P P5 {{}} DEF I PositionInterpolator {{}} ROUTE I.value_changed TO P.at"
        ),
        "stands for more than",
    );
}

#[test]
fn an_extrusion_of_too_many_points_is_an_error() {
    let section = "0 0 1 0 1 1 ".repeat(2_000);
    let spine = "0 0 0 1 0 0 1 1 0 ".repeat(2_000);
    refused(
        &format!("Shape {{ geometry Extrusion {{ crossSection [ {section} ] spine [ {spine} ] }} }}"),
        "more than 16000000 vertices",
    );
}

/// A face set of one face around the z axis, whose corners alternate between two distances from it, and its end.
fn star(corners: usize, radii: [f64; 2]) -> Scene {
    let point = |i: usize| {
        let (sin, cos) = (std::f64::consts::TAU * i as f64 / corners as f64).sin_cos();
        format!("{} {} 0,", radii[i % 2] * cos, radii[i % 2] * sin)
    };
    let points: String = (0..corners).map(point).collect();
    let index: String = (0..corners).map(|i| format!("{i} ")).collect();
    scene(&format!(
        "Shape {{ geometry IndexedFaceSet {{ coord Coordinate {{ point [ {points} ] }} coordIndex [ {index} ] }} }}"
    ))
}

/// Of a convex face of any number of corners a fan is right; of a concave one ears are, of which no more are cut than take little time.
#[test]
fn only_a_concave_face_of_too_many_corners_is_a_fan_with_a_warning() {
    let warning = "IndexedFaceSet: 1 polygon without an area, crossing itself, or concave with more than 5000 corners, is a fan \
                   that is folded over";
    for (corners, radii, expected) in
        [(8_000, [1.0, 1.0], None), (4_000, [1.0, 0.5], None), (8_000, [1.0, 0.5], Some(warning))]
    {
        let scene = star(corners, radii);
        assert_eq!(scene.objects()[0].shape().primitive_count(), corners - 2);
        assert_eq!(warnings(&scene), Vec::from_iter(expected), "{corners} {radii:?}");
    }
}

/// Law: how many faces are folded over is told once for a node.
#[test]
fn faces_that_are_folded_over_are_counted() {
    let corners = "1 2 3 0 ".repeat(2_500);
    let points = "coord Coordinate { point [ 0 0 0, 2 0 0, .5 .5 0, 0 2 0 ] }";
    let scene = scene(&format!(
        "Shape {{ geometry IndexedFaceSet {{ {points} coordIndex [ {corners} -1 {corners} -1 1 2 3 0 ] }} }}"
    ));
    assert_eq!(scene.objects()[0].shape().primitive_count(), 2 * 9_998 + 2);
    let warning = "IndexedFaceSet: 2 polygons without an area, crossing itself, or concave with more than 5000 corners, are fans \
                   that are folded over";
    assert_eq!(warnings(&scene), [warning]);
}

/// A long name of many objects takes memory for each.
#[test]
fn names_by_the_gigabyte_are_an_error() {
    let (name, shapes) = ("n".repeat(1 << 20), "Shape { geometry Box {} } ".repeat(257));
    refused(
        &format!("DEF {name} Group {{ children [ {shapes} ] }}"),
        "Shape: the names of the objects have more than 268435456 bytes in all",
    );
}

#[test]
fn what_would_be_slow_to_parse_is_an_error() {
    refused(&"ROUTE a.b TO c.d\n".repeat(30_000), "more than 20000 ROUTEs");
    refused(&"Group{}".repeat(300_000), "more than 200000 nodes");
    refused(&"DEF A Group{}".repeat(30_000), "more than 20000 names given again by DEF");
    for proto in ["PROTO P [] {}", "EXTERNPROTO P [] \"\""] {
        refused(&proto.repeat(30_000), "more than 20000 names given again by PROTO and EXTERNPROTO");
    }
    refused(&format!("Script {{ {} }}", "field SFBool a TRUE ".repeat(3_000)), "more than 2000 declared");
    let script = format!("Script {{ {} }}", "eventIn SFBool a ".repeat(1_900));
    refused(&script.repeat(11), "more than 20000 declared");
    refused(&format!("Script {{ {} }}", "fieldSFBool a TRUE ".repeat(3_000)), "more than 2000 declared");
    let others: String = (0..20_000).map(|i| format!("DEF a{i} Other {{}} USE a{i} ")).collect();
    refused(&others, "any node and one that USE names");
    assert!(load(&"#/* \n".repeat(300_000)).is_ok());
}

/// A number ends before them, as the parser has it, so that they would be counted nowhere.
#[test]
fn words_of_the_language_after_a_number_are_an_error() {
    let uses: String = (0..100_000).map(|i| format!("1USEa{i} ")).collect();
    refused(
        &format!("Group {{ a [ {uses} ] }}"),
        "1USEa0 holds USE; expected a number, or space before that",
    );
    refused("Transform { scale 1 1 .5ROUTE A.b TO C.d }", "5ROUTE holds ROUTE");
    assert!(
        load("Shape { appearance Appearance { texture PixelTexture { image 1 2 3 0xDEF 0XdeFDEF } } }")
            .is_ok()
    );
}

/// The disk is asked once for each URL, and there are not too many of them, however many instances have them.
#[test]
fn urls_of_many_instances_take_no_time() {
    let folder = Folder::new();
    folder.write("0.wrl", "Shape { geometry Box {} }");
    for i in 1..20 {
        folder.write(&format!("{i}.wrl"), &format!("Inline {{ url \"{}.wrl\" }} ", i - 1).repeat(2));
    }
    let protos: String = (1..18)
        .map(|i| {
            format!("PROTO P{i} [] {{ Group {{ children [ {} ] }} }} ", format!("P{} {{}} ", i - 1).repeat(2))
        })
        .collect();
    let missing: String = (0..500).map(|i| format!("\"{i}.gone\" ")).collect();
    let [many, long] = [missing, format!("\"{}\"", "gone".repeat(100_000))]
        .map(|urls| format!("PROTO P0 [] {{ Inline {{ url [ {urls} ] }} }} {protos} P17 {{}}"));
    for (body, part) in [
        ("Inline { url \"19.wrl\" }", "more than 1000000 nodes"),
        (&many, "more than 4000000 URLs"),
        (&long, "more than 4000000 URLs"),
    ] {
        let start = Instant::now();
        let error = load_file(&folder.write("a.wrl", body)).expect_err("too many");
        assert!(error.message.contains(part), "{error}");
        assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
    }
}

/// Law: it makes no difference whether nodes are written in one file or in several.
#[test]
fn nodes_of_inlined_files_count_together() {
    let folder = Folder::new();
    for name in ["a.wrl", "b.wrl"] {
        folder.write(name, &"Group{}".repeat(110_000));
    }
    let load = |urls: &str| load_file(&folder.write("main.wrl", urls));
    let (a, b) = ("Inline { url \"a.wrl\" }", "Inline { url \"b.wrl\" }");
    assert!(load(&format!("{a} {a} {a}")).is_ok());
    let error = load(&format!("{a} {b}")).expect_err("they are too many");
    assert!(error.file.ends_with("b.wrl"), "{error}");
    assert_eq!(error.message, "with this file there are more than 200000 nodes");
}

/// What the limits let through at most.
#[test]
fn what_is_just_within_the_limits_is_read_in_time() {
    let fields = (0..1_900).map(|i| format!("field SFBool a{i} TRUE ")).collect::<String>();
    let worst = [
        "DEF A Group{}".repeat(20_000) + &"Group{}".repeat(179_000),
        format!("DEF A Transform{{}} {}", "ROUTE A.scale TO A.scale ".repeat(19_000)),
        format!("Script {{ {} }}", fields).repeat(10),
        format!("PROTO P [ {} ] {{ Group {{}} }} P {{ {} }}", fields, "a1899 FALSE ".repeat(200_000)),
        (0..19_000).map(|i| format!("DEF A{i} Transform {{}} ")).collect::<String>()
            + &(1..19_000).map(|i| format!("ROUTE A0.scale TO A{i}.scale ")).collect::<String>(),
    ];
    for text in worst {
        let start = Instant::now();
        assert!(load(&text).is_ok());
        println!("{:?} for {}...", start.elapsed(), &text[..30]);
        assert!(start.elapsed() < Duration::from_secs(30));
    }
}
