//! What is noted of boxes as they are told.

use super::status::Status;
use crate::broad::Proxy;
#[cfg(feature = "rayon")]
use crate::broad::room::extend;
use crate::broad::room::push;

/// What became of the boxes since the last flush.
#[derive(Clone, Debug, Default)]
pub(super) struct Notes {
    /// Whether any is not what it was.
    pub changed: bool,
    /// Those that moved, each once, unless it is all; some may have been removed since.
    pub moved: Vec<Proxy>,
    /// Whether so many moved that no more of them are noted.
    pub all_moved: bool,
    /// Those whose fat boxes are not in the tree as they are, each once; some may have been removed since.
    pub queue: Vec<Proxy>,
    /// Whether any of those was removed.
    pub queued_removed: bool,
    /// Whether several threads were told boxes.
    pub shared: bool,
    /// What threads note of their parts; empty but for its memory.
    #[cfg(feature = "rayon")]
    pub parts: Vec<Notes>,
}

impl Notes {
    /// Notes that a box moved; of more than `moved_max` only that they are so many.
    #[inline(always)]
    pub fn note_moved(&mut self, proxy: Proxy, status: &mut Status, moved_max: usize) {
        self.changed = true;
        if !self.all_moved && status.put(Status::MOVED) {
            push(&mut self.moved, proxy);
            self.all_moved = self.moved.len() > moved_max;
        }
    }

    /// Adds what was noted after this, and leaves nothing there.
    #[cfg(feature = "rayon")]
    pub fn append(&mut self, later: &mut Notes, moved_max: usize) {
        self.changed |= later.changed;
        self.all_moved |= later.all_moved || self.moved.len() + later.moved.len() > moved_max;
        if !self.all_moved {
            extend(&mut self.moved, &later.moved);
        }
        extend(&mut self.queue, &later.queue);
        later.changed = false;
        later.moved.clear();
        later.queue.clear();
    }

    /// Gives back what a first insertion of all boxes took. Nothing may be queued.
    pub fn trim(&mut self) {
        self.queue = Vec::new();
        #[cfg(feature = "rayon")]
        {
            self.parts = Vec::new();
        }
    }
}
