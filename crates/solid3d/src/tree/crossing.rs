//! One box against boxes of another space, whatever the affine map between: the six facet axes ("SAT lite", thesis 5.2.4).
//!
//! S is the space of the single box, L that of the eight lanes, both in tree coordinates, so that no coordinate exceeds 1.
//! F, f take S to L; G, g take L to S. A box has centre c and half extents h.
//!
//! - On the axes of L, the single box spans F c + f -+ |F| h: an interval `lo..hi`, computed in `f64` and rounded outward.
//!   The lanes are intervals already, and comparing them is exact.
//! - On the axes of S, a lane spans G c + g -+ |G| h, in `f32`. It is apart from the single box (c', h') if
//!   |G c + (g - c')| > |G| h + h'. The difference g - c' is taken in `f64` and only then rounded, so that a small box in a
//!   large space keeps its resolution.
//!
//! # The margin on the axes of S
//!
//! u = 2^-24. On the left, G, c, the products and the three sums are rounded once each, so a product takes part in six
//! roundings and b = g - c' in four; on the right the same. As |c| + h <= 1 in each coordinate, the errors of both sides
//! together are at most 6u/(1 - 6u) (sum |G| + |b| + reach), with sum |G| over the row and reach all that is added to
//! |G| h. [`MARGIN`] is 8u, and counts sum |G| twice. Underflow loses less than 12 * 2^-149: [`UNDERFLOW`] is more.
//! What is beyond [`HUGE`] might overflow: that axis then separates nothing.

use super::normal::{GROWTH, GROWTH_RELATIVE, Normal};
use super::packed::PackedBox;
use super::relative::Relative;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, f64x4};
use glam::{DAffine3, DMat3, DVec3};
use solid_convex::simd::{each, part};

use crate::bounds::abs;

/// 8u for `f32`: see the module.
pub(super) const MARGIN: f64 = 4.0 * f32::EPSILON as f64;

/// Covers what underflow may lose in `f32`.
pub(super) const UNDERFLOW: f64 = f32::MIN_POSITIVE as f64;

/// A reach up to here means terms below 1e37, and their sums do not overflow in `f32`.
const HUGE: f64 = 1e30;

/// Bound on the relative rounding of an affine map and the few operations around it in `f64`: eight times 2^-53.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// An affine map between tree coordinates, and the error it makes.
pub(super) struct Folded {
    pub map: DAffine3,
    pub abs: DMat3,
    /// In each coordinate: the caller's slack, the rounding of the folding, and that of mapping a point within `[-1, 1]^3`.
    pub slack: DVec3,
}

impl Folded {
    #[inline(always)]
    pub fn new(map: &DAffine3, slack: f64, from: &Normal, to: &Normal) -> Self {
        let linear = map.matrix3 * from.scale * to.inverse;
        let offset = map.matrix3 * from.origin + map.translation - to.origin;
        let terms = abs(&map.matrix3) * from.origin.abs() + map.translation.abs() + to.origin.abs();
        let translation = offset * to.inverse;
        let sums = row_sums(&abs(&linear)) + translation.abs();
        Folded {
            map: DAffine3 { matrix3: linear, translation },
            abs: abs(&linear),
            slack: (slack + ROUNDING * terms) * to.inverse + ROUNDING * sums,
        }
    }

    /// The size of things where they are taken to over their size where they are, for an even comparison of boxes.
    pub fn magnification(&self) -> f64 {
        frobenius(&self.map.matrix3) / frobenius(&DMat3::IDENTITY)
    }
}

/// Of a rotation times a scale, `3.sqrt()` times the scale.
fn frobenius(m: &DMat3) -> f64 {
    (m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()).sqrt()
}

#[inline(always)]
pub(super) fn row_sums(m: &DMat3) -> DVec3 {
    m.x_axis + m.y_axis + m.z_axis
}

/// The rows of a matrix, rounded.
#[inline(always)]
pub(super) fn rows(m: &DMat3) -> [[f32; 3]; 3] {
    each(m.transpose().to_cols_array_2d(), |row| each(row, |x| x as f32))
}

/// A vector, and a fourth lane that means nothing.
type Quad = [f64; 4];

fn quad(v: DVec3) -> Quad {
    [v.x, v.y, v.z, 0.0]
}

fn columns(m: &DMat3) -> [Quad; 3] {
    [quad(m.x_axis), quad(m.y_axis), quad(m.z_axis)]
}

/// The relative placement of the space of a single box and that of a tree, folded with their tree coordinates.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Crossing {
    /// S to L: F, |F|, f, and the error.
    into: [Quad; 3],
    into_abs: [Quad; 3],
    into_offset: Quad,
    into_slack: Quad,
    /// g.
    offset: Quad,
    /// Error in S.
    slack: Quad,
    /// Twice the sum of |G| over each row.
    sums: Quad,
    /// G / 2, as lanes give twice the centre and the half extents; and its absolute value.
    pub half_rows: [[f32; 3]; 3],
    pub half_rows_abs: [[f32; 3]; 3],
}

