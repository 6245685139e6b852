//! Convex shapes: primitives and hulls, with signed distances (negative: penetration depth).

use std::path::Path;

use glam::{DAffine3, DVec3};
use solid_oracle::{Convex, Verdict, distance_bounds, penetration_bounds, verdict};
use solid3d::{Shape, query};

use crate::data::{Row, folder, for_each_row, json};
use crate::tally::Tally;

/// The error of our distance, relative to the size of the pair.
const DISTANCE_ERROR: f64 = 1e-12;

#[test]
fn primitives() {
    let Some(folder) = folder("convex") else { return };
    // The two libraries stop early on round shapes; the certified bounds say how far we are from the truth.
    let mut libraries = Tally::new("primitives, against coal and parry");
    let mut certified = Tally::new("primitives, against certified bounds");
    for_each_row(&folder.join("primitives.csv"), |row| {
        let label = format!("row {} ({} {})", row.text("id"), row.text("shapeA"), row.text("shapeB"));
        let (a, b) = (primitive(&row, "A", "a"), primitive(&row, "B", "b"));
        let (at_a, at_b) = (row.placement("A"), row.placement("B"));
        let collide = row.flag("collide");
        let (shape_a, shape_b) = (shape(&a), shape(&b));
        libraries.hit(&label, collide, query::intersects(&shape_a, &at_a, &shape_b, &at_b).unwrap());
        let found = query::distance(&shape_a, &at_a, &shape_b, &at_b).unwrap().distance;
        let swapped = query::distance(&shape_b, &at_b, &shape_a, &at_a).unwrap().distance;
        let size = reach(&a) + reach(&b) + (at_b.translation - at_a.translation).length();
        libraries.error(&label, (found - swapped).abs() / size, DISTANCE_ERROR);
        let (coal, parry) = (row.real("signed_distance_coal"), row.real("signed_distance_parry"));
        let limit = (coal - parry).abs() + 1e-6;
        libraries.error(&label, (found - coal.max(0.0)).abs(), limit);
        let (low, high) = distance_bounds(&a, &at_a, &b, &at_b);
        certified.hit(&label, collide, high == 0.0);
        let depth = query::penetration(&shape_a, &at_a, &shape_b, &at_b).unwrap();
        certified.check(depth.is_some() == collide, || format!("{label}: {depth:?}"));
        if let (Some(depth), Some(truth)) = (depth, penetration_bounds(&a, &at_a, &b, &at_b)) {
            certified.error(
                &label,
                outside([depth.depth_min, depth.depth_max], truth) / size,
                DISTANCE_ERROR,
            );
        }
        certified.error(&label, (low - found).max(found - high).max(0.0) / size, DISTANCE_ERROR);
    });
    libraries.finish_representative();
    certified.finish();
}

/// How far apart an answer, given as bounds, and certified bounds of the truth are.
pub(crate) fn outside([low, high]: [f64; 2], (certain_low, certain_high): (f64, f64)) -> f64 {
    (certain_low - high).max(low - certain_high).max(0.0)
}

fn primitive(row: &Row, object: &str, prefix: &str) -> Convex {
    let size = |i: usize| row.number::<f64>(&format!("{prefix}{i}"));
    let number = |i: usize| size(i).expect("a size");
    match row.text(&format!("shape{object}")) {
        "box" => Convex::Cuboid { half: DVec3::new(number(0), number(1), number(2)) },
        "sphere" => Convex::Sphere { radius: number(0) },
        "capsule" => Convex::Capsule { radius: number(0), half_height: number(1) },
        "cylinder" => Convex::Cylinder { radius: number(0), half_height: number(1) },
        "cone" => Convex::Cone { radius: number(0), half_height: number(1) },
        other => panic!("unknown shape {other}"),
    }
}

/// Our shape for one of the oracle's, whose numbers are half extents.
pub(crate) fn shape(convex: &Convex) -> Shape {
    match convex {
        Convex::Sphere { radius } => Shape::sphere(*radius),
        Convex::Cuboid { half } => Shape::cuboid(*half * 2.0),
        Convex::Cone { radius, half_height } => Shape::cone(*radius, half_height * 2.0),
        Convex::Cylinder { radius, half_height } => Shape::cylinder(*radius, half_height * 2.0),
        Convex::Capsule { radius, half_height } => Shape::capsule(*radius, half_height * 2.0),
        Convex::Hull { points } => Shape::convex_hull(points),
    }
    .unwrap()
}

/// The greatest distance of a point of the shape from the local origin, or a bit more.
pub(crate) fn reach(convex: &Convex) -> f64 {
    match convex {
        Convex::Sphere { radius } => *radius,
        Convex::Cuboid { half } => half.length(),
        Convex::Cone { radius, half_height }
        | Convex::Cylinder { radius, half_height }
        | Convex::Capsule { radius, half_height } => radius + half_height,
        Convex::Hull { points } => points.iter().map(|p| p.length()).fold(0.0, f64::max),
    }
}

