//! Work on many items: on one thread, or with the feature `rayon`, where it is worth it, on those of the current pool.
//!
//! What is computed of an item depends on it alone, and results come in the order of the items: so the number of threads
//! changes nothing.

use crate::pair::Scratch;

/// Work that is worth more than one thread, in units of [`Statistics::units_for`](super::Statistics::units_for), of some 25 ns each. To
/// wake a sleeping thread and to wait for it takes some 10 us.
#[cfg(feature = "rayon")]
const WORK_MIN: u64 = 4_000;

/// Items of which the results are kept at a time: what they take is bounded by it.
#[cfg(feature = "rayon")]
pub(super) const BATCH: usize = 8192;

/// Working memory for each thread.
#[derive(Debug, Default)]
pub(super) struct Workers {
    own: Scratch,
    #[cfg(feature = "rayon")]
    of_pool: Vec<std::sync::Mutex<Scratch>>,
}

impl Workers {
    /// That of the calling thread.
    pub fn own(&mut self) -> &mut Scratch {
        &mut self.own
    }
}

#[cfg(feature = "rayon")]
impl Workers {
    /// Whether work is worth more than one thread, and there is more than one.
    pub fn share(units: u64) -> bool {
        units >= WORK_MIN && rayon::current_num_threads() > 1
    }

    /// Puts into `results` what `work` makes of each item, in their order.
    pub fn map<T: Sync, R: Send>(
        &mut self,
        items: &[T],
        results: &mut Vec<R>,
        work: impl Fn(&T, &mut Scratch) -> R + Sync + Send,
    ) {
        use std::sync::{Mutex, PoisonError};

        use rayon::prelude::*;
        /// Fewer items than this are not worth passing to another thread.
        const ITEMS_MIN: usize = 16;
        let threads = rayon::current_num_threads();
        if self.of_pool.len() < threads {
            self.of_pool.resize_with(threads, Mutex::default);
        }
        let of_pool = &self.of_pool;
        let scratch = || {
            let thread = rayon::current_thread_index().unwrap_or(0);
            // What a panic left is as good as new: it is memory to be overwritten, and counts of which differences are taken.
            of_pool[thread].lock().unwrap_or_else(PoisonError::into_inner)
        };
        let items = items.par_iter().with_min_len(ITEMS_MIN);
        items.map_init(scratch, |scratch, item| work(item, scratch)).collect_into_vec(results);
    }
}
