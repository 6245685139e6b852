//! One geometry, described in several ways, gives one answer.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by panicking, and prints its seed"
)]

mod common;

use common::{assert_rate, at, cube, in_cube, log_uniform, placement, random_complex, torus};
use glam::{DAffine3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::seeded;
use solid3d::query::{self, ContactOptions};
use solid3d::{ComplexShapeBuilder, Shape, glam};

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

/// What is told of a shape beside some others.
fn answers(shape: &Shape) -> String {
    let options = ContactOptions { margin: 0.05, ..ContactOptions::default() };
    let others = [
        Shape::sphere(0.4).unwrap(),
        Shape::cuboid([0.5, 0.6, 0.7]).unwrap(),
        torus(30, 16, 0.3).shape(),
        cube(0.3).shape(),
    ];
    let here = DAffine3::IDENTITY;
    let mut told = Vec::new();
    for (other, at) in
        others.iter().zip([at(0.4, 0.3, 0.1), at(0.1, 0.6, 0.2), at(0.9, 0.1, 0.0), at(0.3, 0.0, 0.45)])
    {
        let point = at.translation;
        told.push(format!(
            "{:?}",
            (
                query::distance(shape, &here, other, &at),
                query::penetration(shape, &here, other, &at),
                query::contacts(shape, &here, other, &at, &options),
                query::intersection_curve(shape, &here, other, &at),
                query::cast_shape(other, &at, 4.0 * point, shape, &here, DVec3::ZERO),
                query::signed_distance(shape, &here, point),
                query::closest_point(shape, &here, 3.0 * point),
            )
        ));
    }
    told.join("\n")
}

/// Law: what was asked of a shape, and is kept, is forgotten when it is deformed, a little or by so much that its tree is made anew, and when it is made
/// solid.
#[test]
fn what_was_asked_before_changes_no_answer() {
    let mut rng = seeded(431);
    let complex = random_complex(&mut rng, 40);
    let square = [[-0.6, -0.6], [0.6, -0.6], [0.6, 0.6], [0.2, 0.6], [-0.6, 0.6]];
    let corners = square.map(|[x, y]| DVec3::new(x, 0.1, y));
    let polygon = || ComplexShapeBuilder::new(corners).simple_polygon(&[0, 1, 2, 3, 4]).build().unwrap();
    let shapes: [&dyn Fn() -> Shape; 5] = [
        &|| cube(0.5).shape(),
        &|| torus(40, 24, 0.4).shape(),
        &|| torus(24, 12, 0.4).shape().into_solid().unwrap(),
        &|| complex.shape(),
        &polygon,
    ];
    for (case, make) in shapes.into_iter().enumerate() {
        let mut asked = make();
        let start = asked.vertices().unwrap().to_vec();
        let mut ways = Vec::new();
        for (wave, twist) in [(0.3, 0.0), (0.02, 0.4), (0.02, 40.0), (0.0, 0.1)] {
            let mut before = make();
            ways.iter().for_each(|way: &Vec<DVec3>| before.deform(way).unwrap());
            assert!(answers(&asked) == answers(&before), "case {case}, {} deformations", ways.len());
            let moved =
                |&v: &DVec3| DQuat::from_rotation_y(twist * v.length()) * v + wave * in_cube(&mut rng);
            let moved: Vec<DVec3> = start.iter().map(moved).collect();
            asked.deform(&moved).unwrap();
            ways.push(moved);
        }
        if let Ok(solid) = make().into_solid() {
            let asked = make();
            let of_surface = answers(&asked);
            let of_solid = answers(&solid);
            assert!(answers(&asked.into_solid().unwrap()) == of_solid, "case {case}, as a solid");
            assert!(solid.is_solid() && (case == 2 || of_solid != of_surface), "case {case}");
        }
    }
}
