//! Exact signs for polygons, and the coordinates for which they are exact.

use glam::{DVec2, DVec3};

use crate::exact::{PREDICATE_MIN, power_of_two};
pub(super) use crate::exact::{flatten, height, orient2d as turn, plain, same_strict_side};
pub(super) use crate::exact::{segments_meet, segments_meet_in_space};

/// No predicate overflows while coordinates are at most this: a determinant of three differences stays below
/// 6 * (2^301)^3, with room for the splitting constant of exact products.
const PREDICATE_MAX: f64 = power_of_two(300);

/// Whether signs are exact of a point as it is.
pub(super) fn fits(p: DVec3) -> bool {
    p.to_array().into_iter().all(|x| x == 0.0 || (PREDICATE_MIN..=PREDICATE_MAX).contains(&x.abs()))
}

/// Whether two segments of a plane cross: each has its ends strictly on both sides of the other's line.
pub(super) fn segments_cross(p: DVec2, q: DVec2, r: DVec2, s: DVec2) -> bool {
    if p.max(q).cmplt(r.min(s)).any() || r.max(s).cmplt(p.min(q)).any() {
        return false;
    }
    same_strict_side(turn(p, q, r), -turn(p, q, s)) && same_strict_side(turn(r, s, p), -turn(r, s, q))
}

/// Whether a closed segment of a plane contains a point.
pub(super) fn segment_contains(p: DVec2, q: DVec2, x: DVec2) -> bool {
    p.min(q).cmple(x).all() && x.cmple(p.max(q)).all() && turn(p, q, x) == 0.0
}

/// Whether two segments of a plane share more than a point.
pub(super) fn segments_overlap(p: DVec2, q: DVec2, r: DVec2, s: DVec2) -> bool {
    let (low, high) = (p.min(q).max(r.min(s)), p.max(q).min(r.max(s)));
    low.cmple(high).all() && low != high && turn(p, q, r) == 0.0 && turn(p, q, s) == 0.0
}
