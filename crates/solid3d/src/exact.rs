//! Exact signs: where a point lies to a line or a plane, and what follows from that for segments.
//!
//! Exact while nothing overflows or underflows: callers bring their points to a unit near the size of the data first, and make them [`plain`].

use glam::{DVec2, DVec3};
use robust::{Coord, Coord3D};

/// No predicate loses a bit while coordinates other than zero are at least this: their last bits are at least
/// 2^(-300 - 52), and the product of three such bits is still a positive number.
pub(crate) const PREDICATE_MIN: f64 = power_of_two(-300);

/// A point in a unit near the size of the data, where coordinates too small for exact products count as zero.
#[inline]
pub(crate) fn plain(p: DVec3) -> DVec3 {
    p.map(|x| if x.abs() < PREDICATE_MIN { 0.0 } else { x })
}

/// Positive where `a`, `b`, `c` turn to the left.
#[inline]
pub(crate) fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    robust::orient2d(coord(a), coord(b), coord(c))
}

/// Positive where `d` lies below the plane through `a`, `b`, `c`, from above which they appear counter-clockwise.
#[inline]
pub(crate) fn orient3d(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    let coord = |p: DVec3| Coord3D { x: p.x, y: p.y, z: p.z };
    robust::orient3d(coord(a), coord(b), coord(c), coord(d))
}

/// Positive where `d` lies above the plane through `a`, `b`, `c`, from where they appear counter-clockwise: the sign of
/// `det(b - a, c - a, d - a)`.
#[inline]
pub(crate) fn height(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    -orient3d(a, b, c, d)
}

/// A point without one of its coordinates: looking along that axis, from its positive end.
#[inline]
pub(crate) fn flatten(dropped: usize, p: DVec3) -> DVec2 {
    DVec2::new(p[(dropped + 1) % 3], p[(dropped + 2) % 3])
}

/// `2^e` for `e` from -1022 to 1023.
pub(crate) const fn power_of_two(e: i32) -> f64 {
    f64::from_bits(((1023 + e) as u64) << 52)
}

/// Whether two numbers have the same sign, and neither is zero.
pub(crate) fn same_strict_side(a: f64, b: f64) -> bool {
    (a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0)
}

/// Whether two closed segments of a plane share a point.
pub(crate) fn segments_meet(p: DVec2, q: DVec2, r: DVec2, s: DVec2) -> bool {
    if p.max(q).cmplt(r.min(s)).any() || r.max(s).cmplt(p.min(q)).any() {
        return false;
    }
    // With overlapping boxes, segments that are not parted by each other's lines meet, also collinear ones.
    !same_strict_side(orient2d(p, q, r), orient2d(p, q, s))
        && !same_strict_side(orient2d(r, s, p), orient2d(r, s, q))
}

/// Whether two closed segments of space share a point: if and only if they are coplanar and do so in all three projections
/// along the axes, of which at least one loses nothing, and none parts what meets.
pub(crate) fn segments_meet_in_space(p: DVec3, q: DVec3, r: DVec3, s: DVec3) -> bool {
    orient3d(p, q, r, s) == 0.0
        && (0..3).all(|k| segments_meet(flatten(k, p), flatten(k, q), flatten(k, r), flatten(k, s)))
}
