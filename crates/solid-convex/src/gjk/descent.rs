//! The descent: Algorithms 4.1 and 4.2 of the thesis.

use glam::DVec3;

use super::lean::{Lean, Search, Sure};
use super::task;
use crate::Support;
use crate::difference::{Difference, SUPPORT_ERROR, SupportPoint};
use crate::feature::{normal, perpendicular};
use crate::simd;
use crate::simplex::{Reduced, Simplex};

/// When a descent may stop.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Goal {
    /// As soon as an axis is known to separate the objects.
    Separation,
    /// As soon as what of the distance is beyond some radii is known to this relative error, or to be next to nothing.
    Gap {
        /// The relative error.
        tolerance: f64,
        /// What of the distance is no gap, in the difference's unit of length.
        radii: f64,
    },
    /// As soon as the distance is known to a relative error, or to be more than a bound.
    DistanceWithin {
        /// The relative error.
        tolerance: f64,
        /// The bound, in the difference's unit of length.
        bound: f64,
    },
}

/// How a descent ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum End {
    /// `v` separates the objects.
    Separated,
    /// A tetrahedron of the difference contains the origin.
    Inside,
    /// Neither could be shown: the origin is within the rounding error of the simplex, or the search made no progress.
    Undecided,
}

/// A descent that ended. Space: the difference's own.
pub(crate) struct Descent {
    pub end: End,
    /// The point of the simplex closest to the origin, or the separating axis.
    pub v: DVec3,
    /// Along which the objects are known to be the furthest apart, if they are. It may be far better than `v`: next to what is round, the
    /// normal of a thin simplex may not even separate.
    pub axis: DVec3,
    /// The simplex; may be empty when the search for an axis ends with the first.
    pub simplex: Simplex,
    /// Whether the objects are further apart than the goal asked for; `v` is then not the closest point.
    pub beyond: bool,
}

/// Iterations after which a descent gives up. Polytopes take fewer than 20; quadrics take some 4 for each digit of the
/// distance, and the most seen on touching ellipsoids of axes 1:10^6 was below half of this.
pub(super) const ITERATIONS_MAX: usize = 512;

/// A step that shortens `v` squared by less than this part of it makes no progress: it is within the rounding error.
const PROGRESS_MIN: f64 = 4.0 * f64::EPSILON;

/// No step lengthens `v` by more than the rounding error. Where one does, that hid which part of the simplex is the closest: then it is a face with the
/// new point, or the step is taken back. In the difference's unit of length.
const GROWTH_MAX: f64 = SUPPORT_ERROR;

/// A lower bound of the distance must exceed the bound on it by this much to end a descent: what a descent to its end would call the
/// distance may be below the lower bound by the rounding error. In the difference's unit of length.
const BOUND_MARGIN: f64 = 2.0 * SUPPORT_ERROR;

/// How often a descent may go on from a recomputed normal: each time it must find a new support point. On the side of a flat cone each
/// has a quarter of the error of the one before.
const REFINEMENTS_MAX: usize = 32;

/// Runs a descent: the lean one, and where that is not sure the robust one.
pub(crate) fn descend<A, B>(difference: &Difference<A, B>, goal: Goal) -> Descent
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let lean = task::run_on(simd::level(), difference, Search { goal, warm: &[] });
    finished(&lean, goal).unwrap_or_else(|| descend_robustly(difference, goal))
}

/// What a lean descent was sure of, as the robust descent would leave it.
fn finished(lean: &Lean, goal: Goal) -> Option<Descent> {
    let mut simplex = lean.simplex();
    let (end, v) = match lean.sure {
        Sure::Nothing => return None,
        Sure::Separated(_) | Sure::Beyond => (End::Separated, lean.v),
        Sure::Inside => simplex.reduce_if_inside().then_some((End::Inside, DVec3::ZERO))?,
        Sure::Near(mu) => match simplex.reduce() {
            // Measured again by more careful means.
            Reduced::Closest(v) if goal.is_within_tolerance(v.length(), mu) => (End::Separated, v),
            _ => return None,
        },
    };
    Some(Descent { end, v, axis: lean.v, simplex, beyond: lean.sure == Sure::Beyond })
}

