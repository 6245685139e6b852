//! The surface-area heuristic as a measure of boxes and of trees.

use super::Tree;
use super::node::{Node, WIDTH};
use super::packed::PackedBox;

/// A tree whose cost has grown by this factor since it was built is no longer worth refitting.
///
/// Measured on a torus twisted by 0.5, 1.5 and 3 rad (box tests of a pair of refitted trees over those of rebuilt ones are
/// 1.15, 1.44 and 2.02): the cost grows by 1.23, 1.49 and 2.00.
pub const DEGRADED_RATIO: f64 = 1.3;

/// The side of the query, in tree coordinates, for which the cost is meant. That a query of side `s` meets a box goes with the
/// area of the box grown by it: `area + s * perimeter + ...`. So segments, whose area is zero, are still told apart.
const QUERY_SIDE: f32 = 1.0 / 64.0;

/// How likely a query meets a box: half its area and a little of its perimeter.
#[inline]
pub(super) fn measure(bounds: &PackedBox) -> f32 {
    measure_of([0, 1, 2].map(|axis| bounds.size(axis)))
}

#[inline]
fn measure_of([x, y, z]: [f32; 3]) -> f32 {
    x * y + y * z + z * x + QUERY_SIDE * (x + y + z)
}

/// The sum of the measures of a node's lanes.
#[inline]
pub(super) fn measure_lanes(node: &Node) -> f32 {
    let mut lanes = [0.0; WIDTH];
    for (lane, sum) in lanes.iter_mut().enumerate() {
        // Empty lanes are inverted: their sides count as zero.
        *sum = measure_of([0, 1, 2].map(|axis| (node.max[axis][lane] - node.min[axis][lane]).max(0.0)));
    }
    lanes.iter().sum()
}

impl Tree {
    /// The cost by the surface-area heuristic, of nodes and leaves alike, relative to the squared diagonal of the root.
    ///
    /// Relative to the area of the root it would be the expected visits of a query that meets the root; but a twist that fattens a
    /// flat root then hides its own cost: that measure grew by 1.02, 1.03 and
    /// 1.33 in the measurement of [`DEGRADED_RATIO`].
    pub(super) fn cost_relative(&self) -> f64 {
        if self.bounds.min == self.bounds.max {
            return 0.0; // of a point: any extent that it is given later is worth a build
        }
        let sum: f64 = self.nodes.iter().map(|node| f64::from(measure_lanes(node))).sum();
        let diagonal_squared: f64 =
            [0, 1, 2].map(|axis| f64::from(self.root.size(axis)).powi(2)).iter().sum();
        sum / diagonal_squared
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
