//! Placements: affine maps from an object's space to the world.

use std::ops::RangeInclusive;

use fearless_simd::{Simd, f64x2, prelude::*};
use glam::{DAffine3, DMat3, DVec3};
pub(crate) use solid_convex::direction::{direction, length, length_and_direction};
use solid_convex::simd::dispatch;
use solid_convex::{MAGNITUDE_MAX, MAGNITUDE_MIN, unit_scale};

use crate::bounds::abs;
use crate::error::{Error, Result};

/// A placement whose axes, brought to unit length, span less than this volume is singular: the inverse would have no
/// correct digits left. A uniform or non-uniform scale alone has volume 1, however small it is, down to the least size:
/// the inverse of what is shorter overflows.
const VOLUME_MIN: f64 = 1e-12;

/// The placement itself when it can be used: finite, in range, and not singular.
#[inline]
pub(crate) fn checked<'a>(argument: &'static str, placement: &'a DAffine3) -> Result<&'a DAffine3> {
    if dispatch!(simd => is_plainly_good(simd, placement)) {
        Ok(placement)
    } else {
        checked_at_length(argument, placement)
    }
}

#[inline(never)]
fn checked_at_length<'a>(argument: &'static str, placement: &'a DAffine3) -> Result<&'a DAffine3> {
    let out_of_range = |x: &f64| !x.is_finite() || x.abs() > MAGNITUDE_MAX;
    if let Some(value) = placement.to_cols_array().into_iter().find(out_of_range) {
        return Err(Error::PlacementEntry { argument, value });
    }
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = placement.matrix3;
    let is_long = |axis: &DVec3| axis.abs().max_element() >= MAGNITUDE_MIN;
    let flat = match [x, y, z].map(|axis| Some(axis).filter(is_long).and_then(direction)) {
        [Some(x), Some(y), Some(z)] => x.cross(y).dot(z).abs() < VOLUME_MIN,
        _ => true,
    };
    if flat { Err(Error::SingularPlacement { argument, x, y, z }) } else { Ok(placement) }
}

/// Whether two placements are the same to the bit, of zeros too.
#[inline]
pub(crate) fn is_same(a: &DAffine3, b: &DAffine3) -> bool {
    let differ = |a: DVec3, b: DVec3| {
        (a.x.to_bits() ^ b.x.to_bits()) | (a.y.to_bits() ^ b.y.to_bits()) | (a.z.to_bits() ^ b.z.to_bits())
    };
    let (of_a, of_b) = (&a.matrix3, &b.matrix3);
    let linear = differ(of_a.x_axis, of_b.x_axis)
        | differ(of_a.y_axis, of_b.y_axis)
        | differ(of_a.z_axis, of_b.z_axis);
    linear | differ(a.translation, b.translation) == 0
}

/// Whether a placement is so ordinary that a few products show it to be good: a third of the time.
///
/// It is read by pairs of numbers from its beginning, as it was last written where it was handed over as a copy: what is written so and read in
/// other pairs is waited for.
#[inline(always)]
pub(crate) fn is_plainly_good<S: Simd>(simd: S, DAffine3 { matrix3, translation }: &DAffine3) -> bool {
    /// Sums of the squares of all entries between which no product below overflows or loses digits. Where the volume is plain too, no axis
    /// is shorter than a billionth of the longest.
    const PLAIN_SQUARES: RangeInclusive<f64> = 1e-40..=1e40;
    /// Far above the square of `VOLUME_MIN`, by more than the rounding errors of the products. The sum of the squares of three lengths is no less
    /// than the root, of the third degree, of their product.
    const PLAIN_VOLUME_SQUARED: f64 = 1e-18;
    let columns: &[f64; 9] = matrix3.as_ref();
    let pair = |first: usize| f64x2::from_slice(simd, &columns[first..first + 2]);
    // x_axis = (a0, a1, b0), y_axis = (b1, c0, c1), z_axis = (d0, d1, e).
    let [a, b, c, d] = [pair(0), pair(2), pair(4), pair(6)];
    let e = columns[8];
    let sums = a * a + b * b + (c * c + d * d);
    let squares = sums.as_slice()[0] + sums.as_slice()[1] + e * e;
    let (a, b, c, d) = (a.as_slice(), b.as_slice(), c.as_slice(), d.as_slice());
    let volume = a[0] * (c[0] * e - c[1] * d[1])
        + a[1] * (c[1] * d[0] - b[1] * e)
        + b[0] * (b[1] * d[1] - c[0] * d[0]);
    // No branches; all is false of what is no number.
    PLAIN_SQUARES.contains(&squares)
        & (volume * volume > PLAIN_VOLUME_SQUARED * (squares * squares * squares))
        & (translation.length_squared() <= MAGNITUDE_MAX * MAGNITUDE_MAX)
}

/// The inverse of a checked placement's linear part. Axes of very different length do it no harm.
#[inline(always)]
pub(crate) fn inverse_linear(linear: &DMat3) -> DMat3 {
    // Most of what stays in its place is not turned either.
    if *linear == DMat3::IDENTITY {
        return DMat3::IDENTITY;
    }
    let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis].map(|axis| axis.abs().max_element());
    if x.min(y).min(z) >= PLAIN_LENGTH_MIN && x.max(y).max(z) <= PLAIN_LENGTH_MAX {
        return linear.inverse();
    }
    scaled_inverse(linear)
}

/// The lengths of axes between which no product of the inverse overflows, nor loses digits but those of entries below some 1e-200, which are nothing beside
/// the length of their axis: it then has the same bits without scaling.
const PLAIN_LENGTH_MIN: f64 = 1e-30;
const PLAIN_LENGTH_MAX: f64 = 1e30;