/// A single box, prepared for tests against lanes of the other space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub(super) struct Probe {
    /// On the axes of L, the interval of the single box: three least coordinates, and from the fifth on the greatest.
    interval: [f32; 8],
    /// On the axes of S: g - c', and from the fifth on h' with all margins.
    against: [f32; 8],
}

impl Probe {
    /// The interval of the single box on an axis of L.
    #[inline(always)]
    pub fn interval(&self, axis: usize) -> (f32, f32) {
        (self.interval[axis], self.interval[4 + axis])
    }

    /// On an axis of S, g - c', and h' with all margins.
    #[inline(always)]
    pub fn base_reach(&self, axis: usize) -> (f32, f32) {
        (self.against[axis], self.against[4 + axis])
    }
}

impl Crossing {
    /// From the space `b` of single boxes to the lanes of a tree in `a`.
    pub fn new(relative: &Relative, b: &Normal, a: &Normal) -> Self {
        let into = Folded::new(&relative.b_to_a, relative.slack_in_a, b, a);
        let back = Folded::new(&relative.a_to_b, relative.slack_in_b, a, b);
        Self::of(&into, &back)
    }

    /// The same from the way of boxes to the lanes, and that back.
    pub fn of(into: &Folded, back: &Folded) -> Self {
        let half_rows = rows(&(0.5 * back.map.matrix3));
        Crossing {
            into: columns(&into.map.matrix3),
            into_abs: columns(&into.abs),
            into_offset: quad(into.map.translation),
            into_slack: quad(into.slack),
            offset: quad(back.map.translation),
            slack: quad(back.slack),
            sums: quad(2.0 * row_sums(&back.abs)),
            half_rows,
            half_rows_abs: each(half_rows, |row| each(row, f32::abs)),
        }
    }

    /// Prepares a box of S.
    #[inline(always)]
    pub fn probe<S: Simd>(&self, simd: S, bounds: &PackedBox) -> Probe {
        part!(simd => self.probe_on(simd, bounds))
    }

    #[inline(always)]
    fn probe_on<S: Simd>(&self, simd: S, bounds: &PackedBox) -> Probe {
        // In the fourth lane the box is inverted and the maps are zero: a number comes out, and is not used.
        let (min, negated_max) = simd.widen_f32x8(f32x8::load_array(simd, bounds.0));
        let center = one(simd, 0.5) * (min - negated_max);
        let half = one(simd, -0.5) * (min + negated_max);
        let c = product(simd, &self.into, center) + load(simd, &self.into_offset);
        let h = product(simd, &self.into_abs, half) + load(simd, &self.into_slack);
        let base = load(simd, &self.offset) - center;
        let slack = load(simd, &self.slack);
        let sums = load(simd, &self.sums) + base.abs() + half + slack;
        // The margin makes the reach grow with every term, so a small reach means that none overflows.
        let reach = half + slack + one(simd, MARGIN) * sums + one(simd, UNDERFLOW);
        let reach = -lower(simd, -reach);
        let reach = reach.simd_lt(one(simd, HUGE)).select(reach, one(simd, f64::INFINITY));
        let (lo, hi) = (lower(simd, within(simd, c - h)), -lower(simd, within(simd, -c - h)));
        Probe {
            interval: simd.narrow_f64x4(lo, hi).to_array(),
            against: simd.narrow_f64x4(base, reach).to_array(),
        }
    }
}

#[inline(always)]
fn one<S: Simd>(simd: S, x: f64) -> f64x4<S> {
    f64x4::splat(simd, x)
}

#[inline(always)]
fn load<S: Simd>(simd: S, quad: &Quad) -> f64x4<S> {
    f64x4::load_array_ref(simd, quad)
}

/// A matrix, by columns, times a vector.
#[inline(always)]
fn product<S: Simd>(simd: S, columns: &[Quad; 3], v: f64x4<S>) -> f64x4<S> {
    let [x, y, z, _] = v.to_array();
    load(simd, &columns[0]) * one(simd, x)
        + load(simd, &columns[1]) * one(simd, y)
        + load(simd, &columns[2]) * one(simd, z)
}

/// What is at most `v` when rounded to `f32`: see [`round_down`](super::normal::round_down).
#[inline(always)]
fn lower<S: Simd>(simd: S, v: f64x4<S>) -> f64x4<S> {
    v - (v.abs() * one(simd, GROWTH_RELATIVE) + one(simd, GROWTH))
}

/// Within [`HUGE`], beyond which no box lies; the least if `v` is not a number.
#[inline(always)]
fn within<S: Simd>(simd: S, v: f64x4<S>) -> f64x4<S> {
    v.simd_gt(one(simd, -HUGE)).select(v, one(simd, -HUGE)).min(one(simd, HUGE))
}
