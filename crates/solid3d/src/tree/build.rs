//! The eight-wide build: the set with the greatest measure is split until there are eight.
//!
//! Of many primitives the upper splits are those of `clusters`: only what is below a few of these is gathered, and split while it is at hand.
//! On several threads the sets of large nodes are built apart, and their nodes put together in the order that one thread would have made
//! them in.

use std::sync::Mutex;

use fearless_simd::Simd;
#[cfg(feature = "rayon")]
use rayon::prelude::*;
use solid_convex::simd::dispatch;

use super::clusters::{Clusters, JointIndex};
use super::cost::{Measured, measure, sum};
use super::node::{Child, LEAF_SIZE, Node, PRIMITIVES_MAX, WIDTH};
use super::normal::{COORDINATE_MAX, Normal};
use super::packed::PackedBox;
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
        let builder = Builder::new(
            count,
            heuristic_depth,
            &normal.pack(&bounds),
            #[inline(always)]
            |i| normal.pack(&box_of(i)),
        );
        let (mut nodes, order) = builder.build(count);
        nodes.shrink_to_fit();
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
        dispatch!(_simd => {
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

/// Fewer than a node has below it, on average: some 23 of a torus.
const PRIMITIVES_PER_NODE: usize = 20;

/// Joints of fewer primitives are gathered, which are then at hand for what is below: some 300 kB.
const GATHERED_MAX: usize = 1 << 13;

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

/// Makes nodes of primitives of which `pack` gives the boxes.
struct Builder<F> {
    clusters: Clusters,
    pack: F,
    heuristic_depth: u32,
    /// Working memory that nobody uses just now: to get it anew from the system for each joint takes longer than to build what is below.
    rooms: Mutex<Vec<Room>>,
}

/// Working memory for what is below a joint.
#[derive(Default)]
struct Room {
    items: Vec<Item>,
    spare: Spare,
}

/// The parts of a node, and how many they are.
type Eight = ([Part; WIDTH], usize);

impl<F: Fn(u32) -> PackedBox + Sync> Builder<F> {
    /// For primitives `0..count`, in a box `root`.
    fn new(count: usize, heuristic_depth: u32, root: &PackedBox, pack: F) -> Self {
        Builder {
            clusters: Clusters::new(count, root, &pack),
            pack,
            heuristic_depth,
            rooms: Mutex::default(),
        }
    }

    /// The nodes of all, and the order of the primitives.
    fn build(&self, count: usize) -> (Vec<Node>, Vec<u32>) {
        let (joint, set) = self.clusters.root();
        let (mut nodes, mut order) = (Vec::new(), vec![0; count]);
        self.joint(&mut nodes, &mut order, &Part { set, joint: Some(joint) }, 0);
        (nodes, order)
    }

    /// Adds the nodes of a joint, and gives its primitives their order. It goes as deep as there are large sets: [`DEPTH_MAX`] bounds it.
    fn joint(&self, nodes: &mut Vec<Node>, order: &mut [u32], part: &Part, depth: u32) {
        if part.set.len >= GATHERED_MAX
            && let Some(parts) = self.eight(part, depth, |part| self.below(part, depth))
        {
            let below = |nodes: &mut Vec<Node>, order: &mut [u32], part: &Part| {
                self.joint(nodes, order, part, depth + 1);
            };
            return share_out(nodes, order, parts, below);
        }
        let rooms = || self.rooms.lock().expect("nobody panics who holds it");
        let mut room = rooms().pop().unwrap_or_default();
        let Room { items, spare } = &mut room;
        let items = self.gather(&part.set, items);
        if is_inner(part) || depth == 0 {
            self.subtree(nodes, items, part, depth, spare);
        }
        for (to, item) in order.iter_mut().zip(items) {
            *to = item.index;
        }
        rooms().push(room);
    }

    /// The items of a joint's set.
    fn gather<'i>(&self, set: &Set, items: &'i mut Vec<Item>) -> &'i mut [Item] {
        if items.len() < set.len {
            items.resize(set.len, Item::NONE);
        }
        let items = &mut items[..set.len];
        dispatch!(_simd => {
            let mut rest = &mut *items;
            for cluster in self.clusters.primitives(set) {
                let (of_cluster, after) = rest.split_at_mut(cluster.len());
                for (to, &index) in of_cluster.iter_mut().zip(cluster) {
                    *to = Item { bounds: (self.pack)(index), index };
                }
                rest = after;
            }
        });
        items
    }

    /// Adds the nodes of a set, of which these are the items.
    fn subtree(&self, nodes: &mut Vec<Node>, items: &mut [Item], part: &Part, depth: u32, spare: &mut Spare) {
        #[cfg(feature = "rayon")]
        if crate::threads::share(items.len(), PARALLEL_MIN) {
            let parts = dispatch!(simd => self.eight_of(simd, part, items, part.set.start, depth, spare));
            let below = |nodes: &mut Vec<Node>, items: &mut [Item], part: &Part| {
                if is_inner(part) {
                    self.subtree(nodes, items, part, depth + 1, &mut Spare::default());
                }
            };
            return share_out(nodes, items, parts, below);
        }
        nodes.reserve(items.len() / PRIMITIVES_PER_NODE);
        dispatch!(simd => self.subtree_on_one(simd, nodes, items, part, depth, spare))
    }

    /// Depth first, each node after its parent.
    #[inline(always)]
    fn subtree_on_one<S: Simd>(
        &self,
        simd: S,
        nodes: &mut Vec<Node>,
        items: &mut [Item],
        part: &Part,
        depth: u32,
        spare: &mut Spare,
    ) {
        let base = part.set.start;
        let mut tasks = vec![Task { part: *part, place: Place::ROOT, depth }];
        while let Some(task) = tasks.pop() {
            let index = nodes.len();
            if let Some((parent, lane)) = task.place.split() {
                nodes[parent].child[lane] = Child::inner(index);
            }
            let (parts, count) = self.eight_of(simd, &task.part, items, base, task.depth, spare);
            nodes.push(node_of(&parts[..count]));
            for (lane, part) in parts[..count].iter().enumerate().rev().filter(|(_, part)| is_inner(part)) {
                tasks.push(Task { part: *part, place: Place::lane(index, lane), depth: task.depth + 1 });
            }
        }
    }

    /// Splits a set into up to eight; `items` begin at `base` in the array of all.
    #[inline(always)]
    fn eight_of<S: Simd>(
        &self,
        simd: S,
        part: &Part,
        items: &mut [Item],
        base: usize,
        depth: u32,
        spare: &mut Spare,
    ) -> Eight {
        let parts = self.eight(
            part,
            depth,
            #[inline(always)]
            |part| {
                let items = &mut items[part.set.start - base..][..part.set.len];
                Some(self.split(simd, part, items, depth, spare))
            },
        );
        parts.expect("each is split")
    }

    fn evenly(&self, depth: u32) -> bool {
        depth >= self.heuristic_depth
    }

    /// Splits a set into up to eight; nothing where one is not split that should be.
    #[inline(always)]
    fn eight(
        &self,
        part: &Part,
        depth: u32,
        mut split: impl FnMut(&Part) -> Option<[Part; 2]>,
    ) -> Option<Eight> {
        // Sets of one measure, as of identical boxes, are split by number.
        let key =
            |part: &Part| (if self.evenly(depth) { 0.0 } else { measure(&part.set.bounds) }, part.set.len);
        let mut parts = [*part; WIDTH];
        let mut count = 1;
        while count < WIDTH {
            let large = (0..count).filter(|&i| is_inner(&parts[i]));
            let Some(i) = large.reduce(|a, b| if key(&parts[b]) > key(&parts[a]) { b } else { a }) else {
                break;
            };
            [parts[i], parts[count]] = split(&parts[i])?;
            count += 1;
        }
        Some((parts, count))
    }

    #[inline(always)]
    fn split<S: Simd>(
        &self,
        simd: S,
        part: &Part,
        items: &mut [Item],
        depth: u32,
        spare: &mut Spare,
    ) -> [Part; 2] {
        if let Some(below) = self.below(part, depth) {
            return below;
        }
        // What a joint knows is of its clusters.
        let set = if part.joint.is_some() { Set::new(simd, part.set.start, items) } else { part.set };
        let halves = if self.evenly(depth) {
            set.split_evenly(simd, items)
        } else {
            set.split(simd, items, spare, |_| 1)
        };
        halves.map(|set| Part { set, joint: None })
    }

    /// What a joint is cut into; nothing if it is one cluster, or no joint, or is to be split evenly.
    fn below(&self, part: &Part, depth: u32) -> Option<[Part; 2]> {
        let below = self.clusters.below(part.joint.filter(|_| !self.evenly(depth))?)?;
        Some(below.map(|(joint, set)| Part { set, joint: Some(joint) }))
    }
}

