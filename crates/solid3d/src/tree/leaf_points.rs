//! The points of each leaf, each once: what a refit reads.
//!
//! The triangles of a leaf share most of their vertices. To go from the order of the tree to a triangle, and from there to its
//! vertices, waits for memory three times and looks at each vertex twice and more; here they stand in the order in which they are read.

use super::Tree;
use super::node::{Kind, WIDTH};

/// The points whose box is the box of a leaf, for each leaf of a tree over hulls of points.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LeafPoints {
    /// By node, lane by lane: those of a leaf ascend.
    points: Vec<u32>,
    /// By node and lane: where its points end. Lanes without a leaf have none.
    ends: Vec<[u32; WIDTH]>,
}

impl LeafPoints {
    /// Of a tree, given the points of its primitives. Cost: `O(n)`.
    pub fn new<'p>(tree: &Tree, points_of: impl Fn(u32) -> &'p [u32]) -> Self {
        let mut points: Vec<u32> = Vec::new();
        let mut ends = Vec::with_capacity(tree.nodes.len());
        let mut leaf_points = Vec::new();
        for node in &tree.nodes {
            ends.push(node.child.map(|child| {
                if let Kind::Leaf(range) = child.kind() {
                    leaf_points.clear();
                    leaf_points.extend(tree.leaf(range).iter().flat_map(|&primitive| points_of(primitive)));
                    leaf_points.sort_unstable();
                    leaf_points.dedup();
                    points.extend_from_slice(&leaf_points);
                }
                points.len() as u32
            }));
        }
        points.shrink_to_fit();
        LeafPoints { points, ends }
    }

    /// The points of each lane of a node, in order.
    #[inline(always)]
    pub(super) fn of_node(&self, node: usize) -> impl Iterator<Item = &[u32]> {
        let mut start = if node == 0 { 0 } else { self.ends[node - 1][WIDTH - 1] };
        self.ends[node].iter().map(
            #[inline(always)]
            move |&end| {
                let lane = &self.points[start as usize..end as usize];
                start = end;
                lane
            },
        )
    }

    /// The memory that they own, in bytes.
    pub fn bytes(&self) -> usize {
        self.points.capacity() * size_of::<u32>() + self.ends.capacity() * size_of::<[u32; WIDTH]>()
    }
}
