//! The invariants of a tree, checked.

use super::node::{Child, Kind, LEAF_SIZE};
use super::{DEPTH_MAX, Tree};
use crate::Aabb;

impl Tree {
    /// Checks every invariant against the boxes of the primitives; for tests.
    ///
    /// # Panics
    ///
    /// If one is broken.
    ///
    /// ```
    /// # use solid3d::{Aabb, glam::DVec3, tree::Tree};
    /// let boxes = [Aabb::new(DVec3::ZERO, DVec3::ONE); 20];
    /// Tree::build(&boxes).validate(&boxes);
    /// let moved = [Aabb::new(DVec3::ZERO, DVec3::splat(2.0)); 20];
    /// assert!(std::panic::catch_unwind(|| Tree::build(&boxes).validate(&moved)).is_err());
    /// ```
    pub fn validate(&self, boxes: &[Aabb]) {
        self.validate_bounds(boxes);
        let mut seen = vec![false; boxes.len()];
        let mut parents = vec![0; self.nodes.len()];
        for index in 0..self.nodes.len() {
            for lane in 0..self.nodes[index].child.len() {
                match self.nodes[index].child[lane].kind() {
                    Kind::Empty => self.validate_empty(index, lane),
                    Kind::Inner(child) => {
                        assert!(child > index, "child {child} of node {index} comes before it");
                        parents[child] += 1;
                        let union = self.nodes[child].union();
                        assert_eq!(self.nodes[index].lane(lane), union, "box of node {child}");
                    }
                    Kind::Leaf(range) => self.validate_leaf(index, lane, range, boxes, &mut seen),
                }
            }
        }
        assert!(seen.iter().all(|&s| s), "a primitive is in no leaf");
        assert!(parents[1..].iter().all(|&p| p == 1) && parents[0] == 0, "a node has not one parent");
        assert!(self.depth() <= DEPTH_MAX, "depth {}", self.depth());
    }

    fn validate_bounds(&self, boxes: &[Aabb]) {
        assert_eq!(self.len(), boxes.len());
        assert_eq!(self.bounds, boxes.iter().fold(Aabb::EMPTY, |sum, b| sum.union(b)), "the union is tight");
        assert_eq!(self.root, self.nodes[0].union());
        let corners = [self.root.min(), self.root.max()].concat();
        assert!(
            corners.iter().all(|u| u.abs() <= 1.0),
            "the root is outside of its coordinates: {corners:?}"
        );
    }

    fn validate_empty(&self, index: usize, lane: usize) {
        let node = &self.nodes[index];
        assert!(lane > 0, "node {index} bounds nothing");
        assert!(node.child[lane..].iter().all(|&c| c == Child::EMPTY), "a lane in use after an empty one");
        assert!((0..3).all(|axis| node.min[axis][lane] > node.max[axis][lane]), "an empty lane has a box");
    }

    fn validate_leaf(
        &self,
        index: usize,
        lane: usize,
        range: std::ops::Range<usize>,
        boxes: &[Aabb],
        seen: &mut [bool],
    ) {
        assert!((1..=LEAF_SIZE).contains(&range.len()), "a leaf of {}", range.len());
        let stored = self.nodes[index].lane(lane);
        for &primitive in self.leaf(range) {
            let was_seen = std::mem::replace(&mut seen[primitive as usize], true);
            assert!(!was_seen, "primitive {primitive} is in two leaves");
            let mut union = stored;
            union.grow(&self.normal.pack(&boxes[primitive as usize]));
            assert_eq!(union, stored, "primitive {primitive} is not in the box of its leaf");
            assert!(self.normal.unpack(&stored).contains(&boxes[primitive as usize]));
        }
    }

    /// The number of nodes above the deepest leaf.
    pub(super) fn depth(&self) -> u32 {
        let mut depth = vec![1; self.nodes.len()];
        for index in 0..self.nodes.len() {
            for child in self.nodes[index].child {
                if let Kind::Inner(child) = child.kind() {
                    depth[child] = depth[index] + 1;
                }
            }
        }
        depth.into_iter().fold(0, u32::max)
    }
}
