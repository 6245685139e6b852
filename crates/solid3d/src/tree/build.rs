//! The eight-wide build: the set with the greatest measure is split until there are eight.

use super::cost::measure;
use super::node::{Child, LEAF_SIZE, Node, PRIMITIVES_MAX, WIDTH};
use super::normal::{COORDINATE_MAX, Normal};
use super::split::{Item, Set};
use super::{Place, Tree};
use crate::Aabb;
use glam::DVec3;

/// From this depth on, sets are split evenly: a heuristic that peels off one primitive at a time ends here.
/// A torus of a million triangles has depth 7, the worst set of boxes in the tests 11.
const HEURISTIC_DEPTH_MAX: u32 = 16;

/// No tree is deeper, in nodes: below depth 16, where the heuristic ends, each level halves the number of
/// primitives thrice, up to a leaf, and 8^10 > 2^28.
pub const DEPTH_MAX: u32 = HEURISTIC_DEPTH_MAX + 10;

/// A node to be made.
struct Task {
    set: Set,
    /// Where the node will hang.
    place: Place,
    depth: u32,
}

impl Tree {
    /// Builds a tree over primitives `0..boxes.len()`, `O(n log n)`.
    ///
    /// # Panics
    ///
    /// If there is no box or more than [`PRIMITIVES_MAX`], or if one is empty, not a number, or beyond [`COORDINATE_MAX`].
    ///
    /// ```
    /// # use solid3d::{Aabb, glam::DVec3, tree::Tree};
    /// let floor: Vec<Aabb> = (0..10_000)
    ///     .map(|i| DVec3::new(f64::from(i % 100), f64::from(i / 100), 0.0))
    ///     .map(|corner| Aabb::new(corner, corner + DVec3::new(1.0, 1.0, 0.0)))
    ///     .collect();
    /// let tree = Tree::build(&floor);
    /// tree.validate(&floor);
    /// assert!(tree.node_count() < 600);
    /// ```
    pub fn build(boxes: &[Aabb]) -> Self {
        Tree::build_with(boxes, HEURISTIC_DEPTH_MAX)
    }

    /// Builds by the heuristic down to a depth, and evenly below.
    pub(super) fn build_with(boxes: &[Aabb], heuristic_depth: u32) -> Self {
        assert!(!boxes.is_empty(), "a tree needs at least one primitive");
        assert!(boxes.len() <= PRIMITIVES_MAX, "{} primitives, at most {PRIMITIVES_MAX}", boxes.len());
        let bounds = boxes.iter().fold(Aabb::EMPTY, |sum, b| sum.union(proper(b)));
        let normal = Normal::of(&bounds);
        let item = |(bounds, index): (&Aabb, u32)| Item { bounds: normal.pack(bounds), index };
        let mut items: Vec<Item> = boxes.iter().zip(0..).map(item).collect();

        let mut nodes = build_nodes(&mut items, heuristic_depth);
        nodes.shrink_to_fit();
        let order = items.iter().map(|item| item.index).collect();
        let root = nodes[0].union();
        let mut tree = Tree { nodes, order, normal, root, bounds, cost: 0.0, cost_at_build: 0.0 };
        tree.cost = tree.cost_relative();
        tree.cost_at_build = tree.cost;
        tree
    }
}

/// The box, which must be a box.
#[inline]
pub(super) fn proper(bounds: &Aabb) -> &Aabb {
    let limit = DVec3::splat(COORDINATE_MAX);
    let proper = bounds.min.cmple(bounds.max) & bounds.min.cmpge(-limit) & bounds.max.cmple(limit);
    assert!(proper.all(), "{bounds:?} is empty, not a number, or beyond {COORDINATE_MAX:e}");
    bounds
}

/// Makes the nodes, depth first, each after its parent.
fn build_nodes(items: &mut [Item], heuristic_depth: u32) -> Vec<Node> {
    let mut nodes: Vec<Node> = Vec::with_capacity(items.len().div_ceil(4 * LEAF_SIZE));
    let mut tasks = vec![Task { set: Set::new(0, items), place: Place::ROOT, depth: 0 }];
    while let Some(task) = tasks.pop() {
        let index = nodes.len();
        if let Some((parent, lane)) = task.place.split() {
            nodes[parent].child[lane] = Child::inner(index);
        }
        let (sets, count) = eight(&task.set, items, task.depth >= heuristic_depth);
        let mut node = Node::EMPTY;
        for (lane, set) in sets[..count].iter().enumerate() {
            node.set_lane(lane, &set.bounds);
            if set.len <= LEAF_SIZE {
                node.child[lane] = Child::leaf(set.start..set.start + set.len);
            }
        }
        nodes.push(node);
        for (lane, set) in sets[..count].iter().enumerate().rev().filter(|(_, set)| set.len > LEAF_SIZE) {
            tasks.push(Task { set: *set, place: Place::lane(index, lane), depth: task.depth + 1 });
        }
    }
    nodes
}

/// Splits a set into up to eight, and says how many.
fn eight(set: &Set, items: &mut [Item], evenly: bool) -> ([Set; WIDTH], usize) {
    // Sets of one measure, as of identical boxes, are split by number.
    let key = |set: &Set| (if evenly { 0.0 } else { measure(&set.bounds) }, set.len);
    let mut sets = [*set; WIDTH];
    let mut count = 1;
    while count < WIDTH {
        let large = (0..count).filter(|&i| sets[i].len > LEAF_SIZE);
        let Some(i) = large.reduce(|a, b| if key(&sets[b]) > key(&sets[a]) { b } else { a }) else { break };
        let [below, above] = if evenly { sets[i].split_evenly(items) } else { sets[i].split(items) };
        sets[i] = below;
        sets[count] = above;
        count += 1;
    }
    (sets, count)
}

const _: () = assert!(size_of::<Node>() == 224);
