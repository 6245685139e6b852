//! New boxes in the same topology (thesis, 5.2.5).
//!
//! One backward loop gives every node its boxes: those of its leaves from what is in them, those of its children from their lanes. It goes
//! block by block: a few nodes of each wait for later blocks, all else is the same whichever block comes first. So several threads
//! give the same bits as one, the cost included, which is summed in each block and then over the blocks.

use std::ops::Range;

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4};
use glam::DVec3;
use solid_convex::simd::{Level, dispatch, level};

use super::Tree;
use super::build::proper;
use super::cost::{BLOCK, Measured, measure_lanes};
use super::leaf_points::LeafPoints;
use super::node::{Kind, Node};
use super::normal::{GROWTH, GROWTH_RELATIVE, Normal};
use crate::Aabb;

impl Tree {
    /// Gives every node the box of its primitives as they are now: linear, bottom-up, without allocation.
    ///
    /// Calls `box_of` once for each primitive, and once more when the root has left the coordinates of the tree, or has
    /// become small in them. Ask [`degraded`](Tree::degraded) afterwards.
    ///
    /// # Panics
    ///
    /// As [`build`](Tree::build), for boxes that are none. The tree is then unfit for queries.
    ///
    /// ```
    /// # use solid3d::{Aabb, glam::DVec3, tree::Tree};
    /// let at = |x: f64| Aabb::new(DVec3::splat(x), DVec3::splat(x + 1.0));
    /// let mut tree = Tree::build(&[at(0.0), at(2.0)]);
    /// tree.refit(|i| at(f64::from(i) + 50.0));
    /// assert_eq!(tree.bounds(), Aabb::new(DVec3::splat(50.0), DVec3::splat(52.0)));
    /// ```
    pub fn refit(&mut self, box_of: impl Fn(u32) -> Aabb) {
        self.refit_by(|tree, normal| {
            let Tree { nodes, order, .. } = tree;
            let set_leaves = |_, node: &mut Node| {
                let mut total = Aabb::EMPTY;
                for lane in 0..node.child.len() {
                    if let Kind::Leaf(range) = node.child[lane].kind() {
                        let boxes = order[range].iter().map(|&primitive| box_of(primitive));
                        // Rounding is monotone, so packing the union gives the bits of the union of the packed.
                        let bounds = boxes.fold(Aabb::EMPTY, |sum, bounds| sum.union(proper(&bounds)));
                        node.set_lane(lane, &normal.pack(&bounds));
                        total = total.union(&bounds);
                    }
                }
                total
            };
            dispatch!(simd => pass(simd, nodes, set_leaves))
        });
    }

    /// The same for primitives that are hulls of points, whose coordinates must be within
    /// [`COORDINATE_MAX`](super::COORDINATE_MAX); with the feature `rayon` on the threads of the current pool, if the tree is large.
    pub(crate) fn refit_points(&mut self, points: &LeafPoints, positions: &[DVec3]) {
        self.refit_points_on(level(), points, positions);
    }

    pub(super) fn refit_points_on(&mut self, level: Level, points: &LeafPoints, positions: &[DVec3]) {
        self.refit_by(|tree, normal| {
            #[cfg(feature = "rayon")]
            if threads::share(tree.nodes.len()) {
                return threads::pass(level, tree, points, positions, normal);
            }
            dispatch!(level, simd => pass(
                simd,
                &mut tree.nodes,
                #[inline(always)]
                |index, node| set_leaves(simd, node, points.of_node(index), positions, normal),
            ))
        });
    }

    /// Refits by a pass over the nodes in given tree coordinates.
    fn refit_by(&mut self, pass: impl Fn(&mut Tree, &Normal) -> Measured) {
        let mut normal = self.normal;
        let mut measured = pass(self, &normal);
        if !normal.suits(&measured.bounds) {
            normal = Normal::of(&measured.bounds);
            if normal != self.normal {
                measured = pass(self, &normal);
            }
        }
        self.normal = normal;
        self.take(&measured);
    }
}

