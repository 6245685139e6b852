//! One geometry, described in several ways, gives one answer.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by panicking, and prints its seed"
)]

mod common;

use common::{assert_rate, in_cube, log_uniform, placement};
use glam::{DAffine3, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::seeded;
use solid3d::{ComplexShapeBuilder, Shape, glam, query};

const CASES: usize = 4000;

/// Distances are right to 1e-12 of the size of the data, and each description may err on its side.
const TOLERANCE: f64 = 1e-11;

type Placed = (Shape, DAffine3);

/// A box as a box, as a hull, as a scaled and as a translated one, and as a polyhedron and tetrahedra under a tree.
fn boxes(size: DVec3, at: DAffine3) -> Vec<Placed> {
    let corners: Vec<DVec3> =
        (0..8).map(|i| 0.5 * size * DVec3::new(sign(i), sign(i >> 1), sign(i >> 2))).collect();
    let away = DVec3::new(0.5, -0.25, 1.0) * size;
    let moved: Vec<DVec3> = corners.iter().map(|&corner| corner + away).collect();
    let all = [0, 1, 2, 3, 4, 5, 6, 7];
    // The tetrahedron inside, and one at each of the corners that it leaves.
    let tetrahedra = [[0, 3, 5, 6], [1, 0, 3, 5], [2, 0, 3, 6], [4, 0, 5, 6], [7, 3, 5, 6]];
    let cut = ComplexShapeBuilder::new(corners.clone());
    let cut = tetrahedra.into_iter().fold(cut, ComplexShapeBuilder::tetrahedron);
    vec![
        (Shape::cuboid(size).unwrap(), at),
        (Shape::cuboid([1.0; 3]).unwrap(), at * DAffine3::from_scale(size)),
        (Shape::cuboid(size).unwrap(), at * DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0))),
        (Shape::convex_hull(&corners).unwrap(), at),
        (Shape::convex_hull(&moved).unwrap(), at * DAffine3::from_translation(-away)),
        (ComplexShapeBuilder::new(corners).polyhedron(&all).build().unwrap(), at),
        (cut.build().unwrap(), at),
    ]
}

/// A ball as a ball, as a scaled one, and as a mirrored one.
fn balls(radius: f64, at: DAffine3) -> Vec<Placed> {
    vec![
        (Shape::sphere(radius).unwrap(), at),
        (Shape::sphere(1.0).unwrap(), at * DAffine3::from_scale(DVec3::splat(radius))),
        (Shape::sphere(radius).unwrap(), at * DAffine3::from_scale(DVec3::NEG_ONE)),
    ]
}

/// A cylinder as one, turned over, and scaled.
fn cylinders(radius: f64, height: f64, at: DAffine3) -> Vec<Placed> {
    vec![
        (Shape::cylinder(radius, height).unwrap(), at),
        (Shape::cylinder(radius, height).unwrap(), at * DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0))),
        (Shape::cylinder(1.0, 1.0).unwrap(), at * DAffine3::from_scale(DVec3::new(radius, height, radius))),
    ]
}

fn sign(bit: usize) -> f64 {
    if bit & 1 == 0 { -1.0 } else { 1.0 }
}

/// The descriptions of a random geometry, with its reach.
fn any(rng: &mut StdRng, scale: f64) -> (Vec<Placed>, f64) {
    let mut at = placement(rng, 1.0);
    at.translation = in_cube(rng) * 1.1 * scale;
    let mut size = || scale * log_uniform(rng, 0.2, 2.0);
    let (x, y, z) = (size(), size(), size());
    let placed = match rng.random_range(0..3) {
        0 => boxes(DVec3::new(x, y, z), at),
        1 => balls(x, at),
        _ => cylinders(x, y, at),
    };
    let bounds = query::bounds(&placed[0].0, &placed[0].1).unwrap();
    (placed, (bounds.max - bounds.min).length())
}

#[test]
fn descriptions_of_one_geometry_agree() {
    let seed = 1;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let mut hits = 0;
    for case in 0..CASES {
        let scale = log_uniform(&mut rng, 1e-6, 1e6);
        let ((these, reach_a), (those, reach_b)) = (any(&mut rng, scale), any(&mut rng, scale));
        let apart = these[0].1.translation.distance(those[0].1.translation);
        let tolerance = TOLERANCE * (reach_a + reach_b + apart);
        let ask = |(a, at_a): &Placed, (b, at_b): &Placed| {
            let distance = query::distance(a, at_a, b, at_b).unwrap().distance;
            (distance, query::intersects(a, at_a, b, at_b).unwrap())
        };
        let (distance, meet) = ask(&these[0], &those[0]);
        hits += usize::from(meet);
        for a in &these {
            for b in &those {
                for (d, m) in [ask(a, b), ask(b, a)] {
                    let context = || format!("seed {seed}, case {case}: {a:?} and {b:?}");
                    assert!((d - distance).abs() <= tolerance, "{d} for {distance}: {}", context());
                    // A grazing overlap is not told by a distance of 0, but then all of them are near 0.
                    assert!(m == meet || d <= tolerance, "{m} for {meet} at {d}: {}", context());
                }
            }
        }
    }
    assert_rate("descriptions of one geometry", hits, CASES);
}
