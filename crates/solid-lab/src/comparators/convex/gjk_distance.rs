use solid3d::convex::Support;
use solid3d::glam::DVec3;

use super::{Johnson, Pair};

/// What tells one version of the GJK distance algorithm from another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// How far the length of `v` may be above its lower bound at the end: epsilon.
    pub tolerance: f64,
    /// Whether that is a share of the length of `v`, else it is a length.
    pub relative: bool,
    /// Whether a support point that was seen before ends the search.
    pub stop_on_repeat: bool,
    /// Whether the backup procedure takes over when the sub-algorithm finds no subset, else that ends the search.
    pub backup: bool,
}

impl Rules {
    /// As in the thesis, section 4.4.4.
    pub fn thesis(tolerance: f64) -> Self {
        Rules { tolerance, relative: true, stop_on_repeat: true, backup: false }
    }

    /// As Gilbert, Johnson and Keerthi had it (*A fast procedure for computing the distance between complex objects in
    /// three-dimensional space*, 1988): without the measures of section 4.4.4.
    pub fn original(tolerance: f64) -> Self {
        Rules { tolerance, relative: false, stop_on_repeat: false, backup: true }
    }
}

/// How a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Within the tolerance, or at the origin.
    Converged,
    /// A support point came again.
    Repeated,
    /// Rounding left the sub-algorithm no subset.
    NoSubset,
    /// After the limit of iterations: it would not have ended.
    Limit,
}

/// What the search found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Zero when they intersect.
    pub distance: f64,
    /// A closest point of A.
    pub on_a: DVec3,
    /// A closest point of B.
    pub on_b: DVec3,
    /// Support points that were computed.
    pub iterations: u32,
    /// Why it ended.
    pub end: End,
}

/// More iterations than any search that ends has needed, tenfold.
pub const ITERATIONS_MAX: u32 = 1000;

/// `v` this much shorter than the longest point of the simplex is zero: thesis's omega, as a share of the size.
pub const ORIGIN: f64 = 1e-14;

/// Algorithm 4.1.
pub fn distance<A, B>(pair: &Pair<A, B>, rules: &Rules) -> Distance
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let mut simplex = Johnson::default();
    let first = pair.support_against(pair.center());
    simplex.push(first);
    let mut v = simplex.reduce().expect("a point is its own closest point");
    // mu: a lower bound of the distance.
    let mut mu = 0.0f64;
    let mut iterations = 1;
    let end = loop {
        let length = v.length();
        if simplex.is_full() || length <= ORIGIN * simplex.length_squared_max().sqrt() {
            v = DVec3::ZERO;
            break End::Converged;
        }
        if iterations == ITERATIONS_MAX {
            break End::Limit;
        }
        iterations += 1;
        let point = pair.support_against(v);
        mu = mu.max(v.dot(point.w) / length);
        let allowed = if rules.relative { rules.tolerance * length } else { rules.tolerance };
        if length - mu <= allowed {
            break End::Converged;
        }
        if rules.stop_on_repeat && simplex.contains(point.w) {
            break End::Repeated;
        }
        simplex.push(point);
        if rules.backup {
            v = simplex.reduce_with_backup();
        } else {
            match simplex.reduce() {
                Some(closest) => v = closest,
                None => break End::NoSubset,
            }
        }
    };
    let [on_a, on_b] = simplex.witness();
    Distance { distance: v.length(), on_a, on_b, iterations, end }
}
