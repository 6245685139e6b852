use glam::DAffine3;

use crate::decide::{Decision, decide};
use crate::penetration::{Effort, inscribed};
use crate::placed::PlacedPair;
use crate::search::Limits;
use crate::shape::Convex;

/// What is proven about two placed shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// Proven apart.
    Separated {
        /// A rigorous lower bound of the distance, positive; within about 1e-9 of it unless the gap is below 1e-11 of
        /// the size.
        gap: f64,
    },
    /// Proven to share a point, be it a single one.
    Intersecting {
        /// About a lower bound of the penetration depth, at least zero: the radius of a ball around the origin inside
        /// the Minkowski difference. Searched to a few percent and computed with rounding, from which a margin of
        /// 1e-14 of the largest coordinate was taken; the shared point is proven, this number is not.
        /// [`penetration_bounds`](crate::penetration_bounds) is tighter.
        depth: f64,
    },
    /// Neither could be proven: a touch, up to the precision of the search.
    Uncertain {
        /// An upper bound of the distance as well as of the depth.
        gap_max: f64,
    },
}

impl Verdict {
    /// Whether a common point was proven or refuted, `None` when neither.
    pub fn shares_point(&self) -> Option<bool> {
        match self {
            Self::Separated { .. } => Some(false),
            Self::Intersecting { .. } => Some(true),
            Self::Uncertain { .. } => None,
        }
    }
}

/// 1e-9 of the distance is known once the search stops.
const LIMITS: Limits = Limits { relative_width: 1e-9, iterations_max: 400 };

/// Decides whether two placed shapes share a point.
///
/// Two polytopes (cuboids and hulls) are always decided, exact touches included. Round shapes are decided unless
/// they touch up to about 1e-25 of their size; exact touches of round shapes are proven only where the touching
/// point is representable. Laws: swapping A and B, a power-of-two scale of both, and translating both by a
/// representable amount leave the verdict's variant unchanged.
///
/// # Panics
/// When a number of the input is infinite or NaN, or a hull has no points.
///
/// ```
/// use glam::{DAffine3, DVec3};
/// use solid_oracle::{Convex, Verdict, verdict};
/// let ball = Convex::Sphere { radius: 1.0 };
/// let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
/// let judge = |x: f64| verdict(&ball, &at(0.0), &ball, &at(x));
/// assert_eq!(judge(2.5), Verdict::Separated { gap: 0.5 });
/// assert_eq!(judge(2.0), Verdict::Intersecting { depth: 0.0 });
/// ```
pub fn verdict(a: &Convex, pa: &DAffine3, b: &Convex, pb: &DAffine3) -> Verdict {
    let pair = PlacedPair::new(a, pa, b, pb);
    match decide(&pair, LIMITS) {
        Decision::Common(vertices) => {
            Verdict::Intersecting { depth: inscribed(&pair, &vertices, Effort::QUICK).radius }
        }
        Decision::Apart { lower, .. } => Verdict::Separated { gap: lower },
        Decision::Open { distance_max, depth_max } => {
            Verdict::Uncertain { gap_max: distance_max.max(depth_max) }
        }
    }
}
