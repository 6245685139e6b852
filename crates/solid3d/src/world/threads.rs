//! Work on many items: on one thread, or with the feature `rayon`, where it is worth it, on those of the current pool.
//!
//! What is computed of an item depends on it alone, and results come in the order of the items: so the number of threads
//! changes nothing.

use crate::pair::Scratch;

/// Work that is worth more than one thread, in units of [`Statistics::units_for`](super::Statistics::units_for), of some 25 ns each. To
/// wake a sleeping thread and to wait for it takes some 10 us.
#[cfg(feature = "rayon")]
const WORK_MIN: u64 = 4_000;

/// Items of which the results are kept at a time, where work is shared: what they take is bounded by it.
const BATCH: usize = 4096;

/// Items that are worth passing to another thread. Their results stay at hand until they are read.
pub(super) const PART: usize = 16;

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

    /// Whether work is worth more than one thread, and there is more than one.
    #[cfg(feature = "rayon")]
    pub fn share(units: u64) -> bool {
        units >= WORK_MIN && rayon::current_num_threads() > 1
    }

    /// Whether work is shared: it never is.
    #[cfg(not(feature = "rayon"))]
    pub fn share(_units: u64) -> bool {
        false
    }

    /// Of how many items the results are to be kept at a time.
    pub fn batch(share: bool) -> usize {
        if share { BATCH } else { PART }
    }

    /// Calls `work` with each [`PART`] of `items` and the place for what comes of it, of which there are as many as parts or more; with the
    /// feature `rayon` on the threads of the current pool, if `share`.
    pub fn each_part<T: Sync, R: Default + Send>(
        &mut self,
        share: bool,
        items: &[T],
        results: &mut Vec<R>,
        work: impl Fn(&[T], &mut R, &mut Scratch) + Sync + Send,
    ) {
        let parts = items.len().div_ceil(PART);
        if results.len() < parts {
            results.resize_with(parts, R::default);
        }
        #[cfg(feature = "rayon")]
        if share {
            return self.share_parts(items, results, work);
        }
        let _ = share;
        items.chunks(PART).zip(results).for_each(|(part, result)| work(part, result, &mut self.own));
    }

    #[cfg(feature = "rayon")]
    fn share_parts<T: Sync, R: Send>(
        &mut self,
        items: &[T],
        results: &mut [R],
        work: impl Fn(&[T], &mut R, &mut Scratch) + Sync + Send,
    ) {
        use std::sync::{Mutex, PoisonError};

        use rayon::prelude::*;
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
        let parts = items.par_chunks(PART).zip(results);
        parts.for_each_init(scratch, |scratch, (part, result)| work(part, result, scratch));
    }
}