/// The inverse by axes of about unit length.
#[inline(never)]
fn scaled_inverse(linear: &DMat3) -> DMat3 {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = *linear;
    // With L = U D, D powers of two near the lengths of the axes, by which all products are exact: L^-1 = D^-1 U^-1.
    let [a, b, c] = [x, y, z].map(|axis| unit_scale(axis.abs().max_element()));
    let unit = DMat3::from_cols(x * a, y * b, z * c).inverse();
    let rows = unit.transpose();
    DMat3::from_cols(rows.x_axis * a, rows.y_axis * b, rows.z_axis * c).transpose()
}

/// The largest sum of magnitudes over a row: a bound on how much the map stretches the largest coordinate.
#[inline(always)]
pub(crate) fn row_norm(linear: &DMat3) -> f64 {
    (abs(linear) * DVec3::ONE).max_element()
}

#[cfg(test)]
mod tests {
    use rand::Rng;
    use solid_convex::simd::levels;
    use solid_oracle::generate::seeded;

    use super::*;

    /// On every level, which must say the same.
    fn is_plain(placement: &DAffine3) -> bool {
        let [scalar, wide] = levels().map(|level| dispatch!(level, simd => is_plainly_good(simd, placement)));
        assert_eq!(scalar, wide, "{placement}");
        scalar
    }

    #[test]
    fn scales_alone_are_never_singular() {
        for scale in [1e-100, 1e-30, 1.0, 1e100] {
            let placement = DAffine3::from_scale(DVec3::new(scale, 1.0, -1e-100));
            assert!(checked("placement", &placement).is_ok(), "{scale}");
            let product = placement.matrix3 * inverse_linear(&placement.matrix3);
            assert!(product.abs_diff_eq(DMat3::IDENTITY, 1e-15), "{product}");
        }
    }

    /// Law: what spans a little more than the least volume is good at any size, and so is its inverse; what spans a little less is singular.
    #[test]
    fn nearly_flat_placements_have_an_inverse() {
        for scale in [1e-100, 1e-60, 1.0, 1e60, 1e100] {
            let slanted =
                |height| DAffine3::from_cols(DVec3::X, DVec3::Y, DVec3::new(1.0, 0.0, height), DVec3::ZERO);
            let placement = |height| DAffine3::from_mat3(slanted(height).matrix3 * scale);
            let [good, flat] = [1.1e-12, 0.9e-12].map(placement);
            assert!(checked("placement", &good).is_ok(), "{scale}");
            assert!(matches!(checked("placement", &flat), Err(Error::SingularPlacement { .. })), "{scale}");
            let product = good.matrix3 * inverse_linear(&good.matrix3);
            assert!(product.abs_diff_eq(DMat3::IDENTITY, 1e-15), "{scale}: {product}");
        }
    }

    /// Law: of axes of ordinary lengths the inverse has the same bits with and without scaling.
    #[test]
    fn scaling_changes_no_bit_of_an_inverse() {
        let mut rng = seeded(815);
        for case in 0..10_000 {
            let mut axis = || {
                let size = 10f64.powi(if case % 2 == 0 { 0 } else { rng.random_range(-28..=28) });
                size * DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)))
            };
            let linear = DMat3::from_cols(axis(), axis(), axis());
            assert_eq!(inverse_linear(&linear), scaled_inverse(&linear), "{linear}");
        }
    }

    /// Law: what is plainly good is good by the longer look too; and most of what is ordinary is plainly good.
    #[test]
    fn what_is_plainly_good_is_good() {
        let mut rng = seeded(814);
        let (mut plain, mut good, cases) = (0, 0, 10_000);
        for case in 0..cases {
            let mut axis = || DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)));
            let (x, y, to) = (axis(), axis(), axis());
            // In half of the cases the third axis is nearly in the plane of the others, in some nearly as far as may be.
            let flatness = 10f64.powi(-(case % 16));
            let z = if case % 2 == 0 { axis() } else { x - y + flatness * axis() };
            let scales = [1.0, 1e-19, 1e-21, 1e19, 1e21, 1e-90, 1e90, 0.0];
            let mut scale = || scales[rng.random_range(0..4 * scales.len()).saturating_sub(3 * scales.len())];
            let placement =
                DAffine3::from_cols(x * scale(), y * scale(), z * scale(), to * scale() * scale());
            let is_good = checked_at_length("placement", &placement).is_ok();
            assert!(is_good || !is_plain(&placement), "{placement}");
            good += usize::from(is_good);
            plain += usize::from(is_plain(&placement));
        }
        assert!(3 * cases < 10 * good as i32 && 10 * good as i32 <= 9 * cases, "{good} of {cases} are good");
        assert!(3 * plain > good && plain < good, "{plain} of {good} are plainly good");
    }

    #[test]
    fn flat_and_wild_placements_are_refused() {
        let flat = DAffine3::from_cols(DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 0.0), DVec3::ZERO);
        assert!(matches!(checked("placement", &flat), Err(Error::SingularPlacement { .. })));
        for short in [0.0, 5e-324, 9e-101] {
            let placement = DAffine3::from_scale(DVec3::new(1.0, short, 1.0));
            assert!(
                matches!(checked("placement", &placement), Err(Error::SingularPlacement { .. })),
                "{short}"
            );
        }
        for bad in [f64::NAN, f64::INFINITY, 1e101] {
            let placement = DAffine3::from_translation(DVec3::new(0.0, bad, 0.0));
            assert!(matches!(checked("placement", &placement), Err(Error::PlacementEntry { .. })));
        }
    }
}
