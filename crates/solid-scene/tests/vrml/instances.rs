//! DEF and USE, PROTO, EXTERNPROTO and Inline.

use glam::DVec3;

use crate::bounds::sizes;
use crate::files::{Folder, assert_near, error, load_file, names, origin, pose, scene, warnings};

#[test]
fn use_places_a_shape_again() {
    let scene = scene(
        "Transform { translation 1 0 0 children DEF S Shape { geometry Box {} } }
         Transform { translation 2 0 0 children USE S }",
    );
    assert_eq!(names(&scene), ["S", "S#2"]);
    let pose = pose(&scene, 0.0);
    assert_eq!(pose.objects[1].placement.translation, DVec3::new(2.0, 0.0, 0.0));
}

#[test]
fn a_name_given_twice_means_the_latest() {
    let scene = scene(
        "DEF G Sphere_ {} Group { children [ Shape { geometry DEF G Box { size 2 2 2 } } ] }
         Shape { geometry DEF G Box { size 4 4 4 } } Shape { geometry USE G }",
    );
    assert_eq!(sizes(scene.objects()[2].shape()), [2.0, 2.0, 2.0]);
}

/// Of Latin-1, as old exporters wrote them.
#[test]
fn names_that_are_no_utf_8_are_told_apart() {
    let body = b"#VRML V2.0 utf8\nDEF T\xfcr Shape { geometry Box {} } DEF T\xf6r Shape { geometry Sphere {} } USE T\xfcr";
    let scene = load_file(&Folder::new().write_bytes("a.wrl", body)).expect("it loads");
    assert_eq!(names(&scene), ["T\u{fc}r", "T\u{f6}r", "T\u{fc}r#2"]);
    assert_eq!(scene.objects()[2].shape().kind(), scene.objects()[0].shape().kind());
}

#[test]
fn a_use_before_its_def_is_an_error() {
    let (line, message) = error("Shape {\n geometry USE B }\nShape { geometry DEF B Box {} }");
    assert_eq!(line, Some(3));
    assert_eq!(message, "USE B: expected the name of a DEF that stands before");
}

const CUBE: &str = "PROTO Cube [ field SFVec3f size 2 2 2 exposedField SFVec3f at 0 0 0 field MFNode more [] ] {
    Transform { translation IS at children [ Shape { geometry Box { size IS size } } Group { children IS more } ] }
    Shape { geometry Sphere {} }
}";

#[test]
fn a_proto_stands_for_its_first_node_with_its_fields() {
    let scene = scene(&format!("{CUBE} Cube {{}} DEF Big Cube {{ size 4 6 8 at 1 2 3 }}"));
    assert_eq!(names(&scene), ["box", "Big"]);
    assert_eq!(sizes(scene.objects()[0].shape()), [1.0, 1.0, 1.0]);
    assert_eq!(sizes(scene.objects()[1].shape()), [2.0, 3.0, 4.0]);
    assert_eq!(pose(&scene, 0.0).objects[1].placement.translation, DVec3::new(1.0, 2.0, 3.0));
}

/// An eventIn of the interface has no value; the field that receives it keeps its own until there is an event.
#[test]
fn a_field_that_receives_events_of_a_proto_keeps_its_value() {
    let event = "eventIn SFVec3f move";
    for (interface, fields, x) in [
        (event, "translation 1 2 3 set_translation IS move", 1.0),
        (event, "set_translation IS move translation 1 2 3", 1.0),
        ("eventOut SFVec3f move", "translation 1 2 3 translation_changed IS move", 1.0),
        ("eventIn SFVec3f move field SFVec3f at 4 2 3", "set_translation IS move translation IS at", 4.0),
    ] {
        let cube = "children Shape { geometry Box {} }";
        let scene = scene(&format!("PROTO P [ {interface} ] {{ Transform {{ {fields} {cube} }} }} P {{}}"));
        assert_eq!(origin(&scene, 0.0), DVec3::new(x, 2.0, 3.0), "{fields}");
    }
    let scene = scene(
        "PROTO Inner [ exposedField SFVec3f at 1 2 3 ] { Transform { translation IS at children Shape { geometry Box {} } } }
         PROTO Outer [ eventIn SFVec3f move ] { Inner { at 4 2 3 set_at IS move } }
         DEF O Outer {} DEF C TimeSensor { startTime 1 } DEF I PositionInterpolator { key 0 keyValue 7 0 0 }
         ROUTE C.fraction_changed TO I.set_fraction ROUTE I.value_changed TO O.move",
    );
    assert_eq!(origin(&scene, 0.0), DVec3::new(4.0, 2.0, 3.0));
    assert_eq!(origin(&scene, 1.0), DVec3::new(7.0, 0.0, 0.0));
}

