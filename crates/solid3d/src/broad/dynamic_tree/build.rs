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

use std::ops::Range;

use solid_convex::simd::prefetch;

use super::codes::{MANY, PART, code, encode, proxy, sort, sort_ascending};
use super::fat_box::FatBox;
use super::node::{Child, Node, Place, PlaceCell, WIDTH};
use super::tree::{ROOT, Tree};
use crate::broad::Proxy;
use crate::broad::room::{push, resize_on_threads, room};
use crate::threads::both;

/// From this depth on ranges are halved by order instead of by code: with 2^28 leaves at most 28 more levels follow,
/// fewer than `DEPTH_MAX` in all.
const DEPTH_BY_CODE: usize = 32;

/// Ranges of so many leaves or fewer are cut into full nodes.
const CUT_BY_CODE_MIN: usize = 32;

/// So many leaves before it is hung the box of one is asked for, which is anywhere in memory.
const AHEAD: usize = 32;

/// So many nodes to make are worth another thread.
const NODES_MANY: usize = 1 << 10;

/// A tree in the making, kept for its memory.
#[derive(Debug, Default)]
pub(super) struct Builder {
    /// The leaves, as entries of [`codes`](super::codes).
    order: Vec<u64>,
    /// Where they are sorted to.
    sorted: Vec<u64>,
    /// The upper levels, each node before those below it; leaves hang in them, what else is below does not yet.
    upper: Vec<Node>,
    /// Leaves in the upper levels.
    leaves: Vec<(Proxy, Place)>,
    /// What is below the upper levels, in order.
    below: Vec<Subtree>,
    /// How many of `below` there are.
    subtrees: usize,
}

/// A subtree in the making.
#[derive(Debug)]
struct Subtree {
    /// Its leaves in the order.
    leaves: Range<usize>,
    depth: usize,
    /// Where its root hangs.
    place: Place,
    /// How it is cut: of each range of more than `CUT_BY_CODE_MIN` leaves, each before those in it, the number of pieces and their ends.
    plan: Vec<u32>,
    /// What its nodes are called.
    nodes: Range<usize>,
}

impl Builder {
    /// Makes `tree` a tree of the given leaves, whose boxes are found in `boxes` by proxy.
    pub fn build(&mut self, tree: &mut Tree, leaves: impl Iterator<Item = Proxy>, boxes: &[FatBox]) {
        tree.free.clear();
        self.order.clear();
        room(&mut self.order, boxes.len());
        self.order.extend(leaves.map(u64::from));
        if self.order.is_empty() {
            tree.nodes.clear();
            tree.nodes.push(Node::empty(Place::NONE));
            return;
        }
        if encode(&mut self.order, boxes) {
            sort_ascending(&mut self.order, &mut self.sorted);
        }
        self.upper.clear();
        self.leaves.clear();
        self.subtrees = 0;
        self.cut(0..self.order.len(), Place::NONE, boxes, 1);
        plan(&mut self.below[..self.subtrees], 0, &mut self.order, boxes);
        self.hang(tree, boxes);
    }

    /// Cuts a range until what is left is small.
    fn cut(&mut self, leaves: Range<usize>, place: Place, boxes: &[FatBox], depth: usize) {
        if leaves.len() <= PART {
            if self.subtrees == self.below.len() {
                let (leaves, nodes) = (0..0, 0..0);
                push(&mut self.below, Subtree { leaves, depth, place, plan: Vec::new(), nodes });
            }
            let subtree = &mut self.below[self.subtrees];
            (subtree.leaves, subtree.depth, subtree.place) = (leaves, depth, place);
            self.subtrees += 1;
            return;
        }
        let at = self.upper.len() as u32;
        self.upper.push(Node::empty(place));
        let mut ends = [0; WIDTH];
        let pieces = split(&mut self.order[leaves.clone()], boxes, depth, &mut ends);
        let mut start = leaves.start;
        for &end in &ends[..pieces] {
            let piece = start..leaves.start + end;
            start = piece.end;
            let node = &mut self.upper[at as usize];
            let here = Place::new(at, node.count());
            if piece.len() == 1 {
                let leaf = proxy(self.order[piece.start]);
                node.push(Child::leaf(leaf), &boxes[leaf as usize]);
                self.leaves.push((leaf, here));
            } else {
                // What hangs there, and its box, is known later.
                node.push(Child::node(ROOT), &FatBox { min: [0.0; 3], max: [0.0; 3] });
                self.cut(piece, here, boxes, depth + 1);
            }
        }
    }

