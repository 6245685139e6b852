//! A face of the polytope: its plane, and how well that is known.

use glam::DVec3;

use super::HEIGHT_ERROR;
use crate::Support;
use crate::difference::{Difference, SupportPoint};

/// A triangle of the polytope, counterclockwise from outside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Its vertices.
    pub corners: [u32; 3],
    /// For the edge from each corner to the next, the same edge of the face across it.
    pub twins: [HalfEdge; 3],
    /// Outward, of unit length.
    pub normal: DVec3,
    /// How far the plane is from the origin along the normal; infinite for a face that was replaced.
    pub offset: f64,
    /// How much less it may be.
    pub slack: f64,
    /// How much higher above the plane, or lower, a vertex may be than its computed height says.
    pub blur: f64,
    /// Whether the point being inserted sees it.
    pub seen: bool,
    /// Whether it is still to be looked across.
    pub open: bool,
}

/// An edge of a face: four times its number, plus that of the corner which the edge starts at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HalfEdge(u32);

impl HalfEdge {
    pub const fn new(face: u32, corner: u32) -> Self {
        HalfEdge(4 * face + corner)
    }

    /// The face that it is an edge of.
    pub fn face(self) -> usize {
        (self.0 / 4) as usize
    }

    /// Which of the face's corners it starts at.
    pub fn corner(self) -> usize {
        (self.0 % 4) as usize
    }

    /// The edges of the same face that follow, in their order.
    pub fn others(self) -> [HalfEdge; 2] {
        const NEXT: [[u32; 2]; 3] = [[1, 2], [2, 0], [0, 1]];
        NEXT[self.corner()].map(|corner| HalfEdge(self.0 / 4 * 4 + corner))
    }
}

/// Roundings of 2^-53 of the normal of two edges, each relative to the parts that the edge is computed from: two products with
/// matrices and their difference for each edge, the cross product, the root and the scalar product with a corner.
const NORMAL_ROUNDINGS: f64 = 16.0 / (1u64 << 53) as f64;

/// No two points of the difference, whose coordinates are below 2, are further apart.
const DIAMETER: f64 = 8.0;

/// The square of how wide a triangle is, in the difference's unit, beyond which the rounding of its corners does not tilt it by
/// more than some 1e-14.
const WIDE_SQUARED: f64 = 1.0 / 1024.0;

impl Face {
    /// The face of three points.
    #[inline]
    pub fn new<A, B>(
        difference: &Difference<A, B>,
        corners: [u32; 3],
        points: [&SupportPoint; 3],
        twins: [HalfEdge; 3],
    ) -> Self
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let [p, q, r] = points.map(|point| point.w);
        let (pq, qr, rp) = (q - p, r - q, p - r);
        let squares = [pq.length_squared(), qr.length_squared(), rp.length_squared()];
        // The two shortest: see `simplex::normal`.
        let longest = (1..3).fold(0, |i, j| if squares[j] > squares[i] { j } else { i });
        let [(x, x_squared), (y, y_squared)] = match longest {
            0 => [(qr, squares[1]), (rp, squares[2])],
            1 => [(rp, squares[2]), (pq, squares[0])],
            _ => [(pq, squares[0]), (qr, squares[1])],
        };
        let near = |x: DVec3, y: DVec3| if y.length_squared() < x.length_squared() { y } else { x };
        let nearest = near(near(p, q), r);
        let normal = x.cross(y);
        let length_squared = normal.length_squared();
        let plane = if length_squared > WIDE_SQUARED * x_squared.max(y_squared) {
            let length = length_squared.sqrt();
            // The corners are what they are: only the computation rounds.
            let tilt = NORMAL_ROUNDINGS * (1.0 + (x_squared * y_squared).sqrt() / length);
            Plane { normal: normal / length, tilt, error: 0.0 }
        } else {
            Plane::of_edges(difference, points, longest)
        };
        if plane.tilt == f64::INFINITY {
            // So thin that its normal is lost: looked across once, along its nearest corner, and of no use as a bound.
            let normal = nearest.try_normalize().unwrap_or(DVec3::X);
            let (slack, blur) = (f64::INFINITY, f64::INFINITY);
            return Face { corners, twins, normal, offset: 0.0, slack, blur, seen: false, open: true };
        }
        let Plane { normal, tilt, error } = plane;
        let (slack, blur) = (tilt.min(2.0) * nearest.length() + error, tilt * DIAMETER + error);
        Face { corners, twins, normal, offset: normal.dot(nearest), slack, blur, seen: false, open: true }
    }
}

/// A normal, and how well it is known.
struct Plane {
    normal: DVec3,
    /// How much it may be off; infinite when nothing is known.
    tilt: f64,
    /// How far the corners may be from the plane.
    error: f64,
}

impl Plane {
    /// From the edges of the two objects, which are precise where the points are large and the face is small.
    #[inline(never)]
    fn of_edges<A, B>(difference: &Difference<A, B>, [p, q, r]: [&SupportPoint; 3], longest: usize) -> Plane
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let edges = [(p, q), (q, r), (r, p)];
        let edge = |i: usize| difference.edge_with_size(edges[i].0, edges[i].1);
        let [(x, size_x), (y, size_y)] = [edge((longest + 1) % 3), edge((longest + 2) % 3)];
        let normal = x.cross(y);
        let length = normal.length();
        let unit = normal / length;
        if !unit.is_finite() {
            return Plane { normal: DVec3::X, tilt: f64::INFINITY, error: 0.0 };
        }
        let tilt = NORMAL_ROUNDINGS * (1.0 + (size_x * y.length() + size_y * x.length()) / length);
        Plane { normal: unit, tilt, error: HEIGHT_ERROR }
    }
}
