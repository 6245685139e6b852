use solid3d::glam::DVec3;

/// The control points of a bicubic patch.
pub type Patch = [[DVec3; 4]; 4];

/// The point of a patch at (u, v) in the unit square; at a corner the control point itself.
pub fn point(patch: &Patch, u: f64, v: f64) -> DVec3 {
    cubic(patch.map(|row| cubic(row, v)), u)
}

/// De Casteljau's algorithm, exact at the ends and where control points are the same.
fn cubic([p, q, r, s]: [DVec3; 4], t: f64) -> DVec3 {
    let between = |a: DVec3, b: DVec3| if t < 0.5 { a + (b - a) * t } else { b - (b - a) * (1.0 - t) };
    let (pq, qr, rs) = (between(p, q), between(q, r), between(r, s));
    between(between(pq, qr), between(qr, rs))
}
