use core::cmp::Ordering;
use core::ops::{Add, Mul, Neg, Sub};

use dashu_int::ops::{BitTest, SquareRoot};
use dashu_int::{IBig, UBig};

/// Bits kept by the roots and quotients that cannot be exact.
const INEXACT_BITS: usize = 192;

/// `mantissa * 2^exponent`: the ring every finite `f64` lives in, closed under `+`, `-` and `*`, without gcds.
#[derive(Clone, Debug)]
pub(crate) struct Dyadic {
    mantissa: IBig,
    exponent: i32,
}

impl Dyadic {
    pub(crate) const ZERO: Self = Self { mantissa: IBig::ZERO, exponent: 0 };

    /// # Panics
    /// When `value` is infinite or not a number.
    pub(crate) fn from_f64(value: f64) -> Self {
        assert!(value.is_finite(), "the oracle takes finite numbers only, not {value}");
        if value == 0.0 {
            return Self::ZERO;
        }
        let bits = value.to_bits();
        let biased = ((bits >> 52) & 0x7ff) as i32;
        let fraction = (bits & ((1 << 52) - 1)) as i64;
        let (mantissa, exponent) =
            if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
        let zeros = mantissa.trailing_zeros();
        let mantissa = (mantissa >> zeros) * if value < 0.0 { -1 } else { 1 };
        Self { mantissa: IBig::from(mantissa), exponent: exponent + zeros as i32 }
    }

    pub(crate) fn from_integer(mantissa: IBig) -> Self {
        Self { mantissa, exponent: 0 }
    }

    /// The integer `self / 2^exponent`; `exponent` must not exceed that of the number.
    pub(crate) fn to_integer(&self, exponent: i32) -> IBig {
        if self.is_zero() {
            return IBig::ZERO;
        }
        &self.mantissa
            << usize::try_from(self.exponent - exponent).expect("a common exponent is the least one")
    }

    /// The exponent of the last bit, `None` for zero.
    pub(crate) fn last_exponent(&self) -> Option<i32> {
        (!self.is_zero()).then_some(self.exponent)
    }

    /// The least `e` with `|self| < 2^e`, `None` for zero.
    pub(crate) fn magnitude(&self) -> Option<i32> {
        (!self.is_zero()).then(|| self.exponent + self.mantissa.bit_len() as i32)
    }

    pub(crate) fn is_zero(&self) -> bool {
        self.mantissa == IBig::ZERO
    }

    /// -1, 0 or 1.
    pub(crate) fn sign(&self) -> i32 {
        match self.mantissa.cmp(&IBig::ZERO) {
            Ordering::Less => -1,
            Ordering::Equal => 0,
            Ordering::Greater => 1,
        }
    }

    pub(crate) fn abs(&self) -> Self {
        if self.sign() < 0 { -self } else { self.clone() }
    }

    pub(crate) fn square(&self) -> Self {
        self * self
    }

    /// `self * 2^power`.
    pub(crate) fn scaled(&self, power: i32) -> Self {
        Self { mantissa: self.mantissa.clone(), exponent: self.exponent + power }
    }

    /// The greatest `f64` not above the number (minus infinity below the range of `f64`).
    pub(crate) fn round_down(&self) -> f64 {
        if self.is_zero() {
            return 0.0;
        }
        let length = self.mantissa.bit_len() as i32;
        let shift = (length - 53).max(-1074 - self.exponent).max(0);
        let top = if shift as usize > length as usize + 1 {
            if self.sign() < 0 { -1 } else { 0 }
        } else {
            i64::try_from(floor_shift(&self.mantissa, shift as usize)).expect("at most 54 bits are left")
        };
        let result = times_power_of_two(top as f64, self.exponent + shift);
        if result == f64::INFINITY { f64::MAX } else { result }
    }

    /// The least `f64` not below the number.
    #[cfg(test)]
    pub(crate) fn round_up(&self) -> f64 {
        -(-self).round_down()
    }

    /// A number not below the root of `self >= 0`, exact for squares, otherwise within a relative 2^-190.
    pub(crate) fn sqrt_up(&self) -> Self {
        let (root, exact) = self.sqrt_floor();
        if exact { root } else { Self { mantissa: root.mantissa + IBig::ONE, exponent: root.exponent } }
    }

    /// A number not above the root of `self >= 0`, exact for squares, otherwise within a relative 2^-190.
    pub(crate) fn sqrt_down(&self) -> Self {
        self.sqrt_floor().0
    }

    fn sqrt_floor(&self) -> (Self, bool) {
        debug_assert!(self.sign() >= 0);
        if self.is_zero() {
            return (Self::ZERO, true);
        }
        let length = self.mantissa.bit_len();
        let mut shift = (2 * INEXACT_BITS).saturating_sub(length);
        if (self.exponent - shift as i32) % 2 != 0 {
            shift += 1;
        }
        let radicand: UBig =
            UBig::try_from(&self.mantissa << shift).expect("the root is asked of non-negative numbers only");
        let root = radicand.sqrt();
        let exact = &root * &root == radicand;
        (Self { mantissa: IBig::from(root), exponent: (self.exponent - shift as i32) / 2 }, exact)
    }