/// Runs the robust descent. `v` starts along the initial direction; the objects' own support points take over from there.
#[cold]
pub(super) fn descend_robustly<A, B>(difference: &Difference<A, B>, goal: Goal) -> Descent
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    descend_within(difference, goal, &[], ITERATIONS_MAX)
}

/// Runs the robust descent where a lean one was not sure. Of what is curved it goes on from there, since that is most of the way; of polytopes it begins
/// anew, for what a lean descent cannot tell of them is a sliver.
#[cold]
pub(super) fn descend_after<A, B>(difference: &Difference<A, B>, goal: Goal, lean: &Lean) -> Descent
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let points = if difference.is_polytope() { &[] } else { lean.points() };
    descend_within(difference, goal, points, ITERATIONS_MAX)
}

/// Runs a descent of at most so many iterations, from points of the difference if there are any. One that has to stop is undecided, whatever the objects do: it claims
/// neither separation nor intersection without the evidence.
pub(super) fn descend_within<A, B>(
    difference: &Difference<A, B>,
    goal: Goal,
    points: &[SupportPoint],
    iterations_max: usize,
) -> Descent
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    // v: the point of conv(W) closest to the origin; w: a support point of A - B against v; W: `simplex`;
    // mu: the greatest lower bound of the distance so far, along `axis`.
    let (mut simplex, mut v) =
        begun(points).unwrap_or_else(|| (Simplex::new(), difference.initial_direction()));
    let (mut mu, mut axis) = (0.0, v);
    let mut refinements = 0;
    for _ in 0..iterations_max {
        let p = difference.support_against(v);
        let mu_before = mu;
        let reached = goal.reached(v, &p, &mut mu, !simplex.is_empty());
        if mu > mu_before {
            axis = v;
        }
        if reached {
            return Descent { end: End::Separated, v, axis, simplex, beyond: goal.is_exceeded(mu) };
        }
        let (members_before, v_before) = (simplex.members(), v);
        let mut stalled = simplex.contains(&p);
        if !stalled {
            simplex.push(p);
            match simplex.reduce() {
                Reduced::ContainsOrigin => {
                    return Descent { end: End::Inside, v: DVec3::ZERO, axis, simplex, beyond: false };
                }
                Reduced::Closest(closest) => v = closest,
            }
            let length_squared = v.length_squared();
            if length_squared <= SUPPORT_ERROR * SUPPORT_ERROR {
                return Descent { end: End::Undecided, v, axis, simplex, beyond: false };
            }
            if members_before.any() {
                stalled = length_squared > (1.0 - PROGRESS_MIN) * v_before.length_squared();
                let length_max = v_before.length() + GROWTH_MAX;
                // What is so thin that products of its edges vanish has a closest point that is no number.
                if length_squared > length_max * length_max || length_squared.is_nan() {
                    stalled = true;
                    simplex.restore(members_before);
                    v = v_before;
                    if refinements < REFINEMENTS_MAX
                        && let Some(normal) = face_with(difference, &mut simplex, p, length_max)
                    {
                        (v, stalled) = (normal, false);
                        refinements += 1;
                    }
                }
            }
        }
        if stalled {
            // Where the simplex says nothing new, with the point that it was closer without: of a plane that passes the origin as
            // closely as one of its edges.
            let anew = refined(difference, simplex.points())
                .filter(|&normal| normal != v_before)
                .or_else(|| refined(difference, simplex.points().chain([&p])));
            match anew {
                Some(normal) if normal != v_before && refinements < REFINEMENTS_MAX => v = normal,
                _ => break,
            }
            refinements += 1;
        }
        if mu > 0.0 && v.length() < mu - SUPPORT_ERROR {
            // Nothing of A - B is that near: the simplex is too thin a sliver for its closest point to be computed.
            simplex.restore(members_before);
            v = v_before;
            break;
        }
    }
    let end = if mu > 0.0 { End::Separated } else { End::Undecided };
    Descent { end, v, axis, simplex, beyond: false }
}

