//! Scenes of tests: meshes beside a small convex shape.

use glam::{DAffine3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_convex::{Capsule, Cone, Cuboid, Polytope, Sphere, Support};
use solid_oracle::generate::in_cube;

use super::POINTS_MAX;
use crate::shape::Complex;

/// Up to `most` triangles about a place, near each other and of about a size; by the number of a case thin, flat and of no area too.
pub fn triangles(rng: &mut StdRng, case: usize, most: u32, size: f64, place: DVec3) -> Complex {
    let count = rng.random_range(1..=most);
    let vertices = (0..count).flat_map(|_| {
        let (p, q, r) = (in_cube(rng), 0.25 * in_cube(rng), 0.25 * in_cube(rng));
        match case % 5 {
            0 => [p, p + q, p + 0.4 * q + r * 1e-6],
            1 => [p, p + q, p + r].map(|corner| corner.with_z(0.3)),
            2 => [p, p + q, p],
            _ => [p, p + q, p + r],
        }
    });
    let vertices: Vec<DVec3> = vertices.map(|corner| corner * size + place).collect();
    let indices: Vec<[u32; 3]> = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Complex::mesh(vertices, indices).expect("it is well formed")
}

/// A convex shape of about a size; by the number of a case of all kinds, hulls of few and of many points among them.
pub fn convex(rng: &mut StdRng, case: usize, size: f64) -> Box<dyn Support> {
    let mut hull = |count: usize| {
        let points: Vec<DVec3> = (0..count).map(|_| size * in_cube(rng)).collect();
        Box::new(Polytope::new(points).expect("there are points"))
    };
    match case % 7 {
        0 => Box::new(Sphere::new(size).expect("it has a size")),
        1 => Box::new(Capsule::new(0.3 * size, size).expect("it has a size")),
        2 => Box::new(Cone::new(0.5 * size, size).expect("it has a size")),
        3 => hull(8),
        4 => hull(POINTS_MAX + 1),
        _ => Box::new(Cuboid::new(size * DVec3::new(1.0, 0.5, 0.7)).expect("it has a size")),
    }
}

/// A random rotation, and with it a placement at the origin that in one case of three shears and mirrors too.
pub fn turned(rng: &mut StdRng, case: usize) -> (DQuat, DAffine3) {
    let turn = DQuat::from_axis_angle(in_cube(rng).normalize(), rng.random_range(0.0..6.0));
    let mut at = DAffine3::from_quat(turn);
    if case.is_multiple_of(3) {
        at.matrix3.x_axis = at.matrix3.x_axis * -1.5 + at.matrix3.y_axis * 0.7;
    }
    (turn, at)
}
