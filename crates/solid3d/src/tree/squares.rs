//! Squared distances in units of a metric, by which walks compare subtrees.
//!
//! A square is a lower bound of the squared distance of two boxes: nothing in them is nearer than `unit * sqrt(square)`. So what is at least
//! `d` away is told by a limit, found once for each `d`: at least (d / unit)². A root of each square would be waited for, as it tells where the walk
//! goes on.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};

use super::lanes::LANES;

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

/// The greater of squares and those of lower bounds in units, where these are above zero; finite, as no limit may be less.
#[inline(always)]
pub fn raised<S: Simd>(simd: S, squares: f32x8<S>, units: f32x8<S>) -> f32x8<S> {
    let square = (units * units).min(f32x8::splat(simd, f32::MAX));
    (units.simd_gt(f32x8::splat(simd, 0.0)) & square.simd_gt(squares)).select(square, squares)
}
