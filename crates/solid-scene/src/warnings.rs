//! What was passed over or guessed.

use std::collections::HashSet;

use crate::text::counted;

/// Warnings of a file that are kept.
const WARNINGS_MAX: usize = 200;

/// Warnings in the order of their first appearance, each once.
#[derive(Debug, Default)]
pub(crate) struct Warnings {
    seen: HashSet<String>,
    list: Vec<String>,
    dropped: usize,
}

impl Warnings {
    /// Adds a warning, unless it is known or there are [`WARNINGS_MAX`].
    pub fn add(&mut self, warning: impl Into<String>) {
        let warning = warning.into();
        if self.seen.contains(&warning) {
            return;
        }
        if self.list.len() == WARNINGS_MAX {
            self.dropped += 1;
            return;
        }
        self.seen.insert(warning.clone());
        self.list.push(warning);
    }

    /// All of them; the last one tells how many were dropped.
    pub fn into_vec(mut self) -> Vec<String> {
        if self.dropped > 0 {
            self.list.push(counted(self.dropped, "more warning"));
        }
        self.list
    }
}