    /// Makes the nodes of the subtrees and hangs them below the upper levels.
    fn hang(&mut self, tree: &mut Tree, boxes: &[FatBox]) {
        let Self { order, upper, leaves, below, subtrees, .. } = self;
        let below = &mut below[..*subtrees];
        let mut count = upper.len();
        for subtree in below.iter_mut() {
            subtree.nodes = count..count + subtree.nodes.len();
            count = subtree.nodes.end;
        }
        resize_on_threads(&mut tree.nodes, count, Node::empty(Place::NONE));
        let (upper_nodes, lower_nodes) = tree.nodes.split_at_mut(upper.len());
        upper_nodes.clone_from_slice(upper);
        hang(below, lower_nodes, order, boxes, &tree.places);
        for &(leaf, place) in leaves.iter() {
            tree.places[leaf as usize].set(place);
        }
        for subtree in below.iter() {
            tree.hang(subtree.place, subtree.nodes.start as u32);
        }
        // Each after those below it.
        for at in (1..upper.len() as u32).rev() {
            tree.hang(tree.nodes[at as usize].parent, at);
        }
    }
}

/// Plans subtrees, whose leaves are in `order` from `first` on.
fn plan(below: &mut [Subtree], first: usize, order: &mut [u64], boxes: &[FatBox]) {
    match below {
        [] => {}
        [Subtree { leaves, depth, plan, nodes, .. }] => {
            plan.clear();
            let range = &mut order[leaves.start - first..leaves.end - first];
            *nodes = 0..Planner { boxes, plan }.count(range, *depth);
        }
        _ => {
            let (left, right) = below.split_at_mut(below.len() / 2);
            let middle = right[0].leaves.start;
            let (left_order, right_order) = order.split_at_mut(middle - first);
            both(
                left_order.len() + right_order.len() >= MANY,
                || plan(left, first, left_order, boxes),
                || plan(right, middle, right_order, boxes),
            );
        }
    }
}

/// Makes the nodes of subtrees, which `nodes` has room for.
fn hang(below: &[Subtree], nodes: &mut [Node], order: &[u64], boxes: &[FatBox], places: &[PlaceCell]) {
    match below {
        [] => {}
        [subtree] => {
            let range = &order[subtree.leaves.clone()];
            let mut hanger = Hanger {
                boxes,
                places,
                plan: subtree.plan.iter(),
                first: subtree.nodes.start,
                nodes,
                used: 0,
                later: range.get(AHEAD..).unwrap_or_default().iter(),
            };
            hanger.hang(range, subtree.place);
        }
        [head, ..] => {
            let (left, right) = below.split_at(below.len() / 2);
            let (left_nodes, right_nodes) = nodes.split_at_mut(right[0].nodes.start - head.nodes.start);
            both(
                left_nodes.len() + right_nodes.len() >= NODES_MANY,
                || hang(left, left_nodes, order, boxes, places),
                || hang(right, right_nodes, order, boxes, places),
            );
        }
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
    boxes: &'a [FatBox],
    places: &'a [PlaceCell],
    plan: std::slice::Iter<'a, u32>,
    /// What the first of `nodes` is called.
    first: usize,
    nodes: &'a mut [Node],
    used: usize,
    /// The leaves that are hung [`AHEAD`] leaves later.
    later: std::slice::Iter<'a, u64>,
}

impl Hanger<'_> {
    /// Hangs a range of leaves below a new node at `place`; gives the node and the box around the leaves.
    fn hang(&mut self, range: &[u64], place: Place) -> (u32, FatBox) {
        let at = self.used;
        self.used += 1;
        self.nodes[at] = Node::empty(place);
        let name = (self.first + at) as u32;
        let mut ends = [0; WIDTH];
        let pieces = self.ends(range.len(), &mut ends);
        let mut start = 0;
        for &end in &ends[..pieces] {
            let piece = &range[start..end];
            start = end;
            let here = Place::new(name, self.nodes[at].count());
            if let [entry] = *piece {
                let leaf = proxy(entry);
                if let Some(&later) = self.later.next() {
                    prefetch(&self.boxes[proxy(later) as usize]);
                    prefetch(&self.places[proxy(later) as usize]);
                }
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
    let is_one_cell = code(range[0]) == code(range[range.len() - 1]);
    if depth < DEPTH_BY_CODE && is_one_cell && encode(range, boxes) {
        sort(range);
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
