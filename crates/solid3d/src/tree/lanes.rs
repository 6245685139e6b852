//! One box against the eight of a node, in vectors of eight `f32`. Every level of instructions gives the same bits.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, mask32x8};

use super::crossing::{Crossing, Probe};
use super::node::{Node, WIDTH};
use super::packed::PackedBox;
use solid_convex::simd::part;

/// The lanes whose box overlaps a box of the same tree coordinates, as bits.
#[inline(always)]
pub(super) fn overlapping_box<S: Simd>(simd: S, node: &Node, query: &PackedBox) -> u32 {
    part!(simd => {
        let (lo, hi) = (query.min(), query.max());
        let [x, y, z] = three(
            #[inline(always)]
            |axis| interval_gap(simd, node, axis, (lo[axis], hi[axis])),
        );
        let zero = splat(simd, 0.0);
        !((x.simd_gt(zero) | y.simd_gt(zero) | z.simd_gt(zero)).to_bitmask() as u32) & LANES
    })
}

/// The lanes whose box may overlap a box of the other space, as bits; and how far each is apart from it on its own axes, below zero
/// by how far it overlaps.
#[inline(always)]
pub(super) fn overlapping_probe<S: Simd>(
    simd: S,
    node: &Node,
    crossing: &Crossing,
    probe: &Probe,
) -> (u32, f32x8<S>) {
    part!(simd => {
        let [x, y, z] = interval_gaps(simd, node, probe);
        let [u, v, w] = projected_gaps(simd, node, crossing, probe);
        let zero = f32x8::splat(simd, 0.0);
        // What is not a number is not greater: it separates nothing.
        let gap = x.max(y).max(z);
        let apart: mask32x8<S> = gap.simd_gt(zero) | u.simd_gt(zero) | v.simd_gt(zero) | w.simd_gt(zero);
        (!(apart.to_bitmask() as u32) & LANES, gap)
    })
}

/// The sizes of the lanes, by which nodes compare: the sums of the sides.
#[inline(always)]
pub(super) fn extents<S: Simd>(simd: S, node: &Node) -> [f32; WIDTH] {
    let [x, y, z] = three(
        #[inline(always)]
        |axis| {
            let (min, max) = lanes(simd, node, axis);
            max - min
        },
    );
    (x + y + z).to_array()
}

/// A bit for each lane.
pub(super) const LANES: u32 = (1 << WIDTH) - 1;

/// What a gap counts in a distance, squared: on each axis, and for the norm of the gaps on all three.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weights {
    pub axes: [f32; 3],
    pub norm: f32,
}

impl Weights {
    /// Gaps count fully, whatever their direction.
    pub const ALL: Weights = Weights { axes: [1.0; 3], norm: 1.0 };

    /// Nothing counts.
    pub const NONE: Weights = Weights { axes: [0.0; 3], norm: 0.0 };
}

/// Lower bounds of the squared distances between a box of the other space and the lanes, up to the relative rounding of ten
/// operations.
#[inline(always)]
pub(super) fn distances_squared<S: Simd>(
    simd: S,
    node: &Node,
    crossing: &Crossing,
    probe: &Probe,
    on_lanes: &Weights,
    on_box: &Weights,
) -> f32x8<S> {
    part!(simd => {
        let along_lanes = weighed(simd, positive(simd, interval_gaps(simd, node, probe)), on_lanes);
        let along_box = weighed(simd, positive(simd, projected_gaps(simd, node, crossing, probe)), on_box);
        along_lanes.max(along_box)
    })
}

/// Lower bounds of the squared distances between a box of the same tree coordinates and the lanes, up to the same rounding.
#[inline(always)]
pub(super) fn distances_squared_to_box<S: Simd>(
    simd: S,
    node: &Node,
    query: &PackedBox,
    weights: &Weights,
) -> f32x8<S> {
    part!(simd => {
        let (lo, hi, zero) = (query.min(), query.max(), splat(simd, 0.0));
        let gaps = three(
            #[inline(always)]
            |axis| interval_gap(simd, node, axis, (lo[axis], hi[axis])).max(zero),
        );
        weighed(simd, gaps, weights)
    })
}

/// The gaps between the lanes and the single box on each axis of the lanes; negative where they overlap. The sign is exact.
#[inline(always)]
fn interval_gaps<S: Simd>(simd: S, node: &Node, probe: &Probe) -> [f32x8<S>; 3] {
    three(
        #[inline(always)]
        |axis| interval_gap(simd, node, axis, probe.interval(axis)),
    )
}

#[inline(always)]
fn interval_gap<S: Simd>(simd: S, node: &Node, axis: usize, (lo, hi): (f32, f32)) -> f32x8<S> {
    let (min, max) = lanes(simd, node, axis);
    (splat(simd, lo) - max).max(min - splat(simd, hi))
}

/// The gaps between the lanes and the single box on each axis of the latter; not a number where that cannot be said.
#[inline(always)]
fn projected_gaps<S: Simd>(simd: S, node: &Node, crossing: &Crossing, probe: &Probe) -> [f32x8<S>; 3] {
    let ends = [lanes(simd, node, 0), lanes(simd, node, 1), lanes(simd, node, 2)];
    three(
        #[inline(always)]
        |axis| {
            let [row, abs] = [&crossing.half_rows[axis], &crossing.half_rows_abs[axis]];
            let (base, reach) = probe.base_reach(axis);
            let (mut center, mut extent) = (splat(simd, base), splat(simd, reach));
            for ((min, max), (g, ga)) in ends.iter().zip(row.iter().zip(abs)) {
                center += splat(simd, *g) * (*max + *min);
                extent += splat(simd, *ga) * (*max - *min);
            }
            center.abs() - extent
        },
    )
}