/// Gives all nodes their boxes; `set_leaves` those of leaves, and gives their tight union.
#[inline(always)]
fn pass<S: Simd>(
    simd: S,
    nodes: &mut [Node],
    mut set_leaves: impl FnMut(usize, &mut Node) -> Aabb,
) -> Measured {
    let mut measured = Measured::NONE;
    for block in (0..nodes.len().div_ceil(BLOCK)).rev() {
        let start = block * BLOCK;
        let end = nodes.len().min(start + BLOCK);
        // A closure of its own: a reference to the one that was given would be called, in code without vectors.
        let block = Block::set(
            simd,
            &mut nodes[start..end],
            start,
            #[inline(always)]
            |index, node| set_leaves(index, node),
        );
        measured.add(&block.finish(simd, &mut nodes[start..], start));
    }
    measured
}

/// Nodes that stand one after the other, of which those are not done yet that wait for later ones.
#[derive(Clone, Copy, Debug)]
pub(super) struct Block {
    measured: Measured,
    /// A bit for each node that waits.
    waiting: [u64; BLOCK / 64],
}

impl Block {
    #[cfg(feature = "rayon")]
    const NONE: Block = Block { measured: Measured::NONE, waiting: [0; BLOCK / 64] };

    /// Gives the nodes of a block their boxes, where they depend on the block alone. The first is number `start` of all.
    #[inline(always)]
    fn set<S: Simd>(
        simd: S,
        nodes: &mut [Node],
        start: usize,
        mut set_leaves: impl FnMut(usize, &mut Node) -> Aabb,
    ) -> Block {
        let (mut bounds, mut waiting) = (Aabb::EMPTY, [0; BLOCK / 64]);
        // Nodes stand depth first: so what has nodes below it after the block are the ancestors of the first of these, each the parent of
        // the one that was found before.
        let mut last_waiting = nodes.len();
        for index in (0..nodes.len()).rev() {
            bounds = bounds.union(&set_leaves(start + index, &mut nodes[index]));
            if !set_children(nodes, start, index, 0..last_waiting) {
                waiting[index / 64] |= 1 << (index % 64);
                last_waiting = index;
            }
        }
        let block = Block { measured: Measured::NONE, waiting };
        // Not node by node: lanes that were just written one by one cannot be read as a vector without waiting.
        let done = nodes.iter().enumerate().rev().filter(|(index, _)| !block.waits(*index));
        let sum = measure_lanes(simd, done.map(|(_, node)| node));
        Block { measured: Measured { bounds, sum }, ..block }
    }

    #[inline(always)]
    fn waits(&self, index: usize) -> bool {
        self.waiting[index / 64] >> (index % 64) & 1 != 0
    }

    /// Gives the nodes that waited their boxes, and says what was found out of all; `nodes` are those of the block and all after it.
    #[inline(never)] // apart from what is done for every node
    fn finish<S: Simd>(&self, simd: S, nodes: &mut [Node], start: usize) -> Measured {
        simd.vectorize(
            #[inline(always)]
            || self.finish_on(simd, nodes, start),
        )
    }

    #[inline(always)]
    fn finish_on<S: Simd>(&self, simd: S, nodes: &mut [Node], start: usize) -> Measured {
        let mut measured = self.measured;
        let mut last_waiting = BLOCK;
        for (word, &waiting) in self.waiting.iter().enumerate().rev() {
            let mut waiting = waiting;
            while let Some(bit) = waiting.checked_ilog2() {
                let index = word * 64 + bit as usize;
                set_children(nodes, start, index, last_waiting..usize::MAX);
                measured.sum += measure_lanes(simd, std::iter::once(&nodes[index]));
                last_waiting = index;
                waiting ^= 1 << bit;
            }
        }
        measured
    }
}

/// Gives the inner lanes of a node their boxes, from nodes after it: those lanes that hold `those` nodes; `false` when there is one beyond. The first node
/// is number `start` of all; `those` count from it.
#[inline(always)]
fn set_children(nodes: &mut [Node], start: usize, index: usize, those: Range<usize>) -> bool {
    let (before, after) = nodes.split_at_mut(index + 1);
    let node = &mut before[index];
    for lane in 0..node.child.len() {
        if let Kind::Inner(child) = node.child[lane].kind() {
            let child = child - start;
            if child >= those.end {
                return false;
            }
            if child >= those.start {
                node.set_lane(lane, &after[child - index - 1].union());
            }
        }
    }
    true
}

