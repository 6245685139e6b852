//! The pairs of subtrees that are to be looked at, by the nodes whose children they are, and which of them comes next.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, i32x8, mask32x8};
use solid_convex::simd::part;

use super::Place;
use super::eights::Overlaps;
use super::lanes::LANES;
use super::node::WIDTH;
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
    /// The first child of each, or the subtree.
    first: [Place; 2],
    /// The bits of a number in `left` that are the lane of each, those of the second when it is shifted: none of a subtree.
    lanes: [u8; 2],
    shift: u8,
}

impl Stack {
    /// Takes all away, and puts a pair of subtrees there.
    pub fn begin(&mut self, subtrees: [Place; 2]) {
        self.used = 0;
        let entry = self.above();
        entry.left.hits = 1;
        (entry.first, entry.lanes) = (subtrees, [0; 2]);
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
    pub fn pop<S: Simd>(&mut self, simd: S, wants_deepest: bool) -> Option<[Place; 2]> {
        let top = self.entries[..self.used].last_mut()?;
        let left = &mut top.left;
        let place = if wants_deepest { left.deepest(simd) } else { left.last() };
        left.hits ^= 1 << place;
        self.used -= usize::from(left.hits == 0);
        let place = place as u32;
        let [lane_a, lane_b] =
            [place & u32::from(top.lanes[0]), place >> top.shift & u32::from(top.lanes[1])];
        Some([top.first[0].after(lane_a), top.first[1].after(lane_b)])
    }

    /// The memory that it owns, in bytes.
    pub fn bytes(&self) -> usize {
        self.entries.capacity() * size_of::<Siblings>()
    }
}

/// So many nodes deep most walks go.
const ROOM: usize = 8;

/// The bits that a lane takes.
const LANE: u8 = WIDTH as u8 - 1;

impl Siblings {
    /// They are the children of two nodes.
    #[inline(always)]
    pub fn of_both(&mut self, node_a: usize, node_b: usize) {
        self.first = [Place::lane(node_a, 0), Place::lane(node_b, 0)];
        (self.lanes, self.shift) = ([LANE; 2], WIDTH.ilog2() as u8);
    }

    /// They are the children of a node of `a`, and a subtree of `b`.
    #[inline(always)]
    pub fn of_a<S: Simd>(&mut self, node: usize, b: Place, (hits, gaps): (u32, f32x8<S>)) {
        self.left.take_row(hits, gaps);
        (self.first, self.lanes) = ([Place::lane(node, 0), b], [LANE, 0]);
    }

