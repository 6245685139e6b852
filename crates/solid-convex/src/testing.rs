//! What the tests of several modules ask about.

use glam::{DAffine3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;

use crate::{Capsule, Cone, Cuboid, Cylinder, Sphere, Support};

/// One of each kind.
pub fn shapes() -> Vec<Box<dyn Support>> {
    vec![
        Box::new(Sphere::new(0.7).unwrap()),
        Box::new(Cuboid::new(DVec3::new(1.0, 0.5, 2.0)).unwrap()),
        Box::new(Cone::new(0.5, 1.5).unwrap()),
        Box::new(Cylinder::new(0.6, 1.0).unwrap()),
        Box::new(Capsule::new(0.3, 1.2).unwrap()),
    ]
}

/// A shape of a kind, by number, whose sizes are told one after the other.
pub fn of_sizes(kind: usize, mut size: impl FnMut() -> f64) -> Box<dyn Support> {
    match kind {
        0 => Box::new(Cylinder::new(size(), size()).unwrap()),
        1 => Box::new(Cone::new(size(), size()).unwrap()),
        2 => Box::new(Sphere::new(size()).unwrap()),
        3 => Box::new(Capsule::new(size(), size()).unwrap()),
        _ => Box::new(Cuboid::new(DVec3::new(size(), size(), size())).unwrap()),
    }
}

/// The faces of an octahedron with corners on the axes x, y and z, on each the greater first.
pub fn octahedron_faces() -> Vec<[u32; 3]> {
    let face = |i: u32| {
        let [x, y, z] = [i & 1, 2 + (i >> 1 & 1), 4 + (i >> 2)];
        if i.count_ones().is_multiple_of(2) { [x, y, z] } else { [x, z, y] }
    };
    (0..8).map(face).collect()
}

/// The corners of a box from 0 to some sizes, and its faces.
pub fn block(size: DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let corners = (0..8).map(|i| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64) * size);
    let faces = [0, 1, 2].into_iter().flat_map(|axis| {
        let [u, v] = [1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3)];
        // The lower face is seen from below.
        [(0, v, u), (1 << axis, u, v)]
            .into_iter()
            .flat_map(|(o, u, v)| [[o, o + u, o + v], [o + u, o + u + v, o + v]])
    });
    (corners.collect(), faces.collect())
}

/// Placements spread over orientations and distances by a low-discrepancy sequence.
pub fn placement(i: u32) -> DAffine3 {
    let part = |step: f64| (f64::from(i) * step).fract();
    let rotation =
        DQuat::from_xyzw(part(0.618) - 0.5, part(0.414) - 0.5, part(0.732) - 0.5, part(0.236) + 0.1);
    let translation = DVec3::new(part(0.7549), part(0.5698), part(0.3247)) * 1.6 - 0.8;
    DAffine3::from_rotation_translation(rotation.normalize(), translation)
}

/// A vector in the cube from -1 to 1.
pub fn in_cube(rng: &mut StdRng) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)))
}

/// A law about two shapes and where they are: of all pairs of kinds, in so many placements each. With the numbers of the kinds and the placement.
pub fn for_each_pair(placements: u32, mut law: impl FnMut([u32; 3], [&dyn Support; 2], [&DAffine3; 2])) {
    let all = shapes();
    for (i, a) in (0..).zip(&all) {
        for (j, b) in (0..).zip(&all) {
            for k in 0..placements {
                law([i, j, k], [&**a, &**b], [&placement(k), &placement(7 * k + i + 5 * j + 1)]);
            }
        }
    }
}
