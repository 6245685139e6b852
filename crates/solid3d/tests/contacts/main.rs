//! Contacts of all kinds of shapes: by their laws, against the penetration depth, and known cases.
#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by panicking and says what it did"
)]

mod bodies;
#[path = "../common/mod.rs"]
mod common;
mod ground;
mod margins;
mod names;
mod places;
mod surfaces;

use common::sheet;
use glam::{DAffine3, DVec3};
use solid3d::query::{self, ContactOptions, ContactPoint, Manifold};
use solid3d::{Shape, glam};

const SEED: u64 = 20_262;

fn within(margin: f64) -> ContactOptions {
    ContactOptions { margin, ..ContactOptions::default() }
}

fn contacts(a: &Shape, pa: &DAffine3, b: &Shape, pb: &DAffine3) -> Vec<Manifold> {
    query::contacts(a, pa, b, pb, &ContactOptions::default()).unwrap()
}

/// The only region.
fn only(a: &Shape, pa: &DAffine3, b: &Shape, pb: &DAffine3) -> Manifold {
    let mut found = contacts(a, pa, b, pb);
    assert_eq!(found.len(), 1, "{found:#?}");
    found.remove(0)
}

fn cube() -> Shape {
    Shape::cuboid([1.0; 3]).unwrap()
}

/// A flat floor of squares of two triangles each, from -5 to 5.
fn floor(squares: u32) -> Shape {
    sheet(squares + 1, squares + 1, [false, false], |u, v| DVec3::new(10.0 * v - 5.0, 0.0, 10.0 * u - 5.0))
        .shape()
}

/// The surface of a unit cube, of 12 triangles.
fn cube_mesh() -> Shape {
    common::cube(0.5).shape()
}

/// How far the vertices of a placed mesh are along a direction.
fn reach(mesh: &Shape, at: &DAffine3, along: DVec3) -> f64 {
    let heights = mesh.vertices().unwrap().iter().map(|&vertex| along.dot(at.transform_point3(vertex)));
    heights.fold(f64::NEG_INFINITY, f64::max)
}

fn deepest(manifolds: &[Manifold]) -> f64 {
    manifolds.iter().flat_map(|m| &m.points).map(|point| point.depth).fold(f64::NEG_INFINITY, f64::max)
}

/// What holds of every answer.
fn assert_laws(manifolds: &[Manifold], margin: f64, size: f64, context: &str) {
    for Manifold { normal, points } in manifolds {
        assert!((normal.length() - 1.0).abs() < 1e-9, "{context}: {normal}");
        assert!(!points.is_empty(), "{context}: a manifold without points");
        for ContactPoint { point_on_a, point_on_b, depth, .. } in points {
            assert!(depth.is_finite() && *depth >= -margin - 1e-9 * size, "{context}: {depth}");
            let off = (point_on_b - point_on_a).distance(normal * *depth);
            // The deepest points of round bodies are known to the square root of the error of the depth.
            let limit = 3e-3 * depth.abs() + 1e-8 * size;
            assert!(off <= limit, "{context}: the points of depth {depth} are {off:e} off the normal");
        }
    }
}

fn assert_flat(found: &Manifold, normal: DVec3, depth: f64, count: usize) {
    assert!((found.normal - normal).length() < 1e-9, "{found:?}");
    assert_eq!(found.points.len(), count, "{found:#?}");
    for point in &found.points {
        assert!((point.depth - depth).abs() < 1e-7, "{point:?} is not {depth} deep");
    }
}
