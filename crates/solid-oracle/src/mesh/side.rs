use glam::DVec3;

/// Rounding of a 3x3 determinant of rounded differences is below this times its permanent: (7 + 56u)u with u = 2^-53
/// (Shewchuk 1997, section 4.3), rounded up.
const DETERMINANT_ERROR: f64 = 1e-15;

/// A permanent below this may hide an underflow.
const PERMANENT_MIN: f64 = 1e-280;

/// Whether p lies on the side of the plane (a, b, c) from which they run clockwise, or on the other; `None` when rounding may
/// decide it.
pub(super) fn side(a: DVec3, b: DVec3, c: DVec3, p: DVec3) -> Option<bool> {
    let (a, b, c) = (a - p, b - p, c - p);
    let det = a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
    let (a, b, c) = (a.abs(), b.abs(), c.abs());
    let permanent =
        a.x * (b.y * c.z + b.z * c.y) + a.y * (b.z * c.x + b.x * c.z) + a.z * (b.x * c.y + b.y * c.x);
    (permanent > PERMANENT_MIN && det.abs() > DETERMINANT_ERROR * permanent).then_some(det > 0.0)
}
