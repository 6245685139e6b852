//! The eight-wide build: the set with the greatest measure is split until there are eight.
//!
//! Of many primitives the upper splits are those of `clusters`. On several threads the sets of large nodes are built apart, and their nodes
//! put together in the order that one thread would have made them in.

use fearless_simd::Simd;
#[cfg(feature = "rayon")]
use rayon::prelude::*;
use solid_convex::simd::{dispatch, level};

use super::clusters::{Clusters, JointIndex, arrange};
use super::cost::{Measured, measure, sum};
use super::node::{Child, LEAF_SIZE, Node, PRIMITIVES_MAX, WIDTH};
use super::normal::{COORDINATE_MAX, Normal};
use super::split::{Item, Set, Spare};
use super::{Place, Tree};
use crate::Aabb;
use glam::DVec3;

/// From this depth on, sets are split evenly: a heuristic that peels off one primitive at a time ends here.
/// A torus of a million triangles has depth 7, the worst set of boxes in the tests 11.
const HEURISTIC_DEPTH_MAX: u32 = 16;

/// No tree is deeper, in nodes: below depth 16, where the heuristic ends, each level halves the number of
/// primitives thrice, up to a leaf, and 8^10 > 2^28.
pub const DEPTH_MAX: u32 = HEURISTIC_DEPTH_MAX + 10;

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
        Tree::build_of_with(boxes.len(), heuristic_depth, |i| boxes[i as usize])
    }

    /// Builds over primitives `0..count`, of which `box_of` gives the boxes; it is called three times for each. With the feature `rayon` on
    /// the threads of the current pool, if there are many; the tree is the same for any number of threads.
    pub(crate) fn build_of(count: usize, box_of: impl Fn(u32) -> Aabb + Sync + Send) -> Self {
        Tree::build_of_with(count, HEURISTIC_DEPTH_MAX, box_of)
    }

    fn build_of_with(count: usize, heuristic_depth: u32, box_of: impl Fn(u32) -> Aabb + Sync + Send) -> Self {
        assert!(count > 0, "a tree needs at least one primitive");
        assert!(count <= PRIMITIVES_MAX, "{count} primitives, at most {PRIMITIVES_MAX}");
        let bounds = bounds_of(count, &box_of);
        let normal = Normal::of(&bounds);
        let (mut items, clusters) = arrange(
            count,
            &normal.pack(&bounds),
            #[inline(always)]
            |i| normal.pack(&box_of(i)),
        );
        let mut nodes = Builder { clusters, heuristic_depth }.build(&mut items);
        nodes.shrink_to_fit();
        let order = items.iter().map(|item| item.index).collect();
        let measured = Measured { bounds, sum: sum(&nodes) };
        let root = nodes[0].union();
        let mut tree = Tree {
            nodes,
            order,
            normal,
            root,
            bounds,
            cost: 0.0,
            cost_at_build: 0.0,
            #[cfg(feature = "rayon")]
            blocks: Vec::new(),
        };
        tree.take(&measured);
        tree.cost_at_build = tree.cost;
        tree
    }
}

/// The box around all, each of which must be a box.
fn bounds_of(count: usize, box_of: &(impl Fn(u32) -> Aabb + Sync)) -> Aabb {
    let part = |indices: std::ops::Range<u32>| -> Aabb {
        dispatch!(level(), _simd => {
            let mut sum = Aabb::EMPTY;
            for index in indices {
                let bounds = box_of(index);
                proper(&bounds);
                sum.grow(bounds.min);
                sum.grow(bounds.max);
            }
            sum
        })
    };
    let count = count as u32;
    #[cfg(feature = "rayon")]
    let sum = if crate::threads::share(count as usize, PARALLEL_MIN) {
        /// Primitives of which the box is found in one piece.
        const PART: u32 = 1 << 12;
        let parts = (0..count.div_ceil(PART)).into_par_iter();
        let parts = parts.map(|i| part(i * PART..count.min((i + 1) * PART)));
        parts.reduce(|| Aabb::EMPTY, |a, b| a.union(&b))
    } else {
        part(0..count)
    };
    #[cfg(not(feature = "rayon"))]
    let sum = part(0..count);
    // Of zeros with two signs either may have been the least: the sum has one.
    Aabb::new(sum.min + DVec3::ZERO, sum.max + DVec3::ZERO)
}

/// The box, which must be a box.
#[inline(always)]
pub(super) fn proper(bounds: &Aabb) -> &Aabb {
    let proper = (0..3).fold(true, |is, k| {
        let (min, max) = (bounds.min[k], bounds.max[k]);
        is & (min <= max) & (min >= -COORDINATE_MAX) & (max <= COORDINATE_MAX)
    });
    assert!(proper, "{bounds:?} is empty, not a number, or beyond {COORDINATE_MAX:e}");
    bounds
}

/// Sets of at least so many primitives are worth another thread.
#[cfg(feature = "rayon")]
const PARALLEL_MIN: usize = 1 << 13;

/// A set that may be a joint of clusters.
#[derive(Clone, Copy)]
struct Part {
    set: Set,
    joint: Option<JointIndex>,
}

/// A node to be made.
struct Task {
    part: Part,
    /// Where the node will hang.
    place: Place,
    depth: u32,
}

/// Makes nodes.
struct Builder {
    clusters: Clusters,
    heuristic_depth: u32,
}

impl Builder {
    fn build(&self, items: &mut [Item]) -> Vec<Node> {
        let root = match self.clusters.root() {
            Some((joint, set)) => Part { set, joint: Some(joint) },
            None => Part { set: dispatch!(level(), simd => Set::new(simd, 0, items)), joint: None },
        };
        self.subtree(items, 0, root, 0)
    }