/// One for each axis. Array functions of the standard library are not compiled for the level of instructions, nor are closures
/// that are not always inlined.
#[inline(always)]
fn three<T>(f: impl Fn(usize) -> T) -> [T; 3] {
    [f(0), f(1), f(2)]
}

#[inline(always)]
pub(super) fn splat<S: Simd>(simd: S, x: f32) -> f32x8<S> {
    f32x8::splat(simd, x)
}

/// The ends of the lanes' intervals on an axis.
#[inline(always)]
pub(super) fn lanes<S: Simd>(simd: S, node: &Node, axis: usize) -> (f32x8<S>, f32x8<S>) {
    (f32x8::load_array_ref(simd, &node.min[axis]), f32x8::load_array_ref(simd, &node.max[axis]))
}

/// Gaps are counted up to here, so that their squares do not overflow.
const GAP_MAX: f32 = 1e18;

/// Gaps above zero. What is not a number counts nothing.
#[inline(always)]
fn positive<S: Simd>(simd: S, gaps: [f32x8<S>; 3]) -> [f32x8<S>; 3] {
    three(
        #[inline(always)]
        |axis| gaps[axis].max_precise(splat(simd, 0.0)),
    )
}

/// The squared distance that the gaps on three axes imply.
#[inline(always)]
fn weighed<S: Simd>(simd: S, gaps: [f32x8<S>; 3], weights: &Weights) -> f32x8<S> {
    let [x, y, z] = three(
        #[inline(always)]
        |axis| {
            let gap = gaps[axis].min(splat(simd, GAP_MAX));
            gap * gap
        },
    );
    let sum = x + y + z;
    if weights.norm >= 1.0 {
        return sum; // no weight is more
    }
    let [a, b, c] = weights.axes;
    let one_axis = (splat(simd, a) * x).max(splat(simd, b) * y).max(splat(simd, c) * z);
    (splat(simd, weights.norm) * sum).max(one_axis)
}

/// The set bits of a mask, from the lowest.
#[inline]
pub(crate) fn bits(mask: impl Into<u64>) -> impl Iterator<Item = usize> {
    let mut mask = mask.into();
    std::iter::from_fn(move || {
        (mask != 0).then(|| {
            let lane = mask.trailing_zeros() as usize;
            mask &= mask - 1;
            lane
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Aabb;
    use crate::tree::node::Node;
    use crate::tree::normal::Normal;
    use crate::tree::tests::scenes::{affine, point, random_boxes, relative, rng};
    use glam::DVec3;
    use solid_convex::simd::alike;
    use solid_convex::simd::dispatch;

    /// What all kernels say of one node and one box, as bits.
    #[inline(always)]
    fn answers<S: Simd>(
        simd: S,
        node: &Node,
        crossing: &Crossing,
        bounds: &PackedBox,
        weights: &Weights,
    ) -> (u32, u32, [u32; 8], [u32; 8], Probe) {
        let probe = crossing.probe(simd, bounds);
        let distances = distances_squared(simd, node, crossing, &probe, weights, weights);
        let to_box = distances_squared_to_box(simd, node, bounds, weights);
        (
            overlapping_box(simd, node, bounds),
            overlapping_probe(simd, node, crossing, &probe).0,
            distances.to_array().map(f32::to_bits),
            to_box.to_array().map(f32::to_bits),
            probe,
        )
    }

    /// Also where sizes are so unlike that nothing can be said on some axes.
    #[test]
    fn every_level_of_instructions_gives_the_same_bits() {
        let mut rng = rng(50);
        let (mut hits, mut lanes) = (0, 0);
        let unit = Normal::of(&Aabb::new(DVec3::splat(-2.0), DVec3::splat(2.0)));
        for round in 0..4000 {
            let boxes = random_boxes(&mut rng, 9, 1.0);
            let mut node = Node::EMPTY;
            for (lane, bounds) in boxes.iter().take(1 + round % 8).enumerate() {
                node.set_lane(lane, &unit.pack(bounds));
            }
            let size = [1.0, 1.0, 1.0, 1e-3, 1e36, 1e-36][round % 6];
            let mut map = affine(&mut rng, size, 0.0);
            map.translation = point(&mut rng, 0.5);
            let crossing = Crossing::new(&relative(map, 2.0, 2.0), &unit, &unit);
            let weights = Weights { axes: [1.0, 0.5, 0.25], norm: 0.25 };
            let query = unit.pack(&boxes[8]);
            let found = alike(
                |level| dispatch!(widest level, simd => answers(simd, &node, &crossing, &query, &weights)),
            );
            if round % 6 < 3 {
                hits += found.1.count_ones();
                lanes += 1 + round as u32 % 8;
            }
        }
        println!("{hits} of {lanes} lanes hit");
        assert!(10 * hits > 3 * lanes && 10 * hits < 7 * lanes);
    }
}
