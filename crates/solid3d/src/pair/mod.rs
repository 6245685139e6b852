//! The algorithm table: what is computed for two placed shapes, for every pair of kinds (thesis, section 6.3.4).
//!
//! As in the thesis the table has two classes: convex shapes, which are known by their support mapping, and complex
//! shapes, which are soups of convex primitives under a tree. [`table`] picks the algorithm; each file named after a pair
//! holds the algorithms for it. The entry (convex, complex) is made from (complex, convex) by swapping. A solid mesh is a
//! complex shape whose surface is tested first, then what it contains ([`containment`]).
//!
//! Placements were checked by the caller.

mod approach;
mod cast;
mod closed_form;
mod coherent;
mod complex_complex;
mod complex_convex;
mod contact;
mod containment;
mod convex_convex;
mod crossing;
mod crossing_point;
mod curve;
mod deepest;
mod depth;
mod direct;
mod far;
mod fixed_box;
mod frame;
mod gaps;
mod glance;
mod leaf_pair;
mod ray;
mod reach;
mod row;
mod scratch;
mod surface;
pub(crate) mod swept;
mod table;

use std::ops::ControlFlow;
use std::sync::LazyLock;

use fearless_simd::Simd;
use glam::{DAffine3, DVec3};

pub(crate) use approach::{Approach, approach, overlap, proximity};
pub(crate) use cast::cast;
pub use closed_form::ClosestPoint;
pub(crate) use closed_form::{
    by_cast, by_quickly_closest, closest_to, contains, nearest_on_surface, quickly_closest,
    quickly_penetration,
};
pub(crate) use coherent::{closest_again, intersects_again, penetration_again};
pub use contact::{ContactOptions, ContactPoint, Feature, Manifold};
pub(crate) use contact::{contacts_closely, quick_contact};
pub(crate) use curve::intersection_curve;
pub use curve::{IntersectionCurve, Polyline, PrimitivePair, Segment};
pub(crate) use fixed_box::fixed_bounds;
pub use ray::{Faces, FromInside, Ray, RayHit, RayOptions, SurfaceHit};
pub(crate) use ray::{Hits, Wanted, first_hit, ray_hits};
pub(crate) use reach::{world_bounds, world_bounds_into};
pub(crate) use scratch::Scratch;
use solid_convex::gjk::Glance;
use solid_convex::{Closest, Impact, Polytope, Witness, gjk};
pub use surface::SignedDistance;
pub(crate) use surface::surface_point;
pub use swept::Path;
pub(crate) use table::{
    axis, closest, closest_within, convex_closest_within, convex_intersects, decide, intersection,
    intersects, intersects_by_class, penetration,
};

use crate::placement::inverse_linear;
use crate::shape::{Class, Shape};
use crate::triangle_triangle;

/// A point at the origin, as a shape.
static POINT: LazyLock<Polytope> =
    LazyLock::new(|| Polytope::new(vec![DVec3::ZERO]).expect("it has a point"));

/// A shape at a place.
#[derive(Clone, Copy)]
pub(crate) struct Placed<'a> {
    pub shape: &'a Shape,
    pub placement: &'a DAffine3,
}

/// Whether two shapes intersect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Relation {
    /// They do not; convex shapes come with an axis that separates them, from `B` to `A`.
    Separated { axis: Option<DVec3> },
    /// They do: a common point, as a point of each shape.
    Common(Witness),
}

/// Whether two shapes intersect, where that takes no search: as [`gjk::glance`], of other simple shapes too. Placements need not have been
/// checked.
#[inline(always)]
pub(crate) fn glance<S: Simd>(simd: S, a: Placed, b: Placed) -> Glance {
    match (a.shape.polytope(), b.shape.polytope()) {
        (Some(on_a), Some(on_b)) => gjk::glance_by(simd, (on_a, a.placement), (on_b, b.placement)),
        _ => closed_form::glance(simd, a, b),
    }
}