#[test]
fn hull_pairs() {
    let Some(folder) = folder("convex") else { return };
    let hulls = hulls(&folder.join("hulls_open.json"));
    let mut tally = Tally::new("hull_pairs");
    for_each_row(&folder.join("hull_pairs.csv"), |row| {
        let label = format!("row {} ({})", row.text("id"), row.text("kind"));
        let [(a, shape_a), (b, shape_b)] =
            ["hullA", "hullB"].map(|column| &hulls[row.number::<usize>(column).unwrap()]);
        let (here, at) = (DAffine3::IDENTITY, row.placement(""));
        let signed = row.real("signed_distance");
        tally.hit(&label, signed < 0.0, query::intersects(shape_a, &here, shape_b, &at).unwrap());
        tally.check(query::intersects(shape_b, &at, shape_a, &here).unwrap() == (signed < 0.0), || {
            format!("{label}: another answer when swapped")
        });
        let found = query::distance(shape_a, &here, shape_b, &at).unwrap().distance;
        let size = reach(a) + reach(b) + at.translation.length();
        tally.error(&label, (found - signed.max(0.0)).abs() / size, DISTANCE_ERROR);
        let depth =
            query::penetration(shape_a, &here, shape_b, &at).unwrap().map_or(0.0, |found| found.depth);
        tally.error(&label, (depth - (-signed).max(0.0)).abs() / size, DISTANCE_ERROR);
    });
    tally.finish_representative();
}

fn hulls(path: &Path) -> Vec<(Convex, Shape)> {
    let file = json(path);
    let hulls = file["hulls"].as_array().unwrap().iter();
    hulls
        .map(|points| {
            let points: Vec<[f64; 3]> = serde_json::from_value(points.clone()).unwrap();
            let hull = Convex::Hull { points: points.into_iter().map(DVec3::from_array).collect() };
            let shape = shape(&hull);
            (hull, shape)
        })
        .collect()
}

/// Hull vertices of CGAL, and each hull against itself moved, judged exactly.
#[test]
fn jolt_hulls() {
    let Some(folder) = folder("convex") else { return };
    let sets = point_sets(&std::fs::read(folder.join("jolt_convex_hulls_open.bin")).unwrap());
    let mut tally = Tally::new("jolt_convex_hulls_open");
    let mut flat = Vec::new();
    for_each_row(&folder.join("jolt_convex_hulls_open.csv"), |row| {
        let index: usize = row.number("index").unwrap();
        let label = format!("set {index}");
        let points = &sets[index];
        assert_eq!(points.len(), row.number::<usize>("n_points").unwrap());
        let hull = Shape::convex_hull(points).unwrap();
        let found = hull.vertices().unwrap().len();
        if row.text("affine_dim") == "3" {
            let expected = row.number("hull_vertices_cgal");
            tally.check(expected == Some(found), || format!("{label}: {found} vertices, CGAL {expected:?}"));
        } else {
            println!("{label}: {found} vertices of a set of dimension {}", row.text("affine_dim"));
            flat.push(found);
        }
        let size = diameter(points);
        let part = (index % 8) as f64 / 7.0;
        let (here, moved) = (DAffine3::IDENTITY, DVec3::new(0.64, 0.6, -0.48) * size * part);
        let moved = DAffine3::from_translation(moved);
        let exact = Convex::Hull { points: points.clone() };
        let hit = matches!(verdict(&exact, &here, &exact, &moved), Verdict::Intersecting { .. });
        tally.hit(&label, hit, query::intersects(&hull, &here, &hull, &moved).unwrap());
        let (low, high) = distance_bounds(&exact, &here, &exact, &moved);
        let distance = query::distance(&hull, &here, &hull, &moved).unwrap().distance;
        tally.error(&label, (low - distance).max(distance - high).max(0.0) / size, DISTANCE_ERROR);
    });
    // CGAL counts no vertices of a flat set. The file has one, and rational arithmetic by hand gives its hull 6 corners.
    tally.check(flat == [6], || format!("flat sets have {flat:?} corners"));
    tally.finish_representative();
}

/// Sets of points: the count, then that many triples of `f32`, little-endian.
fn point_sets(bytes: &[u8]) -> Vec<Vec<DVec3>> {
    let mut words = bytes.chunks_exact(4).map(|word| [word[0], word[1], word[2], word[3]]);
    let mut sets = Vec::new();
    while let Some(count) = words.next().map(u32::from_le_bytes) {
        let mut coordinate = || f64::from(f32::from_le_bytes(words.next().unwrap()));
        sets.push((0..count).map(|_| DVec3::new(coordinate(), coordinate(), coordinate())).collect());
    }
    sets
}

fn diameter(points: &[DVec3]) -> f64 {
    points.iter().flat_map(|p| points.iter().map(|q| p.distance(*q))).fold(0.0, f64::max)
}
