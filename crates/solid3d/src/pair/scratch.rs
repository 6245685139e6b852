//! Working memory of the algorithms, and what they count.

use super::row::{Row, Rows};
use crate::bounds::Aabb;
use crate::tree::Traversal;

/// A primitive of a complex shape, in a frame that it shares with others.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedPrimitive {
    /// Its number.
    pub primitive: u32,
    /// Its box.
    pub bounds: Aabb,
}

/// Working memory: kept from pair to pair, so that nothing is allocated once it has grown. One for each thread.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    /// For walks over trees.
    pub traversal: Traversal,
    /// The primitives of a leaf, in a common frame, in vectors: none before it is needed, as it is large.
    pub row: Option<Row>,
    /// The same for leaves of two shapes.
    pub rows: [Rows; 2],
    /// The primitives of two leaves, in a common frame.
    pub leaves: [Vec<PlacedPrimitive>; 2],
    /// The primitives of one complex shape that the other may meet on its way.
    pub on_the_way: Vec<u32>,
    /// Pairs of primitives that meet.
    pub meeting: Vec<[u32; 2]>,
    /// Tests of one primitive against another.
    pub primitive_tests: u64,
}

impl Scratch {
    /// Box tests and primitive tests so far.
    pub fn work(&self) -> (u64, u64) {
        (self.traversal.counters.box_tests, self.primitive_tests)
    }
}
