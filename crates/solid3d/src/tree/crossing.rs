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

use super::normal::{Normal, round_down};
use super::packed::{FAR, PackedBox};
use super::relative::Relative;
use glam::{DAffine3, DMat3, DVec3};

/// 8u for `f32`: see the module.
const MARGIN: f64 = 4.0 * f32::EPSILON as f64;

/// Covers what underflow may lose in `f32`.
const UNDERFLOW: f64 = f32::MIN_POSITIVE as f64;

/// A reach up to here means terms below 1e37, and their sums do not overflow in `f32`.
const HUGE: f64 = 1e30;

/// Bound on the relative rounding of an affine map and the few operations around it in `f64`: eight times 2^-53.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// An affine map between tree coordinates, and the error it makes.
#[derive(Clone, Copy, Debug)]
struct Folded {
    map: DAffine3,
    abs: DMat3,
    /// In each coordinate: the caller's slack, the rounding of the folding, and that of mapping a point within `[-1, 1]^3`.
    slack: DVec3,
}

impl Folded {
    fn new(map: &DAffine3, slack: f64, from: &Normal, to: &Normal) -> Self {
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
}

fn row_sums(m: &DMat3) -> DVec3 {
    m.x_axis + m.y_axis + m.z_axis
}

/// The relative placement of the space of a single box and that of a tree, folded with their tree coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    /// S to L.
    into_lanes: Folded,
    /// g.
    offset: DVec3,
    /// Error in S.
    slack: DVec3,
    /// Sum of |G| over each row.
    row_sums: DVec3,
    /// G / 2, as lanes give twice the centre and the half extents; and its absolute value.
    pub half_rows: [[f32; 3]; 3],
    pub half_rows_abs: [[f32; 3]; 3],
}

/// A single box, prepared for tests against lanes of the other space.
#[derive(Clone, Copy, Debug)]
pub(super) struct Probe {
    /// On the axes of L: the interval of the single box.
    pub lo: [f32; 3],
    pub hi: [f32; 3],
    /// On the axes of S: g - c', and h' with all margins.
    pub base: [f32; 3],
    pub reach: [f32; 3],
}

impl Crossing {
    /// From the space `b` of single boxes to the lanes of a tree in `a`.
    pub fn new(relative: &Relative, b: &Normal, a: &Normal) -> Self {
        let into_lanes = Folded::new(&relative.b_to_a, relative.slack_in_a, b, a);
        let back = Folded::new(&relative.a_to_b, relative.slack_in_b, a, b);
        let rows = back.map.matrix3.transpose().to_cols_array_2d();
        let half_rows = rows.map(|row| row.map(|x| (0.5 * x) as f32));
        Crossing {
            into_lanes,
            offset: back.map.translation,
            slack: back.slack,
            row_sums: row_sums(&back.abs),
            half_rows,
            half_rows_abs: half_rows.map(|row| row.map(f32::abs)),
        }
    }

    /// Prepares a box of S.
    #[inline(always)] // else the box goes through memory, stored by coordinate and loaded by vector: a stall
    pub fn probe(&self, bounds: &PackedBox) -> Probe {
        let (center, half) = bounds.center_half();
        let into = &self.into_lanes;
        let (c, h) = (into.map.transform_point3(center), into.abs * half + into.slack);
        let base = self.offset - center;
        let sums = 2.0 * self.row_sums + base.abs() + half + self.slack;
        // The margin makes the reach grow with every term, so a small reach means that none overflows.
        let reach = half + self.slack + MARGIN * sums + UNDERFLOW;
        Probe {
            lo: each(c - h, lower),
            hi: each(-c - h, |v| -lower(v)),
            base: each(base, |v| v as f32),
            reach: each(reach, |v| if v < HUGE { -round_down(-v) } else { f32::INFINITY }),
        }
    }

    /// The size of things in L over their size in S, for an even comparison of boxes.
    pub fn magnification(&self) -> f64 {
        self.into_lanes.map.matrix3.determinant().abs().cbrt()
    }
}

/// A function of each coordinate. (As `array::map`, which was not inlined here.)
#[inline(always)]
fn each(v: DVec3, f: impl Fn(f64) -> f32) -> [f32; 3] {
    [f(v.x), f(v.y), f(v.z)]
}

/// An `f32` at most `v` and within [`FAR`]; the least if `v` is not a number.
#[inline]
fn lower(v: f64) -> f32 {
    let down = round_down(v);
    let capped = if down < FAR { down } else { FAR };
    if v > -HUGE { capped } else { -FAR }
}

fn abs(m: &DMat3) -> DMat3 {
    DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs())
}