#[test]
fn protos_nest_and_take_nodes() {
    let scene = scene(&format!(
        "{CUBE} PROTO Two [ field SFVec3f each 2 2 2 field MFNode inside [] ] {{
           Group {{ children [ Cube {{ size IS each at -1 0 0 }} Cube {{ size IS each at 1 0 0 more IS inside }} ] }} }}
         Two {{ each 2 4 6 inside [ DEF Cone Shape {{ geometry Cone {{}} }} ] }}"
    ));
    assert_eq!(names(&scene), ["box", "box#2", "Cone"]);
    assert_eq!(sizes(scene.objects()[1].shape()), [1.0, 2.0, 3.0]);
    assert_eq!(pose(&scene, 0.0).objects[2].placement.translation, DVec3::X);
}

#[test]
fn a_proto_can_be_a_geometry_and_a_coordinate() {
    let scene = scene(
        "PROTO Points [ field MFVec3f p [ 0 0 0, 1 0 0, 0 1 0 ] ] { Coordinate { point IS p } }
         PROTO Face [ field SFNode c Points {} ] { IndexedFaceSet { coord IS c coordIndex [ 0 1 2 ] } }
         Shape { geometry Face {} } Shape { geometry Face { c Points { p [ 0 0 0, 5 0 0, 0 1 0 ] } } }",
    );
    let x = |object: usize| scene.objects()[object].shape().vertices().map(|vertices| vertices[1].x);
    assert_eq!((x(0), x(1)), (Some(1.0), Some(5.0)));
}

/// Law: a name is one as a whole, whatever it begins with.
#[test]
fn names_may_begin_with_words_of_the_language() {
    let words = [
        "USE",
        "DEF",
        "NULL",
        "null",
        "IS",
        "ROUTE",
        "PROTO",
        "EXTERNPROTO",
        "TRUE",
        "false",
        "IMPORT",
        "EXPORT",
    ];
    for name in words.map(|word| format!("{word}R_1")).iter().map(String::as_str).chain(["IMPORT", "EXPORT"])
    {
        let body = format!(
            "PROTO {name} [ exposedField SFVec3f {name} 1 0 0 ] {{
               Transform {{ translation IS {name} children Shape {{ geometry Box {{}} }} }} }}
             Group {{ children {name} {{}} }} DEF {name} {name} {{ {name} 2 0 0 }}
             Group {{ children [ USE {name} ] }}
             DEF Clock TimeSensor {{}} DEF I PositionInterpolator {{ key 0 keyValue 3 0 0 }}
             ROUTE Clock.fraction_changed TO I.set_fraction ROUTE I.value_changed TO {name}.set_{name}"
        );
        let scene = scene(&body);
        assert_eq!(names(&scene), ["box", name, &format!("{name}#2")]);
        let x: Vec<f64> = pose(&scene, 0.0).objects.iter().map(|o| o.placement.translation.x).collect();
        assert_eq!(x, [1.0, 3.0, 3.0], "{name}");
        assert_eq!(warnings(&scene), [""; 0], "{name}");
    }
    let folder = Folder::new();
    folder.write("cars.wrl", "PROTO CAR [] {} PROTO USED_CAR [] { Shape { geometry Box {} } }");
    let file = folder.write("main.wrl", "EXTERNPROTO USED_CAR [] \"cars.wrl#USED_CAR\" USED_CAR {}");
    assert_eq!(load_file(&file).expect("it is there").objects().len(), 1);
    let (line, message) = error("PROTO USER [ field SFInt32 ISO 1 ] {}\nUSER { ISO x }");
    assert_eq!((line, message.as_str()), (Some(3), "expected a value for the field 'ISO'"));
}

#[test]
fn a_proto_cannot_hold_itself() {
    let scene = scene("PROTO P [] { Group { children [ Shape { geometry Box {} } P {} ] } } P {}");
    assert_eq!(scene.objects().len(), 1);
    assert_eq!(warnings(&scene), ["line 2: 'P' is no node of VRML97, and no PROTO before; passed over"]);
}

