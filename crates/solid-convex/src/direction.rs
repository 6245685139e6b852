//! The directions of vectors of any length.

use glam::DVec3;

use crate::size::PLAIN;

/// The length of a vector, without overflow or underflow on the way: a `hypot`, which not all machines find to the same digits.
#[inline(always)]
pub fn length(v: DVec3) -> f64 {
    length_and_direction(v).map_or(0.0, |(length, _)| length)
}

/// The unit vector along a vector of any length; `None` for zero.
pub fn direction(v: DVec3) -> Option<DVec3> {
    length_and_direction(v).map(|(_, direction)| direction)
}

/// The same of one that is mostly a unit vector already, but for rounding: of that without a root and a quotient, which take longer than all else.
///
/// A step of Newton's method for the inverse of the root: of a square that is off by e it leaves 3/8 of e squared.
#[inline(always)]
pub fn direction_of_nearly_unit(v: DVec3) -> Option<DVec3> {
    /// Its square is far below the last digit.
    const OFF_MAX: f64 = 1e-9;
    let square = v.length_squared();
    if (square - 1.0).abs() <= OFF_MAX { Some(v * (1.5 - 0.5 * square)) } else { direction(v) }
}

/// The length of a vector, and the unit vector along it, without overflow or underflow on the way; `None` for zero.
#[inline(always)]
pub fn length_and_direction(v: DVec3) -> Option<(f64, DVec3)> {
    let square = v.length_squared();
    if PLAIN.contains(&square) {
        let length = square.sqrt();
        return Some((length, v / length));
    }
    scaled_length_and_direction(v)
}

/// The same by the largest coordinate.
#[cold]
fn scaled_length_and_direction(v: DVec3) -> Option<(f64, DVec3)> {
    let largest = v.abs().max_element();
    let (unit, length) = (largest > 0.0).then(|| (v / largest).normalize_and_length())?;
    Some((length * largest, unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: what is nearly a unit vector has the direction that it has by its length, up to a rounding or two.
    #[test]
    fn nearly_unit_vectors_have_their_directions() {
        for i in 0..1000 {
            let unit = DVec3::new(f64::from(i % 10) - 4.5, f64::from(i / 10 % 10) - 4.5, 1.0).normalize();
            let v = unit * (1.0 + f64::from(i - 500) * 2e-12);
            let (found, expected) = (direction_of_nearly_unit(v).unwrap(), direction(v).unwrap());
            assert!((found - expected).abs().max_element() <= 2.0 * f64::EPSILON, "{v}: {found}, {expected}");
        }
        for v in [DVec3::X * 3.0, DVec3::Y * 1e-200, DVec3::ZERO] {
            assert_eq!(direction_of_nearly_unit(v), direction(v));
        }
    }

    #[test]
    fn directions_are_unit_vectors_at_any_length() {
        for exponent in (-323..=307).map(f64::from) {
            let v = DVec3::new(1.0, -2.0, 3.0) * 10f64.powf(exponent);
            let (length, unit) = length_and_direction(v).unwrap();
            assert!((unit.length() - 1.0).abs() < 1e-15 && length > 0.0, "1e{exponent}: {unit}");
        }
        assert_eq!(direction(DVec3::ZERO), None);
        assert_eq!(direction(DVec3::NAN), None);
    }
}