/// A simplex of points of the difference, and its point closest to the origin; `None` where that is the origin, nearly, and of no points.
pub(super) fn begun(points: &[SupportPoint]) -> Option<(Simplex, DVec3)> {
    if points.is_empty() {
        return None;
    }
    let mut simplex = Simplex::of(points);
    match simplex.reduce() {
        Reduced::Closest(v) if v.length_squared() > SUPPORT_ERROR * SUPPORT_ERROR => Some((simplex, v)),
        Reduced::Closest(_) | Reduced::ContainsOrigin => None,
    }
}

impl Goal {
    /// Whether the support point `p` against `v` ends the search; keeps the lower bound of the distance.
    fn reached(self, v: DVec3, p: &SupportPoint, mu: &mut f64, v_in_difference: bool) -> bool {
        let mut near_enough = || {
            let length = v.length();
            if certifies(v, p.w) {
                *mu = mu.max(v.dot(p.w) / length);
            }
            v_in_difference && *mu > 0.0 && self.is_within_tolerance(length, *mu)
        };
        match self {
            Goal::Separation => certifies(v, p.w),
            Goal::Gap { .. } => near_enough(),
            Goal::DistanceWithin { .. } => near_enough() || self.is_exceeded(*mu),
        }
    }

    /// Whether a distance is known well enough, by a lower bound of it.
    pub(super) fn is_within_tolerance(self, length: f64, mu: f64) -> bool {
        match self {
            Goal::Separation => true,
            Goal::DistanceWithin { tolerance, .. } => length - mu <= tolerance * length,
            Goal::Gap { tolerance, radii } => {
                length - mu <= (tolerance * (length - radii)).max(SUPPORT_ERROR)
            }
        }
    }

    /// Whether a lower bound of the distance is more than was asked for.
    pub(super) fn is_exceeded(self, mu: f64) -> bool {
        matches!(self, Goal::DistanceWithin { bound, .. } if mu > bound + BOUND_MARGIN)
    }
}

/// Whether `w`, a support point against `v`, shows that `v` separates the objects: beyond the rounding error.
pub(super) fn certifies(v: DVec3, w: DVec3) -> bool {
    v.dot(w) > SUPPORT_ERROR * v.abs().element_sum()
}

/// Where rounding hid on which face with a new support point the closest point is: the normal of that face, which the simplex then is;
/// `None`, and the simplex as it was, where there is none that is as near as `length_max`.
#[cold]
fn face_with<A, B>(
    difference: &Difference<A, B>,
    simplex: &mut Simplex,
    p: SupportPoint,
    length_max: f64,
) -> Option<DVec3>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let members = simplex.members();
    let normal = if simplex.push_to_face(p) { refined(difference, simplex.points()) } else { None };
    let normal = normal.filter(|normal| normal.length() <= length_max);
    if normal.is_none() {
        simplex.restore(members);
    }
    normal
}

/// The point closest to the origin on the line or plane of a simplex, computed from the objects' edges; `None` where
/// that says nothing.
fn refined<'p, A, B>(
    difference: &Difference<A, B>,
    mut points: impl Iterator<Item = &'p SupportPoint> + Clone,
) -> Option<DVec3>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let nearer = |x: &&SupportPoint, y: &&SupportPoint| x.w.length_squared().total_cmp(&y.w.length_squared());
    let nearest = points.clone().min_by(nearer)?;
    let v = match [points.next(), points.next(), points.next(), points.next()] {
        [Some(p), Some(q), None, None] => perpendicular(nearest.w, difference.edge(p, q)),
        [Some(p), Some(q), Some(r), None] => {
            let normal = normal([difference.edge(p, q), difference.edge(q, r), difference.edge(r, p)]);
            normal * (nearest.w.dot(normal) / normal.length_squared())
        }
        _ => return None,
    };
    (v.is_finite() && v != DVec3::ZERO).then_some(v)
}