#[test]
fn events_go_in_and_out_of_protos() {
    let scene = scene(
        "PROTO Mover [ exposedField SFVec3f at 0 0 0 field MFNode children [] ] {
           Transform { translation IS at children IS children } }
         PROTO Clock [ field SFTime cycle 1 eventOut SFFloat fraction ] {
           TimeSensor { cycleInterval IS cycle fraction_changed IS fraction } }
         PROTO Way [ eventIn SFFloat in eventOut SFVec3f out field MFVec3f way [] ] {
           PositionInterpolator { key [ 0 1 ] keyValue IS way set_fraction IS in value_changed IS out } }
         DEF M Mover { children Shape { geometry Box {} } }
         DEF C Clock { cycle 4 } DEF W Way { way [ 0 0 0, 8 0 0 ] }
         ROUTE C.fraction TO W.in ROUTE W.out TO M.set_at",
    );
    assert_eq!(scene.duration(), 4.0);
    assert_near(origin(&scene, 1.0), DVec3::new(2.0, 0.0, 0.0));
}

#[test]
fn every_instance_of_a_proto_moves_by_itself() {
    let scene = scene(
        "PROTO Slide [ field SFTime start 0 ] {
           DEF T Transform { children Shape { geometry Box {} } }
           DEF C TimeSensor { startTime IS start }
           DEF P PositionInterpolator { key [ 0 1 ] keyValue [ 0 0 0, 1 0 0 ] }
           ROUTE C.fraction_changed TO P.set_fraction ROUTE P.value_changed TO T.translation }
         Slide {} Slide { start 10 }",
    );
    let pose = pose(&scene, 10.5);
    assert_near(pose.objects[0].placement.translation, DVec3::X);
    assert_near(pose.objects[1].placement.translation, 0.5 * DVec3::X);
}

#[test]
fn inlines_are_read_from_beside_the_file() {
    let folder = Folder::new();
    std::fs::create_dir_all(folder.write("a.wrl", "").with_file_name("sub")).expect("a folder");
    folder.write("sub/b.wrl", "Transform { translation 0 1 0 children Inline { url \"c%20d.wrl\" } }");
    folder.write("sub/c d.wrl", "DEF Deep Shape { geometry Box {} }");
    let main = "Transform { translation 1 0 0 children DEF I Inline { url [ \"gone.wrl\" \"sub/b.wrl\" ] } }";
    let scene = load_file(&folder.write("main.wrl", main)).expect("it loads");
    assert_eq!(names(&scene), ["Deep"]);
    assert_eq!(origin(&scene, 0.0), DVec3::new(1.0, 1.0, 0.0));
}

#[test]
fn an_inline_that_is_not_there_is_a_warning() {
    let scene = scene(
        "DEF A Inline { url \"gone.wrl\" } DEF B Inline { url \"http://example.org/b.wrl\" } DEF C Inline {}",
    );
    assert_eq!(
        warnings(&scene),
        [
            "Inline A: there is no file \"gone.wrl\"; passed over",
            "Inline B: \"http://example.org/b.wrl\" is not a relative path; only local files are read; passed over",
            "Inline C: it has no url; passed over",
        ]
    );
}

#[test]
fn an_error_in_an_inline_names_its_file() {
    let folder = Folder::new();
    folder.write("bad.wrl", "\nBox {");
    let error = load_file(&folder.write("a.wrl", "Inline { url \"bad.wrl\" }")).expect_err("it is bad");
    assert!(error.file.ends_with("bad.wrl"));
    assert!(error.message.contains("'}' was expected, for the bracket of line 3"), "{}", error.message);
}

#[test]
fn files_that_inline_each_other_are_an_error() {
    let folder = Folder::new();
    folder.write("b.wrl", "Inline { url \"a.wrl\" }");
    let error = load_file(&folder.write("a.wrl", "Inline { url \"b.wrl\" }")).expect_err("a cycle");
    assert!(error.message.contains("holds itself by way of this"), "{}", error.message);
}

#[test]
fn an_externproto_is_found_by_its_name() {
    let folder = Folder::new();
    folder.write("lib.wrl", &format!("PROTO Other [] {{ Group {{}} }} {CUBE}"));
    let main = "EXTERNPROTO Cube [ field SFVec3f size ] \"lib.wrl#Cube\" Cube { size 4 4 4 } Cube {}
        EXTERNPROTO Gone [] [ \"lib.wrl#Gone\" ] Gone {}
        EXTERNPROTO Far [] \"http://example.org/lib.wrl\" Far {}";
    let scene = load_file(&folder.write("a.wrl", main)).expect("it loads");
    let made: Vec<_> = scene.objects().iter().map(|object| sizes(object.shape())).collect();
    assert_eq!(made, [[2.0; 3], [1.0; 3]]);
    assert_eq!(warnings(&scene).len(), 2);
}
