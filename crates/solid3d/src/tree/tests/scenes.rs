//! What the tests are run on.

use crate::Aabb;
use crate::tree::{PairMetric, Relative};
use glam::{DAffine3, DMat3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::seeded;
use std::f64::consts::TAU;

pub fn rng(seed: u64) -> StdRng {
    eprintln!("seed {seed}");
    seeded(seed)
}

/// A point within the cube of half side `side`.
pub fn point(rng: &mut StdRng, side: f64) -> DVec3 {
    DVec3::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0)) * side
}

/// Boxes with centres in the unit cube and sizes up to `size`, each axis its own.
pub fn random_boxes(rng: &mut StdRng, n: usize, size: f64) -> Vec<Aabb> {
    (0..n).map(|_| (point(rng, 1.0), point(rng, size).abs())).map(|(c, h)| Aabb::new(c - h, c + h)).collect()
}

/// A uniformly random rotation (Shoemake, as in thesis 5.2.4).
pub fn rotation(rng: &mut StdRng) -> DQuat {
    let (u, v, w): (f64, f64, f64) = (rng.random(), rng.random(), rng.random());
    let ((s1, c1), (s2, c2)) = ((TAU * v).sin_cos(), (TAU * w).sin_cos());
    let (a, b) = ((1.0 - u).sqrt(), u.sqrt());
    DQuat::from_xyzw(a * s1, a * c1, b * s2, b * c2).normalize()
}

/// A random affine map whose linear part is a rotation, sheared, stretched and mirrored, of about `size`.
pub fn affine(rng: &mut StdRng, size: f64, distance: f64) -> DAffine3 {
    let stretch =
        DVec3::new(rng.random_range(0.5..2.0), rng.random_range(0.5..2.0), rng.random_range(0.5..2.0));
    let sign = if rng.random() { 1.0 } else { -1.0 };
    let matrix3 = DMat3::from_quat(rotation(rng))
        * DMat3::from_diagonal(stretch * DVec3::new(sign, 1.0, 1.0) * size)
        * DMat3::from_quat(rotation(rng));
    DAffine3 { matrix3, translation: point(rng, distance) }
}

/// The relative placement of a map, with slack for boxes within `radius_a` and `radius_b` of their local origins.
pub fn relative(b_to_a: DAffine3, radius_a: f64, radius_b: f64) -> Relative {
    let a_to_b = b_to_a.inverse();
    let reach = |m: &DAffine3, radius: f64| {
        let linear =
            m.x_axis.abs().element_sum() + m.y_axis.abs().element_sum() + m.z_axis.abs().element_sum();
        linear * radius + m.translation.abs().max_element()
    };
    Relative {
        b_to_a,
        a_to_b,
        slack_in_a: 1e-14 * reach(&b_to_a, radius_b),
        slack_in_b: 1e-13 * reach(&a_to_b, radius_a.max(b_to_a.translation.length())),
    }
}

fn facet(linear: DMat3) -> DVec3 {
    let rows = linear.inverse().transpose();
    DVec3::new(rows.x_axis.length(), rows.y_axis.length(), rows.z_axis.length()).recip() * (1.0 - 1e-14)
}

/// The inverse of the Frobenius norm of the inverse is at most the least singular value.
fn sigma_min(linear: DMat3) -> f64 {
    let inverse = linear.inverse();
    let squared =
        inverse.x_axis.length_squared() + inverse.y_axis.length_squared() + inverse.z_axis.length_squared();
    squared.sqrt().recip() * (1.0 - 1e-14)
}

/// A distance of one in either space is worth so much.
pub fn uniform(length: f64) -> PairMetric {
    let facets = DVec3::splat(length);
    PairMetric { facet_a: facets, facet_b: facets, sigma_min_a: length, sigma_min_b: length }
}

/// What distances in two placed spaces are worth, less some roundings.
pub fn metric(a: &DAffine3, b: &DAffine3) -> PairMetric {
    PairMetric {
        facet_a: facet(a.matrix3),
        facet_b: facet(b.matrix3),
        sigma_min_a: sigma_min(a.matrix3),
        sigma_min_b: sigma_min(b.matrix3),
    }
}

/// The 5,000 triangles of a torus around z, major radius 10, minor 2 (thesis, 5.2.4), deformed by `warp`.
pub fn torus(around: u32, across: u32, warp: impl Fn(DVec3) -> DVec3) -> Vec<[DVec3; 3]> {
    let vertex = |i: u32, j: u32| {
        let (s, c) = (TAU * f64::from(i % around) / f64::from(around)).sin_cos();
        let (t, r) = (TAU * f64::from(j % across) / f64::from(across)).sin_cos();
        warp(DVec3::new(c * (10.0 + 2.0 * r), s * (10.0 + 2.0 * r), 2.0 * t))
    };
    let quad = |i, j| {
        let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    (0..around).flat_map(|i| (0..across).flat_map(move |j| quad(i, j))).collect()
}

pub fn boxes_of(triangles: &[[DVec3; 3]]) -> Vec<Aabb> {
    triangles.iter().map(|t| Aabb::of_points(*t)).collect()
}

/// A torus of 5,000 triangles.
pub fn torus_boxes() -> Vec<Aabb> {
    boxes_of(&torus(100, 25, |p| p))
}

/// A random rigid placement in the cube of half side 10.2, of which about 60 % of torus pairs collide.
pub fn torus_placement(rng: &mut StdRng) -> DAffine3 {
    let place = |rng: &mut StdRng| DAffine3::from_rotation_translation(rotation(rng), point(rng, 10.2));
    place(rng).inverse() * place(rng)
}
