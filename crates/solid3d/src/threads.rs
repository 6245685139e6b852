//! Work on the parts of a slice: on one thread, or with the feature `rayon`, where there is enough of it, on those of the current pool.
//!
//! What is done to a part depends on it alone, and parts do not depend on the number of threads: so neither do results.
//!
//! Work is shared by the threads of the pool alone. A thread from outside would wait for the pool to wake, and to be woken by it, at each
//! work that it shared, for some 20 us each: it [enters](in_pool) the pool once for all that an operation has to do.

/// Calls `work` with each part of `items`, of `part` elements but for the last, and its number. `enough` elements are worth another
/// thread.
pub(crate) fn for_each_part<T: Send>(
    items: &mut [T],
    part: usize,
    enough: usize,
    work: impl Fn(usize, &mut [T]) + Sync + Send,
) {
    #[cfg(feature = "rayon")]
    if share(items.len(), enough) {
        use rayon::prelude::*;
        return items.par_chunks_mut(part).enumerate().for_each(|(i, part)| work(i, part));
    }
    let _ = enough;
    items.chunks_mut(part).enumerate().for_each(|(i, part)| work(i, part));
}

/// Calls `work` with each of `items` and its number; of any two, each is worth a thread of its own, if `worth`.
pub(crate) fn for_each<T: Send>(items: &mut [T], worth: bool, work: impl Fn(usize, &mut T) + Sync + Send) {
    #[cfg(feature = "rayon")]
    if share(usize::from(worth), 1) {
        use rayon::prelude::*;
        // Else some would be kept together, and what comes late for its share would wait for all of them.
        return items.par_iter_mut().enumerate().with_max_len(1).for_each(|(i, item)| work(i, item));
    }
    let _ = worth;
    items.iter_mut().enumerate().for_each(|(i, item)| work(i, item));
}

/// The number of the first part of `items` for which `is` holds.
pub(crate) fn first_part_where<T: Sync>(
    items: &[T],
    part: usize,
    enough: usize,
    is: impl Fn(&[T]) -> bool + Sync + Send,
) -> Option<usize> {
    #[cfg(feature = "rayon")]
    if share(items.len(), enough) {
        use rayon::prelude::*;
        return items.par_chunks(part).position_first(is);
    }
    let _ = enough;
    items.chunks(part).position(is)
}

/// Does two things: at the same time where there is another thread and it is worth it, else one after the other.
pub(crate) fn both(worth: bool, one: impl FnOnce() + Send, other: impl FnOnce() + Send) {
    #[cfg(feature = "rayon")]
    if share(usize::from(worth), 1) {
        rayon::join(one, other);
        return;
    }
    let _ = worth;
    one();
    other();
}

/// Does an operation that shares several works, some 200 us or more of them if `worth`: then a thread of the current pool does it, where the
/// calling one is from outside.
pub(crate) fn in_pool<R: Send>(worth: bool, operation: impl FnOnce() -> R + Send) -> R {
    #[cfg(feature = "rayon")]
    if worth && may_share() && rayon::current_thread_index().is_none() {
        return rayon::scope(|_| operation());
    }
    let _ = worth;
    operation()
}

/// Does what this thread does alone between works that are shared. Another stays awake meanwhile, if `shares`: to wake one takes some 20 us,
/// and it sleeps after 2 us without work.
pub(crate) fn between<R: Send>(shares: bool, work: impl FnOnce() -> R + Send) -> R {
    #[cfg(feature = "rayon")]
    if share(usize::from(shares), 1) {
        use std::sync::atomic::{AtomicBool, Ordering};
        /// Then, after some 100 us, it may sleep all the same.
        const LOOKS_MAX: u32 = 5_000;
        struct Done<'a>(&'a AtomicBool);
        impl Drop for Done<'_> {
            fn drop(&mut self) {
                self.0.store(true, Ordering::Relaxed);
            }
        }
        let done = AtomicBool::new(false);
        let work = || {
            let _done = Done(&done);
            work()
        };
        let wait = || {
            (0..LOOKS_MAX).take_while(|_| !done.load(Ordering::Relaxed)).for_each(|_| std::hint::spin_loop())
        };
        return rayon::join(work, wait).0;
    }
    let _ = shares;
    work()
}

