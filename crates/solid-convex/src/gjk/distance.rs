//! Distance and closest points: Algorithm 4.1 of the thesis.

use glam::{DAffine3, DVec3};

use super::descent::{Descent, End, Goal, descend_after, descend_robustly};
use super::lean::{Lean, Search, Sure};
use super::pairs::Pair;
use super::task::{self, Task};
use super::{BEYOND_TOUCHING, TOUCHING_ERROR, Witness, intersects};
use crate::difference::{Difference, MinkowskiDifference, SUPPORT_ERROR, SupportPoint};
use crate::rounded::Core;
use crate::{Polytope, Support};

/// The closest points of two placed convex objects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Their distance; 0 when the objects intersect or touch. World units.
    pub distance: f64,
    /// The closest points; a common point when the distance is 0. Each is in its object, and they are as far apart as the distance, to
    /// within [`TOUCHING_ERROR`] of the size of the data.
    pub points: Witness,
}

/// The relative error of a distance, as far as the rounding error of positions allows: polytopes reach it in their last
/// iteration anyway, and next to what is curved Newton's method does in one step more than for half of the digits.
pub(crate) const DISTANCE_TOLERANCE: f64 = 1e-12;

/// The closest points of two placed convex objects, and their distance. Algorithm 4.1 of the thesis.
///
/// The error of the distance is at most 1e-12 of the distance plus [`TOUCHING_ERROR`] of the size
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
    let closest = closest_points_within(a, placement_a, b, placement_b, f64::INFINITY);
    closest.expect("every distance is finite")
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
    closest_points_or_axis(a, placement_a, b, placement_b, bound).ok()
}

/// The same; of objects that are further apart than `bound`, an axis along which they are, up to the rounding error. It points from `b` to `a` in
/// the world, and is of any length.
///
/// ```
/// use solid_convex::{Cuboid, gjk};
/// use glam::{DAffine3, DVec3};
/// let block = Cuboid::new(DVec3::ONE)?;
/// let right = DAffine3::from_translation(DVec3::new(3.0, 0.0, 0.0));
/// let found = gjk::closest_points_or_axis(&block, &DAffine3::IDENTITY, &block, &right, 1.5);
/// assert_eq!(found.map_err(DVec3::normalize), Err(-DVec3::X));
/// # Ok::<(), solid_convex::SizeError>(())
/// ```
pub fn closest_points_or_axis<A, B>(
    a: &A,
    placement_a: &DAffine3,
    b: &B,
    placement_b: &DAffine3,
    bound: f64,
) -> Result<Closest, DVec3>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let (closest, v) = if a.core_radius() + b.core_radius() == 0.0 {
        nearest(a, placement_a, b, placement_b, bound)?
    } else {
        let (core_a, core_b) = (Core::of(a, placement_a), Core::of(b, placement_b));
        of_rounded((&core_a, placement_a), (&core_b, placement_b), bound)?
    };
    // One that is no number, of support points that are none, is beyond nothing.
    if closest.distance > bound { Err(v) } else { Ok(closest) }
}

/// The closest points are sought, up to a bound in world units; from what is known of them.
#[derive(Clone, Copy)]
pub(super) struct Measure<'w> {
    pub bound: f64,
    /// As for [`Search`].
    pub warm: &'w [Pair],
}

impl Measure<'_> {
    fn goal(&self, scale: f64) -> Goal {
        Goal::DistanceWithin { tolerance: DISTANCE_TOLERANCE, bound: self.bound * scale }
    }

    /// Runs it in place: what the search ends with is too large to be moved about.
    #[inline(always)]
    pub fn run_in(&self, lean: &mut Lean, difference: &impl MinkowskiDifference) -> Answer {
        let goal = self.goal(difference.scale());
        Search { goal, warm: self.warm }.descend(lean, difference);
        Answer::of(lean, goal, difference.scale())
    }
}

/// What a lean search for the closest points is sure of.
pub(super) enum Answer {
    /// They are further apart than the bound, along an axis.
    Beyond(DVec3),
    /// The closest points, with the vector from that of `B` to that of `A`, in the difference's unit; zero when they meet.
    Closest(Closest, DVec3),
    /// Nothing.
    Unknown,
}

impl Answer {
    #[inline(always)]
    fn of(lean: &Lean, goal: Goal, scale: f64) -> Answer {
        match lean.sure {
            Sure::Beyond => Answer::Beyond(lean.v),
            Sure::Inside => {
                Answer::Closest(Closest { distance: 0.0, points: lean.common_point() }, DVec3::ZERO)
            }
            Sure::Near(mu) => match lean.closest_point() {
                Some((v, points)) if goal.is_within_tolerance(v.length(), mu) => {
                    Answer::Closest(Closest { distance: v.length() / scale, points }, v)
                }
                _ => Answer::Unknown,
            },
            Sure::Separated(_) | Sure::Nothing => Answer::Unknown,
        }
    }
}

