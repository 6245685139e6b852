//! What is true of a box of the tree.

/// Some of the things below. One byte: it is read for every box that moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Status(u8);

impl Status {
    /// The proxy is in use.
    pub const ALIVE: u8 = 1;
    /// Stands in the queue.
    pub const QUEUED: u8 = 2;
    /// Its tight box changed since the last flush.
    pub const MOVED: u8 = 4;
    /// Hangs in the tree.
    pub const IN_TREE: u8 = 8;

    pub fn is(self, what: u8) -> bool {
        self.0 & what != 0
    }

    pub fn set(&mut self, what: u8, is: bool) {
        self.0 = if is { self.0 | what } else { self.0 & !what };
    }

    /// Makes something true; says whether it was not.
    pub fn put(&mut self, what: u8) -> bool {
        let was = self.is(what);
        self.0 |= what;
        !was
    }
}
