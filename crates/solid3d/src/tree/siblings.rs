//! The pairs of subtrees that are to be looked at, by the nodes whose children they are, and which of them comes next.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, i32x8, mask32x8};
use solid_convex::simd::part;

use super::Place;
use super::eights::Overlaps;
use super::lanes::{LANES, extents};
use super::node::{Child, Node, WIDTH};
use super::order::TIE_BITS;

/// Pairs of subtrees to be looked at, depth first: the next is one of those on top. What is taken off leaves its memory there.
#[derive(Clone, Debug, Default)]
pub(super) struct Stack {
    entries: Vec<Siblings>,
    used: usize,
}

/// Those of the pairs of the children of two nodes, or of the children of one node and a subtree, that may overlap and are still to be
/// looked at.
#[derive(Clone, Debug, Default)]
pub(super) struct Siblings {
    /// Which they are, and how deep each overlaps. The children of one node stand where those of `a` against the first of `b` do.
    pub left: Overlaps,
    /// Those of `a`, and those of `b`.
    sides: [Side; 2],
    /// How far the bits of a number in `left` are shifted to be the lane of the second.
    shift: u8,
}

/// The children of one node, or a subtree.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
struct Side {
    children: [Child; WIDTH],
    extents: [f32; WIDTH],
    /// The first.
    first: Place,
    /// The bits of its lane: none of a subtree.
    lanes: u32,
}

/// A subtree that is to be looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Subtree {
    pub place: Place,
    pub child: Child,
    /// The size of its box.
    pub extent: f32,
}

impl Stack {
    /// Takes all away, and puts a pair of subtrees there.
    pub fn begin(&mut self, [a, b]: [Subtree; 2]) {
        self.used = 0;
        let entry = self.above();
        (entry.left.hits, entry.left.deepest) = (1, None);
        entry.sides[0].set_subtree(&a);
        entry.sides[1].set_subtree(&b);
        self.push();
    }

    /// What is above those on top, to be written: anything is in it.
    #[inline(always)]
    pub fn above(&mut self) -> &mut Siblings {
        if self.used == self.entries.len() {
            self.grow();
        }
        &mut self.entries[self.used]
    }

    #[cold]
    #[inline(never)]
    fn grow(&mut self) {
        self.entries.resize(self.used + ROOM, Siblings::default());
    }

    /// Makes what is [`above`](Stack::above) the top, if there is any pair in it.
    #[inline(always)]
    pub fn push(&mut self) {
        self.used += usize::from(self.entries[self.used].left.hits != 0);
    }

    /// Takes the next pair off: of those on top the one that overlaps deepest, if that is wanted, or the last.
    #[inline(always)]
    pub fn pop<S: Simd>(&mut self, simd: S, wants_deepest: bool) -> Option<[Subtree; 2]> {
        let top = self.entries[..self.used].last_mut()?;
        let left = &mut top.left;
        let place = if wants_deepest { left.take_deepest(simd) } else { left.last() };
        left.hits ^= 1 << place;
        self.used -= usize::from(left.hits == 0);
        let place = place as u32;
        Some([top.sides[0].subtree(place), top.sides[1].subtree(place >> top.shift)])
    }

    /// The memory that it owns, in bytes.
    pub fn bytes(&self) -> usize {
        self.entries.capacity() * size_of::<Siblings>()
    }
}

/// So many nodes deep most walks go.
const ROOM: usize = 8;

/// The bits that a lane takes.
const LANE: u32 = WIDTH as u32 - 1;

impl Subtree {
    /// A whole tree, given the size of its box.
    pub fn root(extent: f32) -> Self {
        Subtree { place: Place::ROOT, child: Child::inner(0), extent }
    }
}

impl Default for Side {
    fn default() -> Self {
        Side { children: [Child::EMPTY; WIDTH], extents: [0.0; WIDTH], first: Place::ROOT, lanes: 0 }
    }
}

impl Side {
    #[inline(always)]
    fn set_children<S: Simd>(&mut self, simd: S, (index, node): (usize, &Node)) {
        (self.children, self.extents) = (node.child, extents(simd, node));
        (self.first, self.lanes) = (Place::lane(index, 0), LANE);
    }

    #[inline(always)]
    fn set_subtree(&mut self, subtree: &Subtree) {
        (self.children[0], self.extents[0]) = (subtree.child, subtree.extent);
        (self.first, self.lanes) = (subtree.place, 0);
    }