    /// The reverse.
    #[inline(always)]
    pub fn of_b<S: Simd>(&mut self, node: usize, a: Place, (hits, gaps): (u32, f32x8<S>)) {
        self.left.take_row(hits, gaps);
        (self.first, self.lanes, self.shift) = ([a, Place::lane(node, 0)], [0, LANE], 0);
    }
}

impl Overlaps {
    /// Boxes that overlap one box.
    #[inline(always)]
    fn take_row<S: Simd>(&mut self, hits: u32, gaps: f32x8<S>) {
        self.hits = u64::from(hits);
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
    fn deepest<S: Simd>(&self, simd: S) -> usize {
        if self.hits.is_power_of_two() { self.last() } else { part!(simd => self.deepest_on(simd)) }
    }

    #[inline(always)]
    fn deepest_on<S: Simd>(&self, simd: S) -> usize {
        let lanes = i32x8::from_slice(simd, &[0, 1, 2, 3, 4, 5, 6, 7]);
        let none = i32x8::splat(simd, -1);
        let mut deepest = none;
        let mut rest = self.hits;
        while rest != 0 {
            let row = rest.trailing_zeros() as usize / WIDTH;
            let hits = rest >> (WIDTH * row) & u64::from(LANES);
            rest ^= hits << (WIDTH * row);
            // The bits of numbers that are not negative are in their order.
            let depths: i32x8<S> = f32x8::load_array_ref(simd, &self.gaps[row]).abs().bitcast();
            let places = lanes + i32x8::splat(simd, (WIDTH * row) as i32);
            let keys = depths & i32x8::splat(simd, !TIE_BITS) | places;
            deepest = deepest.max(mask32x8::from_bitmask(simd, hits).select(keys, none));
        }
        (deepest.reduce_max() & TIE_BITS) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::tests::scenes::rng;
    use rand::Rng;
    use solid_convex::simd::{dispatch, levels};

    /// What is taken from a stack until it is empty, on every level of instructions.
    fn taken(siblings: &Siblings, wants_deepest: bool) -> Vec<[Place; 2]> {
        let all = levels().map(|level| {
            let mut stack = Stack::default();
            stack.above().clone_from(siblings);
            stack.push();
            let next = |_| dispatch!(level, simd => stack.pop(simd, wants_deepest));
            (0..).map_while(next).collect::<Vec<_>>()
        });
        assert_eq!(all[0], all[1]);
        let [_, wide] = all;
        wide
    }

    /// Law: all that are left are taken once; where the deepest are asked for, none after one that is clearly less deep, of equal ones the
    /// highest first; and else the highest first.
    #[test]
    fn the_deepest_comes_first() {
        let mut rng = rng(97);
        for case in 0..3000 {
            let few = 1 + case % 7;
            let mut siblings = Siblings::default();
            siblings.of_both(5, 7);
            let left = &mut siblings.left;
            left.gaps.as_flattened_mut().fill_with(|| match case % 3 {
                0 => -rng.random_range(0.0..1.0f32),
                1 => -(rng.random_range(0..few) as f32),
                _ => -1.0 - rng.random_range(0..few) as f32 * 2f32.powi(-20),
            });
            left.hits = rng.random::<u64>();
            (0..case % 5).for_each(|_| left.hits &= rng.random::<u64>());
            let mut places: Vec<usize> = (0..64).filter(|i| siblings.left.hits >> i & 1 == 1).rev().collect();
            let pairs = |places: &[usize]| -> Vec<[Place; 2]> {
                places.iter().map(|i| [Place::lane(5, i % WIDTH), Place::lane(7, i / WIDTH)]).collect()
            };
            assert_eq!(taken(&siblings, false), pairs(&places), "case {case}");
            // As the key has it: less the last bits.
            let depth = |i: &usize| siblings.left.gaps.as_flattened()[*i].abs().to_bits() >> 6;
            places.sort_by_key(|i| std::cmp::Reverse(depth(i))); // stable
            assert_eq!(taken(&siblings, true), pairs(&places), "case {case}");
        }
    }

    /// The children of one node come with the subtree beside it, and what was on the stack before comes after them.
    #[test]
    fn children_of_one_node_come_with_the_other_subtree() {
        let gaps = [-1.0, -3.0, -2.0, 0.0, 0.0, 0.0, 0.0, -4.0];
        let other = Place::lane(9, 3);
        let all = levels().map(|level| {
            dispatch!(level, simd => {
                let found = (0b1000_0111, f32x8::load_array(simd, gaps));
                let mut stack = Stack::default();
                stack.begin([Place::ROOT, other]);
                let mut taken = vec![stack.pop(simd, true)];
                stack.above().of_a(4, other, found);
                stack.push();
                taken.push(stack.pop(simd, true));
                stack.above().of_b(6, other, found);
                stack.push();
                stack.above().of_b(6, other, (0, found.1));
                stack.push();
                (0..8).for_each(|_| taken.push(stack.pop(simd, true)));
                taken
            })
        });
        let of_a = |lane| Some([Place::lane(4, lane), other]);
        let of_b = |lane| Some([other, Place::lane(6, lane)]);
        let deepest = [7, 1, 2, 0];
        let mut expected = vec![Some([Place::ROOT, other]), of_a(7)];
        expected.extend(deepest.map(of_b));
        expected.extend(deepest[1..].iter().map(|&lane| of_a(lane)));
        expected.push(None);
        assert_eq!(all, [expected.clone(), expected]);
    }
}
