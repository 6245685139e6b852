//! The build: sets are cut in two until they are leaves, and of the binary tree `collapse` makes eight-wide nodes.
//!
//! Of many primitives the upper splits are those of `clusters`: only what is below a few of these is gathered, and split while it is at hand.
//! The halves of large sets are cut apart, on several threads where there are some.

use std::sync::Mutex;

use fearless_simd::Simd;
#[cfg(feature = "rayon")]
use rayon::prelude::*;
use solid_convex::simd::dispatch;

use super::Tree;
use super::clusters::{Clusters, JointIndex};
use super::collapse::Binary;
use super::cost::{Measured, sum};
use super::node::{Node, PRIMITIVES_MAX};
use super::normal::{COORDINATE_MAX, Normal};
use super::packed::PackedBox;
use super::split::{Item, Set, Spare};
use crate::Aabb;
use crate::threads::{both, in_pool};
use glam::DVec3;

/// From this depth of the binary tree on, sets are split evenly: a heuristic that peels off one primitive at a time ends here.
const HEURISTIC_DEPTH_MAX: u32 = 48;

/// No tree is deeper, in nodes, since none has more than one at each depth of the binary tree: below that at which the heuristic ends, each
/// level halves the number of primitives, up to a leaf, and 8 * 2^26 > 2^28.
pub const DEPTH_MAX: u32 = HEURISTIC_DEPTH_MAX + 26;

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
        in_pool(boxes.len() >= MANY, || {
            Tree::build_of_with(boxes.len(), heuristic_depth, |i| boxes[i as usize])
        })
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
        let (binary, order) = builder.build(count);
        let mut nodes = binary.nodes();
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
    let sum = if crate::threads::share(count as usize, MANY) {
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

/// Sets of at least so many primitives are worth another thread. Fewer are gathered before they are cut, some 300 kB, which are then at hand.
pub(super) const MANY: usize = 1 << 13;

/// A set that may be a joint of clusters.
#[derive(Clone, Copy)]
struct Part {
    set: Set,
    joint: Option<JointIndex>,
}

/// Makes a binary tree of primitives of which `pack` gives the boxes.
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

    /// The binary tree of all, and the order of the primitives.
    fn build(&self, count: usize) -> (Binary, Vec<u32>) {
        let (joint, set) = self.clusters.root();
        let mut order = vec![0; count];
        let tree = self.joint(&mut order, &Part { set, joint: Some(joint) }, 0);
        (tree, order)
    }

    /// The tree of a joint, whose primitives it gives their order. It goes as deep as there are large sets: [`DEPTH_MAX`] bounds it.
    fn joint(&self, order: &mut [u32], part: &Part, depth: u32) -> Binary {
        if part.set.len >= MANY
            && let Some(halves) = self.below(part, depth)
        {
            return apart(order, part, halves, |order, part| self.joint(order, part, depth + 1));
        }
        let rooms = || self.rooms.lock().expect("nobody panics who holds it");
        let mut room = rooms().pop().unwrap_or_default();
        let Room { items, spare } = &mut room;
        let items = self.gather(&part.set, items);
        let tree = self.gathered(items, part, depth, spare);
        for (to, item) in order.iter_mut().zip(items) {
            *to = item.index;
        }
        rooms().push(room);
        tree
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

    /// The tree of a set, of which these are the items; as deep as the one before.
    fn gathered(&self, items: &mut [Item], part: &Part, depth: u32, spare: &mut Spare) -> Binary {
        if items.len() >= MANY {
            let halves = dispatch!(simd => self.split(simd, part, items, depth, spare));
            return apart(items, part, halves, |items, part| {
                self.gathered(items, part, depth + 1, &mut Spare::default())
            });
        }
        let base = part.set.start;
        dispatch!(simd => Binary::cut(
            *part,
            #[inline(always)]
            |part| part.set,
            #[inline(always)]
            |part, below| {
                self.split(simd, part, &mut items[part.set.start - base..][..part.set.len], depth + below, spare)
            },
        ))
    }

    fn evenly(&self, depth: u32) -> bool {
        depth >= self.heuristic_depth
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

/// The tree of a set from those of its halves, which `below` makes, given those of `items` that are theirs: on two threads, where there are.
fn apart<T: Send>(
    items: &mut [T],
    part: &Part,
    halves: [Part; 2],
    below: impl Fn(&mut [T], &Part) -> Binary + Sync,
) -> Binary {
    let (of_first, of_second) = items.split_at_mut(halves[0].set.len);
    let (mut first, mut second) = (None, None);
    both(true, || first = Some(below(of_first, &halves[0])), || second = Some(below(of_second, &halves[1])));
    let [first, second] = [first, second].map(|tree| tree.expect("both were made"));
    Binary::join(&part.set, [first, second])
}

const _: () = assert!(size_of::<Node>() == 224);
