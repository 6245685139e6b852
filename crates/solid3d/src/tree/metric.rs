//! What distances in two local spaces are worth in the world.

use solid_convex::simd::each;

use super::lanes::Weights;
use super::normal::{Normal, round_down};
use super::squares::limit;
use glam::DVec3;

/// How the placements of two trees stretch distances; all are lower bounds, and zero is always valid.
///
/// Two boxes that are a gap apart along axis `i` of a local space are at least that gap times `facet[i]` apart in the world: the
/// distance of two planes. And boxes whose gaps have a norm are at least that norm times `sigma_min` apart.
///
/// ```
/// use solid3d::{glam::DVec3, tree::PairMetric};
/// // a rotated, b stretched by 2, 3 and 4 along its axes
/// let metric = PairMetric {
///     facet_a: DVec3::ONE,
///     facet_b: DVec3::new(2.0, 3.0, 4.0),
///     sigma_min_a: 1.0,
///     sigma_min_b: 2.0,
/// };
/// assert_eq!(metric.swapped().facet_a, metric.facet_b);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairMetric {
    /// For each axis of `a`, the distance in the world of two planes across it that are 1 apart in `a`: `1 / |n|`, `n` a row of the
    /// inverse of the linear part of the placement.
    pub facet_a: DVec3,
    /// The same for `b`.
    pub facet_b: DVec3,
    /// A lower bound of the least singular value of the linear part of the placement of `a`.
    pub sigma_min_a: f64,
    /// The same for `b`.
    pub sigma_min_b: f64,
}

impl PairMetric {
    /// The same with `a` and `b` exchanged.
    pub fn swapped(&self) -> PairMetric {
        PairMetric {
            facet_a: self.facet_b,
            facet_b: self.facet_a,
            sigma_min_a: self.sigma_min_b,
            sigma_min_b: self.sigma_min_a,
        }
    }
}

/// Pays for the rounding of all weighing, about ten operations in `f32` on squares, and of some five on what raises them, with sixteen times 2^-24.
const ROUNDING: f64 = 8.0 * f32::EPSILON as f64;

/// A metric in tree coordinates.
pub(crate) struct Folded {
    pub(super) a: Weights,
    pub(super) b: Weights,
    /// A length in the world times this is more units than it has, by what rounding may add to squares. Units are so chosen that no weight exceeds 1.
    pub(super) per_unit: f64,
    /// A length in the world times this is no more units than it has.
    pub(super) units: f32,
}

impl Folded {
    #[inline(always)]
    pub fn new(metric: &PairMetric, a: &Normal, b: &Normal) -> Self {
        let (axes_a, norm_a) = (metric.facet_a * a.scale, metric.sigma_min_a * a.scale);
        let (axes_b, norm_b) = (metric.facet_b * b.scale, metric.sigma_min_b * b.scale);
        let unit = axes_a.max(axes_b).max_element().max(norm_a).max(norm_b);
        let inverse = inverse(unit);
        let squared = {
            #[inline(always)]
            |w: f64| (w * inverse) as f32 * (w * inverse) as f32
        };
        let weights = {
            #[inline(always)]
            |axes: DVec3, norm: f64| Weights { axes: each(axes.to_array(), squared), norm: squared(norm) }
        };
        Folded::in_units(inverse, weights(axes_a, norm_a), weights(axes_b, norm_b))
    }

    /// Of a tree in whose space whatever has a length of one has at least `length` in the world.
    #[inline(always)]
    pub fn alike(length: f64, normal: &Normal) -> Self {
        Folded::in_units(inverse(length * normal.scale), Weights::ALL, Weights::NONE)
    }

    /// In units of which so many are a length of one in the world.
    #[inline(always)]
    fn in_units(inverse: f64, a: Weights, b: Weights) -> Self {
        Folded {
            a,
            b,
            per_unit: if inverse > 0.0 { inverse * (1.0 + 2.0 * ROUNDING) } else { f64::INFINITY },
            // No less than zero: bounds below zero, which tell nothing, would become great ones.
            units: round_down(inverse.min(f64::from(f32::MAX))).max(0.0),
        }
    }

    /// What has a square of at least this is no nearer in the world than a distance.
    #[inline(always)]
    pub fn limit(&self, distance: f64) -> f32 {
        limit(distance * self.per_unit)
    }
}

/// How many units are a length of one in the world, or zero: without a unit every bound is zero, nothing is skipped, and nothing lost.
#[inline(always)]
fn inverse(unit: f64) -> f64 {
    if unit.is_normal() { unit.recip() } else { 0.0 }
}
