//! When two balls, one of which moves along a straight line, first meet: a quadratic equation.

use glam::DVec3;
use solid_convex::{Impact, Witness, unit_scale};

use super::GAP_MIN;
use super::ball::placed_ball;
use crate::pair::Placed;

/// The gap at the time that is given, in the unit of the pair: above what rounding moves, so that the time is never past the impact.
const GAP: f64 = 0.25 * GAP_MIN;

/// When the first, moving by `motion` in a unit of time, meets the second in that time; `Some(None)` when it does not. `None` for other shapes, and for placements
/// that are not a rotation with a uniform scale; where they are not clearly apart at the start, or do no more than graze each other, GJK has to say.
pub(in crate::pair) fn cast(a: Placed, motion: DVec3, b: Placed) -> Option<Option<Impact>> {
    let (at_a, radius_a) = placed_ball(a)?;
    let (at_b, radius_b) = placed_ball(b)?;
    let between = a.placement.translation - b.placement.translation;
    let scale = unit_scale(radius_a + radius_b + between.abs().element_sum() + motion.abs().element_sum());
    let (start, way, radii) = (between * scale, motion * scale, (radius_a + radius_b) * scale);
    let distance = start.length();
    if distance - radii <= GAP_MIN {
        return None;
    }
    let (approach, square) = (-start.dot(way), way.length_squared());
    if approach <= 0.0 {
        return Some(None);
    }
    let nearest = (start + way * (approach / square).min(1.0)).length() - radii;
    if nearest.abs() <= GAP_MIN {
        return None;
    }
    if nearest > 0.0 {
        return Some(None);
    }
    let beyond = (distance - (radii + GAP)) * (distance + (radii + GAP));
    let time = beyond / (approach + (approach * approach - square * beyond).sqrt());
    let there = start + way * time;
    let length = there.length();
    // Where rounding hides when, GJK has to say.
    if !(0.0..=GAP_MIN).contains(&(length - radii)) {
        return None;
    }
    let normal = there / length;
    let points = Witness { on_a: at_a.local(normal * -radius_a), on_b: at_b.local(normal * radius_b) };
    Some(Some(Impact { time, normal: Some(normal), points }))
}
