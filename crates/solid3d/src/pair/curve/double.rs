//! Numbers of twice the precision: the unevaluated sum of two `f64` (Dekker, *A floating-point technique for extending the
//! available precision*, 1971). The errors of sums and products are a few 2^-104, relative to the operands.

use std::ops::{Add, Mul, Sub};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Double {
    high: f64,
    low: f64,
}

impl Double {
    /// `a - b`, exactly.
    pub fn difference(a: f64, b: f64) -> Self {
        let (high, low) = two_sum(a, -b);
        Double { high, low }
    }

    /// Rounded.
    pub fn value(self) -> f64 {
        self.high + self.low
    }
}

impl Add for Double {
    type Output = Double;

    fn add(self, other: Double) -> Double {
        let (high, error) = two_sum(self.high, other.high);
        let (low, error_low) = two_sum(self.low, other.low);
        let (high, low) = two_sum(high, error + low);
        let (high, low) = two_sum(high, low + error_low);
        Double { high, low }
    }
}

impl Sub for Double {
    type Output = Double;

    fn sub(self, other: Double) -> Double {
        self + Double { high: -other.high, low: -other.low }
    }
}

impl Mul for Double {
    type Output = Double;

    fn mul(self, other: Double) -> Double {
        let product = self.high * other.high;
        let error = self.high.mul_add(other.high, -product);
        let (high, low) = two_sum(product, error + (self.high * other.low + self.low * other.high));
        Double { high, low }
    }
}

/// The rounded sum, and its error.
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let rounded_b = sum - a;
    (sum, (a - (sum - rounded_b)) + (b - rounded_b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_f64_loses_is_kept() {
        let (big, small) = (1.0, 2f64.powi(-80));
        let sum = Double::difference(big, -small);
        assert_eq!((sum - Double::difference(big, 0.0)).value(), small);
        // (1 + s)^2 - 1 - 2 s = s^2 is beyond twice the precision, (1 + r)^2 - 1 - 2 r is not.
        let root = Double::difference(1.0, -2f64.powi(-50));
        let rest = root * root - Double::difference(1.0, -2f64.powi(-49));
        assert_eq!(rest.value(), 2f64.powi(-100));
    }
}
