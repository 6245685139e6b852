//! The bounding-volume hierarchy: a static tree of boxes over primitives `0..n`. It knows no shapes.
//!
//! Thesis, sections 5.2.3 to 5.2.5, with these deviations, each measured (see the commit messages):
//!
//! - eight children a node instead of two, so that one box is tested against eight at once;
//! - boxes of `f32`, rounded outward, in coordinates *of the tree* (`normal`): half the memory and twice the lanes,
//!   with the same resolution at any size and any distance from the local origin;
//! - leaves of up to eight primitives, split by the surface-area heuristic instead of the midpoint.
//!
//! As in the thesis, a child's index is greater than its parent's, so a refit is one backward loop (5.2.5); the pair
//! test looks at the six facet axes only ("SAT lite", 5.2.4); and the relative placement is computed once per pair of trees.
//!
//! | file | holds |
//! |---|---|
//! | `packed` | one box of `f32` |
//! | `normal` | tree coordinates and the outward rounding |
//! | `node` | the eight-wide node and its child words |
//! | `split`, `clusters`, `build` | a binary tree by the binned surface-area heuristic, first on cells of a grid |
//! | `collapse` | which of its sets become nodes |
//! | `refit`, `leaf_points`, `cost` | boxes anew in the same topology, what they are around, and when that no longer pays |
//! | `leaf_images` | the triangles of each leaf, coarsely, side by side: what is looked at before they are |
//! | `signposts` | a leaf near to each cell of a grid: where to look first, when any that is found will do |
//! | `validate` | the invariants |
//! | `traversal` | scratch and counters of every query |
//! | `relative`, `crossing`, `lanes` | an affine map between two trees; one box against eight across it |
//! | `siblings` | pairs of subtrees to be looked at: in which order, where one that meets will do |
//! | `beam`, `order` | pairs of leaves that are likely near to each other, for a first distance |
//! | `eights` | the eight boxes of a node against the eight of another, across such a map |
//! | `overlap`, `pairs` | queries for overlap: box, placed box, tree against tree |
//! | `ray_probe` | a ray, or a box that moves along one, against eight boxes |
//! | `ray`, `cast_pairs` | queries along a ray or for a moving box, for two trees that move; nearest first |
//! | `furthest` | what is furthest along a direction |
//! | `insertion`, `broods` | subtrees that are yet to be visited, the nearest first |
//! | `near`, `nearest`, `metric`, `squares`, `nearest_pairs` | branch and bound: one query, tree against tree |
//! | `slabs`, `patch` | how flat what hangs in each lane is; the lane's box cut by that |
//! | `parting`, `facing` | by that, for tree against tree: what is apart though boxes overlap; better bounds on distances |
//!
//! # Laws
//!
//! 1. Every primitive lies in exactly one leaf, and every stored box contains what it bounds, in exact arithmetic.
//! 2. No overlapping pair is lost, whatever the affine map, the sizes and the distance from the origin; none nearer than the
//!    reported distance either.
//! 3. A build of boxes scaled by a power of two gives the same bits; so does a refit of unchanged boxes.
//! 4. The depth is bounded ([`DEPTH_MAX`]), and nothing recurses but a build, the search for slabs and that for what is furthest.
//! 5. Every order is a function of the input alone, not of the number of threads.

mod beam;
mod broods;
mod build;
mod cast_pairs;
mod clusters;
mod collapse;
mod cost;
mod crossing;
mod eights;
mod facing;
mod furthest;
mod insertion;
mod lanes;
mod leaf_images;
mod leaf_points;
mod metric;
mod near;
mod nearest;
mod nearest_pairs;
mod node;
mod normal;
mod order;
mod overlap;
mod packed;
mod pairs;
mod parting;
mod patch;
mod ray;
mod ray_probe;
mod refit;
mod relative;
mod siblings;
mod signposts;
mod slabs;
mod split;
mod squares;
mod traversal;
mod validate;

#[cfg(test)]
mod tests;

pub use build::DEPTH_MAX;
pub use cast_pairs::cast_pairs;
pub(crate) use cast_pairs::first_pairs;
pub use cost::DEGRADED_RATIO;
pub(crate) use facing::Facing;
pub(crate) use insertion::push_unless_far;
pub(crate) use lanes::bits;
pub(crate) use leaf_images::{HALF_STEP, Image, Leaf, LeafImages, STEPS};
pub(crate) use leaf_points::LeafPoints;
pub use metric::PairMetric;
pub(crate) use near::{Around, Boxes, NearLeaves, NearQuery};
pub use nearest_pairs::nearest_pairs;
pub(crate) use nearest_pairs::{NearLeafPairs, nearest_pairs_on};
pub use node::{LEAF_SIZE, PRIMITIVES_MAX};
pub use normal::COORDINATE_MAX;
pub use pairs::pairs;
pub(crate) use pairs::{LeafPairs, pairs_on};
pub(crate) use ray::RayLeaves;
pub use ray::TreeRay;
pub(crate) use ray_probe::{RayProbe, Space, entry};
pub use relative::{PlacedBox, Relative};
pub(crate) use signposts::Signposts;
pub(crate) use slabs::Slabs;
pub use traversal::{Counters, Traversal};

use crate::Aabb;
use node::{Child, Kind, Node};
pub(crate) use normal::Normal;
use packed::PackedBox;
use solid_convex::simd;

