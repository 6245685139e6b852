//! Squared distances in units of a metric, by which walks compare subtrees.
//!
//! A square is a lower bound of the squared distance of two boxes: nothing in them is nearer than `unit * sqrt(square)`. So what is at least
//! `d` away is told by a limit, found once for each `d`: at least (d / unit)². A root of each square would be waited for, as it tells where the walk
//! goes on. For the same reason a square tells its lane: see [`keys`].

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, i32x8};

use super::lanes::LANES;
use super::node::WIDTH;

/// The last bits of a key.
const LANE_MAX: i32 = WIDTH as i32 - 1;

/// The limit of a distance that is at most so many units. Without a unit that is no number, and nothing is skipped.
#[inline(always)]
pub fn limit(units: f64) -> f32 {
    // Rounded up: also what underflows.
    ((units * units).min(f64::INFINITY) as f32).next_up()
}

/// The lanes whose square is at least a limit, as bits.
#[inline(always)]
pub fn reaching<S: Simd>(simd: S, squares: f32x8<S>, limit: f32) -> u32 {
    squares.simd_ge(f32x8::splat(simd, limit)).to_bitmask() as u32 | !LANES
}

/// Squares as whole numbers, with the number of the lane in place of their last bits: the least of them says where it is.
#[inline(always)]
pub fn keys<S: Simd>(simd: S, squares: f32x8<S>) -> i32x8<S> {
    let lanes = i32x8::from_slice(simd, &[0, 1, 2, 3, 4, 5, 6, 7]);
    (squares.bitcast::<i32x8<S>>() & !i32x8::splat(simd, LANE_MAX)) | lanes
}

/// The limit of keys: where one is at least that, its square is at least the limit of squares.
#[inline(always)]
pub fn key_limit(limit: f32) -> i32 {
    (limit.to_bits() as i32 + LANE_MAX) & !LANE_MAX
}

/// The lane of a key.
#[inline(always)]
pub fn lane(key: i32) -> usize {
    (key & LANE_MAX) as usize
}

/// The keys that are below a limit, as bits.
#[inline(always)]
pub fn below<S: Simd>(simd: S, keys: i32x8<S>, limit: i32) -> u32 {
    keys.simd_lt(i32x8::splat(simd, limit)).to_bitmask() as u32 & LANES
}

/// The greater of squares and those of lower bounds in units, where these are above zero; finite, as no limit may be less.
#[inline(always)]
pub fn raised<S: Simd>(simd: S, squares: f32x8<S>, units: f32x8<S>) -> f32x8<S> {
    let square = (units * units).min(f32x8::splat(simd, f32::MAX));
    (units.simd_gt(f32x8::splat(simd, 0.0)) & square.simd_gt(squares)).select(square, squares)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::tests::scenes::rng;
    use rand::Rng;
    use solid_convex::simd::{alike, dispatch};

    /// Law: a key tells its lane, and is below a limit where its square is; where the square is clearly not, it is not. Of squares of all sizes, on every
    /// level of instructions.
    #[test]
    fn keys_are_below_a_limit_where_squares_are() {
        let mut rng = rng(101);
        for case in 0..20_000 {
            let square = |bits: u32| f32::from_bits(bits.min(f32::MAX.to_bits()));
            let bits = rng.random_range(0..f32::MAX.to_bits()) >> rng.random_range(0..31);
            let limit = if case % 10 == 0 { f32::INFINITY } else { square(bits).next_up() };
            let squares: [f32; WIDTH] =
                std::array::from_fn(|_| square((bits + 16).saturating_sub(rng.random_range(0..32))));
            let (keys, below) = alike(|level| {
                dispatch!(widest level, simd => {
                    let keys = keys(simd, f32x8::from_slice(simd, &squares));
                    (keys.to_array(), below(simd, keys, key_limit(limit)))
                })
            });
            for (i, square) in squares.into_iter().enumerate() {
                let is_below = below >> i & 1 == 1;
                assert_eq!(lane(keys[i]), i);
                assert!(is_below || square >= limit, "{square:e} {limit:e}");
                assert!(!is_below || square.to_bits() < limit.to_bits() + 8, "{square:e} {limit:e}");
            }
        }
    }
}
