//! Pointers of the client as the values they are compared by.

use std::collections::{HashMap, HashSet};
use std::ffi::c_void;
use std::fmt;

use foldhash::fast::RandomState;

/// A pointer that is compared and handed back, and never followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Reference(usize);

/// What is known by a reference, or by several.
pub(crate) type ByReference<K, T> = HashMap<K, T, RandomState>;

/// References, each once.
pub(crate) type References = HashSet<Reference, RandomState>;

impl Reference {
    /// The reference of a number that the library gives out.
    pub fn of_number(number: usize) -> Self {
        Reference(number)
    }

    /// The pointer, as the client gave it.
    pub fn pointer(self) -> *mut c_void {
        std::ptr::with_exposed_provenance_mut(self.0)
    }
}

impl From<*mut c_void> for Reference {
    fn from(pointer: *mut c_void) -> Self {
        Reference(pointer.expose_provenance())
    }
}

impl fmt::Display for Reference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0 == 0 { f.write_str("NULL") } else { write!(f, "{:#x}", self.0) }
    }
}
