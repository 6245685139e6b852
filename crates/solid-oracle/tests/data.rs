//! Published cases, from the folder that the environment variable `SOLID_DATA` names.
//!
//! Their reference values come from other libraries or from references of 60 digits; each test says how close.

#![allow(
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "helpers of tests print and unwrap as tests may"
)]

use std::path::PathBuf;

use glam::{DAffine3, DMat3, DQuat, DVec3};
use serde_json::Value;
use solid_oracle::generate::Pair;
use solid_oracle::{Convex, Verdict, distance_bounds, known_answers, penetration_bounds, verdict};

/// A file of the folder `convex`, `None` when there is no data.
fn data_file(name: &str) -> Option<PathBuf> {
    known_answers(&format!("convex/{name}"))
}

fn read_json(path: &PathBuf) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn vector(v: &Value) -> DVec3 {
    let [x, y, z] = [0, 1, 2].map(|i| v[i].as_f64().unwrap());
    DVec3::new(x, y, z)
}

fn vectors(v: &Value) -> Vec<DVec3> {
    v.as_array().unwrap().iter().map(vector).collect()
}

/// The quaternion (w, x, y, z) of the files, read by the formula of their notes.
fn placement(q: [f64; 4], t: [f64; 3]) -> DAffine3 {
    let [w, x, y, z] = q;
    DAffine3 { matrix3: DMat3::from_quat(DQuat::from_xyzw(x, y, z, w)), translation: DVec3::from_array(t) }
}

fn numbers<const N: usize>(record: &csv::StringRecord, first: usize) -> [f64; N] {
    core::array::from_fn(|i| record[first + i].parse().unwrap_or(0.0))
}

/// How far the certified interval is from a signed distance (negative: penetration depth); panics when undecided.
fn mismatch(p: &Pair, signed: f64) -> f64 {
    let outside = |(low, high): (f64, f64), x: f64| (low - x).max(x - high).max(0.0);
    match verdict(&p.a, &p.pa, &p.b, &p.pb) {
        Verdict::Separated { .. } => outside(distance_bounds(&p.a, &p.pa, &p.b, &p.pb), signed),
        Verdict::Intersecting { .. } => {
            outside(penetration_bounds(&p.a, &p.pa, &p.b, &p.pb).expect("they intersect"), -signed)
        }
        Verdict::Uncertain { gap_max } => {
            println!("undecided within {gap_max:e}: {p:?}");
            signed.abs().max(gap_max)
        }
    }
}

fn csv_shape(name: &str, [x, y, z]: [f64; 3]) -> Convex {
    match name {
        "box" => Convex::Cuboid { half: DVec3::new(x, y, z) },
        "sphere" => Convex::Sphere { radius: x },
        "capsule" => Convex::Capsule { radius: x, half_height: y },
        "cylinder" => Convex::Cylinder { radius: x, half_height: y },
        "cone" => Convex::Cone { radius: x, half_height: y },
        other => panic!("unknown shape {other}"),
    }
}

#[test]
fn primitives_agree_with_two_libraries() {
    let Some(path) = data_file("primitives.csv") else { return };
    let (mut worst, mut rows, mut hits) = (0.0f64, 0, 0);
    for record in csv::Reader::from_path(path).unwrap().records() {
        let record = record.unwrap();
        let p = Pair {
            a: csv_shape(&record[1], numbers(&record, 2)),
            pa: placement(numbers(&record, 5), numbers(&record, 9)),
            b: csv_shape(&record[12], numbers(&record, 13)),
            pb: placement(numbers(&record, 16), numbers(&record, 20)),
            size: 1.0,
        };
        let [collide, signed] = numbers(&record, 23);
        let hit = matches!(verdict(&p.a, &p.pa, &p.b, &p.pb), Verdict::Intersecting { .. });
        assert_eq!(hit, collide == 1.0, "row {}", &record[0]);
        rows += 1;
        hits += u32::from(hit);
        let off = mismatch(&p, signed);
        // The libraries stop at a relative 1e-6 or so on the round shapes.
        assert!(off < 2e-5, "row {}: off by {off:e} from {signed}", &record[0]);
        worst = worst.max(off);
    }
    println!("{rows} rows, {hits} hits, worst mismatch {worst:e}");
    assert!((rows * 3 / 10..=rows * 7 / 10).contains(&hits));
}

