//! Which primitives have no length or area.

use glam::DVec3;

/// A triangle is flat when its area is less than that of a needle this many times as long as wide: single-precision
/// coordinates make a needle of a line up to 2^-24 wide, and a triangle in earnest is wider than 1e-9.
const NEEDLE: f64 = 1e-9;

/// Whether a triangle has no area, up to rounding.
pub(super) fn is_flat([a, b, c]: [DVec3; 3]) -> bool {
    let (u, v, w) = (b - a, c - b, a - c);
    let longest = u.length_squared().max(v.length_squared()).max(w.length_squared());
    u.cross(v).length() <= NEEDLE * longest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn collinear_corners_are_flat_at_any_size() {
        let thirds = [DVec3::ZERO, DVec3::ONE / 3.0, DVec3::ONE];
        assert!(is_flat(thirds));
        assert!(is_flat(thirds.map(|p| 1e-6 * p)));
        assert!(is_flat([DVec3::ONE; 3]));
        assert!(!is_flat([DVec3::ZERO, DVec3::X, 1e-6 * DVec3::Y]));
    }
}
