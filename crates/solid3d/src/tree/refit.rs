//! New boxes in the same topology (thesis, 5.2.5).
//!
//! One backward loop gives every node its boxes: those of its leaves from what is in them, those of its children from their lanes. On
//! several threads all leaves come first, which are nearly all of the work, and then the loop, without them. The boxes are least and
//! greatest coordinates, and the cost is summed in blocks of nodes: so both ways give the same bits.

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
            dispatch!(level(), simd => pass(simd, nodes, set_leaves))
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
                return threads::pass(level, &mut tree.nodes, points, positions, normal);
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
        let block = block * BLOCK..nodes.len().min((block + 1) * BLOCK);
        for index in block.clone().rev() {
            let bounds = set_leaves(index, &mut nodes[index]);
            set_children(nodes, index);
            measured.bounds = measured.bounds.union(&bounds);
        }
        // Not node by node: lanes that were just written one by one cannot be read as a vector without waiting.
        measured.sum += measure_lanes(simd, &nodes[block]);
    }
    measured
}

/// Gives the inner lanes of a node their boxes, from nodes after it.
#[inline(always)]
fn set_children(nodes: &mut [Node], index: usize) {
    let (before, after) = nodes.split_at_mut(index + 1);
    let node = &mut before[index];
    for lane in 0..node.child.len() {
        if let Kind::Inner(child) = node.child[lane].kind() {
            node.set_lane(lane, &after[child - index - 1].union());
        }
    }
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
        nodes: &mut [Node],
        points: &LeafPoints,
        positions: &[DVec3],
        normal: &Normal,
    ) -> Measured {
        let set_block = |(block, nodes): (usize, &mut [Node])| {
            let first = block * BLOCK;
            dispatch!(level, simd => {
                let mut bounds = Aabb::EMPTY;
                for (i, node) in nodes.iter_mut().enumerate() {
                    bounds = bounds.union(&set_leaves(simd, node, points.of_node(first + i), positions, normal));
                }
                bounds
            })
        };
        let bounds = nodes.par_chunks_mut(BLOCK).enumerate().map(set_block);
        let bounds = bounds.reduce(|| Aabb::EMPTY, |a, b| a.union(&b));
        dispatch!(level, _simd => {
            for index in (0..nodes.len()).rev() {
                set_children(nodes, index);
            }
        });
        Measured { bounds, sum: super::super::cost::sum(nodes) }
    }
}
