//! Builds a tree at once, along a Morton curve.
//!
//! The centres are quantised to 10 bits an axis, interleaved and sorted; a range of the order is split where the highest
//! differing bit changes, the largest piece first, until there are eight or none is larger than a node. (Lauterbach et al., *Fast BVH construction on
//! GPUs*, 2009, for the splits.)
//!
//! One box far away would squeeze all others into one cell. So a range that shares one code, yet not one centre, is
//! quantised again within its own bounds.

#[cfg(feature = "rayon")]
use rayon::prelude::*;

use super::fat_box::FatBox;
use super::node::{Child, Node, Place, WIDTH};
use super::tree::{ROOT, Tree};
use crate::broad::Proxy;
use crate::broad::room::{push, room};
use crate::threads::for_each_part;
#[cfg(feature = "rayon")]
use crate::threads::share;

/// From this depth on ranges are halved by order instead of by code: with 2^28 leaves at most 28 more levels follow,
/// fewer than `DEPTH_MAX` in all.
const DEPTH_BY_CODE: usize = 32;

/// There are more leaves than this for each node, inner nodes included; with the reserve of a vector there is room for all nodes.
const LEAVES_PER_NODE: usize = 5;

/// Ranges of so many leaves or fewer are cut into full nodes.
const CUT_BY_CODE_MIN: usize = 32;

/// Bits of a code for each axis.
const BITS: u32 = 10;

/// Leaves that are looked at in one piece.
const PART: usize = 1 << 11;

/// So many, each of some 60 ns, are worth another thread.
const MANY: usize = 1 << 13;

/// The leaves in the making, kept for its memory.
#[derive(Debug, Default)]
pub(super) struct Builder {
    /// Code in the high half, proxy in the low half: sorting is a sort of plain integers.
    order: Vec<u64>,
}

impl Builder {
    /// Makes `tree` a tree of the given leaves, whose boxes are found in `boxes` by proxy.
    pub fn build(&mut self, tree: &mut Tree, leaves: impl Iterator<Item = Proxy>, boxes: &[FatBox]) {
        tree.nodes.clear();
        tree.free.clear();
        tree.nodes.push(Node::empty(Place::NONE));
        self.order.clear();
        room(&mut self.order, boxes.len());
        self.order.extend(leaves.map(u64::from));
        if self.order.is_empty() {
            return;
        }
        room(&mut tree.nodes, self.order.len() / LEAVES_PER_NODE);
        encode(&mut self.order, boxes);
        fill(tree, ROOT, &mut self.order, boxes, 1);
    }
}

fn proxy(entry: u64) -> Proxy {
    entry as Proxy
}

fn code(entry: u64) -> u32 {
    (entry >> 32) as u32
}

/// Gives the entries codes relative to their own bounds, and sorts them. False if all centres are one.
fn encode(order: &mut [u64], boxes: &[FatBox]) -> bool {
    let FatBox { min, max } = bounds_of_centers(order, boxes);
    // In `f64`: the extent of finite `f32` boxes may overflow, and the inverse of a tiny one too.
    let scale: [f64; 3] = std::array::from_fn(|k| {
        let extent = f64::from(max[k]) - f64::from(min[k]);
        if extent > 0.0 { f64::from(1 << BITS) / extent } else { 0.0 }
    });
    if scale == [0.0; 3] {
        return false;
    }
    for_each_part(order, PART, MANY, |_, order| {
        for entry in order {
            let center = boxes[proxy(*entry) as usize].center();
            let cell = |k: usize| {
                let cell = (f64::from(center[k]) - f64::from(min[k])) * scale[k];
                spread((cell as u32).min((1 << BITS) - 1))
            };
            let code = cell(0) | cell(1) << 1 | cell(2) << 2;
            *entry = u64::from(code) << 32 | u64::from(proxy(*entry));
        }
    });
    sort(order);
    true
}

