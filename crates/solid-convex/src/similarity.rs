//! Placements that turn and scale alike in all directions: known nearly, by two numbers, or closely, of two at once, by wide instructions.

use std::ops::RangeInclusive;

use fearless_simd::{Simd, f64x2, f64x4, mask64x4, prelude::*};
use glam::{DAffine3, DVec3};

use crate::MAGNITUDE_MAX;
use crate::size::{PLAIN_SQUARES, REGULAR_SQUARES};

/// How far the scalar products of a placement's rows, or columns, relative to their squared length, may be from those of
/// perpendicular ones of equal length. Products of a dozen rotations in f64 are within it. By Gershgorin's circles what it lets through
/// changes no length by more than one and a half of it, when it is asked of rows, and no less of columns.
pub const SKEW_MAX: f64 = 256.0 / (1u64 << 53) as f64;

/// How much less the squared volume of a placement may be than the cube of its mean squared stretch, relative to that, to be taken for nearly a similarity:
/// some hundred times the rounding error of the two.
const VOLUME_LOSS_MAX: f64 = 1e-13;

/// Added to the squared volume that is asked for: nothing, to one whose products are far from losing digits. Placements with scales below 1e-42 are refused
/// by it; those above 1e51 are where the cube overflows, since nothing is more than that.
const SQUARED_VOLUME_MIN: f64 = 1e-270;

/// Of what is nearly a similarity, no stretch differs by more than this part from the scale. Let the squares of the stretches be `f (1 + e)`, where `f` is their
/// mean: if one `e` is given, their product, which is the squared volume, is at most `f^3 (1 - 3/4 e^2 + 1/4 |e|^3)`, where the two others are
/// equal. So `e^2` is at most twice the loss, and half of `e` 2.3e-7.
pub const STRETCH_ERROR: f64 = 3e-7;

/// The squares of the scales of two placements of plain sizes that nearly are similarities: good placements. `None` unless both are.
///
/// A lane for each, since what is done for one is done for the other. The sum of the squares of all entries is three times the mean squared stretch.
#[inline(always)]
pub fn rough_squares<S: Simd>(simd: S, [a, b]: [&DAffine3; 2]) -> Option<[f64; 2]> {
    /// The square of what has coordinates below the greatest allowed.
    const SQUARE_MAX: f64 = MAGNITUDE_MAX * MAGNITUDE_MAX;
    let (linear_a, linear_b) = (&a.matrix3, &b.matrix3);
    let x = of_both(simd, linear_a.x_axis, linear_b.x_axis);
    let y = of_both(simd, linear_a.y_axis, linear_b.y_axis);
    let z = of_both(simd, linear_a.z_axis, linear_b.z_axis);
    let t = of_both(simd, a.translation, b.translation);
    let normal = [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]];
    let volume = dot(normal, z);
    let sums = dot(x, x) + dot(y, y) + dot(z, z);
    // All is false of what is no number.
    let cube = (sums * sums) * (sums * f64x2::splat(simd, (1.0 - VOLUME_LOSS_MAX) / 27.0));
    let volume_min = cube + f64x2::splat(simd, SQUARED_VOLUME_MIN);
    let good = (volume * volume).simd_gt(volume_min) & dot(t, t).simd_le(f64x2::splat(simd, SQUARE_MAX));
    let squares = sums * f64x2::splat(simd, 1.0 / 3.0);
    good.all_true().then(|| [squares.as_slice()[0], squares.as_slice()[1]])
}

/// The coordinates of two vectors, a lane for each.
#[inline(always)]
fn of_both<S: Simd>(simd: S, a: DVec3, b: DVec3) -> [f64x2<S>; 3] {
    let [x, y, z] = [[a.x, b.x], [a.y, b.y], [a.z, b.z]];
    [f64x2::simd_from(simd, x), f64x2::simd_from(simd, y), f64x2::simd_from(simd, z)]
}

#[inline(always)]
fn dot<S: Simd>(u: [f64x2<S>; 3], v: [f64x2<S>; 3]) -> f64x2<S> {
    u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
}

/// The squares of the scales of two placements that are similarities of plain sizes, and so good placements; `None` unless both are.
#[inline(always)]
pub fn plain_squares<S: Simd>(simd: S, [a, b]: [&DAffine3; 2]) -> Option<[f64; 2]> {
    squares_in(simd, [a, b], &PLAIN_SQUARES)
}