/// With the points that the search ended with.
impl Task for Measure<'_> {
    type Found = (Answer, Lean);

    #[inline(always)]
    fn run(self, difference: &impl MinkowskiDifference) -> (Answer, Lean) {
        let mut lean = Lean::default();
        (self.run_in(&mut lean, difference), lean)
    }
}

/// From nothing, and without the points, which would be carried about for nothing.
struct MeasureAnew {
    bound: f64,
}

impl Task for MeasureAnew {
    type Found = Answer;

    #[inline(always)]
    fn run(self, difference: &impl MinkowskiDifference) -> Answer {
        Measure { bound: self.bound, warm: &[] }.run_in(&mut Lean::default(), difference)
    }
}

/// The closest points of two placed polytopes, each in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestInWorld {
    /// Their distance; 0 when the polytopes intersect or touch. World units.
    pub distance: f64,
    /// That of the first. Space: world.
    pub point_on_a: DVec3,
    /// That of the second. Space: world.
    pub point_on_b: DVec3,
}

/// What [`closest_points`] says of two polytopes, to the bit, where a search without care is enough. Nothing is asked of the placements: of an
/// answer they are finite, far from singular and of plain size. `None` says nothing.
///
/// ```
/// use solid_convex::{Polytope, gjk};
/// use glam::{DAffine3, DVec3};
/// let corners = (0..8).map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)));
/// let block = Polytope::new(corners.collect()).unwrap();
/// let right = DAffine3::from_translation(DVec3::new(3.0, 0.5, 0.5));
/// let found = gjk::quickly_closest(&block, &DAffine3::IDENTITY, &block, &right).unwrap();
/// assert_eq!((found.distance, found.point_on_a.x, found.point_on_b.x), (2.0, 1.0, 3.0));
/// let wild = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
/// assert_eq!(gjk::quickly_closest(&block, &wild, &block, &right), None);
/// ```
pub fn quickly_closest(
    a: &Polytope,
    placement_a: &DAffine3,
    b: &Polytope,
    placement_b: &DAffine3,
) -> Option<ClosestInWorld> {
    task::run_in_world(a, placement_a, b, placement_b, MeasureSurely)
}

/// From nothing, and nothing where that is not sure.
struct MeasureSurely;

impl Task for MeasureSurely {
    type Found = Option<Closest>;

    #[inline(always)]
    fn run(self, difference: &impl MinkowskiDifference) -> Option<Closest> {
        match (MeasureAnew { bound: f64::INFINITY }).run(difference) {
            Answer::Closest(closest, _) => Some(closest),
            Answer::Beyond(_) | Answer::Unknown => None,
        }
    }
}

/// The closest points of two placed objects, and the vector from that of `B` to that of `A`, in the difference's unit; when they are further
/// apart than the bound, an axis along which they are.
fn nearest<A, B>(
    a: &A,
    placement_a: &DAffine3,
    b: &B,
    placement_b: &DAffine3,
    bound: f64,
) -> Result<(Closest, DVec3), DVec3>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    if a.as_polytope().is_none() || b.as_polytope().is_none() {
        let (difference, mut lean) = (Difference::new(a, placement_a, b, placement_b), Lean::default());
        let task = Measure { bound, warm: &[] };
        return match task.run_in(&mut lean, &difference) {
            Answer::Beyond(axis) => Err(axis),
            Answer::Closest(closest, v) => Ok((closest, v)),
            Answer::Unknown => {
                measure_robustly(&difference, task, &lean).map(|found| (found.closest, found.v))
            }
        };
    }
    match task::run(a, placement_a, b, placement_b, MeasureAnew { bound }) {
        Answer::Beyond(axis) => Err(axis),
        Answer::Closest(closest, v) => Ok((closest, v)),
        Answer::Unknown => {
            let difference = Difference::new(a, placement_a, b, placement_b);
            let task = Measure { bound, warm: &[] };
            measure_robustly(&difference, task, &Lean::default()).map(|found| (found.closest, found.v))
        }
    }
}

/// What measuring gave: with the points of the difference between which the closest one is, up to three, or four that have the origin
/// between them.
pub(super) struct Measured {
    pub closest: Closest,
    /// From the closest point of `B` to that of `A`, in the difference's unit; zero when they meet.
    pub v: DVec3,
    pub points: [SupportPoint; 4],
    pub len: usize,
}