/// Whether so many elements are worth another thread, there is one, and this one may ask it.
#[cfg(feature = "rayon")]
pub(crate) fn share(elements: usize, enough: usize) -> bool {
    elements >= enough && may_share() && rayon::current_thread_index().is_some()
}

/// Whether there is another thread, and this one may wait for it.
#[cfg(feature = "rayon")]
fn may_share() -> bool {
    rayon::current_num_threads() > 1 && !ALONE.get()
}

#[cfg(feature = "rayon")]
thread_local! {
    static ALONE: std::cell::Cell<bool> = const { std::cell::Cell::new(false) };
}

/// Does work on this thread alone. A thread that waits for others takes up any work of its pool; so what a pool's thread does while
/// it holds something that other work of the pool wants must not wait.
pub(crate) fn alone<R>(work: impl FnOnce() -> R) -> R {
    #[cfg(feature = "rayon")]
    let _guard = {
        struct Guard(bool);
        impl Drop for Guard {
            fn drop(&mut self) {
                ALONE.set(self.0);
            }
        }
        Guard(ALONE.replace(true))
    };
    work()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_all_visited_and_the_first_is_found() {
        let run = || {
            let mut numbers = vec![0; 1000];
            for_each_part(&mut numbers, 7, 1, |i, part| part.fill(i));
            assert!(numbers.iter().enumerate().all(|(i, &number)| number == i / 7));
            for worth in [true, false] {
                for_each(&mut numbers, worth, |i, number| *number += i);
            }
            assert!(numbers.iter().enumerate().all(|(i, &number)| number == i / 7 + 2 * i));
            for_each_part(&mut numbers, 7, 1, |i, part| part.fill(i));
            assert_eq!(first_part_where(&numbers, 7, 1, |part| part[0] >= 20), Some(20));
            assert_eq!(first_part_where(&numbers, 7, 1, |part| part[0] > 1000), None);
            let (mut one, mut other) = (0, 0);
            for worth in [true, false] {
                both(worth, || one += 1, || other += 2);
            }
            assert_eq!((one, other), (2, 4));
            for shares in [true, false] {
                assert_eq!(between(shares, || in_pool(shares, || one)), 2);
            }
        };
        run();
        alone(run);
        #[cfg(feature = "rayon")]
        rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap().install(run);
    }

    /// Law: a thread from outside shares nothing; it enters the pool for what is worth it, unless it must not wait.
    #[cfg(feature = "rayon")]
    #[test]
    fn who_is_outside_enters_the_pool() {
        let is_inside = || rayon::current_thread_index().is_some();
        let has_threads = rayon::current_num_threads() > 1;
        assert!(!share(10, 10) && !is_inside());
        assert!(!in_pool(false, is_inside) && !alone(|| in_pool(true, is_inside)));
        assert_eq!(in_pool(true, || (is_inside(), share(10, 10))), (has_threads, has_threads));
    }

    /// Law: who is kept awake is let go, also when what it waits for panics.
    #[cfg(feature = "rayon")]
    #[test]
    fn who_is_kept_awake_is_let_go() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
        for _ in 0..100 {
            let failed = pool.install(|| std::panic::catch_unwind(|| between(true, || panic!("as it may"))));
            assert!(failed.is_err_and(|it: Box<_>| it.downcast_ref() == Some(&"as it may")));
        }
        assert_eq!(pool.install(|| between(true, || 7)), 7);
    }

    #[cfg(feature = "rayon")]
    #[test]
    fn who_is_alone_shares_nothing() {
        rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap().install(|| {
            assert!(share(10, 10) && !share(9, 10));
            assert!(!alone(|| share(10, 10)));
            assert!(share(10, 10));
        });
    }
}
