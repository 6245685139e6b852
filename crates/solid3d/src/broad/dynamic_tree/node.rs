//! The 8-wide node: eight boxes as a structure of arrays.

use std::sync::atomic::{AtomicU32, Ordering};

use fearless_simd::{Simd, SimdBase, SimdMask, f32x8};

use super::fat_box::FatBox;
use crate::broad::Proxy;

/// Children of a node.
pub(super) const WIDTH: usize = 8;

/// What a lane of a node holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Node(u32),
    Leaf(Proxy),
}

/// A [`Kind`] in one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Child(u32);

impl Child {
    const LEAF: u32 = 1 << 31;

    pub fn node(index: u32) -> Self {
        Child(index)
    }

    pub fn leaf(proxy: Proxy) -> Self {
        Child(proxy | Child::LEAF)
    }

    pub fn kind(self) -> Kind {
        if self.0 & Child::LEAF == 0 { Kind::Node(self.0) } else { Kind::Leaf(self.0 & !Child::LEAF) }
    }
}

/// A lane of a node: where a child hangs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Place(u32);

impl Place {
    /// Hangs nowhere.
    pub const NONE: Place = Place(u32::MAX);

    pub fn new(node: u32, lane: usize) -> Self {
        Place(node * WIDTH as u32 + lane as u32)
    }

    pub fn node(self) -> u32 {
        self.0 / WIDTH as u32
    }

    pub fn lane(self) -> usize {
        self.0 as usize % WIDTH
    }
}

/// A [`Place`] that is written through a shared reference: a tree is built on several threads, each of which places its own leaves,
/// and what they are called is anywhere among all.
#[derive(Debug)]
pub(super) struct PlaceCell(AtomicU32);

impl Clone for PlaceCell {
    fn clone(&self) -> Self {
        PlaceCell::new(self.get())
    }
}

impl PlaceCell {
    pub fn new(place: Place) -> Self {
        PlaceCell(AtomicU32::new(place.0))
    }

    pub fn get(&self) -> Place {
        Place(self.0.load(Ordering::Relaxed))
    }

    pub fn set(&self, place: Place) {
        // Nobody reads it before the threads are joined.
        self.0.store(place.0, Ordering::Relaxed);
    }
}

/// Up to eight children and their boxes.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct Node {
    /// Lanes from `count` on hold an inverted box, which overlaps nothing.
    min: [[f32; WIDTH]; 3],
    max: [[f32; WIDTH]; 3],
    children: [Child; WIDTH],
    /// Where this node hangs; `Place::NONE` for the root.
    pub parent: Place,
    count: u32,
}

impl Node {
    pub fn empty(parent: Place) -> Self {
        Node {
            min: [[f32::INFINITY; WIDTH]; 3],
            max: [[f32::NEG_INFINITY; WIDTH]; 3],
            children: [Child::node(0); WIDTH],
            parent,
            count: 0,
        }
    }

    /// The lesser and the greater sides of the boxes.
    pub fn sides(&self) -> [&[[f32; WIDTH]; 3]; 2] {
        [&self.min, &self.max]
    }

    pub fn count(&self) -> usize {
        self.count as usize
    }

    pub fn child(&self, lane: usize) -> Kind {
        self.children[lane].kind()
    }

    pub fn set_child(&mut self, lane: usize, child: Child) {
        self.children[lane] = child;
    }

    pub fn lane_box(&self, lane: usize) -> FatBox {
        FatBox {
            min: std::array::from_fn(|k| self.min[k][lane]),
            max: std::array::from_fn(|k| self.max[k][lane]),
        }
    }

    pub fn set_box(&mut self, lane: usize, b: &FatBox) {
        for k in 0..3 {
            self.min[k][lane] = b.min[k];
            self.max[k][lane] = b.max[k];
        }
    }

    /// Adds a child; gives its lane. There must be room.
    pub fn push(&mut self, child: Child, b: &FatBox) -> usize {
        let lane = self.count();
        self.children[lane] = child;
        self.set_box(lane, b);
        self.count += 1;
        lane
    }

