//! What sizes a shape may have.

use std::fmt;
use std::ops::RangeInclusive;

/// The largest magnitude of a coordinate, a size or an entry of a placement, in its own unit.
///
/// Products of a placement and a coordinate then stay below 1e200, so that no sum overflows before it is scaled.
pub const MAGNITUDE_MAX: f64 = 1e100;

/// The least size of a shape, in its own unit: products of three sizes still do not vanish.
pub const MAGNITUDE_MIN: f64 = 1e-100;

/// Squares of lengths that lose no digits.
pub(crate) const PLAIN: RangeInclusive<f64> = 1e-200..=1e200;

/// Squares of scales that are plain: no product of a few of them overflows or loses digits.
pub(crate) const PLAIN_SQUARES: RangeInclusive<f64> = 1e-60..=1e60;

/// Squares of scales that are within the limits of placements, and lose no digits.
pub(crate) const REGULAR_SQUARES: RangeInclusive<f64> = 1e-199..=1e199;

/// A size that no shape can have.
#[derive(Clone, Debug, PartialEq)]
pub struct SizeError {
    /// The argument's name.
    pub argument: &'static str,
    /// The value it had.
    pub value: f64,
}

impl fmt::Display for SizeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let SizeError { argument, value } = self;
        write!(f, "{argument} is {value:?}; it must be from {MAGNITUDE_MIN:e} to {MAGNITUDE_MAX:e}")
    }
}

impl std::error::Error for SizeError {}

/// `value` when it is in range.
pub(crate) fn positive(argument: &'static str, value: f64) -> Result<f64, SizeError> {
    if (MAGNITUDE_MIN..=MAGNITUDE_MAX).contains(&value) {
        Ok(value)
    } else {
        Err(SizeError { argument, value })
    }
}

/// The power of two that takes `size` to [1, 2), and 1 for size 0: multiplying by it loses nothing.
///
/// Whatever is scaled by it first can be computed with neither overflow nor underflow, and with the same digits in any
/// unit of length. `size` must be at least 0 and below 2^1023; below 2^-1000 it counts as that.
///
/// ```
/// assert_eq!(solid_convex::unit_scale(1000.0), 1.0 / 512.0);
/// ```
#[inline]
pub fn unit_scale(size: f64) -> f64 {
    if size == 0.0 {
        return 1.0;
    }
    let exponent = ((size.to_bits() >> 52) & 0x7ff) as i64 - 1023;
    let power = (-exponent).clamp(-1022, 1000);
    f64::from_bits(((1023 + power) as u64) << 52)
}
