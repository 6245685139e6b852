//! What every query needs from its caller: a stack to work on, and counters to add to.

use super::Place;
use super::broods::Broods;
use super::node::Child;
use super::pairs::Pair;
use super::siblings::Stack;
use std::ops::AddAssign;

/// The work of queries: deterministic, so tests can assert on it where times are noise.
///
/// ```
/// use solid3d::tree::Counters;
/// let mut sum = Counters { box_tests: 1, leaf_visits: 2 };
/// sum += Counters { box_tests: 10, leaf_visits: 20 };
/// assert_eq!(sum, Counters { box_tests: 11, leaf_visits: 22 });
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Tests of one box against the eight of a node.
    pub box_tests: u64,
    /// Leaves, or pairs of leaves, handed to the visitor.
    pub leaf_visits: u64,
}

impl AddAssign for Counters {
    fn add_assign(&mut self, other: Counters) {
        self.box_tests += other.box_tests;
        self.leaf_visits += other.leaf_visits;
    }
}

/// Room that most queries do with, taken at once: growing to it took a query of a fresh scratch a tenth of its time.
pub(super) const STACK_USUAL: usize = 128;

/// The scratch memory of queries. Keep one per thread: a query like one before allocates nothing.
///
/// ```
/// use solid3d::tree::{Counters, Traversal};
/// assert_eq!(Traversal::default().counters, Counters::default());
/// ```
#[derive(Clone, Debug, Default)]
pub struct Traversal {
    /// The work done so far; queries only add to it.
    pub counters: Counters,
    /// Nodes to visit.
    pub(super) nodes: Vec<u32>,
    /// Pairs of subtrees to visit.
    pub(super) pairs: Stack,
    /// Subtrees to visit, the nearest first.
    pub(super) near: Broods,
    /// The same, by bounds that are functions; of each node, the nearest last.
    pub(super) nearest: Vec<(f64, Place)>,
    /// Subtrees to visit along a ray, with the parameter at which it enters them; of each node, the nearest last.
    pub(super) ahead: Vec<(f32, (Child, Place))>,
    /// The same for pairs of subtrees.
    pub(super) pairs_ahead: Vec<(f64, Pair)>,
    /// Pairs of subtrees, by squares of their distances; of the children of a node, the nearest last.
    pub(super) near_pairs: Vec<(f32, Pair)>,
}

impl Traversal {
    /// The memory that it owns, in bytes.
    pub(crate) fn bytes(&self) -> usize {
        let Traversal { counters: _, nodes, pairs, near, nearest, ahead, pairs_ahead, near_pairs } = self;
        nodes.capacity() * size_of::<u32>()
            + pairs.bytes()
            + near.bytes()
            + nearest.capacity() * size_of::<(f64, Place)>()
            + ahead.capacity() * size_of::<(f32, (Child, Place))>()
            + pairs_ahead.capacity() * size_of::<(f64, Pair)>()
            + near_pairs.capacity() * size_of::<(f32, Pair)>()
    }
}