    /// That in the lane of which some bits are given.
    #[inline(always)]
    fn subtree(&self, bits: u32) -> Subtree {
        let lane = bits & self.lanes;
        let at = (lane & LANE) as usize;
        Subtree { place: self.first.after(lane), child: self.children[at], extent: self.extents[at] }
    }
}

impl Siblings {
    /// They are the children of two nodes.
    #[inline(always)]
    pub fn of_both<S: Simd>(&mut self, simd: S, a: (usize, &Node), b: (usize, &Node)) {
        self.sides[0].set_children(simd, a);
        self.sides[1].set_children(simd, b);
        self.shift = WIDTH.ilog2() as u8;
    }

    /// They are the children of a node of `a`, and a subtree of `b`.
    #[inline(always)]
    pub fn of_a<S: Simd>(&mut self, simd: S, a: (usize, &Node), b: &Subtree, found: (u32, f32x8<S>)) {
        self.left.take_row(found);
        self.sides[0].set_children(simd, a);
        self.sides[1].set_subtree(b);
    }

    /// The reverse.
    #[inline(always)]
    pub fn of_b<S: Simd>(&mut self, simd: S, b: (usize, &Node), a: &Subtree, found: (u32, f32x8<S>)) {
        self.left.take_row(found);
        self.sides[0].set_subtree(a);
        self.sides[1].set_children(simd, b);
        self.shift = 0;
    }
}

impl Overlaps {
    /// Boxes that overlap one box.
    #[inline(always)]
    fn take_row<S: Simd>(&mut self, (hits, gaps): (u32, f32x8<S>)) {
        (self.hits, self.deepest) = (u64::from(hits), None);
        self.gaps[0] = gaps.to_array();
    }

    /// The last pair in the order of places.
    #[inline(always)]
    fn last(&self) -> usize {
        self.hits.ilog2() as usize
    }

    /// The pair that overlaps deepest, in numbers compared to within 2^-17 of them; of equal ones the last.
    ///
    /// Most of the pairs are never looked at: to bring them all into this order took twice as long, each told its place by how many come
    /// before it.
    #[inline(always)]
    pub fn take_deepest<S: Simd>(&mut self, simd: S) -> usize {
        match self.deepest.take() {
            Some(deepest) => usize::from(deepest),
            None if self.hits.is_power_of_two() => self.last(),
            None => part!(simd => self.deepest_on(simd)),
        }
    }

    #[inline(always)]
    fn deepest_on<S: Simd>(&self, simd: S) -> usize {
        let mut deepest = Deepest::new(simd);
        let mut rest = self.hits;
        while rest != 0 {
            let row = rest.trailing_zeros() as usize / WIDTH;
            let hits = rest >> (WIDTH * row) & u64::from(LANES);
            rest ^= hits << (WIDTH * row);
            let gaps = f32x8::load_array_ref(simd, &self.gaps[row]);
            deepest.take(simd, row, mask32x8::from_bitmask(simd, hits), gaps);
        }
        usize::from(deepest.place())
    }
}

/// Of pairs that overlap, the one that does so deepest.
pub(super) struct Deepest<S: Simd> {
    /// Of each lane, by a key: how deep, and the place in the last bits; -1 of none.
    keys: i32x8<S>,
}

impl<S: Simd> Deepest<S> {
    /// Of none.
    #[inline(always)]
    pub fn new(simd: S) -> Self {
        Deepest { keys: i32x8::splat(simd, -1) }
    }

    /// Takes in those of a row that overlap, given the gaps of all that are there.
    #[inline(always)]
    pub fn take(&mut self, simd: S, row: usize, hits: mask32x8<S>, gaps: f32x8<S>) {
        // The bits of numbers that are not negative are in their order.
        let depths: i32x8<S> = gaps.abs().bitcast();
        let lanes = i32x8::from_slice(simd, &[0, 1, 2, 3, 4, 5, 6, 7]);
        let places = lanes + i32x8::splat(simd, (WIDTH * row) as i32);
        let keys = depths & i32x8::splat(simd, !TIE_BITS) | places;
        self.keys = self.keys.max(hits.select(keys, i32x8::splat(simd, -1)));
    }

