//! The 8-wide node: eight boxes as a structure of arrays.

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
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
        self.set_box(last, &FatBox { min: [f32::INFINITY; 3], max: [f32::NEG_INFINITY; 3] });
        self.count -= 1;
    }

    /// The box around all children.
    pub fn bounds(&self) -> FatBox {
        FatBox {
            min: std::array::from_fn(|k| self.min[k].iter().copied().fold(f32::INFINITY, f32::min)),
            max: std::array::from_fn(|k| self.max[k].iter().copied().fold(f32::NEG_INFINITY, f32::max)),
        }
    }

    /// One box against eight: bit `i` is set where the box of lane `i` overlaps `b`.
    #[inline]
    pub fn overlap_mask(&self, b: &FatBox) -> u32 {
        let mut hits = [0u32; WIDTH];
        for (i, hit) in hits.iter_mut().enumerate() {
            // `&`, not `&&`: no branches, so the compiler makes vectors of it.
            let overlaps = (self.min[0][i] <= b.max[0])
                & (b.min[0] <= self.max[0][i])
                & (self.min[1][i] <= b.max[1])
                & (b.min[1] <= self.max[1][i])
                & (self.min[2][i] <= b.max[2])
                & (b.min[2] <= self.max[2][i]);
            *hit = u32::from(overlaps) << i;
        }
        hits.iter().fold(0, |mask, hit| mask | hit)
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

/// Visits the set bits of a mask of lanes, lowest first.
#[inline]
pub(super) fn lanes(mut mask: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (mask != 0).then(|| {
            let lane = mask.trailing_zeros() as usize;
            mask &= mask - 1;
            lane
        })
    })
}
