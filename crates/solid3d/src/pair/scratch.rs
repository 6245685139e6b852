//! Working memory of the algorithms, and what they count.

use super::triangle_triangle::Triangle;

use crate::tree::Traversal;

/// Working memory: kept from pair to pair, so that nothing is allocated once it has grown. One for each thread.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    /// For walks over trees.
    pub traversal: Traversal,
    /// The triangles of two leaves, in a common frame.
    pub corners: [Vec<Option<Triangle>>; 2],
    /// Tests of one primitive against another.
    pub primitive_tests: u64,
}

impl Scratch {
    /// Box tests and primitive tests so far.
    pub fn work(&self) -> (u64, u64) {
        (self.traversal.counters.box_tests, self.primitive_tests)
    }
}
