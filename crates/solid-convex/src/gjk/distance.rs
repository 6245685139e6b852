//! Distance and closest points: Algorithm 4.1 of the thesis.

use glam::DAffine3;

use super::Witness;
use super::descent::{Descent, End, Goal, descend};
use crate::Support;
use crate::difference::Difference;
use crate::rounded::Core;

/// The closest points of two placed convex objects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Their distance; 0 when the objects intersect or touch. World units.
    pub distance: f64,
    /// The closest points; a common point when the distance is 0.
    pub points: Witness,
}

/// The relative error of a distance, as far as the rounding error of positions allows: polytopes reach it in their last
/// iteration anyway, and for quadrics each digit costs some four iterations.
pub(crate) const DISTANCE_TOLERANCE: f64 = 1e-12;

/// The closest points of two placed convex objects, and their distance. Algorithm 4.1 of the thesis.
///
/// The error of the distance is at most 1e-12 of the distance plus [`TOUCHING_ERROR`](super::TOUCHING_ERROR) of the size
/// of the data. The placements must be finite, with entries of at most [`MAGNITUDE_MAX`](crate::MAGNITUDE_MAX).
///
/// ```
/// use solid_convex::{Cuboid, gjk};
/// use glam::{DAffine3, DVec3};
/// let block = Cuboid::new(DVec3::ONE)?;
/// let right = DAffine3::from_translation(DVec3::new(3.0, 0.0, 0.0));
/// let closest = gjk::closest_points(&block, &DAffine3::IDENTITY, &block, &right);
/// assert_eq!(closest.distance, 2.0);
/// assert_eq!(closest.points.on_a.x, 0.5);
/// # Ok::<(), solid_convex::SizeError>(())
/// ```
pub fn closest_points<A, B>(a: &A, placement_a: &DAffine3, b: &B, placement_b: &DAffine3) -> Closest
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let (core_a, core_b) = (Core::of(a, placement_a), Core::of(b, placement_b));
    if core_a.radius() + core_b.radius() > 0.0 {
        return of_rounded((&core_a, placement_a), (&core_b, placement_b));
    }
    let difference = Difference::new(a, placement_a, b, placement_b);
    let descent = descend(&difference, Goal::Distance { tolerance: DISTANCE_TOLERANCE });
    Closest::of(&descent, &difference)
}

/// The closest points of two placed convex objects, if they are at most `bound` apart, in world units; `None` if they are further.
///
/// The same as [`closest_points`], to the bit, of which only distances up to the bound are taken, but for less work: the search ends as
/// soon as a lower bound of the distance exceeds the bound (the mu of Algorithm 4.1 of the thesis), which for objects that
/// are far apart is after the first support point. A bound of infinity is none.
///
/// ```
/// use solid_convex::{Cuboid, gjk};
/// use glam::{DAffine3, DVec3};
/// let block = Cuboid::new(DVec3::ONE)?;
/// let right = DAffine3::from_translation(DVec3::new(3.0, 0.0, 0.0));
/// let within = |bound: f64| gjk::closest_points_within(&block, &DAffine3::IDENTITY, &block, &right, bound);
/// assert_eq!(within(2.0).map(|closest| closest.distance), Some(2.0));
/// assert_eq!(within(1.999), None);
/// # Ok::<(), solid_convex::SizeError>(())
/// ```
pub fn closest_points_within<A, B>(
    a: &A,
    placement_a: &DAffine3,
    b: &B,
    placement_b: &DAffine3,
    bound: f64,
) -> Option<Closest>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let difference = Difference::new(a, placement_a, b, placement_b);
    let goal = Goal::DistanceWithin { tolerance: DISTANCE_TOLERANCE, bound: bound * difference.scale() };
    let descent = descend(&difference, goal);
    if descent.beyond {
        return None;
    }
    let closest = Closest::of(&descent, &difference);
    (closest.distance <= bound).then_some(closest)
}

impl Closest {
    /// What a descent for the distance found.
    pub(super) fn of<A, B>(descent: &Descent, difference: &Difference<A, B>) -> Closest
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let distance = match descent.end {
            End::Separated => descent.v.length() / difference.scale(),
            End::Undecided | End::Inside => 0.0,
        };
        Closest { distance, points: Witness::of(&descent.simplex) }
    }
}

/// The closest points of objects of which at least one is rounded: by those of their cores, which a few steps find exactly, where a
/// curved surface takes four for each digit.
fn of_rounded<A, B>(
    (core_a, placement_a): (&Core<A>, &DAffine3),
    (core_b, placement_b): (&Core<B>, &DAffine3),
) -> Closest
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let difference = Difference::new(core_a, placement_a, core_b, placement_b);
    let descent = descend(&difference, Goal::Distance { tolerance: DISTANCE_TOLERANCE });
    let Closest { distance: between, mut points } = Closest::of(&descent, &difference);
    let radii = core_a.radius() + core_b.radius();
    if between > 0.0 {
        let axis = descent.v.normalize();
        // All the way to the surfaces, or to where they meet before.
        let part = (between / radii).min(1.0);
        points.on_a -= part * core_a.to_surface(placement_a, axis);
        points.on_b += part * core_b.to_surface(placement_b, axis);
    }
    Closest { distance: (between - radii).max(0.0), points }
}
