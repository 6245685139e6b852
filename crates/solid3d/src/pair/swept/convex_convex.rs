//! Convex against convex.

use glam::{DAffine3, DVec3};
use solid_convex::{Outcome, gjk};

use super::Encounter;
use super::bodies::MovingConvex;
use super::hulls::{MovingDifference, Trace};
use crate::pair::Scratch;

pub(super) fn encounter(a: MovingConvex, b: MovingConvex, scratch: &mut Scratch) -> Encounter {
    scratch.primitive_tests += 1;
    match MovingDifference::new(a, b).contains_origin() {
        Outcome::Separated { axis } => Encounter::None { axis: Some(axis) },
        Outcome::Touching(_) | Outcome::Intersecting(_) => Encounter::At(common_point(a, b)),
    }
}

pub(super) fn still_separated(axis: &DVec3, a: MovingConvex, b: MovingConvex) -> bool {
    MovingDifference::new(a, b).separated_along(axis)
}

/// A point of both swept volumes, in the world. They have one when the moving difference contains the origin.
fn common_point(a: MovingConvex, b: MovingConvex) -> DVec3 {
    let origin = a[1].1.translation;
    let [trace_a, trace_b] = [a, b].map(|ends| Trace { ends, origin });
    let points = gjk::closest_points(&trace_a, &DAffine3::IDENTITY, &trace_b, &DAffine3::IDENTITY).points;
    origin + 0.5 * points.on_a + 0.5 * points.on_b
}
