//! Which boxes of a moving complex shape's tree another moving shape may meet.

use std::ops::ControlFlow;

use glam::{DAffine3, DMat3, DVec3};
use solid_convex::Support;

use super::bodies::{MovingComplex, MovingConvex};
use super::moving_box::MovingBox;
use crate::bounds::Aabb;
use crate::pair::frame::{ROUNDINGS, slack};
use crate::pair::reach::{convex_bounds, image_reach};
use crate::placement::{inverse_linear, row_norm};
use crate::shape::Complex;
use crate::tree::Traversal;

/// All points move straight.
pub(super) const STRAIGHT: f64 = 0.0;

/// The local space of a moving complex shape as it is now, seen by what else moves.
///
/// With `c0`, `c1` the two positions of a point of the shape and `x0`, `x1` those of a point of the other, all in this
/// space, they meet only if the origin is between `x0 - c0` and `x1 - c1`, that is, if `c1` is between `x1` and
/// `x0 - (c0 - c1)`: if a box that moves from the latter to the former meets it. So the tree, which bounds `c1`, serves the
/// whole way.
pub(super) struct TreeSpace<'a> {
    pub shape: &'a Complex,
    to_local: DMat3,
    /// Where this space has its origin. Space: world.
    origin: DVec3,
    /// Contains `c0 - c1` for every point.
    backward: Aabb,
    /// Bounds the error of a box in this space, and that of comparing it.
    pub slack: f64,
}

impl<'a> TreeSpace<'a> {
    /// `size` bounds the size of the data; see [`size`]. `bend` bounds how far points of both are off straight ways, together.
    /// World units.
    pub fn new(moving: &MovingComplex<'a>, size: f64, bend: f64) -> Self {
        let ((was, from), (is, to)) = (moving.from, moving.to);
        let to_local = inverse_linear(&to.matrix3);
        let origin = to.translation;
        // c0 - c1 = (P1^-1 P0 v0 - v0) - (v1 - v0) for the local positions v0 and v1.
        let by_placement = DAffine3 {
            matrix3: to_local * from.matrix3 - DMat3::IDENTITY,
            translation: to_local * (from.translation - origin),
        };
        let backward = less(&was.bounds().transformed(&by_placement), &moving.deformation);
        let local_size = (was.reach() + is.reach()).max_element() * (1.0 + row_norm(&by_placement.matrix3));
        let slack =
            2.0 * (slack(&to.matrix3, &to_local, size) + ROUNDINGS * local_size) + bend * row_norm(&to_local);
        TreeSpace { shape: is, to_local, origin, backward, slack }
    }

    /// The primitives that a box meets.
    pub fn primitives(&self, query: &MovingBox, traversal: &mut Traversal, primitives: &mut Vec<u32>) {
        primitives.clear();
        let meets = |bounds: &Aabb| query.meets(bounds);
        let _ = self.shape.tree().overlapping_where(&query.bounds(), meets, traversal, |leaf| {
            let met = |&&primitive: &&u32| query.meets(&self.shape.primitive_bounds(primitive));
            primitives.extend(leaf.iter().filter(met));
            ControlFlow::<()>::Continue(())
        });
    }

    /// What this box does not meet is not met by a convex shape.
    pub fn query_of_convex(&self, [from, to]: MovingConvex) -> MovingBox {
        let local = |(shape, at): (&dyn Support, &DAffine3)| {
            let map = self.map_from(at);
            let bounds = convex_bounds(shape, &map.matrix3);
            Aabb::new(bounds.min + map.translation, bounds.max + map.translation)
        };
        self.query(local(from), local(to))
    }

    /// The same for a complex shape.
    pub fn query_of_complex(&self, other: &MovingComplex) -> MovingBox {
        let local = |(shape, at): (&Complex, &DAffine3)| shape.bounds().transformed(&self.map_from(at));
        self.query(local(other.from), local(other.to))
    }

    /// Where parts of a complex shape, the one of this space or the other, are in this space at both ends of its way. They meet others of the other
    /// shape only where their boxes, one of them grown by the slack, touch at some time.
    pub fn parts_of<'m>(&self, moving: &'m MovingComplex) -> Parts<'m> {
        let ends = [moving.from, moving.to];
        Parts {
            shapes: ends.map(|(shape, _)| shape),
            maps: ends.map(|(_, at)| self.map_from(at)),
            deformation: moving.deformation,
        }
    }

    fn query(&self, was: Aabb, is: Aabb) -> MovingBox {
        MovingBox { from: less(&was, &self.backward).inflated(self.slack), to: is.inflated(self.slack) }
    }

    fn map_from(&self, at: &DAffine3) -> DAffine3 {
        DAffine3 {
            matrix3: self.to_local * at.matrix3,
            translation: self.to_local * (at.translation - self.origin),
        }
    }
}

/// Parts of a moving complex shape in some space.
pub(super) struct Parts<'a> {
    /// As it was and as it is, and how that is placed.
    shapes: [&'a Complex; 2],
    maps: [DAffine3; 2],
    deformation: Aabb,
}

impl Parts<'_> {
    /// The way of what is in a box, given where that is now in the local space.
    pub fn within(&self, bounds: &Aabb) -> MovingBox {
        let was = less(bounds, &self.deformation);
        MovingBox { from: was.transformed(&self.maps[0]), to: bounds.transformed(&self.maps[1]) }
    }

    /// The way of a primitive.
    pub fn primitive(&self, primitive: u32) -> MovingBox {
        let [from, to] = [0, 1].map(|end| {
            let points = self.shapes[end].points_of(primitive);
            Aabb::of_points(points.map(|point| self.maps[end].transform_point3(point)))
        });
        MovingBox { from, to }
    }
}

/// A bound on every difference of two world points that a test of two moving shapes computes, given how far each reaches
/// from its local origin at each end.
pub(super) fn size(a: [(DVec3, &DAffine3); 2], b: [(DVec3, &DAffine3); 2]) -> f64 {
    let far = |(reach, at): (DVec3, &DAffine3)| {
        let offset = at.translation - a[1].1.translation;
        image_reach(&at.matrix3, reach).max_element() + offset.abs().max_element()
    };
    [a, b].as_flattened().iter().map(|&end| far(end)).sum()
}

/// All differences of a point of one box and one of another.
fn less(x: &Aabb, y: &Aabb) -> Aabb {
    Aabb::new(x.min - y.max, x.max - y.min)
}
