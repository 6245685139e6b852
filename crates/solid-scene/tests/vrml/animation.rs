//! Motion and deformation.

use glam::DVec3;

use crate::files::{assert_near, error, names, origin, pose, scene, warnings};

/// A clock C of 4 s, an interpolator I and a Transform T that it drives.
fn moving(interpolator: &str, field: &str) -> String {
    format!(
        "DEF T Transform {{ translation 9 9 9 children Transform {{ translation 1 0 0
           children Shape {{ geometry Box {{}} }} }} }}
         DEF C TimeSensor {{ cycleInterval 4 startTime 1 }} DEF I {interpolator}
         ROUTE C.fraction_changed TO I.set_fraction ROUTE I.value_changed TO T.{field}"
    )
}

#[test]
fn a_position_interpolator_moves_a_transform() {
    let text =
        moving("PositionInterpolator { key [ 0 .5 1 ] keyValue [ 0 0 0, 2 0 0, 2 4 0 ] }", "set_translation");
    let scene = scene(&text);
    assert_eq!(scene.duration(), 5.0);
    let cases =
        [(0.0, [10.0, 9.0, 9.0]), (1.0, [1.0, 0.0, 0.0]), (3.0, [3.0, 0.0, 0.0]), (4.0, [3.0, 2.0, 0.0])];
    for (time, expected) in cases {
        assert_near(origin(&scene, time), DVec3::from_array(expected));
    }
    assert_near(origin(&scene, 100.0), DVec3::new(3.0, 4.0, 0.0));
    assert_near(origin(&scene, 0.0), DVec3::new(10.0, 9.0, 9.0));
}

#[test]
fn an_orientation_interpolator_turns_and_others_scale() {
    let text =
        moving("OrientationInterpolator { key [ 0 1 ] keyValue [ 0 0 1 0, 0 0 1 1.5707963 ] }", "rotation");
    let (sin, cos) = std::f64::consts::FRAC_PI_4.sin_cos();
    assert_near(origin(&scene(&text), 3.0), DVec3::new(9.0 + cos, 9.0 + sin, 9.0));
    let text = moving("PositionInterpolator { key [ 0 1 ] keyValue [ 1 1 1, 3 1 1 ] }", "scale");
    assert_near(origin(&scene(&text), 3.0), DVec3::new(11.0, 9.0, 9.0));
    let text = moving("OrientationInterpolator { key 0 keyValue [ 0 0 1 1.5707963 ] }", "scaleOrientation");
    assert_near(origin(&scene(&text), 3.0), DVec3::new(10.0, 9.0, 9.0));
}

#[test]
fn center_is_animated_too() {
    let scene = scene(
        "DEF T Transform { rotation 0 0 1 3.14159265358979 children Shape { geometry Box {} } }
         DEF C TimeSensor {} DEF I PositionInterpolator { key [ 0 1 ] keyValue [ 0 0 0, 1 0 0 ] }
         ROUTE C.fraction_changed TO I.set_fraction ROUTE I.value_changed TO T.center",
    );
    assert_near(origin(&scene, 0.5), DVec3::X);
}

const CLOTH: &str = "Shape { geometry IndexedFaceSet { coordIndex [ 0 1 2 ]
      coord DEF P Coordinate { point [ 0 0 0, 1 0 0, 0 1 0 ] } } }
    Transform { translation 5 0 0 children Shape { geometry IndexedLineSet { coord USE P coordIndex [ 0 1 ] } } }
    DEF C TimeSensor { startTime 1 }
    DEF I CoordinateInterpolator { key [ 0 1 ] keyValue [ 0 0 0, 1 0 0, 0 1 0, 0 0 2, 1 0 2, 0 1 2 ] }
    ROUTE C.fraction_changed TO I.set_fraction ROUTE I.value_changed TO P.point";