    /// Takes a child out; the last child comes into its lane.
    pub fn swap_remove(&mut self, lane: usize) {
        let last = self.count() - 1;
        let moved = self.lane_box(last);
        self.set_box(lane, &moved);
        self.children[lane] = self.children[last];
        self.set_box(last, &FatBox::EMPTY);
        self.count -= 1;
    }

    /// The box around all children.
    pub fn bounds(&self) -> FatBox {
        FatBox {
            min: self.min.each_ref().map(|lanes| best(lanes, |a, b| a < b)),
            max: self.max.each_ref().map(|lanes| best(lanes, |a, b| a > b)),
        }
    }

    /// One box against eight: bit `i` is set where the box of lane `i` overlaps `b`.
    #[inline(always)]
    pub fn overlap_mask<S: Simd>(&self, simd: S, b: &FatBox) -> u32 {
        let above =
            |k: usize| f32x8::load_array_ref(simd, &self.min[k]).simd_le(f32x8::splat(simd, b.max[k]));
        let below =
            |k: usize| f32x8::splat(simd, b.min[k]).simd_le(f32x8::load_array_ref(simd, &self.max[k]));
        let hits = (above(0) & below(0)) & (above(1) & below(1)) & (above(2) & below(2));
        hits.to_bitmask() as u32
    }

    /// The lane whose box grows least in area when `b` joins it, the smaller one among equals. At least one child.
    pub fn cheapest_lane(&self, b: &FatBox) -> usize {
        let mut best = (0, f64::INFINITY, f64::INFINITY);
        for lane in 0..self.count() {
            let lane_box = self.lane_box(lane);
            let area = lane_box.half_area();
            let growth = lane_box.union(b).half_area() - area;
            if growth < best.1 || growth == best.1 && area < best.2 {
                best = (lane, growth, area);
            }
        }
        best.0
    }
}

/// The best of eight numbers: in halves, which the compiler makes vectors of.
fn best(lanes: &[f32; WIDTH], is_better: impl Fn(f32, f32) -> bool) -> f32 {
    let better = |a, b| if is_better(a, b) { a } else { b };
    let four: [f32; 4] = std::array::from_fn(|i| better(lanes[i], lanes[i + 4]));
    let [a, b] = std::array::from_fn(|i| better(four[i], four[i + 2]));
    better(a, b)
}

#[cfg(test)]
mod tests {
    use rand::Rng;
    use solid_convex::simd::dispatch;
    use solid_convex::simd::levels;
    use solid_oracle::generate::seeded;

    use super::*;

    /// Law: at any level, a lane is set where its box overlaps; boxes that touch do, lanes that are not in use do not.
    #[test]
    fn the_mask_is_that_of_box_against_box() {
        let mut rng = seeded(810);
        let mut any_box = || {
            let min: [f32; 3] = std::array::from_fn(|_| rng.random_range(-2..2) as f32);
            let max = std::array::from_fn(|k| min[k] + rng.random_range(0..5) as f32);
            FatBox { min, max }
        };
        let (mut hits, mut tests) = (0, 0);
        for case in 0..2000 {
            let mut node = Node::empty(Place::NONE);
            let boxes: Vec<FatBox> = (0..case % (WIDTH + 1)).map(|_| any_box()).collect();
            for (proxy, b) in (0..).zip(&boxes) {
                node.push(Child::leaf(proxy), b);
            }
            let b = any_box();
            let expected = (0..)
                .zip(&boxes)
                .filter(|(_, other)| other.overlaps(&b))
                .fold(0, |mask, (i, _)| mask | 1 << i);
            for level in levels() {
                assert_eq!(
                    dispatch!(level, simd => node.overlap_mask(simd, &b)),
                    expected,
                    "{level:?}, {b:?}, {boxes:?}"
                );
            }
            hits += expected.count_ones();
            tests += boxes.len() as u32;
        }
        assert!((tests * 3 / 10..tests * 7 / 10).contains(&hits), "{hits} of {tests} overlap");
    }
}
