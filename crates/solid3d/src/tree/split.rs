//! Where to split a set of primitives: binned surface-area heuristic on three axes, and the median where that says nothing.

use super::cost::measure;
use super::node::LEAF_SIZE;
use super::packed::PackedBox;

/// Bins along an axis.
const BINS: usize = 16;

/// A primitive during the build.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    pub bounds: PackedBox,
    pub index: u32,
}

/// A set of primitives, consecutive in the array of items from `start`, and what is known of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Set {
    pub start: usize,
    pub len: usize,
    pub bounds: PackedBox,
    /// Box of the doubled centres.
    centers: PackedBox,
}

impl Set {
    /// The set of `items`, which begin at `start` in the array of all.
    pub fn new(start: usize, items: &[Item]) -> Self {
        let mut set = Set::empty(start);
        items.iter().for_each(|item| set.add(item));
        set
    }

    /// Splits in two, neither empty, reordering the items of the set. The set has at least two items.
    pub fn split(&self, all: &mut [Item]) -> [Set; 2] {
        let items = &mut all[self.start..self.start + self.len];
        match best_plane(self, items) {
            Some(plane) => partition(self.start, items, &plane),
            None => self.split_evenly(all),
        }
    }

    /// Splits at the median centre of the longest axis, at a multiple of the leaf size.
    pub fn split_evenly(&self, all: &mut [Item]) -> [Set; 2] {
        let items = &mut all[self.start..self.start + self.len];
        let half = (self.len / 2).next_multiple_of(LEAF_SIZE).min(self.len - 1);
        let sizes = [0, 1, 2].map(|axis| self.centers.size(axis));
        let axis = (0..3).fold(0, |a, b| if sizes[b] > sizes[a] { b } else { a });
        let key = |item: &Item| item.bounds.center_doubled(axis);
        let order = |a: &Item, b: &Item| key(a).total_cmp(&key(b)).then(a.index.cmp(&b.index));
        items.select_nth_unstable_by(half, order);
        let (below, above) = items.split_at(half);
        [Set::new(self.start, below), Set::new(self.start + half, above)]
    }

    fn empty(start: usize) -> Self {
        Set { start, len: 0, bounds: PackedBox::EMPTY, centers: PackedBox::EMPTY }
    }

    #[inline]
    fn add(&mut self, item: &Item) {
        self.len += 1;
        self.bounds.grow(&item.bounds);
        self.centers.grow(&center(&item.bounds));
    }
}

/// The doubled centre, as a box.
#[inline]
fn center(bounds: &PackedBox) -> PackedBox {
    let b = &bounds.0;
    PackedBox(std::array::from_fn(|i| b[i] - b[(i + 4) % 8]))
}

/// How doubled centres along the axes fall into bins.
struct Binning {
    origin: [f32; 3],
    per_unit: [f32; 3],
    last: usize,
}

impl Binning {
    fn new(set: &Set) -> Self {
        // Few items need few bins: the sweep over empty bins would cost more than the items.
        let bins = if set.len < 2 * BINS { BINS / 2 } else { BINS };
        // An axis without extent divides by zero: infinity times zero is not a number, which converts to bin 0.
        let per_unit = [0, 1, 2].map(|axis| bins as f32 / set.centers.size(axis));
        Binning { origin: set.centers.min(), per_unit, last: bins - 1 }
    }

    #[inline]
    fn bin(&self, item: &Item, axis: usize) -> usize {
        let offset = (item.bounds.center_doubled(axis) - self.origin[axis]) * self.per_unit[axis];
        (offset as i32 as usize).min(self.last)
    }
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: PackedBox,
    len: usize,
}

impl Bin {
    const EMPTY: Bin = Bin { bounds: PackedBox::EMPTY, len: 0 };

    fn grow(&mut self, other: &Bin) {
        self.bounds.grow(&other.bounds);
        self.len += other.len;
    }

    /// The cost of a side: that a query meets it, times the leaves it then visits.
    fn cost(&self) -> f32 {
        measure(&self.bounds) * self.len.div_ceil(LEAF_SIZE) as f32
    }
}

/// A plane between two bins of an axis.
struct Plane {
    binning: Binning,
    axis: usize,
    /// The last bin below.
    bin: usize,
}

/// The cheapest plane; none if all centres coincide.
fn best_plane(set: &Set, items: &[Item]) -> Option<Plane> {
    let binning = Binning::new(set);
    let mut bins = [[Bin::EMPTY; BINS]; 3];
    for item in items {
        for (axis, bins) in bins.iter_mut().enumerate() {
            let bin = &mut bins[binning.bin(item, axis)];
            bin.bounds.grow(&item.bounds);
            bin.len += 1;
        }
    }
    let planes = bins
        .iter()
        .enumerate()
        .filter_map(|(axis, bins)| cheapest(&bins[..=binning.last]).map(|(cost, bin)| (cost, axis, bin)));
    let (_, axis, bin) = planes.reduce(|a, b| if b.0 < a.0 { b } else { a })?;
    Some(Plane { binning, axis, bin })
}

/// The cheapest cut of an axis: its cost, and the last bin below it.
fn cheapest(bins: &[Bin]) -> Option<(f32, usize)> {
    let mut above = [0.0; BINS];
    let mut side = Bin::EMPTY;
    for i in (1..bins.len()).rev() {
        side.grow(&bins[i]);
        above[i] = side.cost();
    }
    let total = side.len + bins[0].len;
    let mut side = Bin::EMPTY;
    let mut best: Option<(f32, usize)> = None;
    for (i, bin) in bins[..bins.len() - 1].iter().enumerate() {
        side.grow(bin);
        if bin.len == 0 || side.len == total {
            continue; // the same cut as one bin before, or none
        }
        let cost = side.cost() + above[i + 1];
        if best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, i));
        }
    }
    best
}

/// Moves the items below the plane to the front, and measures both sides on the way.
fn partition(start: usize, items: &mut [Item], plane: &Plane) -> [Set; 2] {
    let [mut below, mut above] = [Set::empty(start), Set::empty(start)];
    let (mut front, mut back) = (0, items.len());
    while front < back {
        let item = &items[front];
        if plane.binning.bin(item, plane.axis) <= plane.bin {
            below.add(item);
            front += 1;
        } else {
            above.add(item);
            back -= 1;
            items.swap(front, back);
        }
    }
    above.start += below.len;
    [below, above]
}
