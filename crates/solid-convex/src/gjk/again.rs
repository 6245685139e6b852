//! The same question about two objects again: what is kept of them is tried first, and a search begins from there.

use std::ops::ControlFlow;

use glam::DVec3;

use super::descent::Goal;
use super::intersection::is_clear;
use super::lean::{Lean, Search, Sure};
use super::pairs::Pair;
use crate::difference::MinkowskiDifference;
use crate::feature::{VOLUME_ERROR, sides_of_origin};

/// Whether the tetrahedron of the differences of four pairs certainly contains the origin; else the three of the face by which that went out, and
/// the fourth.
#[inline(always)]
pub(super) fn contains_origin(
    pairs: [Pair; 4],
    difference: &impl MinkowskiDifference,
) -> ControlFlow<(), [Pair; 4]> {
    let (sides, least) = sides_of_origin(differences(&pairs, difference));
    if least > VOLUME_ERROR && sides[0].min(sides[1]).min(sides[2].min(sides[3])) > 0.0 {
        return ControlFlow::Break(());
    }
    ControlFlow::Continue(left_by(pairs, sides))
}

/// A search for whether two objects intersect, from up to three pairs whose differences are near the origin, then from nothing; whether it is
/// sure.
#[inline(always)]
pub(super) fn search_from(start: &[Pair], difference: &impl MinkowskiDifference, lean: &mut Lean) -> bool {
    for warm in [start, &[]] {
        lean.begin();
        Search { goal: Goal::Separation, warm }.descend(lean, difference);
        let is_sure = match lean.sure {
            // Of a small gap a search from nothing has the word.
            Sure::Separated(along) => warm.is_empty() || is_clear(lean.v, along),
            Sure::Inside => true,
            Sure::Near(_) | Sure::Beyond | Sure::Nothing => false,
        };
        if is_sure || warm.is_empty() {
            return is_sure;
        }
    }
    false
}

/// The points of the difference that pairs make.
#[inline(always)]
pub(super) fn differences(pairs: &[Pair; 4], difference: &impl MinkowskiDifference) -> [DVec3; 4] {
    let mut points = [DVec3::ZERO; 4];
    for (point, pair) in points.iter_mut().zip(pairs) {
        *point = difference.point(pair.a, pair.b).w;
    }
    points
}

/// The face by which the origin went out of a tetrahedron, before the corner opposite.
#[inline(always)]
pub(super) fn left_by([p, q, r, s]: [Pair; 4], sides: [f64; 4]) -> [Pair; 4] {
    let outside = sides[0].min(sides[1]).min(sides[2].min(sides[3]));
    match sides {
        [side, ..] if side == outside => [p, q, s, r],
        [_, side, ..] if side == outside => [q, r, s, p],
        [_, _, side, _] if side == outside => [r, p, s, q],
        _ => [p, q, r, s],
    }
}
