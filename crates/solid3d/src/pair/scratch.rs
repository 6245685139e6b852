//! Working memory of the algorithms, and what they count.

use std::cell::Cell;

use super::row::{Row, Rows};
use crate::bounds::Aabb;
use crate::tree::Traversal;

thread_local! {
    /// Between queries that bring none of their own, that of the thread.
    static KEPT: Cell<Option<Box<Scratch>>> = const { Cell::new(None) };
}

/// What took more than so many bytes is given back: a thread asks of huge shapes once, and lives on.
const KEPT_BYTES_MAX: usize = 1 << 18;

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
    /// Does something with the scratch of the thread, as what was there before has no part in any answer.
    pub fn with<R>(work: impl FnOnce(&mut Scratch) -> R) -> R {
        // None is there for the first query, for one that another calls back, and while the thread ends.
        let mut scratch = KEPT.try_with(Cell::take).ok().flatten().unwrap_or_default();
        let result = work(&mut scratch);
        if scratch.bytes() <= KEPT_BYTES_MAX {
            // An error is the end of the thread: nothing is kept then.
            let _ = KEPT.try_with(|kept| kept.set(Some(scratch)));
        }
        result
    }

    /// The memory that it owns, in bytes.
    fn bytes(&self) -> usize {
        let rows: usize = self.rows.iter().map(Rows::bytes).sum();
        let leaves: usize =
            self.leaves.iter().map(|leaf| leaf.capacity() * size_of::<PlacedPrimitive>()).sum();
        let numbers =
            self.on_the_way.capacity() * size_of::<u32>() + self.meeting.capacity() * size_of::<[u32; 2]>();
        self.traversal.bytes() + rows + leaves + numbers
    }

    /// Box tests and primitive tests so far.
    pub fn work(&self) -> (u64, u64) {
        (self.traversal.counters.box_tests, self.primitive_tests)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: the scratch of a thread is kept, but for one that has grown; and a query within a query has one of its own.
    #[test]
    fn the_scratch_of_a_thread_is_kept_unless_it_has_grown() {
        Scratch::with(|scratch| scratch.on_the_way.reserve(1000));
        let kept = Scratch::with(|outer| {
            let inner = Scratch::with(|inner| inner.on_the_way.capacity());
            [outer.on_the_way.capacity(), inner]
        });
        assert!(kept[0] >= 1000 && kept[1] == 0, "{kept:?}");
        Scratch::with(|scratch| scratch.on_the_way.reserve(KEPT_BYTES_MAX));
        assert_eq!(Scratch::with(|scratch| scratch.on_the_way.capacity()), 0);
    }
}
