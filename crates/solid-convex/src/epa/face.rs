//! A face of the polytope: its plane, and how well that is known.

use glam::DVec3;

use crate::Support;
use crate::difference::{Difference, SupportPoint};

/// A triangle of the polytope, counterclockwise from outside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Its vertices.
    pub corners: [u32; 3],
    /// The face across the edge from each corner to the next.
    pub neighbours: [u32; 3],
    /// Outward, of unit length.
    pub normal: DVec3,
    /// How far the plane is from the origin along the normal; infinite for a face that was replaced.
    pub offset: f64,
    /// How much less it may be.
    pub slack: f64,
    /// Whether the point being inserted sees it.
    pub seen: bool,
}

/// Roundings of 2^-53 of the normal of two edges, each relative to the parts that the edge is computed from: two products with
/// matrices and their difference for each edge, the cross product, the root and the scalar product with a corner.
const NORMAL_ROUNDINGS: f64 = 16.0 / (1u64 << 53) as f64;

impl Face {
    /// The face of three points. Its normal comes from the edges of the two objects, which are precise where the points are large
    /// and the face is small.
    pub fn new<A, B>(
        difference: &Difference<A, B>,
        corners: [u32; 3],
        [p, q, r]: [&SupportPoint; 3],
        neighbours: [u32; 3],
    ) -> Self
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let edges = [(p, q), (q, r), (r, p)].map(|(x, y)| difference.edge_with_size(x, y));
        let squares = edges.map(|(edge, _)| edge.length_squared());
        // The two shortest: see `simplex::normal`.
        let longest = (1..3).fold(0, |i, j| if squares[j] > squares[i] { j } else { i });
        let [(x, size_x), (y, size_y)] = [edges[(longest + 1) % 3], edges[(longest + 2) % 3]];
        let normal = x.cross(y);
        let near = |x: DVec3, y: DVec3| if y.length_squared() < x.length_squared() { y } else { x };
        let nearest = near(near(p.w, q.w), r.w);
        let length = normal.length();
        let unit = normal / length;
        if !unit.is_finite() {
            // So thin that its normal is lost: looked across once, along its nearest corner, and of no use as a bound.
            let normal = nearest.try_normalize().unwrap_or(DVec3::X);
            return Face { corners, neighbours, normal, offset: 0.0, slack: f64::INFINITY, seen: false };
        }
        let tilt = NORMAL_ROUNDINGS * (1.0 + (size_x * y.length() + size_y * x.length()) / length);
        let slack = tilt.min(2.0) * nearest.length();
        Face { corners, neighbours, normal: unit, offset: unit.dot(nearest), slack, seen: false }
    }
}
