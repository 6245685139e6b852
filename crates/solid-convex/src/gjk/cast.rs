//! When a convex object that moves along a straight line first meets another: the GJK ray cast.
//!
//! Van den Bergen, *Ray Casting against General Convex Objects with Application to Continuous Collision Detection*, 2004:
//! the motion is a ray against the Minkowski difference, clipped by one supporting plane after the other. Each plane comes
//! from a separating axis, so the time never passes the first contact. The deviation: where the paper clips within the
//! descent, at each support point, here a descent finds an axis nearly normal to the surface first. The distance along a ray
//! is a convex function of the time, and clipping by its supporting planes is Newton's method on it, from below: quadratic
//! on round objects, exact after a few steps on polytopes; and all measures against rounding are those of the descent.

use glam::{DAffine3, DVec3};

use super::Witness;
use super::descent::{End, Goal, descend};
use crate::Support;
use crate::difference::{Difference, SUPPORT_ERROR};

/// When and where a moving object meets another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// The time, 0 at the start, 1 after the whole motion.
    pub time: f64,
    /// The common normal of the surfaces there, a unit vector pointing from `B` to `A`; `None` when they meet at the
    /// start. Space: world.
    pub normal: Option<DVec3>,
    /// The points that meet.
    pub points: Witness,
}

/// How far apart, relative to the size of the data, objects may be that a cast reports as meeting. The size is the sum of the
/// objects' extents and of the distance of their origins where they meet.
///
/// More than [`TOUCHING_ERROR`](super::TOUCHING_ERROR), since on round objects the coarse axis of a step may fail to separate
/// sooner than the best one; the largest seen in tests is a hundredth of this.
pub const CAST_ERROR: f64 = 1e-10;

/// The relative error of the distance at each step: the axis need only be nearly normal to the surface, and a step leaves
/// about this part of the way. Between 0.1 and 1e-4 the cost hardly changes.
const STEP_TOLERANCE: f64 = 1e-2;

/// A gap within which objects meet, relative to what a support point may be off.
const CONTACT_GAP: f64 = 4.0;

/// How far a place on the way may be off, relative to the length of the way so far: by its rounding, and by that of the time.
const WAY_ERROR: f64 = f64::EPSILON;

/// Steps after which a cast ends where it is, which is before the impact: a grazing motion halves the gap with each,
/// so that 50 steps use up the digits of a gap.
const STEPS_MAX: usize = 128;

/// The normal is that of the last step at which the gap, relative to the size of the data, was at least this; nearer, rounding
/// shows in it.
const NORMAL_GAP: f64 = 1e-7;

/// When `A`, moving along a straight line by `motion` (per unit of time, relative to `B`, in the world), first meets `B`;
/// `None` when it does not up to the time `until`, which may be endless.
///
/// Conservative: the time is never later than the first contact, and no contact is missed. At the time given the gap is
/// below [`CAST_ERROR`] of the size of the data, or 1e-14 of how far apart they start; on a grazing motion that may be some 1e-5 of the
/// size before the contact. The placements and the motion must be finite, with entries of at most
/// [`MAGNITUDE_MAX`](crate::MAGNITUDE_MAX). Cost: some three to ten times [`intersection`](super::intersection()).
///
/// ```
/// use solid_convex::{Sphere, gjk};
/// use glam::{DAffine3, DVec3};
/// let ball = Sphere::new(1.0)?;
/// let right = DAffine3::from_translation(DVec3::X * 6.0);
/// let here = DAffine3::IDENTITY;
/// let impact = gjk::cast(&ball, &here, DVec3::X * 8.0, &ball, &right, 1.0).unwrap();
/// assert!((impact.time - 0.5).abs() < 1e-12);
/// assert!((impact.normal.unwrap() + DVec3::X).length() < 1e-6);
/// assert!(gjk::cast(&ball, &here, DVec3::X * 3.9, &ball, &right, 1.0).is_none());
/// # Ok::<(), solid_convex::SizeError>(())
/// ```
pub fn cast<A, B>(
    a: &A,
    placement_a: &DAffine3,
    motion: DVec3,
    b: &B,
    placement_b: &DAffine3,
    until: f64,
) -> Option<Impact>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    // As seen from where A starts: far from the origin of the world every step would be rounded anew, past what is flat.
    let way = placement_b.translation - placement_a.translation;
    let at_b = DAffine3 { translation: way, ..*placement_b };
    // lambda: the time, never past the impact; r: the motion; v: a separating axis; w: a support point of A - B against it.
    let (mut lambda, mut normal, mut points) = (0.0, None, None);
    for _ in 0..STEPS_MAX {
        let at_a = DAffine3 { translation: motion * lambda, ..*placement_a };
        let difference = Difference::new(a, &at_a, b, &at_b);
        // Beyond the way, A goes no further than the size of the data, of which the rounding is within that of support points.
        let error = SUPPORT_ERROR + WAY_ERROR * difference.scale() * way.abs().max_element();
        let (clip, witness) = clip(&difference, error);
        points = Some(witness);
        let Some((v, gap)) = clip else { break };
        let r = motion * difference.scale();
        let approach = -v.dot(r);
        if approach <= 0.0 {
            return None;
        }
        if normal.is_none() || gap > NORMAL_GAP {
            normal = Some(v);
        }
        let next = lambda + gap / approach;
        // Also where the motion is so nearly along the surface that no number tells when.
        if next > until || !(motion * next).is_finite() {
            return None;
        }
        if next == lambda {
            break;
        }
        lambda = next;
    }
    points.map(|points| Impact { time: lambda, normal, points })
}

/// A unit axis that separates the objects by more than [`CONTACT_GAP`], and the gap along it, less what may be rounding; `None` when
/// they meet. With points of either: the closest ones, nearly. Of a support point each coordinate may be off by `error`.
fn clip<A, B>(difference: &Difference<A, B>, error: f64) -> (Option<(DVec3, f64)>, Witness)
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let nearest = descend(difference, Goal::Distance { tolerance: STEP_TOLERANCE });
    let (on_a, on_b) = nearest.simplex.witness();
    let v = nearest.axis.normalize_or_zero();
    let gap = v.dot(difference.support_against(v).w) - error * v.abs().element_sum();
    let clip = (nearest.end != End::Inside && gap > CONTACT_GAP * error).then_some((v, gap));
    (clip, Witness { on_a, on_b })
}