/// The closest points of two placed objects; when they are further apart than the bound, an axis along which they are.
#[inline]
pub(super) fn measure<A, B>(
    a: &A,
    placement_a: &DAffine3,
    b: &B,
    placement_b: &DAffine3,
    task: Measure,
) -> Result<Measured, DVec3>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    match task::run(a, placement_a, b, placement_b, task) {
        (Answer::Beyond(axis), _) => Err(axis),
        (Answer::Closest(closest, v), lean) => {
            Ok(Measured { closest, v, points: lean.points, len: lean.points().len() })
        }
        (Answer::Unknown, lean) => {
            measure_robustly(&Difference::new(a, placement_a, b, placement_b), task, &lean)
        }
    }
}

#[cold]
fn measure_robustly<A, B>(
    difference: &Difference<A, B>,
    task: Measure,
    lean: &Lean,
) -> Result<Measured, DVec3>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let goal = task.goal(difference.scale());
    let mut descent = descend_after(difference, goal, lean);
    if !difference.is_polytope() && descent.v.length_squared() <= BEYOND_TOUCHING * BEYOND_TOUCHING {
        // What touches is to do so for all questions: they begin from nothing.
        descent = descend_robustly(difference, goal);
    }
    if descent.beyond {
        return Err(descent.axis);
    }
    let (mut points, mut len) = ([SupportPoint::ZERO; 4], 0);
    for (place, p) in points.iter_mut().zip(descent.simplex.points()) {
        *place = *p;
        len += 1;
    }
    let (closest, v) = Closest::of(&descent, difference);
    Ok(Measured { closest, v, points, len })
}

impl Closest {
    /// What a descent for the distance found, with the vector from the point of `B` to that of `A`, in the difference's unit.
    pub(super) fn of<A, B>(descent: &Descent, difference: &Difference<A, B>) -> (Closest, DVec3)
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let points = Witness::of(&descent.simplex);
        match descent.end {
            End::Separated => {
                let (v, points) = apart_by(descent.v, points, difference);
                (Closest { distance: v.length() / difference.scale(), points }, v)
            }
            End::Undecided | End::Inside => (Closest { distance: 0.0, points }, descent.v),
        }
    }
}

/// Points of two objects that are apart by `v`, the closest, and the way between them: those of the simplex, unless it only is on the plane of
/// the closest point and does not reach it, as a sliver on what is round may be. Then they are these or common points once `B` is moved by
/// `v`, whichever are nearer to each other; and where they are as near as `v` says, in another direction, the way is theirs.
fn apart_by<A, B>(v: DVec3, of_simplex: Witness, difference: &Difference<A, B>) -> (DVec3, Witness)
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let way = |points: &Witness| difference.point(points.on_a, points.on_b).w;
    let way_of_simplex = way(&of_simplex);
    if (way_of_simplex - v).length_squared() <= SUPPORT_ERROR * SUPPORT_ERROR {
        return (v, of_simplex);
    }
    let common = Witness::of(&descend_robustly(&difference.moved(v), Goal::Separation).simplex);
    let way_of_common = way(&common);
    let (way, points) = if way_of_common.length_squared() < way_of_simplex.length_squared() {
        (way_of_common, common)
    } else {
        (way_of_simplex, of_simplex)
    };
    (if way.length() <= v.length() + SUPPORT_ERROR { way } else { v }, points)
}

/// The closest points of objects of which at least one is rounded, with the vector between those of their cores, by which they are found: it takes a
/// few steps, where a curved surface takes four for each digit. Of objects that are further apart than the bound, an axis along which they are.
fn of_rounded<A, B>(
    (core_a, placement_a): (&Core<A>, &DAffine3),
    (core_b, placement_b): (&Core<B>, &DAffine3),
    bound: f64,
) -> Result<(Closest, DVec3), DVec3>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let radii = core_a.radius() + core_b.radius();
    // Of cores that are nearly as far apart as the bound, the distance says.
    let of_cores = (bound + radii) * (1.0 + DISTANCE_TOLERANCE);
    let (closest, v) = nearest(core_a, placement_a, core_b, placement_b, of_cores)?;
    let Closest { distance: between, mut points } = closest;
    if between > 0.0 && radii > 0.0 {
        let axis = v.normalize();
        // All the way to the surfaces, or to where they meet before.
        let part = (between / radii).min(1.0);
        points.on_a -= part * core_a.to_surface(placement_a, axis);
        points.on_b += part * core_b.to_surface(placement_b, axis);
    }
    // What rounding leaves of a gap between surfaces that touch is none.
    let size_max = || 2.0 / Difference::new(core_a, placement_a, core_b, placement_b).scale();
    let touch = |gap: f64| {
        gap <= TOUCHING_ERROR * size_max()
            && intersects(core_a.object(), placement_a, core_b.object(), placement_b)
    };
    let gap = between - radii;
    let distance = if gap <= 0.0 || touch(gap) { 0.0 } else { gap };
    Ok((Closest { distance, points }, v))
}
