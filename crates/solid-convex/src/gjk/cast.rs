//! When a convex object that moves along a straight line first meets another: the GJK ray cast.
//!
//! Van den Bergen, *Ray Casting against General Convex Objects with Application to Continuous Collision Detection*, 2004:
//! the motion is a ray against the Minkowski difference, clipped by one supporting plane after the other. Each plane comes
//! from a separating axis, so the time never passes the first contact. The deviation: where the paper clips within the
//! descent, at each support point, here a descent finds an axis nearly normal to the surface first, from the simplex of the step before.
//! The distance along a ray is a convex function of the time, and clipping by its supporting planes is Newton's method on it, from below:
//! exact after a few steps on polytopes; and all measures against rounding are those of the descent. Of spheres and capsules, unless they
//! are stretched, the cores are cast, which are polytopes.

use glam::{DAffine3, DVec3};

use super::descent::{End, Goal, descend_after};
use super::lean::{Lean, Search, Sure};
use super::pairs::Pair;
use super::task::{self, Task};
use super::{Outcome, TOUCHING_ERROR, Witness, closest_points, intersection, intersects};
use crate::Support;
use crate::difference::{Difference, MinkowskiDifference, SUPPORT_ERROR, SupportPoint};
use crate::rounded::Core;
use crate::simplex::Simplex;

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
/// More than [`TOUCHING_ERROR`], since on round objects the coarse axis of a step may fail to separate
/// sooner than the best one; the largest seen in tests is a hundredth of this.
pub const CAST_ERROR: f64 = 1e-10;

/// The relative error of the gap at each step, which leaves about this part of the way: the axis need only be nearly normal to the surface. What is
/// round takes some 4 support points for each digit either way, and from here those of a step go on from those of the one before: of two cylinders a
/// cast with 0.01 takes twice as long, and one that begins each step from nothing six times.
const STEP_TOLERANCE: f64 = 0.2;

/// A gap within which objects meet, relative to what a support point may be off.
const CONTACT_GAP: f64 = 4.0;

/// A gap within which objects may count as touching, though one axis may still be found: [`intersects`] is asked. In the unit of the difference.
const NEARLY_TOUCHING: f64 = 64.0 * TOUCHING_ERROR;

/// Where the gap is surely no more than this, in the unit of the difference, a lean search that is not sure ends the cast.
const SETTLED: f64 = CAST_ERROR;

/// How far apart the points that meet may be, in the unit of the difference.
const WITNESS_GAP: f64 = 10.0 * CAST_ERROR;

/// How far a place on the way may be off, relative to the length of the way so far: by its rounding, and by that of the time.
const WAY_ERROR: f64 = f64::EPSILON;

/// Steps after which a cast ends where it is, which is before the impact: a grazing motion halves the gap with each,
/// so that 50 steps use up the digits of a gap.
const STEPS_MAX: usize = 128;

/// The normal is that of the last step at which the gap, relative to the size of the data, was at least this; nearer, rounding
/// shows in it.
const NORMAL_GAP: f64 = 1e-9;

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
    let (core_a, core_b) = (Core::of(a, placement_a), Core::of(b, placement_b));
    let radii = core_a.radius() + core_b.radius();
    // As seen from where A starts: far from the origin of the world every step would be rounded anew, past what is flat.
    let way = placement_b.translation - placement_a.translation;
    let at_b = DAffine3 { translation: way, ..*placement_b };
    let at_a = |lambda: f64| DAffine3 { translation: motion * lambda, ..*placement_a };
    let length = way.abs().max_element();
    // lambda: the time, never past the impact; r: the motion, in the unit of the difference; gap_max: no gap is wider at lambda.
    let (mut lambda, mut normal, mut gap_max) = (0.0, None, f64::INFINITY);
    let (mut lean, mut known) = (Lean::default(), Known::NONE);
    for _ in 0..STEPS_MAX {
        let at_a = at_a(lambda);
        let clip = Clip { radii, way: length, lean: &mut lean, known: &mut known };
        let clipped = match task::run(&core_a, &at_a, &core_b, &at_b, clip) {
            Ok(clipped) => clipped,
            Err(Unsure) if gap_max <= SETTLED => break,
            Err(Unsure) => {
                let clip = Clip { radii, way: length, lean: &mut lean, known: &mut known };
                clip.robustly(&Difference::new(&core_a, &at_a, &core_b, &at_b))
            }
        };
        let Some(Plane { normal: v, gap, scale }) = clipped else { break };
        if lambda == 0.0 && gap <= NEARLY_TOUCHING && intersects(a, placement_a, b, placement_b) {
            break;
        }
        let r = motion * scale;
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
        // On a step along the surface it may grow, by as much as that is long.
        gap_max = gap / (1.0 - STEP_TOLERANCE) + r.length() * (next - lambda);
        lambda = next;
    }
    let Some(normal) = normal else { return at_once(a, placement_a, motion, b, placement_b) };
    let (normal, points) = contact((&core_a, &at_a(lambda)), (&core_b, &at_b), normal, &known);
    Some(Impact { time: lambda, normal: Some(normal), points })
}

