//! What sizes a shape may have.

use std::fmt;

/// The largest magnitude of a coordinate, a size or an entry of a placement, in its own unit.
///
/// Products of a placement and a coordinate then stay below 1e200, so that no sum overflows before it is scaled.
pub const MAGNITUDE_MAX: f64 = 1e100;

/// The least size of a shape, in its own unit: products of three sizes still do not vanish.
pub const MAGNITUDE_MIN: f64 = 1e-100;

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
        write!(f, "{argument} is {value}; it must be from {MAGNITUDE_MIN:e} to {MAGNITUDE_MAX:e}")
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
