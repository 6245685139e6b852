use core::ops::{Add, Neg, Sub};

use glam::DVec3;

use super::Dyadic;

/// A vector that was never rounded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ExactVec3(pub(crate) [Dyadic; 3]);

impl ExactVec3 {
    pub(crate) fn from_f64(v: DVec3) -> Self {
        Self(v.to_array().map(Dyadic::from_f64))
    }

    pub(crate) fn is_zero(&self) -> bool {
        self.0.iter().all(Dyadic::is_zero)
    }

    pub(crate) fn dot(&self, other: &Self) -> Dyadic {
        let [a, b, c] = [0, 1, 2].map(|i| &self.0[i] * &other.0[i]);
        &(&a + &b) + &c
    }

    pub(crate) fn length_squared(&self) -> Dyadic {
        self.dot(self)
    }

    pub(crate) fn cross(&self, other: &Self) -> Self {
        let ([ax, ay, az], [bx, by, bz]) = (&self.0, &other.0);
        Self([
            &(ay * bz) - &(az * by), //
            &(az * bx) - &(ax * bz),
            &(ax * by) - &(ay * bx),
        ])
    }

    pub(crate) fn scaled_by(&self, factor: &Dyadic) -> Self {
        Self([0, 1, 2].map(|i| &self.0[i] * factor))
    }

    /// The vector times the power of two that makes its greatest coordinate lie in [1/2, 1).
    pub(crate) fn normalised(&self) -> Self {
        let magnitude = self.0.iter().filter_map(Dyadic::magnitude).max().unwrap_or(0);
        Self([0, 1, 2].map(|i| self.0[i].scaled(-magnitude)))
    }

    /// The vector rounded to `f64`, within an ulp a coordinate.
    pub(crate) fn rounded(&self) -> DVec3 {
        DVec3::from_array([0, 1, 2].map(|i| self.0[i].round_down()))
    }
}

impl Add for &ExactVec3 {
    type Output = ExactVec3;
    fn add(self, other: &ExactVec3) -> ExactVec3 {
        ExactVec3([0, 1, 2].map(|i| &self.0[i] + &other.0[i]))
    }
}

impl Sub for &ExactVec3 {
    type Output = ExactVec3;
    fn sub(self, other: &ExactVec3) -> ExactVec3 {
        ExactVec3([0, 1, 2].map(|i| &self.0[i] - &other.0[i]))
    }
}

impl Neg for &ExactVec3 {
    type Output = ExactVec3;
    fn neg(self) -> ExactVec3 {
        ExactVec3([0, 1, 2].map(|i| -&self.0[i]))
    }
}