    /// The place of the deepest, if there is any.
    #[inline(always)]
    pub fn place(&self) -> u8 {
        (self.keys.reduce_max() & TIE_BITS) as u8
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::packed::PackedBox;
    use crate::tree::tests::scenes::rng;
    use rand::Rng;
    use solid_convex::simd::{alike, dispatch};

    /// A node of which no two children are alike.
    fn node(index: usize) -> Node {
        let mut node = Node::EMPTY;
        for lane in 0..WIDTH {
            let size = lane as f32;
            node.set_lane(lane, &PackedBox([0.0, 0.0, 0.0, 0.0, -size, -0.25, -2.0 * size, 0.0]));
            node.child[lane] = Child::inner(WIDTH * index + lane);
        }
        node
    }

    /// The subtree in a lane of it.
    fn child_of(index: usize, lane: usize) -> Subtree {
        let child = Child::inner(WIDTH * index + lane);
        Subtree { place: Place::lane(index, lane), child, extent: 0.25 + 3.0 * lane as f32 }
    }

    /// What is taken from a stack until it is empty, on every level of instructions.
    fn taken(siblings: &Siblings, wants_deepest: bool) -> Vec<[Subtree; 2]> {
        alike(|level| {
            let mut stack = Stack::default();
            stack.above().clone_from(siblings);
            stack.push();
            let next = |_| dispatch!(widest level, simd => stack.pop(simd, wants_deepest));
            (0..).map_while(next).collect::<Vec<_>>()
        })
    }

    /// Law: all that are left are taken once; where the deepest are asked for, none after one that is clearly less deep, of equal ones the
    /// highest first; and else the highest first.
    #[test]
    fn the_deepest_comes_first() {
        let mut rng = rng(97);
        for case in 0..3000 {
            let few = 1 + case % 7;
            let mut siblings = Siblings::default();
            dispatch!(simd => siblings.of_both(simd, (5, &node(5)), (7, &node(7))));
            let left = &mut siblings.left;
            left.gaps.as_flattened_mut().fill_with(|| match case % 3 {
                0 => -rng.random_range(0.0..1.0f32),
                1 => -(rng.random_range(0..few) as f32),
                _ => -1.0 - rng.random_range(0..few) as f32 * 2f32.powi(-20),
            });
            left.hits = rng.random::<u64>();
            (0..case % 5).for_each(|_| left.hits &= rng.random::<u64>());
            let mut places: Vec<usize> = (0..64).filter(|i| siblings.left.hits >> i & 1 == 1).rev().collect();
            let pairs = |places: &[usize]| -> Vec<[Subtree; 2]> {
                places.iter().map(|i| [child_of(5, i % WIDTH), child_of(7, i / WIDTH)]).collect()
            };
            assert_eq!(taken(&siblings, false), pairs(&places), "case {case}");
            // As the key has it: less the last bits.
            let depth = |i: &usize| siblings.left.gaps.as_flattened()[*i].abs().to_bits() >> 6;
            places.sort_by_key(|i| std::cmp::Reverse(depth(i))); // stable
            assert_eq!(taken(&siblings, true), pairs(&places), "case {case}");
            // Nothing else comes if the first is known.
            siblings.left.deepest = places.first().map(|&place| place as u8);
            assert_eq!(taken(&siblings, true), pairs(&places), "case {case}");
        }
    }

    /// The children of one node come with the subtree beside it, and what was on the stack before comes after them.
    #[test]
    fn children_of_one_node_come_with_the_other_subtree() {
        let gaps = [-1.0, -3.0, -2.0, 0.0, 0.0, 0.0, 0.0, -4.0];
        let (root, other) = (Subtree::root(1.0), child_of(9, 3));
        let (node_a, node_b) = (node(4), node(6));
        let (node_a, node_b) = ((4, &node_a), (6, &node_b));
        let taken = alike(|level| {
            dispatch!(widest level, simd => {
                let found = (0b1000_0111, f32x8::load_array(simd, gaps));
                let mut stack = Stack::default();
                stack.begin([root, other]);
                let mut taken = vec![stack.pop(simd, true)];
                stack.above().of_a(simd, node_a, &other, found);
                stack.push();
                taken.push(stack.pop(simd, true));
                stack.above().of_b(simd, node_b, &other, found);
                stack.push();
                stack.above().of_b(simd, node_b, &other, (0, found.1));
                stack.push();
                (0..8).for_each(|_| taken.push(stack.pop(simd, true)));
                taken
            })
        });
        let of_a = |lane| Some([child_of(4, lane), other]);
        let of_b = |lane| Some([other, child_of(6, lane)]);
        let deepest = [7, 1, 2, 0];
        let mut expected = vec![Some([root, other]), of_a(7)];
        expected.extend(deepest.map(of_b));
        expected.extend(deepest[1..].iter().map(|&lane| of_a(lane)));
        expected.push(None);
        assert_eq!(taken, expected);
    }
}
