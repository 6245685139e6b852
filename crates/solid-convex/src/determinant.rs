//! Determinants of which cancelling takes no digits.

/// `a * b - c * d`, off by at most 1.5 units in the last place, so that its sign is exact (Kahan's algorithm; Jeannerod, Louvet and
/// Muller, *Further analysis of Kahan's algorithm for the accurate computation of 2 x 2 determinants*, 2013).
pub fn difference_of_products(a: f64, b: f64, c: f64, d: f64) -> f64 {
    let subtracted = c * d;
    let rounding = (-c).mul_add(d, subtracted);
    a.mul_add(b, -subtracted) + rounding
}
