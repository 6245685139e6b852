//! Intersection: Algorithm 4.2 of the thesis, and its incremental form ISA-GJK.

use glam::{DAffine3, DVec3};

use super::descent::{End, Goal, descend};
use crate::Support;
use crate::difference::Difference;
use crate::simplex::Simplex;

/// Whether two placed convex objects intersect, with the evidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// They have no point in common.
    Separated {
        /// A separating axis, a unit vector pointing from `B` to `A`: every point of `A` is further along it than every
        /// point of `B`. Space: world.
        axis: DVec3,
    },
    /// Their distance or overlap is too small to tell, see [`TOUCHING_ERROR`](super::TOUCHING_ERROR). Since objects are
    /// closed, touching counts as intersecting.
    Touching(Witness),
    /// They have a point in common.
    Intersecting(Witness),
}

/// A point of each of two objects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Witness {
    /// A point of `A`. Space: local to `A`.
    pub on_a: DVec3,
    /// A point of `B`. Space: local to `B`.
    pub on_b: DVec3,
}

impl Witness {
    /// The points that the closest point of a simplex comes from.
    pub(crate) fn of(simplex: &Simplex) -> Witness {
        let (on_a, on_b) = simplex.witness();
        Witness { on_a, on_b }
    }
}

impl Outcome {
    /// The common point, as a point of either object; `None` when they are separate.
    pub fn witness(&self) -> Option<&Witness> {
        match self {
            Outcome::Separated { .. } => None,
            Outcome::Touching(witness) | Outcome::Intersecting(witness) => Some(witness),
        }
    }
}

/// Whether two placed convex objects intersect. Algorithm 4.2 of the thesis.
///
/// The placements must be finite, with entries of at most [`MAGNITUDE_MAX`](crate::MAGNITUDE_MAX). Cost: some two to
/// five support points of each object. Swapping `A` and `B`, or scaling both by a power of two, changes no outcome.
///
/// ```
/// use solid_convex::{Cone, Outcome, Sphere, gjk};
/// use glam::{DAffine3, DVec3};
/// let (cone, ball) = (Cone::new(1.0, 2.0)?, Sphere::new(1.0)?);
/// // The ball rests on the tip of the cone.
/// let tip = DAffine3::from_translation(DVec3::new(0.0, 2.0, 0.0));
/// assert!(matches!(gjk::intersection(&cone, &DAffine3::IDENTITY, &ball, &tip), Outcome::Touching(_)));
/// # Ok::<(), solid_convex::SizeError>(())
/// ```
pub fn intersection<A, B>(a: &A, placement_a: &DAffine3, b: &B, placement_b: &DAffine3) -> Outcome
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let difference = Difference::new(a, placement_a, b, placement_b);
    let descent = descend(&difference, Goal::Separation);
    match descent.end {
        End::Separated => Outcome::Separated { axis: descent.v.normalize() },
        End::Undecided => Outcome::Touching(Witness::of(&descent.simplex)),
        End::Inside => Outcome::Intersecting(Witness::of(&descent.simplex)),
    }
}

/// A cached axis answers alone only when the gap along it is more than this, relative to the size of the data. Nearer,
/// the search from scratch decides, so that what is cached never changes an answer; at such a gap it has never failed.
const CACHED_GAP_MIN: f64 = 1.0 / (1u64 << 26) as f64;

/// Whether an axis, pointing from `B` to `A`, clearly separates two placed convex objects: the first step of ISA-GJK
/// (thesis, section 4.4.3), with the axis of an earlier frame. Cost: one support point of each object.
///
/// `true` is certain, and [`intersection`] then says [`Separated`](Outcome::Separated); `false` says nothing. The zero
/// axis separates nothing.
pub fn separates<A, B>(axis: DVec3, a: &A, placement_a: &DAffine3, b: &B, placement_b: &DAffine3) -> bool
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let p = Difference::new(a, placement_a, b, placement_b).support_against(axis);
    axis.dot(p.w) > CACHED_GAP_MIN * axis.abs().element_sum()
}