fn bounds_of_centers(order: &[u64], boxes: &[FatBox]) -> FatBox {
    let none = FatBox { min: [f32::MAX; 3], max: [-f32::MAX; 3] };
    let of_part = |order: &[u64]| {
        order.iter().fold(none, |sum, &entry| {
            let center = boxes[proxy(entry) as usize].center();
            sum.union(&FatBox { min: center, max: center })
        })
    };
    #[cfg(feature = "rayon")]
    if share(order.len(), MANY) {
        return order.par_chunks(PART).map(of_part).reduce(|| none, |a, b| a.union(&b));
    }
    of_part(order)
}

/// Entries are all different, so there is one order.
fn sort(order: &mut [u64]) {
    #[cfg(feature = "rayon")]
    if share(order.len(), MANY) {
        return order.par_sort_unstable();
    }
    order.sort_unstable();
}

/// Puts two zero bits between the ten low bits.
fn spread(x: u32) -> u32 {
    let x = (x | x << 16) & 0x0300_00FF;
    let x = (x | x << 8) & 0x0300_F00F;
    let x = (x | x << 4) & 0x030C_30C3;
    (x | x << 2) & 0x0924_9249
}

/// Hangs a range of leaves below a node; gives the box around them.
fn fill(tree: &mut Tree, at: u32, range: &mut [u64], boxes: &[FatBox], depth: usize) -> FatBox {
    let mut ends = [0; WIDTH];
    let pieces = split(range, boxes, depth, &mut ends);
    let mut start = 0;
    for &end in &ends[..pieces] {
        let piece = &mut range[start..end];
        start = end;
        if let [entry] = *piece {
            let leaf = proxy(entry);
            let lane = tree.nodes[at as usize].push(Child::leaf(leaf), &boxes[leaf as usize]);
            tree.places[leaf as usize].set(Place::new(at, lane));
        } else {
            let below = tree.nodes.len() as u32;
            let lane = tree.nodes[at as usize].count();
            push(&mut tree.nodes, Node::empty(Place::new(at, lane)));
            let bounds = fill(tree, below, piece, boxes, depth + 1);
            tree.nodes[at as usize].push(Child::node(below), &bounds);
        }
    }
    tree.nodes[at as usize].bounds()
}

/// Cuts a range into at most eight pieces, single leaves if they are few; writes their ends, gives their number.
fn split(range: &mut [u64], boxes: &[FatBox], depth: usize, ends: &mut [usize; WIDTH]) -> usize {
    if range.len() <= WIDTH {
        for (i, end) in ends[..range.len()].iter_mut().enumerate() {
            *end = i + 1;
        }
        return range.len();
    }
    if range.len() <= CUT_BY_CODE_MIN {
        // Along the curve, whatever the codes: fewer nodes, and those of leaves are full. Of a swarm that takes a fifth of the memory of
        // a tree, for 6 % more visits.
        let pieces = range.len().div_ceil(WIDTH);
        for (i, end) in ends[..pieces].iter_mut().enumerate() {
            *end = (WIDTH * (i + 1)).min(range.len());
        }
        return pieces;
    }
    if depth < DEPTH_BY_CODE && code(range[0]) == code(range[range.len() - 1]) {
        encode(range, boxes);
    }
    ends[0] = range.len();
    for pieces in 1..WIDTH {
        let (mut largest, mut largest_start, mut start) = (0, 0, 0);
        for (i, &end) in ends[..pieces].iter().enumerate() {
            if end - start > ends[largest] - largest_start {
                (largest, largest_start) = (i, start);
            }
            start = end;
        }
        if ends[largest] - largest_start <= WIDTH {
            // Each piece is one node of leaves. To cut further would leave nodes of two or three.
            return pieces;
        }
        let piece = &range[largest_start..ends[largest]];
        let middle = largest_start + middle(piece, depth);
        ends.copy_within(largest..pieces, largest + 1);
        ends[largest] = middle;
    }
    WIDTH
}

/// Where to cut a sorted range of at least two in two: where the highest differing bit of its codes changes.
fn middle(range: &[u64], depth: usize) -> usize {
    let differing = code(range[0]) ^ code(range[range.len() - 1]);
    if differing == 0 || depth >= DEPTH_BY_CODE {
        return range.len() / 2;
    }
    let bit = 31 - differing.leading_zeros();
    range.partition_point(|&entry| code(entry) >> bit & 1 == 0)
}
