//! Builds a tree at once, along a Morton curve.
//!
//! The centres are quantised to 10 bits an axis, interleaved and sorted; a range of the order is split where the highest
//! differing bit changes, the largest piece first, until there are eight or none is larger than a node. (Lauterbach et al., *Fast BVH construction on
//! GPUs*, 2009, for the splits.)
//!
//! One box far away would squeeze all others into one cell. So a range that shares one code, yet not one centre, is
//! quantised again within its own bounds.
//!
//! The upper levels are cut first, into ranges small enough that there are many of them. Each is then planned, which says how many nodes
//! it takes, and hung into its own stretch of the nodes: both on all threads. Ranges depend on the boxes alone, so the tree does.

#[cfg(feature = "rayon")]
use rayon::prelude::*;

use super::fat_box::FatBox;
use super::node::{Child, Node, Place, PlaceCell, WIDTH};
use super::tree::{ROOT, Tree};
use crate::broad::Proxy;
use crate::broad::room::resize_on_threads;
use crate::threads::for_each_part;
#[cfg(feature = "rayon")]
use crate::threads::share;

/// From this depth on ranges are halved by order instead of by code: with 2^28 leaves at most 28 more levels follow,
/// fewer than `DEPTH_MAX` in all.
const DEPTH_BY_CODE: usize = 32;

/// Ranges of so many leaves or fewer are cut into full nodes.
const CUT_BY_CODE_MIN: usize = 32;

/// Bits of a code for each axis.
const BITS: u32 = 10;

/// Leaves that are looked at in one piece.
const PART: usize = 1 << 11;

/// So many, each of some 60 ns, are worth another thread.
const MANY: usize = 1 << 13;

/// So many subtrees are.
const SUBTREES_MANY: usize = 4;

/// Makes `tree` a tree of the given leaves, whose boxes are found in `boxes` by proxy.
pub(super) fn build(tree: &mut Tree, leaves: impl Iterator<Item = Proxy>, boxes: &[FatBox]) {
    tree.free.clear();
    // Code in the high half, proxy in the low half: sorting is a sort of plain integers.
    let mut order: Vec<u64> = Vec::with_capacity(boxes.len());
    order.extend(leaves.map(u64::from));
    if order.is_empty() {
        tree.nodes.clear();
        tree.nodes.push(Node::empty(Place::NONE));
        return;
    }
    encode(&mut order, boxes);
    let mut upper = Upper::default();
    upper.cut(&mut order, Place::NONE, boxes, 1);
    hang(tree, upper, boxes);
}

/// The upper levels of a tree in the making.
#[derive(Debug, Default)]
struct Upper<'a> {
    /// Each before those below it; leaves hang in them, what else is below does not yet.
    nodes: Vec<Node>,
    /// Leaves in `nodes`.
    leaves: Vec<(Proxy, Place)>,
    below: Vec<Subtree<'a>>,
}

/// A subtree in the making.
#[derive(Debug)]
struct Subtree<'a> {
    range: &'a mut [u64],
    depth: usize,
    /// Where its root hangs.
    place: Place,
    /// How it is cut: of each range of more than `CUT_BY_CODE_MIN` leaves, each before those in it, the number of pieces and their ends.
    plan: Vec<u32>,
    nodes: usize,
}

impl<'a> Upper<'a> {
    /// Cuts a range until what is left is small.
    fn cut(&mut self, mut range: &'a mut [u64], place: Place, boxes: &[FatBox], depth: usize) {
        if range.len() <= PART {
            self.below.push(Subtree { range, depth, place, plan: Vec::new(), nodes: 0 });
            return;
        }
        let at = self.nodes.len() as u32;
        self.nodes.push(Node::empty(place));
        let mut ends = [0; WIDTH];
        let pieces = split(range, boxes, depth, &mut ends);
        let mut start = 0;
        for &end in &ends[..pieces] {
            let (piece, rest) = range.split_at_mut(end - start);
            (start, range) = (end, rest);
            let lane = self.nodes[at as usize].count();
            let here = Place::new(at, lane);
            if let [entry] = *piece {
                let leaf = proxy(entry);
                self.nodes[at as usize].push(Child::leaf(leaf), &boxes[leaf as usize]);
                self.leaves.push((leaf, here));
            } else {
                // What hangs there, and its box, is known later.
                self.nodes[at as usize].push(Child::node(ROOT), &FatBox { min: [0.0; 3], max: [0.0; 3] });
                self.cut(piece, here, boxes, depth + 1);
            }
        }
    }
}

