//! Shapes with the two ends of their way.

use glam::{DAffine3, DVec3};
use solid_convex::IndexedPoints;

use crate::bounds::Aabb;
use crate::pair::Placed;
use crate::pair::reach::bounds_margin;
use crate::pair::table::{PlacedComplex, PlacedConvex};
use crate::shape::{Class, Shape};

/// A shape on its way from one frame to the next.
#[derive(Clone, Copy)]
pub(crate) struct Moving<'a> {
    /// Where it was. Of the same shape, or of one that is a deformation of it.
    pub from: Placed<'a>,
    /// Where it is.
    pub to: Placed<'a>,
    /// See [`deformation`].
    pub deformation: Aabb,
}

/// A convex shape as it was and as it is.
pub(super) type MovingConvex<'a> = [PlacedConvex<'a>; 2];

/// A complex shape as it was and as it is.
#[derive(Clone, Copy)]
pub(super) struct MovingComplex<'a> {
    pub from: PlacedComplex<'a>,
    pub to: PlacedComplex<'a>,
    /// See [`deformation`].
    pub deformation: Aabb,
}

/// The two classes of the algorithm table.
pub(super) enum MovingClass<'a> {
    Convex(MovingConvex<'a>),
    Complex(MovingComplex<'a>),
}

impl<'a> Moving<'a> {
    pub(super) fn class(&self) -> MovingClass<'a> {
        let Moving { from, to, deformation } = *self;
        match (from.shape.class(), to.shape.class()) {
            (Class::Convex(was), Class::Convex(is)) => {
                MovingClass::Convex([(was, from.placement), (is, to.placement)])
            }
            (Class::Complex(was), Class::Complex(is)) => {
                let (from, to) = ((was, from.placement), (is, to.placement));
                MovingClass::Complex(MovingComplex { from, to, deformation })
            }
            _ => unreachable!("the shape at both ends is the same or a deformation of it"),
        }
    }
}

impl<'a> MovingComplex<'a> {
    /// A primitive as it was and as it is; see [`ends`](Self::ends).
    pub fn primitive_hulls(&self, primitive: u32) -> [IndexedPoints<'a>; 2] {
        [self.from.0.primitive_hull(primitive), self.to.0.primitive_hull(primitive)]
    }

    /// A primitive as a moving convex object.
    pub fn ends<'b>(&'b self, [was, is]: &'b [IndexedPoints<'a>; 2]) -> MovingConvex<'b> {
        [(was, self.from.1), (is, self.to.1)]
    }

    /// How far it reaches from its local origin at either end.
    pub fn reach(&self) -> DVec3 {
        self.from.0.reach().max(self.to.0.reach())
    }

    /// How far it reaches from its local origin, as it was and as it is.
    pub fn reaches(&self) -> [(DVec3, &'a DAffine3); 2] {
        [(self.from.0.reach(), self.from.1), (self.to.0.reach(), self.to.1)]
    }
}

/// A box around how far each vertex of a primitive is in `to` from where it is in `from`, a deformation of the same shape.
/// Space: local. Cost: linear in the shape; none when the two are one shape.
pub(crate) fn deformation(from: &Shape, to: &Shape) -> Aabb {
    let still = Aabb::new(DVec3::ZERO, DVec3::ZERO);
    match (from.class(), to.class()) {
        (Class::Complex(was), Class::Complex(is)) if from.is_deformation_of(to) => {
            let way = |&i: &u32| is.vertices()[i as usize] - was.vertices()[i as usize];
            Aabb::of_points(is.indices().iter().map(way))
        }
        _ => still,
    }
}

/// A box of the world around a shape on its whole way; `bounds` gives that around each end.
///
/// Grown with the length of the way and the larger of the two extents, as [`world_bounds`](crate::pair::world_bounds) with the extent: the
/// error of the narrow phase does so, too, wherever on the way the shapes are.
pub(crate) fn moving_bounds(moving: &Moving, bounds: impl Fn(Placed) -> Aabb) -> Aabb {
    let ends = [moving.from, moving.to];
    let [from, to] = ends.map(|end| end.placement.translation);
    let [was, is] = ends.map(bounds);
    let extent = |bounds: &Aabb, origin: DVec3| (bounds.max - origin).max(origin - bounds.min).max_element();
    let size = (to - from).abs().max_element() + extent(&was, from).max(extent(&is, to));
    was.union(&is).inflated(bounds_margin(size))
}