#[test]
fn a_coordinate_interpolator_deforms_every_instance() {
    let scene = scene(CLOTH);
    let late = pose(&scene, 1.5);
    let expected = [DVec3::Z, DVec3::X + DVec3::Z, DVec3::Y + DVec3::Z];
    assert_eq!(late.objects[0].positions, expected);
    assert_eq!(late.objects[1].positions, expected);
    let mut shape = scene.objects()[0].shape().clone();
    shape.deform(&late.objects[0].positions).expect("as many positions as vertices");
}

#[test]
fn a_pose_that_is_sampled_again_forgets_what_was() {
    let scene = scene(CLOTH);
    let mut again = pose(&scene, 2.0);
    scene.sample(0.0, &mut again);
    assert_eq!(again, pose(&scene, 0.0));
    assert_eq!(Some(again.objects[0].positions.as_slice()), scene.objects()[0].shape().vertices());
}

#[test]
fn the_shape_is_that_of_time_0() {
    let scene = scene(&CLOTH.replace("startTime 1", "startTime -0.5"));
    assert_eq!(scene.objects()[0].shape().vertices().map(|vertices| vertices[0]), Some(DVec3::Z));
}

#[test]
fn routes_chain_and_fan_out() {
    let scene = scene(
        "DEF A Transform { children Shape { geometry Box {} } }
         DEF B Transform { children Shape { geometry Box {} } }
         DEF C TimeSensor {}
         DEF Reverse ScalarInterpolator { key [ 0 1 ] keyValue [ 1 0 ] }
         DEF I PositionInterpolator { key [ 0 1 ] keyValue [ 0 0 0, 4 0 0 ] }
         ROUTE C.fraction_changed TO Reverse.set_fraction
         ROUTE Reverse.value_changed TO I.set_fraction
         ROUTE I.value_changed TO A.set_translation
         ROUTE A.translation_changed TO B.translation",
    );
    let pose = pose(&scene, 0.25);
    assert_near(pose.objects[0].placement.translation, DVec3::new(3.0, 0.0, 0.0));
    assert_near(pose.objects[1].placement.translation, DVec3::new(3.0, 0.0, 0.0));
}

#[test]
fn the_last_of_several_routes_wins_once_it_sends() {
    let scene = scene(
        "DEF T Transform { children Shape { geometry Box {} } }
         DEF C TimeSensor {} DEF D TimeSensor { startTime 5 }
         DEF I PositionInterpolator { key [ 0 1 ] keyValue [ 0 0 0, 1 0 0 ] }
         DEF J PositionInterpolator { key [ 0 1 ] keyValue [ 0 0 0, 0 1 0 ] }
         ROUTE C.fraction_changed TO I.set_fraction ROUTE D.fraction_changed TO J.set_fraction
         ROUTE I.value_changed TO T.translation ROUTE J.value_changed TO T.translation",
    );
    assert_near(origin(&scene, 2.0), DVec3::X);
    assert_near(origin(&scene, 5.5), 0.5 * DVec3::Y);
}

/// Law: of sensors that run one after the other the later counts, in whichever order their ROUTEs stand.
#[test]
fn what_was_sent_last_counts_and_not_the_last_route() {
    let nodes = "DEF T Transform { children Shape { geometry Box {} } }
         DEF C TimeSensor {} DEF D TimeSensor { startTime 5 stopTime 5.75 }
         DEF I PositionInterpolator { key [ 0 1 ] keyValue [ 0 0 0, 1 0 0 ] }
         DEF J PositionInterpolator { key [ 0 1 ] keyValue [ 0 0 0, 0 1 0 ] }
         ROUTE C.fraction_changed TO I.set_fraction ROUTE D.fraction_changed TO J.set_fraction";
    let routes = ["ROUTE I.value_changed TO T.translation", "ROUTE J.value_changed TO T.translation"];
    for [first, second] in [[0, 1], [1, 0]] {
        let scene = scene(&format!("{nodes} {} {}", routes[first], routes[second]));
        assert_near(origin(&scene, 2.0), DVec3::X);
        assert_near(origin(&scene, 5.5), 0.5 * DVec3::Y);
        assert_near(origin(&scene, 9.0), 0.75 * DVec3::Y);
    }
}

