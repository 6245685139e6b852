use glam::{DAffine3, DVec3};

use crate::decide::{Decision, decide};
use crate::placed::PlacedPair;
use crate::search::Limits;
use crate::shape::Convex;

/// The search goes on until the distance is known to a thousandth of the promised width.
const LIMITS: Limits = Limits { relative_width: 1e-13, iterations_max: 2000 };

/// How far above the tolerance [`contains_within`] may answer yes, relative to the tolerance.
const WITHIN_SLACK: f64 = 1e-9;

/// A certified interval `(lower, upper)` around the Euclidean distance of two placed shapes.
///
/// `lower` rests on a verified axis, `upper` on two actual points; both are rigorous. `(0, 0)` when a common point is
/// proven. The width is below 1e-9 of the distance where that is above 1e-11 of the size of the shapes. Nearer touches of
/// round shapes widen it: of 5000 pairs the worst was 2e-5 wide at gaps of 1e-13, a tenth at 1e-15.
///
/// ```
/// use glam::{DAffine3, DVec3};
/// use solid_oracle::{Convex, distance_bounds};
/// let cube = Convex::Cuboid { half: DVec3::ONE };
/// let far = DAffine3::from_translation(DVec3::new(5.0, 6.0, 0.0));
/// assert_eq!(distance_bounds(&cube, &DAffine3::IDENTITY, &cube, &far), (5.0, 5.0));
/// ```
pub fn distance_bounds(a: &Convex, pa: &DAffine3, b: &Convex, pb: &DAffine3) -> (f64, f64) {
    match decide(&PlacedPair::new(a, pa, b, pb), LIMITS) {
        Decision::Common(_) => (0.0, 0.0),
        Decision::Apart { lower, upper } => (lower, upper),
        Decision::Open { distance_max, .. } => (0.0, distance_max),
    }
}

/// Whether `point` lies within `tolerance` of the placed shape.
///
/// Never true for a point farther away than `tolerance * (1 + 1e-9)`; never false for one nearer than
/// `tolerance * (1 - 1e-9)`, as long as the tolerance is above 1e-11 of the size; nor for one proven to lie in the shape.
///
/// ```
/// use glam::{DAffine3, DVec3};
/// use solid_oracle::{Convex, contains_within};
/// let ball = Convex::Sphere { radius: 1.0 };
/// assert!(contains_within(&ball, &DAffine3::IDENTITY, 1.25 * DVec3::X, 0.25));
/// assert!(!contains_within(&ball, &DAffine3::IDENTITY, 1.25 * DVec3::X, 0.24));
/// ```
pub fn contains_within(shape: &Convex, placement: &DAffine3, point: DVec3, tolerance: f64) -> bool {
    let point = Convex::Hull { points: vec![point] };
    let (_, upper) = distance_bounds(shape, placement, &point, &DAffine3::IDENTITY);
    upper <= tolerance * (1.0 + WITHIN_SLACK)
}
