//! Where to split a set of primitives: binned surface-area heuristic on three axes, and the median where that says nothing.
//!
//! The functions are inlined into the build, which is compiled for every level of instructions: a box is one vector, so that a union is one
//! instruction. They compare and add, each number by itself, so every level gives the same bits.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x4, i32x4};

use super::cost::measure_of;
use super::node::LEAF_SIZE;
use super::packed::PackedBox;

/// Bins along an axis.
const BINS: usize = 16;

/// Sets of at most so many items are parted by way of a spare array, without a branch: nobody can foretell on which side an item is.
const SPARE: usize = 512;

/// A primitive during the build, or some of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    pub bounds: PackedBox,
    pub index: u32,
}

impl Item {
    pub const NONE: Item = Item { bounds: PackedBox::EMPTY, index: 0 };
}

/// A set of items, consecutive in the array of all from `start`, and what is known of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Set {
    pub start: usize,
    pub len: usize,
    pub bounds: PackedBox,
    /// Box of the doubled centres.
    centers: PackedBox,
}

/// Working memory of splits.
pub(super) struct Spare(Box<[Item; SPARE]>);

impl Default for Spare {
    fn default() -> Self {
        Spare(Box::new([Item::NONE; SPARE]))
    }
}

impl Set {
    /// A set of which nothing is known but its box: to be made anew before it is split.
    pub fn of_bounds(bounds: PackedBox, len: usize) -> Self {
        Set { start: 0, len, bounds, centers: PackedBox::EMPTY }
    }

    /// The set of `items`, which begin at `start` in the array of all.
    #[inline(always)]
    pub fn new<S: Simd>(simd: S, start: usize, items: &[Item]) -> Self {
        let mut bounds = PackedBox::EMPTY;
        for item in items {
            bounds.grow_on(simd, &item.bounds);
        }
        Set::within(simd, bounds, start, items)
    }

    /// The same, where the bounds are known.
    #[inline(always)]
    fn within<S: Simd>(simd: S, bounds: PackedBox, start: usize, items: &[Item]) -> Self {
        let mut centers = PackedBox::EMPTY;
        for item in items {
            centers.grow_on(simd, &center(&item.bounds));
        }
        Set { start, len: items.len(), bounds, centers }
    }

    /// Splits in two, neither empty, reordering `items`, which are those of the set: at least two. An item counts as `weight`
    /// primitives.
    #[inline(always)]
    pub fn split<S: Simd>(
        &self,
        simd: S,
        items: &mut [Item],
        spare: &mut Spare,
        weight: impl Fn(&Item) -> u32,
    ) -> [Set; 2] {
        match best_plane(simd, self, items, weight) {
            Some(plane) => {
                let below = plane.part(simd, items, spare);
                let [bounds_below, bounds_above] = plane.bounds;
                let (first, second) = items.split_at(below);
                [
                    Set::within(simd, bounds_below, self.start, first),
                    Set::within(simd, bounds_above, self.start + below, second),
                ]
            }
            None => self.split_evenly(simd, items),
        }
    }

    /// Splits at the median centre of the longest axis, at a multiple of the leaf size.
    #[inline(always)]
    pub fn split_evenly<S: Simd>(&self, simd: S, items: &mut [Item]) -> [Set; 2] {
        let half = (self.len / 2).next_multiple_of(LEAF_SIZE).min(self.len - 1);
        let sizes = [0, 1, 2].map(|axis| self.centers.size(axis));
        let axis = (0..3).fold(0, |a, b| if sizes[b] > sizes[a] { b } else { a });
        let key = |item: &Item| item.bounds.center_doubled(axis);
        let order = |a: &Item, b: &Item| key(a).total_cmp(&key(b)).then(a.index.cmp(&b.index));
        items.select_nth_unstable_by(half, order);
        let (below, above) = items.split_at(half);
        [Set::new(simd, self.start, below), Set::new(simd, self.start + half, above)]
    }
}

/// The doubled centre, as a box.
#[inline(always)]
fn center(bounds: &PackedBox) -> PackedBox {
    let b = &bounds.0;
    let mut doubled = [0.0; 8];
    for i in 0..4 {
        doubled[i] = b[i] - b[i + 4];
        doubled[i + 4] = b[i + 4] - b[i];
    }
    PackedBox(doubled)
}

/// How doubled centres along the axes fall into bins.
struct Binning {
    /// The fourth is of no axis.
    origin: [f32; 4],
    per_unit: [f32; 4],
    last: usize,
}

impl Binning {
    #[inline(always)]
    fn new(set: &Set) -> Self {
        // Few items need few bins: the sweep over empty bins would cost more than the items.
        let bins = if set.len < 4 * BINS { BINS / 2 } else { BINS };
        let [x, y, z] = set.centers.min();
        // An axis without extent divides by zero: infinity times zero is not a number.
        let per_unit = |axis: usize| bins as f32 / set.centers.size(axis);
        let per_unit = [per_unit(0), per_unit(1), per_unit(2), 0.0];
        Binning { origin: [x, y, z, 0.0], per_unit, last: bins - 1 }
    }

    /// The bins of an item along the axes, each below [`BINS`]; the fourth is of none.
    #[inline(always)]
    fn bins<S: Simd>(&self, simd: S, item: &Item) -> i32x4<S> {
        let (low, high) = item.bounds.0.split_at(4);
        let doubled = f32x4::from_slice(simd, low) - f32x4::from_slice(simd, high);
        let [origin, per_unit] = [f32x4::simd_from(simd, self.origin), f32x4::simd_from(simd, self.per_unit)];
        let (offset, last) = ((doubled - origin) * per_unit, f32x4::splat(simd, self.last as f32));
        // What is not a number is in the last.
        simd.cvt_i32_f32x4(offset.simd_lt(last).select(offset, last))
    }
}

