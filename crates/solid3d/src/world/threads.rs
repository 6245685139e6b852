//! Work on many items: on one thread, or with the feature `rayon`, where it is worth it, on those of the current pool.
//!
//! What is computed of an item depends on it alone, and results come in the order of the items: so the number of threads
//! changes nothing.

use super::pair_map::Place;
use crate::pair::Scratch;

/// Work that is worth more than one thread, in units of [`Statistics::units_for`](super::Statistics::units_for), of some 12 ns each. To
/// wake a sleeping thread takes some 20 us.
const WORK_MIN: u64 = 8_000;

/// Items of which the results are kept at a time, where work is shared: what they take is bounded by it.
pub(super) const BATCH: usize = 4096;

/// Items that are worth passing to another thread. Their results stay at hand until they are read.
pub(super) const PART: usize = 16;

/// Items of which the results are kept at a time where work is not shared: parts enough that what a part takes comes while the one before is worked at.
pub(super) const BATCH_ALONE: usize = 16 * PART;

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
        crate::threads::share(usize::from(units >= WORK_MIN), 1)
    }

    /// Whether work is shared: it never is.
    #[cfg(not(feature = "rayon"))]
    pub fn share(_units: u64) -> bool {
        false
    }

    /// Whether work is worth entering the pool of threads.
    pub fn is_worth_entering(units: u64) -> bool {
        units >= 2 * WORK_MIN
    }

    /// Of how many items the results are to be kept at a time.
    pub fn batch(share: bool) -> usize {
        if share { BATCH } else { BATCH_ALONE }
    }

    /// Calls `work` with each of the items and the result of the [`PART`] that it is of, of which there are as many as parts or more; with the
    /// feature `rayon` on the threads of the current pool, if `share`. Then places must ascend.
    ///
    /// While a part is worked at `prefetch` has been called with each of the next: it asks for the memory that `work` is going to read. So what is far
    /// away is not waited for by each in turn.
    pub fn each<T: Send, R: Default + Send>(
        &mut self,
        share: bool,
        items: Items<T>,
        results: &mut Vec<R>,
        prefetch: impl Fn(Place, &T) + Sync + Send,
        work: impl Fn(Place, &mut T, &mut R, &mut Scratch) + Sync + Send,
    ) {
        let parts = items.places.len().div_ceil(PART);
        if results.len() < parts {
            results.resize_with(parts, R::default);
        }
        let results = &mut results[..parts];
        #[cfg(feature = "rayon")]
        if share {
            return self.on_threads((items, results), prefetch, work);
        }
        let _ = share;
        items.each(results, &mut self.own, &prefetch, &work);
    }

    #[cfg(feature = "rayon")]
    fn on_threads<T: Send, R: Send>(
        &mut self,
        items: Shared<T, R>,
        prefetch: impl Fn(Place, &T) + Sync + Send,
        work: impl Fn(Place, &mut T, &mut R, &mut Scratch) + Sync + Send,
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
        rayon::iter::split(items, halves).for_each_init(scratch, |scratch, (items, results)| {
            items.each(results, scratch, &prefetch, &work)
        });
    }
}

/// Some of the places of values.
pub(super) struct Items<'a, T> {
    /// The place of the first of `values`.
    pub first: Place,
    pub values: &'a mut [T],
    pub places: &'a [Place],
}

impl<'a, T> Items<'a, T> {
    /// The same, for a while.
    pub fn reborrow(&mut self) -> Items<'_, T> {
        Items { first: self.first, values: self.values, places: self.places }
    }

    /// What stands at a place.
    pub fn at(&mut self, place: Place) -> &mut T {
        &mut self.values[(place - self.first) as usize]
    }

    /// The first so many, or all, and those after them, which ascend; both have what stands there.
    pub fn split_at(self, count: usize) -> (Self, Self) {
        let Items { first, values, places } = self;
        let (places, later) = places.split_at(count.min(places.len()));
        let at = later.first().map_or(values.len(), |&place| (place - first) as usize);
        let (values, later_values) = values.split_at_mut(at);
        let later = Items { first: first + at as Place, values: later_values, places: later };
        (Items { first, values, places }, later)
    }

    fn each<R>(
        mut self,
        results: &mut [R],
        scratch: &mut Scratch,
        prefetch: &impl Fn(Place, &T),
        work: &impl Fn(Place, &mut T, &mut R, &mut Scratch),
    ) {
        for &place in self.places.iter().take(PART) {
            prefetch(place, self.at(place));
        }
        let mut later = self.places.chunks(PART).skip(1);
        for (part, result) in self.places.chunks(PART).zip(results) {
            for &place in later.next().unwrap_or_default() {
                prefetch(place, self.at(place));
            }
            for &place in part {
                work(place, self.at(place), result, scratch);
            }
        }
    }
}

/// Two halves of items and the results of their parts, if there is more than a part.
#[cfg(feature = "rayon")]
fn halves<'a, T, R>((items, results): Shared<'a, T, R>) -> (Shared<'a, T, R>, Option<Shared<'a, T, R>>) {
    if results.len() <= 1 {
        return ((items, results), None);
    }
    let parts = results.len() / 2;
    let (items, later) = items.split_at(parts * PART);
    let (results, later_results) = results.split_at_mut(parts);
    ((items, results), Some((later, later_results)))
}

/// Items, and the result of each part.
#[cfg(feature = "rayon")]
type Shared<'a, T, R> = (Items<'a, T>, &'a mut [R]);
