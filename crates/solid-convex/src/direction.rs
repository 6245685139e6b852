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
