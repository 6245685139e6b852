use std::alloc::System;

use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Makes something, and says how much memory it owns. Only as long as no other thread allocates.
pub fn bytes_of<T>(make: impl FnOnce() -> T) -> (T, usize) {
    let region = Region::new(ALLOCATOR);
    let made = make();
    let change = region.change();
    let grown = change.bytes_allocated as isize - change.bytes_deallocated as isize;
    (made, usize::try_from(grown).unwrap_or(0))
}
