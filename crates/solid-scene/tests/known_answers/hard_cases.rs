//! Published failures of GJK and EPA. The truth is a reference of 60 digits where the file has one, certified bounds
//! everywhere; what libraries and papers say is printed where it differs.

use glam::{DAffine3, DMat3, DVec3};
use serde_json::Value;
use solid_oracle::{Convex, Verdict, distance_bounds, penetration_bounds, verdict};
use solid3d::{convex::gjk::TOUCHING_ERROR, query};

use crate::convex::{outside, reach, shape};
use crate::data::{folder, json};
use crate::tally::Tally;

/// The error of our distance, relative to the size of the pair.
const DISTANCE_ERROR: f64 = 1e-12;

/// Published distances have four digits, those of the libraries some six.
const PUBLISHED_ERROR: f64 = 1e-4;

#[test]
fn hard_cases() {
    let Some(folder) = folder("convex") else { return };
    let mut tally = Tally::new("hard_cases");
    for case in json(&folder.join("hard_cases.json")).as_array().unwrap() {
        check(&mut tally, case);
    }
    tally.finish();
}

fn check(tally: &mut Tally, case: &Value) {
    let name = case["id"].as_str().unwrap();
    let (a, at_a) = placed(&case["a"], &case["pose_a"]);
    let (b, at_b) = placed(&case["b"], &case["pose_b"]);
    let (shape_a, shape_b) = (shape(&a), shape(&b));
    let size = stretch(&at_a) * reach(&a)
        + stretch(&at_b) * reach(&b)
        + (at_b.translation - at_a.translation).length();
    let hit = match verdict(&a, &at_a, &b, &at_b) {
        Verdict::Separated { gap } if gap > TOUCHING_ERROR * size => false,
        Verdict::Intersecting { .. } => true,
        touch => {
            println!("{name}: {touch:?} of size {size}; touching counts as intersecting");
            true
        }
    };
    tally.hit(name, hit, query::intersects(&shape_a, &at_a, &shape_b, &at_b).unwrap());
    tally.check(query::intersects(&shape_b, &at_b, &shape_a, &at_a).unwrap() == hit, || {
        format!("{name}: another answer when swapped")
    });
    let found = query::distance(&shape_a, &at_a, &shape_b, &at_b).unwrap().distance;
    let (low, high) = distance_bounds(&a, &at_a, &b, &at_b);
    tally.error(name, (low - found).max(found - high).max(0.0) / size, DISTANCE_ERROR);
    if let Some(signed) = case["reference_signed_distance"].as_f64() {
        tally.error(name, (found - signed.max(0.0)).abs() / size, DISTANCE_ERROR);
    }
    let deep = query::penetration(&shape_a, &at_a, &shape_b, &at_b).unwrap();
    tally.check(deep.is_some() == hit, || format!("{name}: {deep:?}"));
    if let (Some(deep), Some(truth)) = (deep, penetration_bounds(&a, &at_a, &b, &at_b)) {
        let error = outside([deep.depth_min, deep.depth_max], truth);
        tally.error(name, error / size, DISTANCE_ERROR);
    }
    for (source, signed) in opinions(case) {
        if (found - signed.max(0.0)).abs() > PUBLISHED_ERROR * size || (signed > 0.0) == hit {
            println!("{name}: {source} says {signed:e}, we {found:e}, certified {low:e} to {high:e}");
        }
    }
}

/// What the publication and the libraries say.
fn opinions(case: &Value) -> impl Iterator<Item = (&'static str, f64)> + '_ {
    let number = |value: &Value| value.as_f64().or_else(|| value.as_str()?.parse().ok());
    ["published_distance", "coal_signed_distance", "parry_signed_distance"]
        .into_iter()
        .filter_map(move |source| Some((source, number(&case[source])?)))
}

/// The longest axis.
fn stretch(at: &DAffine3) -> f64 {
    let DMat3 { x_axis, y_axis, z_axis } = at.matrix3;
    x_axis.length().max(y_axis.length()).max(z_axis.length())
}

/// A shape and its placement, the file's own axes and semi-axes turned into ours.
fn placed(shape: &Value, pose: &Value) -> (Convex, DAffine3) {
    let number = |name: &str| shape[name].as_f64().unwrap();
    let rows: [f64; 9] = serde_json::from_value(pose["R"].clone()).unwrap();
    let at = DAffine3 { matrix3: DMat3::from_cols_array(&rows).transpose(), translation: vector(&pose["t"]) };
    match shape["type"].as_str().unwrap() {
        "sphere" => (Convex::Sphere { radius: number("radius") }, at),
        "box" => (Convex::Cuboid { half: vector(&shape["half"]) }, at),
        "hull" => {
            let points = shape["vertices"].as_array().unwrap().iter().map(vector).collect();
            (Convex::Hull { points }, at)
        }
        "ellipsoid" => {
            let axes = DMat3::from_diagonal(vector(&shape["semi_axes"]));
            (Convex::Sphere { radius: 1.0 }, at * DAffine3::from_mat3(axes))
        }
        "capsule_z" => {
            // y onto z, z onto -y.
            let turn = DMat3::from_cols(DVec3::X, DVec3::Z, -DVec3::Y);
            let capsule = Convex::Capsule { radius: number("radius"), half_height: number("half") };
            (capsule, at * DAffine3::from_mat3(turn))
        }
        other => panic!("unknown shape {other}"),
    }
}

fn vector(value: &Value) -> DVec3 {
    DVec3::from_array(serde_json::from_value(value.clone()).unwrap())
}
