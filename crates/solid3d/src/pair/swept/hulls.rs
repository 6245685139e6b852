//! The convex objects that are tested, as support mappings.

use glam::{DAffine3, DVec3};
use solid_convex::{Outcome, Support, gjk};

use super::bodies::MovingConvex;
use crate::pair::reach::image_reach;

/// `conv((A0 - B0) + (A1 - B1))`, with + for the union: all differences of points of two convex objects at any time of
/// their way, and some more when they turn. Space: along the world's axes; the origin is where points coincide.
pub(super) struct MovingDifference<'a> {
    ends: [End<'a>; 2],
    /// Bounds the size of the data at either end, as GJK has it.
    size: f64,
}

/// The difference at one end of the way.
struct End<'a> {
    a: (&'a dyn Support, &'a DAffine3),
    b: (&'a dyn Support, &'a DAffine3),
    /// The origin of `A` as seen from that of `B`.
    offset: DVec3,
}

impl<'a> MovingDifference<'a> {
    pub fn new([a0, a1]: MovingConvex<'a>, [b0, b1]: MovingConvex<'a>) -> Self {
        let ends = [(a0, b0), (a1, b1)].map(|(a, b)| End { a, b, offset: a.1.translation - b.1.translation });
        let size = ends.each_ref().map(End::size);
        MovingDifference { ends, size: size[0].max(size[1]) }
    }

    /// Whether the origin lies in it; the axis is one from `B` to `A`.
    pub fn contains_origin(&self) -> Outcome {
        gjk::intersection(self, &DAffine3::IDENTITY, &Origin, &DAffine3::IDENTITY)
    }

    /// Whether an axis clearly separates it from the origin, and so each of the two ends.
    pub fn separated_along(&self, axis: &DVec3) -> bool {
        gjk::separates(axis, self, &DAffine3::IDENTITY, &Origin, &DAffine3::IDENTITY)
    }
}

impl End<'_> {
    fn size(&self) -> f64 {
        let extent =
            |(shape, at): (&dyn Support, &DAffine3)| image_reach(&at.matrix3, shape.reach()).max_element();
        extent(self.a) + extent(self.b) + self.offset.abs().max_element()
    }

    fn support(&self, direction: DVec3) -> DVec3 {
        furthest(self.a, direction) - furthest(self.b, -direction) + self.offset
    }

    fn center(&self) -> DVec3 {
        self.a.1.matrix3 * self.a.0.center() - self.b.1.matrix3 * self.b.0.center() + self.offset
    }
}

/// The furthest point of a convex object along a direction of the world, as seen from its local origin (Theorem 4.7).
fn furthest((shape, at): (&dyn Support, &DAffine3), direction: DVec3) -> DVec3 {
    at.matrix3 * shape.support(at.matrix3.transpose() * direction)
}

/// The further of two support points along a direction: the support point of the hull of both objects.
fn further([p, q]: [DVec3; 2], direction: DVec3) -> DVec3 {
    if p.dot(direction) > q.dot(direction) { p } else { q }
}

impl Support for MovingDifference<'_> {
    fn support(&self, direction: DVec3) -> DVec3 {
        further(self.ends.each_ref().map(|end| end.support(direction)), direction)
    }

    fn reach(&self) -> DVec3 {
        DVec3::splat(self.size)
    }

    fn center(&self) -> DVec3 {
        0.5 * self.ends[0].center() + 0.5 * self.ends[1].center()
    }
}

/// The hull of a convex object as it was and as it is. Space: along the world's axes, as seen from `origin`.
pub(super) struct Trace<'a> {
    pub ends: MovingConvex<'a>,
    pub origin: DVec3,
}

impl Trace<'_> {
    fn offset(&self, at: &DAffine3) -> DVec3 {
        at.translation - self.origin
    }
}

impl Support for Trace<'_> {
    fn support(&self, direction: DVec3) -> DVec3 {
        further(self.ends.map(|end| furthest(end, direction) + self.offset(end.1)), direction)
    }

    fn reach(&self) -> DVec3 {
        let [was, is] =
            self.ends.map(|(shape, at)| image_reach(&at.matrix3, shape.reach()) + self.offset(at).abs());
        was.max(is)
    }

    fn center(&self) -> DVec3 {
        let [was, is] = self.ends.map(|(shape, at)| at.matrix3 * shape.center() + self.offset(at));
        0.5 * was + 0.5 * is
    }
}

/// The point at the origin.
struct Origin;

impl Support for Origin {
    fn support(&self, _: DVec3) -> DVec3 {
        DVec3::ZERO
    }

    fn reach(&self) -> DVec3 {
        DVec3::ZERO
    }
}