#[test]
fn a_loop_of_routes_is_cut() {
    let scene = scene(
        "DEF A Transform { children Shape { geometry Box {} } } DEF B Transform {}
         ROUTE A.translation TO B.translation ROUTE B.translation TO A.translation",
    );
    assert_eq!(warnings(&scene), ["Transform A: a loop of ROUTEs through translation is cut"]);
    assert_eq!(origin(&scene, 1.0), DVec3::ZERO);
}

#[test]
fn routes_to_unknown_nodes_and_fields_are_warnings() {
    let scene = scene(
        "DEF C TimeSensor {}\nROUTE C.fraction_changed TO Gone.set_fraction\nROUTE C.nothing TO C.loop",
    );
    assert_eq!(names(&scene).len(), 0);
    assert_eq!(
        warnings(&scene),
        [
            "line 3: no DEF before gives the name 'Gone'; the ROUTE is passed over",
            "line 4: TimeSensor has no field or event 'nothing'; the ROUTE is passed over",
        ]
    );
}

#[test]
fn malformed_interpolators_and_sensors_name_the_node() {
    let message = |interpolator: &str| error(&moving(interpolator, "translation")).1;
    assert_eq!(
        message("PositionInterpolator { key [ 0 1 ] keyValue [ 0 0 0 ] }"),
        "PositionInterpolator I: keyValue holds 1 value for 2 keys; expected one for each key"
    );
    assert_eq!(
        message("PositionInterpolator { key [ 0 1 .5 ] keyValue [ 0 0 0, 0 0 0, 0 0 0 ] }"),
        "PositionInterpolator I: key 2 is 0.5, after 1; expected keys that never decrease"
    );
    assert!(message("PositionInterpolator { key [ 0 NAN ] }").contains("key holds NaN"));
    assert!(message("PositionInterpolator { key 0 keyValue [ 0 INF 0 ] }").contains("keyValue holds inf"));
    assert_eq!(
        error("DEF C TimeSensor { cycleInterval 0 }").1,
        "TimeSensor C: cycleInterval is 0; expected more than 0"
    );
    let short = CLOTH.replace("0 0 2, 1 0 2, 0 1 2", "0 0 2, 1 0 2");
    assert!(error(&short).1.starts_with("CoordinateInterpolator I: keyValue holds 5 values for 2 keys"));
    let few = CLOTH.replace("0 1 0, 0 0 2, 1 0 2, 0 1 2", "0 0 2, 1 0 2");
    assert_eq!(error(&few).1, "Coordinate P: has 3 points, but 2 points are sent to it");
}

#[test]
fn the_duration_is_that_of_the_longest_sensor() {
    assert_eq!(scene("Shape { geometry Box {} }").duration(), 0.0);
    let text = "TimeSensor { cycleInterval 3 loop TRUE } TimeSensor { startTime 2 cycleInterval 2 }";
    assert_eq!(scene(text).duration(), 4.0);
}

#[test]
fn a_sensor_lasts_while_it_runs() {
    let duration = |fields: &str| {
        scene(&format!("TimeSensor {{}} TimeSensor {{ startTime 2 cycleInterval 8 {fields} }}")).duration()
    };
    assert_eq!(duration("enabled FALSE"), 1.0);
    assert_eq!(duration("stopTime 5"), 5.0);
    assert_eq!(duration("stopTime 5 loop TRUE"), 5.0);
    assert_eq!(duration("stopTime 50 loop TRUE"), 10.0);
    assert_eq!(duration("stopTime 2"), 10.0);
}

#[test]
fn any_time_can_be_sampled() {
    let scene =
        scene(&moving("PositionInterpolator { key [ 0 1 ] keyValue [ 0 0 0, 1 0 0 ] }", "translation"));
    for time in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1e300, 1e300] {
        assert!(origin(&scene, time).is_finite());
    }
}