/// A hierarchy of bounding boxes over primitives `0..n`.
///
/// ```
/// use solid3d::{Aabb, glam::DVec3, tree::{Traversal, Tree}};
/// use std::ops::ControlFlow;
///
/// let unit = |i: u32| Aabb::new(DVec3::splat(f64::from(i)), DVec3::splat(f64::from(i) + 0.5));
/// let boxes: Vec<Aabb> = (0..100).map(unit).collect();
/// let tree = Tree::build(&boxes);
/// assert_eq!(tree.len(), 100);
///
/// let mut found = Vec::<u32>::new();
/// let query = Aabb::new(DVec3::splat(41.9), DVec3::splat(42.1));
/// let _ = tree.overlapping(&query, &mut Traversal::default(), |leaf| {
///     found.extend(leaf.iter().filter(|&&i| boxes[i as usize].overlaps(&query)));
///     ControlFlow::<()>::Continue(())
/// });
/// assert_eq!(found, [42]);
/// ```
#[derive(Clone, Debug)]
pub struct Tree {
    /// Depth first: each before all that are below it, which stand together.
    nodes: Vec<Node>,
    /// The primitives; each leaf is a range of it.
    order: Vec<u32>,
    normal: Normal,
    /// The union of the root's lanes, in tree coordinates.
    root: PackedBox,
    /// The tight union in local coordinates.
    bounds: Aabb,
    cost: f64,
    cost_at_build: f64,
    /// Of a refit on several threads; kept for its memory.
    #[cfg(feature = "rayon")]
    blocks: Vec<refit::Block>,
}

impl Tree {
    /// The tight box around all primitives, in local coordinates.
    ///
    /// ```
    /// # use solid3d::{Aabb, glam::DVec3, tree::Tree};
    /// let unit = Aabb::new(DVec3::ZERO, DVec3::ONE);
    /// assert_eq!(Tree::build(&[unit]).bounds(), unit);
    /// ```
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The number of primitives.
    #[expect(clippy::len_without_is_empty, reason = "a tree has at least one primitive")]
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// The primitives in the order of the leaves: a permutation of `0..n`. Data laid out in this order is read forward by queries.
    ///
    /// ```
    /// # use solid3d::{Aabb, glam::DVec3, tree::Tree};
    /// let unit = Aabb::new(DVec3::ZERO, DVec3::ONE);
    /// assert_eq!(Tree::build(&[unit; 3]).order(), [0, 1, 2]);
    /// ```
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// The number of nodes, each with up to eight children.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// The memory that the tree owns.
    ///
    /// ```
    /// # use solid3d::{Aabb, glam::DVec3, tree::Tree};
    /// let unit = Aabb::new(DVec3::ZERO, DVec3::ONE);
    /// assert!(Tree::build(&[unit; 800]).bytes() < 800 * 20);
    /// ```
    pub fn bytes(&self) -> usize {
        let blocks = 0;
        #[cfg(feature = "rayon")]
        let blocks = blocks + self.blocks.capacity() * size_of::<refit::Block>();
        self.nodes.capacity() * size_of::<Node>() + self.order.capacity() * size_of::<u32>() + blocks
    }

    /// The map to the coordinates in which its boxes are.
    pub(crate) fn normal(&self) -> &Normal {
        &self.normal
    }

    /// The primitives of a leaf word.
    fn leaf(&self, range: std::ops::Range<usize>) -> &[u32] {
        &self.order[range]
    }

    /// The leaf of a word, at a place.
    #[inline(always)]
    fn leaf_at(&self, place: Place, range: std::ops::Range<usize>) -> Leaf<'_> {
        let (node, lane) = place.split().expect("the root is a node");
        Leaf::new(self, range, node, lane)
    }

    /// The child word at a place: the root, or a lane of a node.
    #[inline(always)]
    fn child_at(&self, place: Place) -> Child {
        match place.split() {
            None => Child::inner(0),
            Some((node, lane)) => self.nodes[node].child[lane],
        }
    }

    /// Asks for the memory of a child to which a walk may soon come: of a node; of a leaf `of_leaf` does so, given where it begins in the order.
    #[inline(always)]
    fn prefetch(&self, child: Child, of_leaf: impl FnOnce(usize)) {
        match child.kind() {
            Kind::Empty => {}
            Kind::Inner(node) => simd::prefetch_some::<_, 1>(&self.nodes, node),
            Kind::Leaf(range) => of_leaf(range.start),
        }
    }

    /// The stored box at a place.
    #[inline(always)]
    fn box_at(&self, place: Place) -> PackedBox {
        match place.split() {
            None => self.root,
            Some((node, lane)) => self.nodes[node].lane(lane),
        }
    }
}

/// Where a subtree hangs: the root, or a lane of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Place(u32);

impl Default for Place {
    fn default() -> Self {
        Place::ROOT
    }
}

impl Place {
    const ROOT: Place = Place(u32::MAX);

    /// Lane `lane` of node `node`.
    fn lane(node: usize, lane: usize) -> Self {
        Place((node * 8 + lane) as u32)
    }

    /// The lane so many after this one, of the same node.
    #[inline(always)]
    fn after(self, lanes: u32) -> Self {
        Place(self.0 + lanes)
    }

    #[inline(always)]
    fn split(self) -> Option<(usize, usize)> {
        (self != Place::ROOT).then_some((self.0 as usize / 8, self.0 as usize % 8))
    }
}
