//! Differences that are thin: needles side by side.
//!
//! The faces along a needle are slivers, and how their normals are rounded decides all: tilted by `e`, a plane is off at the far end by `e` times
//! the length, which is soon more than the needle is thick. So such a difference is searched anew, stretched to much the same extent in all
//! directions. Planes stay planes there; only lengths are others, and the search asks for one alone: that of a normal.

use glam::{DMat3, DVec3};

use super::plane::Plane;
use super::start::furthest;
use crate::Support;
use crate::difference::{Difference, SUPPORT_ERROR, SupportPoint};

/// What is thinner than this, relative to its length, counts as a needle.
const NEEDLE: f64 = 1e-2;

/// A linear map of a difference to a stretched one. A plane with the normal `n` there has the normal `map^T n` here; those of the stretched
/// polytope have the length at which these are unit vectors, so that heights over its planes are heights here.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    map: DMat3,
    /// How much the rounding of a point is for each coordinate of the stretched one.
    error: DVec3,
}

impl Stretch {
    /// The map by which points of a difference that are furthest off the others become a tetrahedron of edges of one length, with these four
    /// points. `None` when they are no needle, or so nearly coplanar that there is no such map.
    pub fn across<A, B>(
        difference: &Difference<A, B>,
        points: &[SupportPoint],
    ) -> Option<(Self, [SupportPoint; 4])>
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let p = *points.first()?;
        let from_p = |x: &SupportPoint| difference.edge(&p, x);
        let (q, length) = furthest(points, |x| from_p(x).length());
        let line = from_p(&q) / length;
        let off_line = |x: &SupportPoint| from_p(x).reject_from_normalized(line);
        let (r, _) = furthest(points, |x| off_line(x).length());
        let aside = off_line(&r).normalize_or_zero();
        let normal = line.cross(aside);
        let (s, _) = furthest(points, |x| normal.dot(off_line(x)).abs());
        // The points may be fewer than show how thick the difference is.
        let width = |n: DVec3| n.dot(difference.support_against(-n).w - difference.support_against(n).w);
        if width(aside).max(width(normal)) > NEEDLE * length {
            return None;
        }
        // A quarter: coordinates are to be below 2.
        let map = DMat3::from_cols(from_p(&q), off_line(&r), off_line(&s)).inverse() * 0.25;
        let error = map.abs() * DVec3::splat(SUPPORT_ERROR);
        (map.is_finite() && error.is_finite()).then_some((Stretch { map, error }, [p, q, r, s]))
    }

    /// The stretched difference.
    pub fn apply<'a, A: Support + ?Sized, B: Support + ?Sized>(
        &self,
        difference: &Difference<'a, A, B>,
    ) -> Difference<'a, A, B> {
        difference.mapped(&self.map)
    }

    /// Gives the normal of a plane its length.
    pub fn measure(&self, plane: Plane) -> Plane {
        let inverse = 1.0 / self.normal(plane.normal).length();
        let normal = plane.normal * inverse;
        let slack = plane.slack * inverse + normal.abs().dot(self.error);
        // Points are rounded by more there than a plane knows: signs are left to the exact arithmetic.
        Plane { normal, offset: plane.offset * inverse, slack, blur: f64::INFINITY }
    }

    /// The normal here of a plane there.
    pub fn normal(&self, normal: DVec3) -> DVec3 {
        self.map.transpose() * normal
    }

    /// Where a point is there.
    pub fn point(&self, point: DVec3) -> DVec3 {
        self.map * point
    }
}
