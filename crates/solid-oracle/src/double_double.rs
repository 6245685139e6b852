//! Numbers of 106 bits as unevaluated sums of two `f64` (Dekker 1971), and vectors of them.

use core::cmp::Ordering;
use core::ops::{Add, Div, Mul, Neg, Sub};

use glam::DVec3;

use crate::exact::{Dyadic, ExactVec3};

/// An unevaluated sum `high + low` with `|low| <= ulp(high)/2`; about 32 decimal digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DoubleDouble {
    high: f64,
    low: f64,
}

/// The exact sum of two numbers (Knuth).
fn two_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    let b_part = high - a;
    DoubleDouble { high, low: (a - (high - b_part)) + (b - b_part) }
}

/// The exact sum when `|a| >= |b|`.
fn quick_two_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble { high, low: b - (high - a) }
}

/// The two halves of a number, each of at most 26 bits (Veltkamp).
fn split(a: f64) -> (f64, f64) {
    const SPLITTER: f64 = 134_217_729.0;
    let t = SPLITTER * a;
    let high = t - (t - a);
    (high, a - high)
}

/// The exact product of two numbers (Dekker).
fn two_product(a: f64, b: f64) -> DoubleDouble {
    let high = a * b;
    let ((a1, a2), (b1, b2)) = (split(a), split(b));
    DoubleDouble { high, low: ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2 }
}

impl DoubleDouble {
    pub(crate) const ZERO: Self = Self { high: 0.0, low: 0.0 };
    pub(crate) const ONE: Self = Self { high: 1.0, low: 0.0 };

    pub(crate) fn new(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }

    /// The nearest `f64`.
    pub(crate) fn to_f64(self) -> f64 {
        self.high
    }

    /// The number rounded to about 106 bits.
    pub(crate) fn from_exact(value: &Dyadic) -> Self {
        let high = value.round_down();
        let low = (value - &Dyadic::from_f64(high)).round_down();
        quick_two_sum(high, low)
    }

    pub(crate) fn to_exact(self) -> Dyadic {
        &Dyadic::from_f64(self.high) + &Dyadic::from_f64(self.low)
    }

    pub(crate) fn is_zero(self) -> bool {
        self.high == 0.0
    }

    pub(crate) fn is_negative(self) -> bool {
        self.high < 0.0
    }

    pub(crate) fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::ZERO;
        }
        let root = Self::new(self.high.sqrt());
        // One Newton step doubles the digits.
        root + (self - root * root) / (root + root)
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let s = two_sum(self.high, other.high);
        let t = two_sum(self.low, other.low);
        let s = quick_two_sum(s.high, s.low + t.high);
        quick_two_sum(s.high, s.low + t.low)
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let p = two_product(self.high, other.high);
        quick_two_sum(p.high, p.low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let q1 = self.high / other.high;
        let r = self - other * Self::new(q1);
        let q2 = r.high / other.high;
        let r = r - other * Self::new(q2);
        quick_two_sum(q1, q2) + Self::new(r.high / other.high)
    }
}

impl PartialOrd for DoubleDouble {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        match self.high.partial_cmp(&other.high) {
            Some(Ordering::Equal) => self.low.partial_cmp(&other.low),
            order => order,
        }
    }
}

/// A vector of [`DoubleDouble`]s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Vec3 {
    pub(crate) x: DoubleDouble,
    pub(crate) y: DoubleDouble,
    pub(crate) z: DoubleDouble,
}

impl Vec3 {
    pub(crate) const ZERO: Self =
        Self { x: DoubleDouble::ZERO, y: DoubleDouble::ZERO, z: DoubleDouble::ZERO };

    pub(crate) fn new(x: DoubleDouble, y: DoubleDouble, z: DoubleDouble) -> Self {
        Self { x, y, z }
    }

    pub(crate) fn from_f64(v: DVec3) -> Self {
        Self::new(DoubleDouble::new(v.x), DoubleDouble::new(v.y), DoubleDouble::new(v.z))
    }

    pub(crate) fn to_f64(self) -> DVec3 {
        DVec3::new(self.x.to_f64(), self.y.to_f64(), self.z.to_f64())
    }

    pub(crate) fn from_exact(v: &ExactVec3) -> Self {
        let [x, y, z] = [0, 1, 2].map(|i| DoubleDouble::from_exact(&v.0[i]));
        Self::new(x, y, z)
    }

    pub(crate) fn to_exact(self) -> ExactVec3 {
        ExactVec3([self.x.to_exact(), self.y.to_exact(), self.z.to_exact()])
    }

    pub(crate) fn dot(self, other: Self) -> DoubleDouble {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    pub(crate) fn length_squared(self) -> DoubleDouble {
        self.dot(self)
    }

    pub(crate) fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    pub(crate) fn is_zero(self) -> bool {
        self.x.is_zero() && self.y.is_zero() && self.z.is_zero()
    }
}

impl Add for Vec3 {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl Sub for Vec3 {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl Neg for Vec3 {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

impl Mul<DoubleDouble> for Vec3 {
    type Output = Self;
    fn mul(self, factor: DoubleDouble) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operations_keep_a_hundred_bits() {
        let (a, b) = (
            DoubleDouble::new(1.0) / DoubleDouble::new(3.0),
            DoubleDouble::new(2.0).sqrt() - DoubleDouble::new(1e-20),
        );
        let exact = |x: DoubleDouble| x.to_exact();
        let error = |x: &Dyadic, y: &Dyadic| (x - y).abs().round_up();
        assert!(error(&exact(a + b), &(&exact(a) + &exact(b))) < 1e-31);
        assert!(error(&exact(a * b), &(&exact(a) * &exact(b))) < 1e-31);
        assert!(error(&(&exact(a) * &Dyadic::from_f64(3.0)), &Dyadic::from_f64(1.0)) < 1e-31);
        let root = b.sqrt();
        assert!(error(&exact(root).square(), &exact(b)) < 1e-31);
        assert!((a / b * b - a).to_f64().abs() < 1e-31);
    }
}
