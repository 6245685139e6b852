//! When two balls, one of which moves along a straight line, first meet: a quadratic equation.

use fearless_simd::Simd;
use glam::DVec3;
use solid_convex::gjk::CAST_ERROR;
use solid_convex::{Impact, Witness, unit_scale};

use super::GAP_MIN;
use super::similarity::{stretch, to_body};
use crate::pair::Placed;

/// The gap at the time that is given, in the unit of the pair: above what rounding moves, so that the time is never past the impact. Of balls that are
/// small beside the way it is less.
const GAP: f64 = 0.25 * GAP_MIN;

/// How far off a cast may end, relative to how far apart the two start, where that is more than [`CAST_ERROR`] of their size.
const WAY_ERROR: f64 = 1e-14;

/// When the first, moving by `motion` in a unit of time, meets the second in that time; `Some(None)` when it does not. `None` for other shapes, and for placements
/// that are not a rotation with a uniform scale; where they are not clearly apart at the start, or do no more than graze each other, GJK has to say. Placements
/// need not have been checked: those of an answer are good.
#[inline(always)]
pub(in crate::pair) fn cast<S: Simd>(simd: S, a: Placed, motion: DVec3, b: Placed) -> Option<Option<Impact>> {
    let (of_a, of_b) = (a.shape.ball_radius()?, b.shape.ball_radius()?);
    let (stretch_a, stretch_b) = (stretch(simd, a.placement)?, stretch(simd, b.placement)?);
    let (radius_a, radius_b) = (of_a * stretch_a, of_b * stretch_b);
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
    let gap_max = (CAST_ERROR * radii).max(WAY_ERROR * distance);
    let gap = GAP.min(0.5 * gap_max);
    let beyond = (distance - (radii + gap)) * (distance + (radii + gap));
    let time = beyond / (approach + (approach * approach - square * beyond).sqrt());
    let there = start + way * time;
    let length = there.length();
    // Where rounding hides when, GJK has to say.
    if !(0.0..=gap_max).contains(&(length - radii)) {
        return None;
    }
    let normal = there / length;
    let points = Witness {
        on_a: to_body(&a.placement.matrix3, normal * -of_a) / stretch_a,
        on_b: to_body(&b.placement.matrix3, normal * of_b) / stretch_b,
    };
    Some(Some(Impact { time, normal: Some(normal), points }))
}
