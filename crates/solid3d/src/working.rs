//! Memory to work in.

use std::ops::{Deref, DerefMut};

/// What an operation works in, kept for its memory alone: what is left in it has no part in any answer. So a copy begins with none.
#[derive(Debug, Default)]
pub(crate) struct Working<T>(pub T);

impl<T: Default> Clone for Working<T> {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl<T> Deref for Working<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T> DerefMut for Working<T> {
    fn deref_mut(&mut self) -> &mut T {
        &mut self.0
    }
}