    /// The nodes of a set, numbered from 0; `items` are those of the set, of which the first is `base` of all.
    fn subtree(&self, items: &mut [Item], base: usize, part: Part, depth: u32) -> Vec<Node> {
        #[cfg(feature = "rayon")]
        if crate::threads::share(part.set.len, PARALLEL_MIN) {
            return self.subtree_on_threads(items, base, part, depth);
        }
        dispatch!(level(), simd => self.subtree_on_one(simd, items, base, part, depth))
    }

    /// Depth first, each node after its parent.
    #[inline(always)]
    fn subtree_on_one<S: Simd>(
        &self,
        simd: S,
        items: &mut [Item],
        base: usize,
        part: Part,
        depth: u32,
    ) -> Vec<Node> {
        let mut nodes: Vec<Node> = Vec::with_capacity(items.len().div_ceil(4 * LEAF_SIZE));
        let mut spare = Spare::default();
        let mut tasks = vec![Task { part, place: Place::ROOT, depth }];
        while let Some(task) = tasks.pop() {
            let index = nodes.len();
            if let Some((parent, lane)) = task.place.split() {
                nodes[parent].child[lane] = Child::inner(index);
            }
            let (parts, count) = self.eight(simd, &task.part, items, base, task.depth, &mut spare);
            nodes.push(node_of(&parts[..count]));
            for (lane, part) in parts[..count].iter().enumerate().rev().filter(|(_, part)| is_inner(part)) {
                tasks.push(Task { part: *part, place: Place::lane(index, lane), depth: task.depth + 1 });
            }
        }
        nodes
    }

    /// One node, and what hangs below it on several threads. It goes as deep as there are large sets: [`DEPTH_MAX`] bounds it.
    #[cfg(feature = "rayon")]
    fn subtree_on_threads(&self, items: &mut [Item], base: usize, part: Part, depth: u32) -> Vec<Node> {
        let (parts, count) =
            dispatch!(level(), simd => self.eight(simd, &part, items, base, depth, &mut Spare::default()));
        let mut below: Vec<usize> = (0..count).filter(|&lane| is_inner(&parts[lane])).collect();
        below.sort_unstable_by_key(|&lane| parts[lane].set.start);
        let (mut rest, mut end) = (items, base);
        let mut shares = Vec::with_capacity(below.len());
        for lane in below {
            let Set { start, len, .. } = parts[lane].set;
            let (items, after) = rest[start - end..].split_at_mut(len);
            shares.push((lane, start, items));
            (rest, end) = (after, start + len);
        }
        let subtree = |(lane, start, items)| (lane, self.subtree(items, start, parts[lane], depth + 1));
        let mut subtrees: Vec<(usize, Vec<Node>)> = shares.into_par_iter().map(subtree).collect();
        subtrees.sort_unstable_by_key(|(lane, _)| *lane);
        let mut nodes = Vec::with_capacity(1 + subtrees.iter().map(|(_, nodes)| nodes.len()).sum::<usize>());
        nodes.push(node_of(&parts[..count]));
        for (lane, subtree) in subtrees {
            let first = nodes.len();
            nodes[0].child[lane] = Child::inner(first);
            nodes.extend(subtree.into_iter().map(|mut node| {
                node.child = node.child.map(|child| child.after(first));
                node
            }));
        }
        nodes
    }

    /// Splits a set into up to eight, and says how many.
    #[inline(always)]
    fn eight<S: Simd>(
        &self,
        simd: S,
        part: &Part,
        items: &mut [Item],
        base: usize,
        depth: u32,
        spare: &mut Spare,
    ) -> ([Part; WIDTH], usize) {
        let evenly = depth >= self.heuristic_depth;
        // Sets of one measure, as of identical boxes, are split by number.
        let key = |part: &Part| (if evenly { 0.0 } else { measure(&part.set.bounds) }, part.set.len);
        let mut parts = [*part; WIDTH];
        let mut count = 1;
        while count < WIDTH {
            let large = (0..count).filter(|&i| is_inner(&parts[i]));
            let Some(i) = large.reduce(|a, b| if key(&parts[b]) > key(&parts[a]) { b } else { a }) else {
                break;
            };
            let Set { start, len, .. } = parts[i].set;
            let [below, above] =
                self.split(simd, &parts[i], &mut items[start - base..][..len], evenly, spare);
            parts[i] = below;
            parts[count] = above;
            count += 1;
        }
        (parts, count)
    }

    #[inline(always)]
    fn split<S: Simd>(
        &self,
        simd: S,
        part: &Part,
        items: &mut [Item],
        evenly: bool,
        spare: &mut Spare,
    ) -> [Part; 2] {
        if let Some(joint) = part.joint
            && !evenly
            && let Some(below) = self.clusters.below(joint)
        {
            return below.map(|(joint, set)| Part { set, joint: Some(joint) });
        }
        // What a joint knows is of its clusters.
        let set = if part.joint.is_some() { Set::new(simd, part.set.start, items) } else { part.set };
        let halves =
            if evenly { set.split_evenly(simd, items) } else { set.split(simd, items, spare, |_| 1) };
        halves.map(|set| Part { set, joint: None })
    }
}

/// Whether a set is too large for a leaf.
fn is_inner(part: &Part) -> bool {
    part.set.len > LEAF_SIZE
}

/// The node of some sets, with its leaves.
fn node_of(parts: &[Part]) -> Node {
    let mut node = Node::EMPTY;
    for (lane, Part { set, .. }) in parts.iter().enumerate() {
        node.set_lane(lane, &set.bounds);
        if set.len <= LEAF_SIZE {
            node.child[lane] = Child::leaf(set.start..set.start + set.len);
        }
    }
    node
}

const _: () = assert!(size_of::<Node>() == 224);