/// The same of any size but next to the limits: squares of scales lose no digits, but products of a few of them may.
#[inline(always)]
pub fn regular_squares<S: Simd>(simd: S, at: [&DAffine3; 2]) -> Option<[f64; 2]> {
    squares_in(simd, at, &REGULAR_SQUARES)
}

#[inline(always)]
fn squares_in<S: Simd>(simd: S, [a, b]: [&DAffine3; 2], range: &RangeInclusive<f64>) -> Option<[f64; 2]> {
    let ((of_a, a_is_good), (of_b, b_is_good)) = (look(simd, a, range), look(simd, b, range));
    all_is_good(a_is_good & b_is_good).then_some([of_a, of_b])
}

/// The square of the scale of one placement, as [`plain_squares`].
#[inline(always)]
pub fn plain_square<S: Simd>(simd: S, at: &DAffine3) -> Option<f64> {
    let (square, is_good) = look(simd, at, &PLAIN_SQUARES);
    all_is_good(is_good).then_some(square)
}

#[inline(always)]
fn all_is_good<S: Simd>(is_good: mask64x4<S>) -> bool {
    // The fourth lane is of no row.
    is_good.to_bitmask() & 0b111 == 0b111
}

/// The square of the scale of a placement, if it is a good one that has a scale, and whether it is: then all is true, but what the fourth lane
/// holds.
///
/// A similarity times its transpose is its squared scale: that takes the sums of products of columns, without any across a vector. The placement
/// is read as it lies, column by column, with the next after each. One mask for all, since single comparisons are slow to join.
#[inline(always)]
fn look<S: Simd>(
    simd: S,
    DAffine3 { matrix3, translation }: &DAffine3,
    range: &RangeInclusive<f64>,
) -> (f64, mask64x4<S>) {
    let columns: &[f64; 9] = matrix3.as_ref();
    let at = |start: usize| f64x4::from_slice(simd, &columns[start..start + 4]);
    let splat = |value: f64| f64x4::splat(simd, value);
    let beyond = |bits: u64| mask64x4::from_bitmask(simd, bits);
    let (x, y, before_z) = (at(0), at(3), at(5));
    let z = before_z.slide::<1>(before_z);
    // Of each row with itself; of the first and the second with the next; of the first with the third.
    let lengths = x * x + y * y + z * z;
    let next = x * at(1) + y * at(4) + z * before_z.slide::<2>(before_z);
    let outer = x * at(2) + y * before_z + z * before_z.slide::<3>(before_z);
    let square = lengths.as_slice()[0];
    let (of_all, skew_max) = (splat(square), splat(square * SKEW_MAX));
    let DVec3 { x, y, z } = *translation;
    // False of what is no number.
    let good = (lengths - of_all).abs().simd_le(skew_max)
        & (next.abs().simd_le(skew_max) | beyond(0b1100))
        & (outer.abs().simd_le(skew_max) | beyond(0b1110))
        & f64x4::simd_from(simd, [x, y, z, z]).abs().simd_le(splat(MAGNITUDE_MAX))
        & of_all.simd_ge(splat(*range.start()))
        & of_all.simd_le(splat(*range.end()));
    (square, good)
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::*;
    use crate::simd::{dispatch, levels};
    use crate::testing::placement;

    fn scales(at: [&DAffine3; 2]) -> Option<[f64; 2]> {
        let found = levels().map(|level| {
            dispatch!(level, simd => plain_squares(simd, at).map(|squares| squares.map(f64::to_bits)))
        });
        assert_eq!(found[0], found[1], "every level says the same");
        found[0].map(|squares| squares.map(|square| f64::from_bits(square).sqrt()))
    }

    /// The squared scale of what nearly is a similarity: the same on every level, in either lane.
    fn rough(at: &DAffine3) -> Option<f64> {
        let here = DAffine3::IDENTITY;
        let found = levels().map(|level| {
            let first = dispatch!(level, simd => rough_squares(simd, [at, &here])).map(|[square, _]| square);
            let second = dispatch!(level, simd => rough_squares(simd, [&here, at])).map(|[_, square]| square);
            assert_eq!(first.map(f64::to_bits), second.map(f64::to_bits));
            first
        });
        assert_eq!(found[0].map(f64::to_bits), found[1].map(f64::to_bits), "every level says the same");
        found[0]
    }

    #[test]
    fn turns_and_scales_are_similarities_and_skews_are_none() {
        let here = DAffine3::IDENTITY;
        let mut turn = DMat3::IDENTITY;
        for k in 1..=12 {
            turn *= DMat3::from_rotation_y(f64::from(k)) * DMat3::from_rotation_x(0.7);
            let at = |linear: DMat3| DAffine3 { matrix3: linear, ..placement(k) };
            for scale in [1e-29, 0.1, -1.0, 1e29] {
                for pair in [[&at(turn * scale), &here], [&here, &at(turn * scale)]] {
                    let found = scales(pair).unwrap();
                    assert!((found[0] * found[1] / scale.abs() - 1.0).abs() < 1e-13);
                }
            }
            let skews = [
                DMat3::from_diagonal(DVec3::new(1.0, 1.0, 1.0 + 1e-13)),
                DMat3::from_diagonal(DVec3::new(1.0, 2.0, 1.0)),
                DMat3::from_diagonal(DVec3::new(1.0, 0.0, 1.0)),
                DMat3::from_diagonal(DVec3::splat(1e-31)),
                DMat3::from_diagonal(DVec3::splat(1e31)),
                DMat3::from_diagonal(DVec3::new(1.0, f64::NAN, 1.0)),
                DMat3::from_cols(DVec3::X, DVec3::new(1e-13, 1.0, 0.0), DVec3::Z),
                DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(0.0, 1e-13, 1.0)),
                DMat3::from_cols(DVec3::new(1.0, 0.0, 1e-13), DVec3::Y, DVec3::Z),
            ];
            for skew in skews {
                assert_eq!(scales([&at(turn * skew), &here]), None, "{skew}");
                assert_eq!(scales([&here, &at(skew * turn)]), None, "{skew}");
            }
            for wild in [f64::NAN, f64::INFINITY, 1e101] {
                let lost = DAffine3 { translation: DVec3::new(0.0, wild, 0.0), ..at(turn) };
                assert_eq!(scales([&lost, &here]), None, "{wild}");
                assert_eq!(scales([&here, &lost]), None, "{wild}");
            }
        }
    }

    /// Law: whatever is let through stretches no vector by more or less than it says; and what is a similarity is let through.
    #[test]
    fn what_nearly_is_a_similarity_stretches_nearly_alike() {
        let (mut passed, mut refused) = (0, 0);
        for k in 0..20_000 {
            let part = |step: f64| (f64::from(k) * step).fract() * 2.0 - 1.0;
            let size = 10f64.powi(-(k as i32 % 12));
            let skew = DMat3::from_cols(
                DVec3::new(part(0.37), part(0.91), part(0.13)),
                DVec3::new(part(0.61), part(0.47), part(0.83)),
                DVec3::new(part(0.29), part(0.71), part(0.53)),
            );
            let scale = [1.0, 1e-29, 1e29, -0.3][k as usize % 4];
            let DAffine3 { matrix3, translation } = placement(k);
            let at = DAffine3 { matrix3: matrix3 * (DMat3::IDENTITY + skew * size) * scale, translation };
            assert!(rough(&DAffine3 { matrix3: matrix3 * scale, translation }).is_some());
            let Some(square) = rough(&at) else {
                refused += 1;
                continue;
            };
            passed += 1;
            for n in 0..10 {
                let v = placement(k + n).translation.normalize();
                let stretch = (at.matrix3 * v).length() / square.sqrt();
                assert!((stretch - 1.0).abs() <= STRETCH_ERROR, "{k}: {stretch}");
            }
        }
        assert!(passed > 6_000 && refused > 6_000, "{passed} and {refused}");
        let lost = |linear: DMat3, translation: DVec3| rough(&DAffine3 { matrix3: linear, translation });
        for wild in [f64::NAN, f64::INFINITY, 1e101] {
            assert_eq!(lost(DMat3::IDENTITY, DVec3::new(0.0, wild, 0.0)), None);
            assert_eq!(lost(DMat3::from_diagonal(DVec3::splat(wild)), DVec3::ZERO), None);
        }
        for flat in [0.0, 1e-100, 1e-43] {
            assert_eq!(lost(DMat3::from_diagonal(DVec3::splat(flat)), DVec3::ZERO), None);
        }
    }
}