#[test]
fn hull_pairs_agree_with_brute_force() {
    let (Some(path), Some(hulls)) = (data_file("hull_pairs.csv"), data_file("hulls_open.json")) else {
        return;
    };
    let hulls: Vec<Convex> = read_json(&hulls)["hulls"]
        .as_array()
        .unwrap()
        .iter()
        .map(|points| Convex::Hull { points: vectors(points) })
        .collect();
    let (mut worst, mut rows, mut hits) = (0.0f64, 0, 0);
    for record in csv::Reader::from_path(path).unwrap().records() {
        let record = record.unwrap();
        let [a, b] = numbers::<2>(&record, 2).map(|i| hulls[i as usize].clone());
        let size = extent(&a).max(extent(&b));
        let pb = placement(numbers(&record, 4), numbers(&record, 8));
        let p = Pair { a, pa: DAffine3::IDENTITY, b, pb, size };
        let [signed] = numbers(&record, 11);
        rows += 1;
        hits += u32::from(signed < 0.0);
        let off = mismatch(&p, signed) / size;
        assert!(off < 1e-9, "row {} ({}): off by {off:e} of the size", &record[0], &record[1]);
        worst = worst.max(off);
    }
    println!("{rows} rows, {hits} hits, worst mismatch {worst:e} of the size");
    assert!((rows * 3 / 10..=rows * 7 / 10).contains(&hits));
}

fn extent(hull: &Convex) -> f64 {
    let Convex::Hull { points } = hull else { unreachable!("the file holds hulls") };
    points.iter().map(|p| p.length()).fold(0.0, f64::max)
}

/// Every hull of the Jolt file, against itself moved by a part of its extent.
#[test]
fn jolt_hulls_are_always_decided() {
    let Some(path) = data_file("jolt_convex_hulls_open.bin") else { return };
    let bytes = std::fs::read(path).unwrap();
    let mut words = bytes.chunks_exact(4).map(|word| [word[0], word[1], word[2], word[3]]);
    let (mut count, mut hits) = (0, 0);
    while let Some(length) = words.next().map(u32::from_le_bytes) {
        let mut coordinate = || f64::from(f32::from_le_bytes(words.next().unwrap()));
        let points: Vec<DVec3> =
            (0..length).map(|_| DVec3::new(coordinate(), coordinate(), coordinate())).collect();
        let size = points.iter().flat_map(|p| points.iter().map(|q| p.distance(*q))).fold(0.0, f64::max);
        let hull = Convex::Hull { points };
        let part = f64::from(count % 8) / 7.0;
        let moved = DAffine3::from_translation(DVec3::new(0.64, 0.6, -0.48) * size * part);
        count += 1;
        match verdict(&hull, &DAffine3::IDENTITY, &hull, &moved) {
            Verdict::Intersecting { .. } => hits += 1,
            Verdict::Separated { .. } => {}
            Verdict::Uncertain { .. } => panic!("hull {count} is undecided"),
        }
    }
    println!("{count} hulls, {hits} hits");
    assert!((count * 3 / 10..=count * 7 / 10).contains(&hits));
}

/// A shape of the hard cases and what its own axes are in ours.
fn hard_shape(shape: &Value, pose: &Value) -> (Convex, DAffine3) {
    let number = |name: &str| shape[name].as_f64().unwrap();
    let rows: Vec<f64> = pose["R"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    let matrix3 = DMat3::from_cols_slice(&rows).transpose();
    let pose = DAffine3 { matrix3, translation: vector(&pose["t"]) };
    match shape["type"].as_str().unwrap() {
        "sphere" => (Convex::Sphere { radius: number("radius") }, pose),
        "box" => (Convex::Cuboid { half: vector(&shape["half"]) }, pose),
        "hull" => (Convex::Hull { points: vectors(&shape["vertices"]) }, pose),
        "ellipsoid" => {
            let scale = DMat3::from_diagonal(vector(&shape["semi_axes"]));
            (Convex::Sphere { radius: 1.0 }, pose * DAffine3::from_mat3(scale))
        }
        "capsule_z" => {
            // y onto z, z onto -y.
            let turn = DMat3::from_cols(DVec3::X, DVec3::Z, -DVec3::Y);
            let capsule = Convex::Capsule { radius: number("radius"), half_height: number("half") };
            (capsule, pose * DAffine3::from_mat3(turn))
        }
        other => panic!("unknown shape {other}"),
    }
}

#[test]
fn hard_cases_agree_with_their_references() {
    let Some(path) = data_file("hard_cases.json") else { return };
    let mut references = 0;
    for case in read_json(&path).as_array().unwrap() {
        let (a, pa) = hard_shape(&case["a"], &case["pose_a"]);
        let (b, pb) = hard_shape(&case["b"], &case["pose_b"]);
        let p = Pair { a, pa, b, pb, size: 1.0 };
        let number = |name: &str| case[name].as_f64();
        if let Some(signed) = number("reference_signed_distance") {
            references += 1;
            let off = mismatch(&p, signed);
            assert!(off <= 1e-13 * (1.0 + signed.abs()), "{}: off by {off:e} from {signed}", case["id"]);
        } else if let Some(signed) = number("coal_signed_distance") {
            let off = mismatch(&p, signed);
            println!("{}: off by {off:e} from the {signed} of coal", case["id"]);
        }
        assert!(
            !matches!(verdict(&p.a, &p.pa, &p.b, &p.pb), Verdict::Uncertain { gap_max } if gap_max > 1e-25),
            "{} is undecided",
            case["id"]
        );
    }
    println!("{references} cases with references");
}