/// What [`intersects`] says of shapes of which a [`glance`](glance()) told nothing but that their placements are good.
#[inline(never)]
pub(crate) fn intersects_closely(a: Placed, b: Placed) -> bool {
    if let (Some(on_a), Some(on_b)) = (a.shape.polytope(), b.shape.polytope()) {
        return gjk::intersects_closely(on_a, a.placement, on_b, b.placement);
    }
    closed_form::closely_intersects(a, b).unwrap_or_else(|| intersects(a, b, &mut Scratch::default()))
}

/// Calls `found` with every pair of primitives that meet, in no particular order, until it breaks off. A convex shape is
/// its only primitive; what lies wholly inside a solid meets nothing.
pub(crate) fn meeting_primitives(
    a: Placed,
    b: Placed,
    scratch: &mut Scratch,
    found: &mut dyn FnMut(u32, u32) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let (at_a, at_b) = (a.placement, b.placement);
    match (a.shape.class(), b.shape.class()) {
        (Class::Convex(_), Class::Convex(_)) => match intersection(a, b, scratch) {
            Relation::Common(_) => found(0, 0),
            Relation::Separated { .. } => ControlFlow::Continue(()),
        },
        (Class::Complex(a), Class::Convex(b)) => {
            let mut found = |i, _| found(i, 0);
            complex_convex::meeting_primitives((a, at_a), (b, at_b), scratch, &mut found)
        }
        (Class::Convex(a), Class::Complex(b)) => {
            let mut found = |j, _| found(0, j);
            complex_convex::meeting_primitives((b, at_b), (a, at_a), scratch, &mut found)
        }
        (Class::Complex(a), Class::Complex(b)) => {
            complex_complex::meeting_pairs((a, at_a), (b, at_b), scratch, found)
        }
    }
}

/// Whether the axis of an earlier frame clearly separates two convex shapes; the answer of [`intersection`] is then
/// the same. See [`gjk::separates`].
pub(crate) fn still_separated(axis: &DVec3, a: Placed, b: Placed) -> bool {
    if let (Some(on_a), Some(on_b)) = (a.shape.polytope(), b.shape.polytope()) {
        return gjk::separates(axis, on_a, a.placement, on_b, b.placement);
    }
    match (a.shape.class(), b.shape.class()) {
        (Class::Convex(on_a), Class::Convex(on_b)) => {
            gjk::separates(axis, on_a, a.placement, on_b, b.placement)
        }
        _ => false,
    }
}

/// The world point between a point of each shape, which are the same up to rounding.
#[inline(always)] // into a kernel
pub(crate) fn midpoint(a: Placed, b: Placed, witness: &Witness) -> DVec3 {
    let on_a = a.placement.transform_point3(witness.on_a);
    let on_b = b.placement.transform_point3(witness.on_b);
    0.5 * on_a + 0.5 * on_b
}

/// A world point as the placement of a shape has it in local space.
pub(crate) fn to_local(placed: Placed, point: DVec3) -> DVec3 {
    let DAffine3 { matrix3, translation } = placed.placement;
    inverse_linear(matrix3) * (point - *translation)
}

/// A result that can be read from the other side.
pub(crate) trait Mirror {
    /// The result for (B, A), from that for (A, B).
    fn mirrored(self) -> Self;
}

impl Mirror for Witness {
    fn mirrored(self) -> Self {
        Witness { on_a: self.on_b, on_b: self.on_a }
    }
}

impl Mirror for Relation {
    fn mirrored(self) -> Self {
        match self {
            Relation::Separated { axis } => Relation::Separated { axis: axis.mirrored() },
            Relation::Common(witness) => Relation::Common(witness.mirrored()),
        }
    }
}

impl Mirror for Closest {
    fn mirrored(self) -> Self {
        Closest { distance: self.distance, points: self.points.mirrored() }
    }
}

impl Mirror for Impact {
    fn mirrored(self) -> Self {
        Impact { normal: self.normal.mirrored(), points: self.points.mirrored(), ..self }
    }
}

/// Whether they intersect.
impl Mirror for bool {
    fn mirrored(self) -> Self {
        self
    }
}

/// An axis.
impl Mirror for DVec3 {
    fn mirrored(self) -> Self {
        -self
    }
}

impl<T: Mirror> Mirror for Option<T> {
    fn mirrored(self) -> Self {
        self.map(Mirror::mirrored)
    }
}
