//! The normal of a triangle.

use glam::DVec3;
use solid_convex::unit_scale;

/// The unit normal of a triangle; `None` for one without area.
pub fn triangle_normal([p, q, r]: [DVec3; 3]) -> Option<DVec3> {
    /// The square of twice the least area whose squares lose no digits.
    const PLAIN_MIN: f64 = 1e-200;
    let (u, v) = (q - p, r - p);
    if u.cross(v).length_squared() >= PLAIN_MIN { normal_across(u, v) } else { scaled_normal_across(u, v) }
}

/// The same in a unit of its own, where squares of its area do not vanish: the other shape may be any number of times as large.
#[cold]
fn scaled_normal_across(u: DVec3, v: DVec3) -> Option<DVec3> {
    let unit = unit_scale(u.abs().max(v.abs()).max_element());
    normal_across(u * unit, v * unit)
}

/// The unit normal of a triangle by two of its edges.
#[inline(always)]
fn normal_across(u: DVec3, v: DVec3) -> Option<DVec3> {
    /// The sine of the least angle at a corner beyond which the normal has no digits.
    const SINE_MIN: f64 = 1e-12;
    let cross = u.cross(v);
    let area = cross.length();
    let longest = u.length_squared().max(v.length_squared()).max((v - u).length_squared());
    (area > SINE_MIN * longest).then(|| cross / area)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle may be any number of times smaller than the pair that the frame is around.
    #[test]
    fn a_triangle_of_any_size_has_a_unit_normal() {
        for exponent in (-200..=0).step_by(3) {
            let corners = [[1.0, 2.0, 3.0], [2.5, -1.0, 0.5], [-0.5, 1.5, -2.0]];
            let corners = corners.map(|p| DVec3::from_array(p) * 10f64.powi(exponent));
            let normal = triangle_normal(corners).expect("it has an area");
            assert!((normal.length() - 1.0).abs() < 1e-14, "1e{exponent}: {normal}");
            let [p, q, r] = corners.map(|corner| corner * 10f64.powi(-exponent));
            assert!(
                normal.dot(q - p).abs() < 1e-12 && normal.dot(r - p).abs() < 1e-12,
                "1e{exponent}: {normal}"
            );
        }
    }
}
