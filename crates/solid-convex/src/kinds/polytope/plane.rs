//! The planes of the faces of a polytope.

use glam::DVec3;

use crate::unit_scale;

/// The plane of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub corner: DVec3,
    /// Its unit normal.
    pub inward: DVec3,
    /// By how much the normal may be off.
    pub error: f64,
}

impl Plane {
    /// Those of triangles of points, counter-clockwise seen from outside.
    pub fn all(points: &[DVec3], faces: &[[u32; 3]]) -> Vec<Plane> {
        faces.iter().map(|face| Plane::of(face.map(|i| points[i as usize]))).collect()
    }

    /// That of a triangle, counter-clockwise seen from outside. Which side is the inner one is not told by a point of the hull: the mean of
    /// corners, as it is rounded, may be off what is flat.
    fn of(corners: [DVec3; 3]) -> Plane {
        /// The error of a normal is this much, relative to the lengths of the two edges: it turns the plane about the corner.
        const NORMAL_ERROR: f64 = 16.0 * f64::EPSILON;
        // From the corner that is opposite to the longest edge, at which the error is least.
        let opposite = |k: usize| corners[(k + 1) % 3].distance_squared(corners[(k + 2) % 3]);
        let widest = (1..3).fold(0, |widest, k| if opposite(k) > opposite(widest) { k } else { widest });
        let [p, q, r] = [0, 1, 2].map(|k| corners[(widest + k) % 3]);
        let edges = [q - p, r - p];
        let scale = unit_scale(edges[0].abs().max_element().max(edges[1].abs().max_element()));
        let [q, r] = edges.map(|edge| edge * scale);
        let normal = r.cross(q);
        let length = normal.length();
        Plane { corner: p, inward: normal / length, error: NORMAL_ERROR * q.length() * r.length() / length }
    }

    /// How far a point is above it, at least. Below any point of a sliver without a plane to speak of.
    pub fn height(&self, point: DVec3) -> f64 {
        let way = point - self.corner;
        // Of what is no number, that it is lowest.
        (self.inward.dot(way) - self.error * way.abs().element_sum()).max(f64::NEG_INFINITY)
    }
}