/// Makes the subtrees and hangs them below the upper levels.
fn hang(tree: &mut Tree, upper: Upper, boxes: &[FatBox]) {
    let Upper { nodes: upper, leaves, mut below } = upper;
    for_each_part(&mut below, 1, SUBTREES_MANY, |_, subtrees| {
        for subtree in subtrees {
            let mut planner = Planner { boxes, plan: &mut subtree.plan };
            subtree.nodes = planner.count(subtree.range, subtree.depth);
        }
    });
    let count = upper.len() + below.iter().map(|subtree| subtree.nodes).sum::<usize>();
    if count > tree.nodes.capacity() {
        // Not one more: most trees that are built are as large until the next is.
        tree.nodes = Vec::new();
        tree.nodes.reserve_exact(count);
    }
    resize_on_threads(&mut tree.nodes, count, Node::empty(Place::NONE));
    let (upper_nodes, mut rest) = tree.nodes.split_at_mut(upper.len());
    upper_nodes.clone_from_slice(&upper);
    let mut first = upper.len() as u32;
    let mut hangers: Vec<Hanger> = Vec::with_capacity(below.len());
    for subtree in &below {
        let (nodes, others) = rest.split_at_mut(subtree.nodes);
        rest = others;
        let plan = subtree.plan.iter();
        hangers.push(Hanger { subtree, boxes, places: &tree.places, plan, first, nodes, used: 0 });
        first += subtree.nodes as u32;
    }
    for_each_part(&mut hangers, 1, SUBTREES_MANY, |_, hangers| {
        for hanger in hangers {
            hanger.hang(hanger.subtree.range, hanger.subtree.place);
        }
    });
    for (leaf, place) in leaves {
        tree.places[leaf as usize].set(place);
    }
    let mut first = upper.len() as u32;
    for subtree in &below {
        tree.hang(subtree.place, first);
        first += subtree.nodes as u32;
    }
    // Each after those below it.
    for at in (1..upper.len() as u32).rev() {
        tree.hang(tree.nodes[at as usize].parent, at);
    }
}

impl Tree {
    /// Puts a node and its box where it hangs.
    fn hang(&mut self, place: Place, node: u32) {
        if place != Place::NONE {
            let bounds = self.nodes[node as usize].bounds();
            let parent = &mut self.nodes[place.node() as usize];
            parent.set_child(place.lane(), Child::node(node));
            parent.set_box(place.lane(), &bounds);
        }
    }
}

/// Writes the plan of a subtree.
struct Planner<'a> {
    boxes: &'a [FatBox],
    plan: &'a mut Vec<u32>,
}

impl Planner<'_> {
    /// Plans a range; gives the number of nodes that it takes.
    fn count(&mut self, range: &mut [u64], depth: usize) -> usize {
        let mut ends = [0; WIDTH];
        let pieces = split(range, self.boxes, depth, &mut ends);
        if range.len() > CUT_BY_CODE_MIN {
            self.plan.push(pieces as u32);
            self.plan.extend(ends[..pieces].iter().map(|&end| end as u32));
        }
        let (mut nodes, mut start) = (1, 0);
        for &end in &ends[..pieces] {
            if end - start > 1 {
                nodes += self.count(&mut range[start..end], depth + 1);
            }
            start = end;
        }
        nodes
    }
}

/// Makes the nodes of a subtree, by its plan.
struct Hanger<'a> {
    subtree: &'a Subtree<'a>,
    boxes: &'a [FatBox],
    places: &'a [PlaceCell],
    plan: std::slice::Iter<'a, u32>,
    /// What the first of `nodes` is called.
    first: u32,
    nodes: &'a mut [Node],
    used: usize,
}

impl Hanger<'_> {
    /// Hangs a range of leaves below a new node at `place`; gives the node and the box around the leaves.
    fn hang(&mut self, range: &[u64], place: Place) -> (u32, FatBox) {
        let at = self.used;
        self.used += 1;
        self.nodes[at] = Node::empty(place);
        let name = self.first + at as u32;
        let mut ends = [0; WIDTH];
        let pieces = self.ends(range.len(), &mut ends);
        let mut start = 0;
        for &end in &ends[..pieces] {
            let piece = &range[start..end];
            start = end;
            let here = Place::new(name, self.nodes[at].count());
            if let [entry] = *piece {
                let leaf = proxy(entry);
                self.nodes[at].push(Child::leaf(leaf), &self.boxes[leaf as usize]);
                self.places[leaf as usize].set(here);
            } else {
                let (below, bounds) = self.hang(piece, here);
                self.nodes[at].push(Child::node(below), &bounds);
            }
        }
        (name, self.nodes[at].bounds())
    }

    /// The ends of the pieces of the range that is next.
    fn ends(&mut self, leaves: usize, ends: &mut [usize; WIDTH]) -> usize {
        if leaves <= CUT_BY_CODE_MIN {
            return split_few(leaves, ends);
        }
        let mut next = || *self.plan.next().expect("the plan has all ranges") as usize;
        let pieces = next();
        ends[..pieces].fill_with(next);
        pieces
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

/// Cuts a range of at most `CUT_BY_CODE_MIN` leaves, whatever their codes: into single leaves, or along the curve into full nodes.
fn split_few(leaves: usize, ends: &mut [usize; WIDTH]) -> usize {
    // Fewer nodes than cutting by code. Of a swarm that takes a fifth of the memory of a tree, for 6 % more visits.
    let piece = if leaves <= WIDTH { 1 } else { WIDTH };
    let pieces = leaves.div_ceil(piece);
    for (i, end) in ends[..pieces].iter_mut().enumerate() {
        *end = (piece * (i + 1)).min(leaves);
    }
    pieces
}

/// Cuts a range into at most eight pieces, single leaves if they are few; writes their ends, gives their number.
fn split(range: &mut [u64], boxes: &[FatBox], depth: usize, ends: &mut [usize; WIDTH]) -> usize {
    if range.len() <= CUT_BY_CODE_MIN {
        return split_few(range.len(), ends);
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
