//! Two balls, without a common space: the square of a distance against that of a sum of radii.

use std::ops::RangeInclusive;

use super::GAP_MIN;
use super::similarity::Similarity;
use crate::pair::Placed;
use crate::shape::Simple;

/// Sizes of the data whose squares neither overflow nor vanish.
const PLAIN_SIZES: RangeInclusive<f64> = 1e-60..=1e60;

/// Whether two balls intersect; `None` for what are none, and where a closer look has to say.
pub(super) fn intersects(a: Placed, b: Placed) -> Option<bool> {
    let (radius_a, radius_b) = (radius(a)?, radius(b)?);
    let (at_a, at_b) = (Similarity::new(&a.placement.matrix3)?, Similarity::new(&b.placement.matrix3)?);
    let offset = b.placement.translation - a.placement.translation;
    let radii = radius_a * at_a.stretch + radius_b * at_b.stretch;
    let size = radii + offset.abs().element_sum();
    let (near, far) = (radii - GAP_MIN * size, radii + GAP_MIN * size);
    let square = offset.length_squared();
    if !PLAIN_SIZES.contains(&size) {
        None
    } else if square > far * far {
        Some(false)
    } else if near > 0.0 && square < near * near {
        Some(true)
    } else {
        None
    }
}

/// The radius of a ball, in its own space.
fn radius(placed: Placed) -> Option<f64> {
    match placed.shape.simple()? {
        Simple::Round { radius, half_height: 0.0 } => Some(radius),
        _ => None,
    }
}