/// Gives the leaves of a node the boxes around their points, and gives the tight union.
#[inline(always)]
fn set_leaves<'p, S: Simd>(
    simd: S,
    node: &mut Node,
    leaves: impl Iterator<Item = &'p [u32]>,
    positions: &[DVec3],
    normal: &Normal,
) -> Aabb {
    let splat = |x: f64| f64x4::splat(simd, x);
    let (mut least_of_all, mut greatest_of_all) = (splat(f64::INFINITY), splat(f64::NEG_INFINITY));
    let origin = four(simd, normal.origin);
    for (lane, leaf) in leaves.enumerate() {
        if leaf.is_empty() {
            continue;
        }
        let (mut least, mut greatest) = (splat(f64::INFINITY), splat(f64::NEG_INFINITY));
        for &point in leaf {
            let position = four(simd, positions[point as usize]);
            least = least.min(position);
            greatest = greatest.max(position);
        }
        least_of_all = least_of_all.min(least);
        greatest_of_all = greatest_of_all.max(greatest);
        // As `Normal::pack` does.
        let inverse = splat(normal.inverse);
        let min = round_down(simd, (least - origin) * inverse);
        let max = round_down(simd, (origin - greatest) * inverse);
        for axis in 0..3 {
            node.min[axis][lane] = min[axis];
            node.max[axis][lane] = -max[axis];
        }
    }
    // Of zeros with two signs either may have been the least: the sum has one.
    let three = |v: f64x4<S>| DVec3::from_slice(&(v + splat(0.0)).to_array()[..3]);
    Aabb::new(three(least_of_all), three(greatest_of_all))
}

#[inline(always)]
fn four<S: Simd>(simd: S, v: DVec3) -> f64x4<S> {
    f64x4::load_array(simd, [v.x, v.y, v.z, v.z])
}

/// As [`normal::round_down`](super::normal::round_down).
#[inline(always)]
fn round_down<S: Simd>(simd: S, v: f64x4<S>) -> [f32; 4] {
    let growth = v.abs() * f64x4::splat(simd, GROWTH_RELATIVE) + f64x4::splat(simd, GROWTH);
    let down = (v - growth).to_array();
    let mut rounded = [0.0; 4];
    for (to, from) in rounded.iter_mut().zip(down) {
        *to = from as f32;
    }
    rounded
}

/// The pass on several threads.
#[cfg(feature = "rayon")]
mod threads {
    use rayon::prelude::*;

    use super::*;

    /// Fewer nodes, each of some 200 ns, are not worth another thread.
    const NODES_MIN: usize = 1024;

    pub fn share(nodes: usize) -> bool {
        crate::threads::share(nodes, NODES_MIN)
    }

    pub fn pass(
        level: Level,
        tree: &mut Tree,
        points: &LeafPoints,
        positions: &[DVec3],
        normal: &Normal,
    ) -> Measured {
        let Tree { nodes, blocks, .. } = tree;
        blocks.clear();
        blocks.resize(nodes.len().div_ceil(BLOCK), Block::NONE);
        let set = |(number, (nodes, block)): (usize, (&mut [Node], &mut Block))| {
            dispatch!(level, simd => *block = Block::set(
                simd,
                nodes,
                number * BLOCK,
                #[inline(always)]
                |index, node| set_leaves(simd, node, points.of_node(index), positions, normal),
            ))
        };
        nodes.par_chunks_mut(BLOCK).zip(&mut *blocks).enumerate().for_each(set);
        let mut measured = Measured::NONE;
        for (number, block) in blocks.iter().enumerate().rev() {
            let start = number * BLOCK;
            dispatch!(level, simd => measured.add(&block.finish(simd, &mut nodes[start..], start)));
        }
        measured
    }
}