/// A plane between two bins of an axis.
struct Plane {
    binning: Binning,
    axis: usize,
    /// The last bin below.
    bin: usize,
    /// The boxes around what is below and above.
    bounds: [PackedBox; 2],
}

/// The cheapest plane; none if all centres coincide.
#[inline(always)]
fn best_plane<S: Simd>(simd: S, set: &Set, items: &[Item], weight: impl Fn(&Item) -> u32) -> Option<Plane> {
    let binning = Binning::new(set);
    // Of the three axes one after the other.
    let mut bounds = [PackedBox::EMPTY; 3 * BINS];
    let mut weights = [0; 3 * BINS];
    for item in items {
        let [x, y, z, _] = binning.bins(simd, item).to_array();
        let weight = weight(item);
        for (axis, bin) in [x, y, z].into_iter().enumerate() {
            let bin = axis * BINS + bin as usize % BINS;
            bounds[bin].grow_on(simd, &item.bounds);
            weights[bin] += weight;
        }
    }
    let mut best: Option<(f32, usize, usize)> = None;
    for axis in 0..3 {
        let of_axis = axis * BINS..(axis + 1) * BINS;
        let cheapest = cheapest(simd, &bounds[of_axis.clone()], &weights[of_axis], binning.last);
        if let Some((cost, bin)) = cheapest
            && best.is_none_or(|(least, ..)| cost < least)
        {
            best = Some((cost, axis, bin));
        }
    }
    let (_, axis, bin) = best?;
    let mut sides = [PackedBox::EMPTY; 2];
    let (below, above) = bounds[axis * BINS..(axis + 1) * BINS].split_at(bin + 1);
    for (side, bounds) in sides.iter_mut().zip([below, above]) {
        for bounds in bounds {
            side.grow_on(simd, bounds);
        }
    }
    Some(Plane { binning, axis, bin, bounds: sides })
}

/// One side of each cut of an axis.
struct Sides {
    sizes: [[f32; BINS]; 3],
    leaves: [f32; BINS],
}

impl Sides {
    const NONE: Sides = Sides { sizes: [[0.0; BINS]; 3], leaves: [0.0; BINS] };

    #[inline(always)]
    fn set(&mut self, cut: usize, side: &PackedBox, weight: u32) {
        for axis in 0..3 {
            self.sizes[axis][cut] = side.size(axis);
        }
        self.leaves[cut] = weight.div_ceil(LEAF_SIZE as u32) as f32;
    }

    /// The cost of a side: that a query meets it, times the leaves it then visits.
    #[inline(always)]
    fn cost(&self, cut: usize) -> f32 {
        let [x, y, z] = &self.sizes;
        measure_of([x[cut], y[cut], z[cut]]) * self.leaves[cut]
    }
}

/// The cheapest cut of an axis into bins up to `last`: its cost, and the last bin below it.
#[inline(always)]
fn cheapest<S: Simd>(simd: S, bounds: &[PackedBox], weights: &[u32], last: usize) -> Option<(f32, usize)> {
    let [mut below, mut above] = [Sides::NONE; 2];
    let (mut side, mut weight) = (PackedBox::EMPTY, 0);
    for i in (0..last).rev() {
        side.grow_on(simd, &bounds[i + 1]);
        weight += weights[i + 1];
        above.set(i, &side, weight);
    }
    (side, weight) = (PackedBox::EMPTY, 0);
    for i in 0..last {
        side.grow_on(simd, &bounds[i]);
        weight += weights[i];
        below.set(i, &side, weight);
    }
    let mut costs = [0.0; BINS];
    for (cut, cost) in costs.iter_mut().enumerate() {
        *cost = below.cost(cut) + above.cost(cut);
    }
    let mut best: Option<(f32, usize)> = None;
    for (cut, &cost) in costs[..last].iter().enumerate() {
        // Where a side is empty it is no cut.
        let cuts = below.leaves[cut] > 0.0 && above.leaves[cut] > 0.0;
        if cuts && best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, cut));
        }
    }
    best
}

impl Plane {
    /// Moves the items below the plane to the front, and gives their number.
    #[inline(always)]
    fn part<S: Simd>(&self, simd: S, items: &mut [Item], Spare(spare): &mut Spare) -> usize {
        let is_below = {
            #[inline(always)]
            |item: &Item| {
                let below = self.binning.bins(simd, item).simd_le(i32x4::splat(simd, self.bin as i32));
                below.to_bitmask() >> self.axis & 1 == 1
            }
        };
        if items.len() > SPARE {
            return part_in_place(items, is_below);
        }
        let (mut below, mut above) = (0, 0);
        for i in 0..items.len() {
            let item = items[i];
            let is = usize::from(is_below(&item));
            items[below] = item;
            spare[above] = item;
            below += is;
            above += 1 - is;
        }
        items[below..].copy_from_slice(&spare[..above]);
        below
    }
}

#[inline(always)]
fn part_in_place(items: &mut [Item], is_below: impl Fn(&Item) -> bool) -> usize {
    let (mut front, mut back) = (0, items.len());
    while front < back {
        if is_below(&items[front]) {
            front += 1;
        } else {
            back -= 1;
            items.swap(front, back);
        }
    }
    front
}
