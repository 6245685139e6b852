//! The surface-area heuristic as a measure of boxes and of trees.

use std::ops::{Add, Mul};

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};

use super::Tree;
use super::node::{Node, WIDTH, halves};
use super::packed::PackedBox;
use crate::Aabb;
use solid_convex::simd::dispatch;

/// A tree whose cost has grown by this factor since it was built is no longer worth refitting.
///
/// Measured on a torus twisted by 0.5, 1.5 and 3 rad (box tests of a pair of refitted trees over those of rebuilt ones are
/// 1.15, 1.44 and 2.02): the cost grows by 1.23, 1.49 and 2.00.
pub const DEGRADED_RATIO: f64 = 1.3;

/// The side of the query, in tree coordinates, for which the cost is meant. That a query of side `s` meets a box goes with the
/// area of the box grown by it: `area + s * perimeter + ...`. So segments, whose area is zero, are still told apart.
const QUERY_SIDE: f32 = 1.0 / 64.0;

/// How likely a query meets a box: half its area and a little of its perimeter.
#[inline(always)]
pub(super) fn measure(bounds: &PackedBox) -> f32 {
    measure_of([0, 1, 2].map(|axis| bounds.size(axis)))
}

#[inline(always)]
pub(super) fn measure_of<T>([x, y, z]: [T; 3]) -> T
where
    T: Copy + Add<Output = T> + Mul<Output = T> + Mul<f32, Output = T>,
{
    x * y + y * z + z * x + (x + y + z) * QUERY_SIDE
}

/// The sum of the measures of all lanes of some nodes.
#[inline(always)]
pub(super) fn measure_lanes<'n, S: Simd>(simd: S, nodes: impl Iterator<Item = &'n Node>) -> f64 {
    let lanes = |of: &[f32; WIDTH]| f32x8::from_slice(simd, of);
    let mut sum = 0.0;
    for node in nodes {
        // Empty lanes are inverted: their sides count as zero.
        let side =
            |axis: usize| (lanes(&node.max[axis]) - lanes(&node.min[axis])).max(f32x8::splat(simd, 0.0));
        let measures = measure_of([side(0), side(1), side(2)]);
        sum += f64::from(halves(&measures.to_array(), |a, b| a + b));
    }
    sum
}

/// Measures are summed in blocks of so many nodes, and then those sums: so several threads can do it, and it has the same bits.
pub(super) const BLOCK: usize = 256;

/// What a pass over the nodes of a tree finds out about it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measured {
    /// The tight union, in local coordinates.
    pub bounds: Aabb,
    /// Of the measures of all lanes.
    pub sum: f64,
}

impl Measured {
    /// Of no nodes.
    pub const NONE: Measured = Measured { bounds: Aabb::EMPTY, sum: 0.0 };

    /// Takes in what was found out about other nodes.
    pub fn add(&mut self, other: &Measured) {
        self.bounds = self.bounds.union(&other.bounds);
        self.sum += other.sum;
    }
}

/// The sum of the measures of all lanes.
pub(super) fn sum(nodes: &[Node]) -> f64 {
    let of_block = |block: &[Node]| dispatch!(simd => measure_lanes(simd, block.iter().rev()));
    #[cfg(feature = "rayon")]
    if crate::threads::share(nodes.len(), NODES_MANY) {
        use rayon::prelude::*;
        let sums: Vec<f64> = nodes.par_chunks(BLOCK).map(of_block).collect();
        return sums.into_iter().rev().fold(0.0, |sum, of_block| sum + of_block);
    }
    nodes.chunks(BLOCK).rev().map(of_block).fold(0.0, |sum, of_block| sum + of_block)
}

/// So many nodes, of some 10 ns each, are worth another thread.
#[cfg(feature = "rayon")]
const NODES_MANY: usize = 1 << 12;

impl Tree {
    /// Takes in what a pass over the nodes found out.
    ///
    /// The cost by the surface-area heuristic is that of nodes and leaves alike, relative to the squared diagonal of the root.
    /// Relative to the area of the root it would be the expected visits of a query that meets the root; but a twist that fattens a
    /// flat root then hides its own cost: that measure grew by 1.02, 1.03 and
    /// 1.33 in the measurement of [`DEGRADED_RATIO`].
    pub(super) fn take(&mut self, measured: &Measured) {
        self.bounds = measured.bounds;
        self.root = self.nodes[0].union();
        self.cost = if self.bounds.min == self.bounds.max {
            0.0 // of a point: any extent that it is given later is worth a build
        } else {
            let size = glam::DVec3::from_array([0, 1, 2].map(|axis| f64::from(self.root.size(axis))));
            measured.sum / size.length_squared()
        };
    }

    /// Whether refits have made the boxes overlap so much that a new build pays: the cost by the surface-area heuristic has grown
    /// by more than [`DEGRADED_RATIO`].
    ///
    /// ```
    /// # use solid3d::{Aabb, glam::DVec3, tree::Tree};
    /// let at = |x: u32| Aabb::new(DVec3::splat(f64::from(x)), DVec3::splat(f64::from(x) + 1.0));
    /// let boxes: Vec<Aabb> = (0..100).map(at).collect();
    /// let mut tree = Tree::build(&boxes);
    /// assert!(!tree.degraded());
    /// tree.refit(|i| at(i * 37 % 100)); // neighbours are torn apart
    /// assert!(tree.degraded());
    /// ```
    pub fn degraded(&self) -> bool {
        self.cost > DEGRADED_RATIO * self.cost_at_build
    }
}
