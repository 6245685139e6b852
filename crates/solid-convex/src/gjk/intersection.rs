//! Intersection: Algorithm 4.2 of the thesis, and its incremental form ISA-GJK.

use glam::{DAffine3, DVec3};

use super::balls;
use super::descent::{End, Goal, descend_robustly};
use super::lean::{Lean, Search, Sure};
use super::task::{self, Task};
use crate::Support;
use crate::difference::{Difference, MinkowskiDifference};
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
    let lean = task::run(a, placement_a, b, placement_b, SEARCH);
    match lean.sure {
        Sure::Separated(_) => Outcome::Separated { axis: lean.v.normalize() },
        Sure::Inside => Outcome::Intersecting(lean.common_point()),
        Sure::Nothing | Sure::Near(_) | Sure::Beyond => {
            robust_intersection(&Difference::new(a, placement_a, b, placement_b))
        }
    }
}

/// What [`intersection`] says of a pair of which the lean descent is not sure.
#[cold]
fn robust_intersection<A, B>(difference: &Difference<A, B>) -> Outcome
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let descent = descend_robustly(difference, Goal::Separation);
    match descent.end {
        End::Separated => Outcome::Separated { axis: descent.v.normalize() },
        End::Undecided => Outcome::Touching(Witness::of(&descent.simplex)),
        End::Inside => Outcome::Intersecting(Witness::of(&descent.simplex)),
    }
}

/// The search for an axis, from nothing.
const SEARCH: Search = Search { goal: Goal::Separation, warm: &[] };

/// What [`SEARCH`] is sure of, without the evidence.
struct Verdict;

impl Task for Verdict {
    type Found = Sure;

    #[inline(always)]
    fn run(self, difference: &impl MinkowskiDifference) -> Sure {
        let mut lean = Lean::default();
        SEARCH.descend(&mut lean, difference);
        lean.sure
    }
}

/// The same, with the axis.
struct Axis;

impl Task for Axis {
    type Found = (Sure, DVec3);

    #[inline(always)]
    fn run(self, difference: &impl MinkowskiDifference) -> (Sure, DVec3) {
        let mut lean = Lean::default();
        SEARCH.descend(&mut lean, difference);
        (lean.sure, lean.v)
    }
}

/// Whether two placed convex objects have a point in common: exactly when [`intersection`] does not say
/// [`Separated`](Outcome::Separated), for less work.
///
/// ```
/// use solid_convex::{Sphere, gjk};
/// use glam::{DAffine3, DVec3};
/// let ball = Sphere::new(1.0)?;
/// let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
/// assert!(gjk::intersects(&ball, &at(0.0), &ball, &at(2.0)));
/// assert!(!gjk::intersects(&ball, &at(0.0), &ball, &at(2.000001)));
/// # Ok::<(), solid_convex::SizeError>(())
/// ```
pub fn intersects<A, B>(a: &A, placement_a: &DAffine3, b: &B, placement_b: &DAffine3) -> bool
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let decided = balls::decide(a, placement_a, b, placement_b);
    decided.unwrap_or_else(|| intersects_closely(a, placement_a, b, placement_b))
}

/// What [`intersects`] says, by a search at once: for objects of which a [`glance`](super::glance) told nothing.
///
/// ```
/// use solid_convex::{Sphere, gjk};
/// use glam::{DAffine3, DVec3};
/// let ball = Sphere::new(1.0)?;
/// let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
/// assert!(gjk::intersects_closely(&ball, &at(0.0), &ball, &at(2.0)));
/// # Ok::<(), solid_convex::SizeError>(())
/// ```
pub fn intersects_closely<A, B>(a: &A, placement_a: &DAffine3, b: &B, placement_b: &DAffine3) -> bool
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    match task::run(a, placement_a, b, placement_b, Verdict) {
        Sure::Separated(_) => false,
        Sure::Inside => true,
        Sure::Nothing | Sure::Near(_) | Sure::Beyond => {
            robust_intersection(&Difference::new(a, placement_a, b, placement_b)).witness().is_some()
        }
    }
}

/// The axis that [`intersection`] gives, a unit vector from `B` to `A`; `None` where the objects intersect or touch. No common point
/// is computed.
///
/// ```
/// use solid_convex::{Cuboid, gjk};
/// use glam::{DAffine3, DVec3};
/// let block = Cuboid::new(DVec3::ONE)?;
/// let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
/// assert_eq!(gjk::separating_axis(&block, &at(3.0), &block, &at(0.0)), Some(DVec3::X));
/// assert_eq!(gjk::separating_axis(&block, &at(1.0), &block, &at(0.0)), None);
/// # Ok::<(), solid_convex::SizeError>(())
/// ```
pub fn separating_axis<A, B>(a: &A, placement_a: &DAffine3, b: &B, placement_b: &DAffine3) -> Option<DVec3>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    if balls::decide(a, placement_a, b, placement_b) == Some(true) {
        return None;
    }
    match task::run(a, placement_a, b, placement_b, Axis) {
        (Sure::Separated(_), v) => Some(v.normalize()),
        (Sure::Inside, _) => None,
        (Sure::Nothing | Sure::Near(_) | Sure::Beyond, _) => {
            robust_axis(&Difference::new(a, placement_a, b, placement_b))
        }
    }
}

/// Out of the way of those pairs, nearly all, of which a lean descent was sure.
#[cold]
pub(super) fn robust_axis<A, B>(difference: &Difference<A, B>) -> Option<DVec3>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    match robust_intersection(difference) {
        Outcome::Separated { axis } => Some(axis),
        Outcome::Touching(_) | Outcome::Intersecting(_) => None,
    }
}

/// Whether an axis separates by so large a gap that it may answer alone.
struct Separates<'a> {
    /// Where it is kept: of a copy, the kernel would wait for what was just written.
    axis: &'a DVec3,
}

impl Task for Separates<'_> {
    type Found = bool;

    #[inline(always)]
    fn run(self, difference: &impl MinkowskiDifference) -> bool {
        let axis = *self.axis;
        is_clear(axis, axis.dot(difference.support_against(axis).w))
    }
}

/// Whether an axis separates by so large a gap that it may answer alone, by its product with a support point against it.
#[inline(always)]
pub(super) fn is_clear(axis: DVec3, along: f64) -> bool {
    along > CACHED_GAP_MIN * axis.abs().element_sum()
}

/// A cached axis answers alone only when the gap along it is more than this, relative to the size of the data. Nearer,
/// the search from scratch decides, so that what is cached never changes an answer; at such a gap it has never failed.
pub(super) const CACHED_GAP_MIN: f64 = 1.0 / (1u64 << 26) as f64;

/// Whether an axis, pointing from `B` to `A`, clearly separates two placed convex objects: the first step of ISA-GJK
/// (thesis, section 4.4.3), with the axis of an earlier frame. Cost: one support point of each object.
///
/// `true` is certain, and [`intersection`] then says [`Separated`](Outcome::Separated); `false` says nothing. The zero
/// axis separates nothing.
pub fn separates<A, B>(axis: &DVec3, a: &A, placement_a: &DAffine3, b: &B, placement_b: &DAffine3) -> bool
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    task::run(a, placement_a, b, placement_b, Separates { axis })
}