    /// A lower bound of `self / divisor` for `divisor > 0`, within a relative 2^-190.
    pub(crate) fn div_down(&self, divisor: &Self) -> Self {
        debug_assert!(divisor.sign() > 0);
        if self.is_zero() {
            return Self::ZERO;
        }
        let shift = (INEXACT_BITS + divisor.mantissa.bit_len()).saturating_sub(self.mantissa.bit_len());
        let dividend = &self.mantissa << shift;
        let quotient = &dividend / &divisor.mantissa;
        let below = &quotient * &divisor.mantissa > dividend;
        let mantissa = if below { quotient - IBig::ONE } else { quotient };
        Self { mantissa, exponent: self.exponent - divisor.exponent - shift as i32 }
    }
}

/// `floor(value / 2^shift)`, whatever the convention of `>>` on negative numbers.
fn floor_shift(value: &IBig, shift: usize) -> IBig {
    let quotient = value >> shift;
    if (&quotient << shift) > *value { quotient - IBig::ONE } else { quotient }
}

/// `value * 2^power`, in two steps because `2^power` alone may leave the range of `f64`.
fn times_power_of_two(value: f64, power: i32) -> f64 {
    let half = power.clamp(-2000, 2000) / 2;
    value * 2f64.powi(half) * 2f64.powi(power.clamp(-2000, 2000) - half)
}

fn aligned(a: &Dyadic, b: &Dyadic) -> (IBig, IBig, i32) {
    let exponent = a.exponent.min(b.exponent);
    let lift = |x: &Dyadic| &x.mantissa << (x.exponent - exponent) as usize;
    (lift(a), lift(b), exponent)
}

impl Add for &Dyadic {
    type Output = Dyadic;
    fn add(self, other: &Dyadic) -> Dyadic {
        if self.is_zero() {
            return other.clone();
        }
        if other.is_zero() {
            return self.clone();
        }
        let (a, b, exponent) = aligned(self, other);
        Dyadic { mantissa: a + b, exponent }
    }
}

impl Sub for &Dyadic {
    type Output = Dyadic;
    fn sub(self, other: &Dyadic) -> Dyadic {
        self + &-other
    }
}

impl Mul for &Dyadic {
    type Output = Dyadic;
    fn mul(self, other: &Dyadic) -> Dyadic {
        if self.is_zero() || other.is_zero() {
            return Dyadic::ZERO;
        }
        Dyadic { mantissa: &self.mantissa * &other.mantissa, exponent: self.exponent + other.exponent }
    }
}

impl Neg for &Dyadic {
    type Output = Dyadic;
    fn neg(self) -> Dyadic {
        Dyadic { mantissa: -&self.mantissa, exponent: self.exponent }
    }
}

impl PartialEq for Dyadic {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Dyadic {}

impl PartialOrd for Dyadic {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Dyadic {
    fn cmp(&self, other: &Self) -> Ordering {
        match (self.sign(), other.sign()) {
            (a, b) if a != b => a.cmp(&b),
            _ => {
                let (a, b, _) = aligned(self, other);
                a.cmp(&b)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact(x: f64) -> Dyadic {
        Dyadic::from_f64(x)
    }

    #[test]
    fn doubles_survive_the_round_trip() {
        for x in [0.0, 1.0, -1.5, 1e-300, 5e-324, -5e-324, f64::MAX, 0.1, -1e17] {
            assert_eq!(exact(x).round_down(), x);
            assert_eq!(exact(x).round_up(), x);
        }
    }

    #[test]
    fn rounding_brackets_the_number() {
        for x in [1.0, -1.0] {
            let y = &exact(x) + &exact(1e-30);
            assert!(exact(y.round_down()) < y && exact(y.round_up()) > y);
            assert_eq!(y.round_down().to_bits().abs_diff(y.round_up().to_bits()), 1);
        }
        let tiny = exact(-5e-324).scaled(-500);
        assert_eq!((tiny.round_down(), tiny.round_up()), (-5e-324, -0.0));
    }

    #[test]
    fn roots_and_quotients_are_bounded_from_the_proper_side() {
        assert_eq!(exact(9.0 / 16.0).sqrt_up(), exact(0.75));
        let (low, high) = (exact(2.0).sqrt_down(), exact(2.0).sqrt_up());
        assert!(low.square() < exact(2.0) && high.square() > exact(2.0));
        assert!((&high - &low).round_up() < 1e-50);
        for x in [1.0, -1.0] {
            let third = exact(x).div_down(&exact(3.0));
            assert!(&third * &exact(3.0) < exact(x));
            assert!((&exact(x) - &(&third * &exact(3.0))).round_up() < 1e-50);
        }
    }
}