/// Adds the node of some parts, and what `below` adds for each of them, given those of `items` that are its own: the node has them all. With
/// the feature `rayon` on the threads of the current pool, if there are many.
fn share_out<T: Send>(
    nodes: &mut Vec<Node>,
    items: &mut [T],
    (parts, count): Eight,
    below: impl Fn(&mut Vec<Node>, &mut [T], &Part) + Sync,
) {
    #[cfg(feature = "rayon")]
    let share = crate::threads::share(items.len(), PARALLEL_MIN);
    let mut lanes: Vec<usize> = (0..count).collect();
    lanes.sort_unstable_by_key(|&lane| parts[lane].set.start);
    let mut shares: [&mut [T]; WIDTH] = Default::default();
    let mut rest = items;
    for lane in lanes {
        (shares[lane], rest) = rest.split_at_mut(parts[lane].set.len);
    }
    #[cfg(feature = "rayon")]
    if share {
        assert!(nodes.is_empty(), "what is above a node that is shared was shared too");
        let subtree = |(part, items): (&Part, &mut &mut [T])| {
            let mut nodes = Vec::new();
            below(&mut nodes, items, part);
            nodes
        };
        let subtrees: Vec<Vec<Node>> = parts[..count].par_iter().zip(&mut shares).map(subtree).collect();
        let (mut node, mut index) = (node_of(&parts[..count]), 1);
        for (lane, subtree) in subtrees.iter().enumerate().filter(|(_, nodes)| !nodes.is_empty()) {
            node.child[lane] = Child::inner(index);
            index += subtree.len();
        }
        nodes.reserve_exact(index);
        nodes.push(node);
        for subtree in subtrees {
            let first = nodes.len();
            nodes.extend(subtree.into_iter().map(|mut node| {
                node.child = node.child.map(|child| child.after(first));
                node
            }));
        }
        return;
    }
    let index = nodes.len();
    nodes.push(node_of(&parts[..count]));
    for (lane, items) in shares[..count].iter_mut().enumerate() {
        if is_inner(&parts[lane]) {
            nodes[index].child[lane] = Child::inner(nodes.len());
        }
        below(nodes, items, &parts[lane]);
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
