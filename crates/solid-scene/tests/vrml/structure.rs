//! Transforms, groups, names and paths.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

use crate::bounds::of_scene;
use crate::files::{assert_near, error, names, origin, pose, scene, warnings};

#[test]
fn a_transform_applies_all_its_fields() {
    let scene = scene(&format!(
        "Transform {{ translation 1 2 3 rotation 0 0 1 {FRAC_PI_2} scale 2 3 4 center 1 0 0
           children Transform {{ translation 2 1 1 children Shape {{ geometry Box {{}} }} }} }}"
    ));
    // (2, 1, 1) - C = (1, 1, 1); scaled (2, 3, 4); turned (-3, 2, 4); + C + T.
    assert_near(origin(&scene, 0.0), DVec3::new(-1.0, 4.0, 7.0));
}

#[test]
fn scale_orientation_turns_the_axes_of_scale() {
    let scene = scene(&format!(
        "Transform {{ scale 5 1 1 scaleOrientation 0 0 1 {FRAC_PI_2} children Shape {{ geometry Box {{}} }} }}"
    ));
    let bounds = of_scene(&scene, &pose(&scene, 0.0));
    assert_near(bounds.max, DVec3::new(1.0, 5.0, 1.0));
}

#[test]
fn a_rotation_about_no_axis_is_none() {
    let scene = scene("Transform { rotation 0 0 0 1 translation 1 0 0 children Shape { geometry Box {} } }");
    assert_eq!(origin(&scene, 0.0), DVec3::X);
}

#[test]
fn what_a_scale_of_zero_hides_is_placed_so() {
    let scene =
        scene("Transform { scale 1 0 1 children [ Shape { geometry Box {} } ] } Shape { geometry Box {} }");
    let pose = pose(&scene, 0.0);
    assert_eq!([0, 1].map(|i| pose.objects[i].placement.matrix3.determinant()), [0.0, 1.0]);
}

#[test]
fn numbers_that_are_none_name_the_node() {
    let (_, message) = error("DEF T Transform { translation 0 NAN 0 children Shape { geometry Box {} } }");
    assert_eq!(message, "Transform T: translation holds NaN; expected finite numbers");
    let (_, message) = error("DEF T Transform { rotation 0 1 0 INF }");
    assert_eq!(message, "Transform T: rotation holds inf; expected finite numbers");
}

#[test]
fn shapes_are_named_by_the_nearest_def() {
    let scene = scene(
        "DEF Outer Group { children [
           DEF Own Shape { geometry Box {} }
           Group { children Shape { geometry Box {} } }
           DEF Inner Transform { children Shape { geometry DEF G Sphere {} } } ] }
         Shape { geometry Cone {} }
         DEF Own Shape { geometry Box {} }",
    );
    assert_eq!(names(&scene), ["Own", "Outer", "Inner", "cone", "Own#2"]);
}

#[test]
fn groups_of_all_kinds_hold_shapes() {
    let shape = |name: &str| format!("DEF {name} Shape {{ geometry Box {{}} }}");
    let (a, b, c) = (shape("A"), shape("B"), shape("C"));
    let named = |text: &str| {
        let scene = scene(text);
        names(&scene).join(" ")
    };
    assert_eq!(named(&format!("Anchor {{ children [ {a} {b} ] }}")), "A B");
    assert_eq!(named(&format!("Billboard {{ children {a} }}")), "A");
    assert_eq!(named(&format!("Switch {{ choice [ {a} {b} ] }}")), "");
    assert_eq!(named(&format!("Switch {{ whichChoice 1 choice [ {a} {b} ] }}")), "B");
    assert_eq!(named(&format!("Switch {{ whichChoice 1 choice [ NULL {b} ] }}")), "B");
    assert_eq!(named(&format!("Switch {{ whichChoice 2 choice [ {a} {b} ] }}")), "");
    assert_eq!(named(&format!("LOD {{ range 5 level [ {a} {b} ] }}")), "A");
    assert_eq!(named(&format!("Collision {{ children {a} }}")), "A");
    assert_eq!(named(&format!("Collision {{ collide FALSE children {a} }}")), "");
    assert_eq!(named(&format!("Collision {{ proxy {c} children {a} }}")), "C");
}

#[test]
fn every_occurrence_has_a_path_of_its_own() {
    let scene = scene("DEF G Group { children Shape { geometry Box {} } } USE G Shape { geometry Box {} }");
    let objects = scene.objects();
    assert_eq!(objects.len(), 3);
    for (i, a) in objects.iter().enumerate() {
        for (j, b) in objects.iter().enumerate() {
            assert_eq!(a.on_root_path_with(b), i == j);
        }
    }
}

#[test]
fn what_is_passed_over_is_named_once_for_each_type() {
    let scene = scene(
        "Billboard {} Billboard {} TouchSensor {} Script {} Script {}
         Viewpoint {} PointLight {} NavigationInfo {} Fog {} WorldInfo {} Strange { a 1 b [ Box {} ] }",
    );
    assert_eq!(
        warnings(&scene),
        [
            "line 3: 'Strange' is no node of VRML97, and no PROTO before; passed over",
            "Billboard does not turn to a viewer; taken as a Group",
            "TouchSensor is not run: it sends no events",
            "Script is not run: it sends no events",
        ]
    );
}

#[test]
fn the_unit_is_the_metre() {
    assert_eq!(scene("").unit(0), "metre");
}
