//! The loops over eight lanes, free of branches: what vector instructions will replace, and be tested against.

use super::crossing::{Crossing, Probe};
use super::node::{Node, WIDTH};
use super::packed::PackedBox;

/// The lanes whose box overlaps a box of the same tree coordinates, as bits.
#[inline]
pub(super) fn overlapping_box(node: &Node, query: &PackedBox) -> u32 {
    let mut apart = [0.0; WIDTH];
    intervals_apart(node, query.min(), query.max(), &mut apart);
    zeros(&apart)
}

/// The lanes whose box may overlap a box of the other space, as bits.
#[inline]
pub(super) fn overlapping_probe(node: &Node, crossing: &Crossing, probe: &Probe) -> u32 {
    let mut apart = [0.0; WIDTH];
    intervals_apart(node, probe.lo, probe.hi, &mut apart);
    let (sum, size) = sums_and_sizes(node);
    for axis in 0..3 {
        let excess = excess(&sum, &size, crossing, probe, axis);
        for (apart, excess) in apart.iter_mut().zip(excess) {
            *apart = max(excess, *apart);
        }
    }
    zeros(&apart)
}

/// Raises `apart` to the gaps between the lanes and an interval on each axis of the lanes. The sign of a gap is exact.
#[inline]
fn intervals_apart(node: &Node, lo: [f32; 3], hi: [f32; 3], apart: &mut [f32; WIDTH]) {
    for axis in 0..3 {
        for (lane, apart) in apart.iter_mut().enumerate() {
            let below = lo[axis] - node.max[axis][lane];
            let above = node.min[axis][lane] - hi[axis];
            *apart = max(above, max(below, *apart));
        }
    }
}

/// Twice the centres and twice the half extents of the lanes, by axis.
#[inline]
fn sums_and_sizes(node: &Node) -> ([[f32; WIDTH]; 3], [[f32; WIDTH]; 3]) {
    let (mut sum, mut size) = ([[0.0; WIDTH]; 3], [[0.0; WIDTH]; 3]);
    for axis in 0..3 {
        for lane in 0..WIDTH {
            sum[axis][lane] = node.max[axis][lane] + node.min[axis][lane];
            size[axis][lane] = node.max[axis][lane] - node.min[axis][lane];
        }
    }
    (sum, size)
}

/// How far apart the lanes and the single box are on an axis of the latter; not a number where that cannot be said.
#[inline]
fn excess(
    sum: &[[f32; WIDTH]; 3],
    size: &[[f32; WIDTH]; 3],
    crossing: &Crossing,
    probe: &Probe,
    axis: usize,
) -> [f32; WIDTH] {
    let (g, ga) = (crossing.half_rows[axis], crossing.half_rows_abs[axis]);
    let (base, reach) = (probe.base[axis], probe.reach[axis]);
    std::array::from_fn(|lane| {
        let center = base + g[0] * sum[0][lane] + g[1] * sum[1][lane] + g[2] * sum[2][lane];
        let extent = reach + ga[0] * size[0][lane] + ga[1] * size[1][lane] + ga[2] * size[2][lane];
        center.abs() - extent
    })
}

/// `b` unless `a` is greater: also if `a` is not a number, as the instruction does.
#[inline]
fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// What a gap counts in a distance, squared: on each axis, and for the norm of the gaps on all three.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weights {
    pub axes: [f32; 3],
    pub norm: f32,
}

/// Gaps are counted up to here, so that their squares do not overflow.
const GAP_MAX: f32 = 1e18;

/// Lower bounds of the squared distances between a box of the other space and the lanes, up to the relative rounding of ten
/// operations.
#[inline]
pub(super) fn distances_squared(
    node: &Node,
    crossing: &Crossing,
    probe: &Probe,
    on_lanes: &Weights,
    on_box: &Weights,
) -> [f32; WIDTH] {
    let mut distances = [0.0; WIDTH];
    let gaps: [[f32; WIDTH]; 3] = std::array::from_fn(|axis| {
        let (lower, upper) = (&node.min[axis], &node.max[axis]);
        std::array::from_fn(|lane| max(probe.lo[axis] - upper[lane], lower[lane] - probe.hi[axis]))
    });
    weigh(&gaps, on_lanes, &mut distances);
    let (sum, size) = sums_and_sizes(node);
    let gaps = [0, 1, 2].map(|axis| excess(&sum, &size, crossing, probe, axis));
    weigh(&gaps, on_box, &mut distances);
    distances
}

/// Raises squared distances to those that the gaps on three axes imply.
#[inline]
fn weigh(gaps: &[[f32; WIDTH]; 3], weights: &Weights, distances: &mut [f32; WIDTH]) {
    for (lane, distance) in distances.iter_mut().enumerate() {
        let mut norm = 0.0;
        for (gaps, weight) in gaps.iter().zip(weights.axes) {
            let positive = max(gaps[lane], 0.0);
            let gap = if positive < GAP_MAX { positive } else { GAP_MAX };
            *distance = max(weight * (gap * gap), *distance);
            norm += gap * gap;
        }
        *distance = max(weights.norm * norm, *distance);
    }
}

/// The lanes that are zero, as bits.
#[inline]
fn zeros(lanes: &[f32; WIDTH]) -> u32 {
    lanes.iter().enumerate().fold(0, |mask, (lane, &x)| mask | u32::from(x <= 0.0) << lane)
}

/// The set bits of a mask, from the lowest.
#[inline]
pub(super) fn bits(mut mask: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (mask != 0).then(|| {
            let lane = mask.trailing_zeros() as usize;
            mask &= mask - 1;
            lane
        })
    })
}
