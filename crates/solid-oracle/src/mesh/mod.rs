//! Triangles and sets of them, by brute force.

mod distance;
mod intersection;
mod side;
mod winding;

pub use distance::{mesh_distance, triangle_distance};
pub use intersection::{mesh_pairs, triangles_intersect};
pub use winding::winding_number;

use glam::DVec3;

/// The corners of a triangle.
pub(crate) type Triangle = [DVec3; 3];

/// The box around some triangle, exact.
#[derive(Clone, Copy)]
struct Bounds {
    min: DVec3,
    max: DVec3,
}

impl Bounds {
    fn of(triangle: &Triangle) -> Self {
        let [a, b, c] = *triangle;
        Self { min: a.min(b).min(c), max: a.max(b).max(c) }
    }

    fn touches(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    fn distance(&self, other: &Self) -> f64 {
        (self.min - other.max).max(other.min - self.max).max(DVec3::ZERO).length()
    }
}

/// The triangles of a mesh.
///
/// # Panics
/// When an index is not that of a vertex.
fn triangles_of(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Vec<(Triangle, Bounds)> {
    let corner = |i: u32| vertices[i as usize];
    triangles.iter().map(|t| t.map(corner)).map(|t| (t, Bounds::of(&t))).collect()
}