/// The impact of objects that meet at the start, or are so little apart that no gap is left of it; `None` of those where they part.
fn at_once<A, B>(
    a: &A,
    placement_a: &DAffine3,
    motion: DVec3,
    b: &B,
    placement_b: &DAffine3,
) -> Option<Impact>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let normal = match intersection(a, placement_a, b, placement_b) {
        Outcome::Separated { axis } if axis.dot(motion) >= 0.0 => return None,
        Outcome::Separated { axis } => Some(axis),
        _ => None,
    };
    Some(Impact { time: 0.0, normal, points: closest_points(a, placement_a, b, placement_b).points })
}

/// The normal and the points of a contact, from the normal of a plane that parted the objects shortly before, and the points that the
/// last search ended with.
fn contact<A, B>(
    (core_a, at_a): (&Core<A>, &DAffine3),
    (core_b, at_b): (&Core<B>, &DAffine3),
    mut normal: DVec3,
    known: &Known,
) -> (DVec3, Witness)
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let difference = Difference::new(core_a, at_a, core_b, at_b);
    let way = |points: &Witness| difference.point(points.on_a, points.on_b).w;
    let radii = (core_a.radius() + core_b.radius()) * difference.scale();
    let mut points = known.closest(&difference);
    if way(&points).length() - radii > WITNESS_GAP {
        points = closest_points(core_a, at_a, core_b, at_b).points;
    }
    if radii > NORMAL_GAP {
        normal = way(&points).try_normalize().unwrap_or(normal);
    }
    points.on_a -= core_a.to_surface(at_a, normal);
    points.on_b += core_b.to_surface(at_b, normal);
    (normal, points)
}

/// A plane that separates two objects.
struct Plane {
    /// From `B` to `A`, of length one.
    normal: DVec3,
    /// Their gap along it, less what may be rounding: more than [`CONTACT_GAP`]. In the unit of the difference.
    gap: f64,
    /// World lengths times this are lengths of the difference.
    scale: f64,
}

/// A lean search does not tell.
struct Unsure;

/// Looks for a plane that separates two cores by more than their radii, and by all of the gap but [`STEP_TOLERANCE`] of it: from the points that the last
/// search ended with, on the way of which the objects have moved.
struct Clip<'l> {
    /// World units.
    radii: f64,
    /// How long the way is, in world units.
    way: f64,
    lean: &'l mut Lean,
    /// Those that the last search that was sure ended with.
    known: &'l mut Known,
}

impl Task for Clip<'_> {
    /// No plane where the objects meet.
    type Found = Result<Option<Plane>, Unsure>;

    #[inline(always)]
    fn run(self, difference: &impl MinkowskiDifference) -> Self::Found {
        self.lean.begin();
        let goal = self.goal(difference.scale());
        Search { goal, warm: self.known.pairs() }.descend(self.lean, difference);
        match self.lean.sure {
            Sure::Near(mu) => {
                self.known.keep(self.lean.points());
                Ok(self.plane(self.lean.v.normalize(), mu, difference.scale()))
            }
            _ => Err(Unsure),
        }
    }
}

impl Clip<'_> {
    fn goal(&self, scale: f64) -> Goal {
        Goal::Gap { tolerance: STEP_TOLERANCE, radii: self.radii * scale }
    }

    /// With more care, where the lean search is not sure.
    #[cold]
    fn robustly<A, B>(self, difference: &Difference<A, B>) -> Option<Plane>
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let scale = difference.scale();
        let descent = descend_after(difference, self.goal(scale), self.lean);
        self.known.keep(descent.simplex.points());
        let v = descent.axis.normalize_or_zero();
        let mu = v.dot(difference.support_against(v).w);
        (descent.end != End::Inside).then(|| self.plane(v, mu, scale)).flatten()
    }

    /// The plane with the normal `v`, along which the cores are `mu` apart.
    #[inline(always)]
    fn plane(&self, v: DVec3, mu: f64, scale: f64) -> Option<Plane> {
        // Beyond the way, A goes no further than the size of the data, of which the rounding is within that of support points.
        let error = SUPPORT_ERROR + WAY_ERROR * scale * self.way;
        let gap = mu - self.radii * scale - error * v.abs().element_sum();
        (gap > CONTACT_GAP * error).then_some(Plane { normal: v, gap, scale })
    }
}

/// Pairs of points between whose differences the closest point was last.
struct Known {
    pairs: [Pair; 3],
    len: usize,
}

impl Known {
    /// Nothing.
    const NONE: Known = Known { pairs: [Pair::ZERO; 3], len: 0 };

    fn pairs(&self) -> &[Pair] {
        &self.pairs[..self.len]
    }

    /// Of four points the origin is between, and nothing is asked any more.
    #[inline(always)]
    fn keep<'p>(&mut self, points: impl IntoIterator<Item = &'p SupportPoint>) {
        self.len = 0;
        for (pair, point) in self.pairs.iter_mut().zip(points) {
            *pair = Pair::from(point);
            self.len += 1;
        }
    }

    /// The closest points of their hulls, where the objects are now.
    fn closest<A, B>(&self, difference: &Difference<A, B>) -> Witness
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let mut simplex = Simplex::new();
        self.pairs().iter().for_each(|pair| simplex.push(difference.point(pair.a, pair.b)));
        simplex.reduce();
        Witness::of(&simplex)
    }
}
