//! Work on the parts of a slice: on one thread, or with the feature `rayon`, where there is enough of it, on those of the current pool.
//!
//! What is done to a part depends on it alone, and parts do not depend on the number of threads: so neither do results.

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

/// Does work that is shared out again and again: where it is worth it, on a thread of the pool, while others of it stay awake. To wake a
/// thread takes longer than many a share; and one that sleeps between them may be woken on the core of the thread that wakes it, frame for
/// frame.
pub(crate) fn with_others_awake<R: Send>(worth: bool, work: impl FnOnce() -> R + Send) -> R {
    #[cfg(feature = "rayon")]
    if share(usize::from(worth), 1) && !awake::AT_WORK.get() {
        return awake::with_others(work);
    }
    let _ = worth;
    work()
}

/// Threads that stay awake while another works.
#[cfg(feature = "rayon")]
mod awake {
    use std::cell::Cell;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::time::{Duration, Instant};

    use rayon::Yield;

    /// More do not stay awake.
    const OTHERS_MAX: usize = 7;

    /// A thread goes when it has had nothing to do for so long. It may be one that waits, and that another waits for in turn: so it must
    /// not stay for what is never done.
    const PATIENCE: Duration = Duration::from_micros(200);

    thread_local! {
        /// Whether this thread does work for which others stay awake.
        pub static AT_WORK: Cell<bool> = const { Cell::new(false) };
    }

    pub fn with_others<R: Send>(work: impl FnOnce() -> R + Send) -> R {
        let done = AtomicBool::new(false);
        let work = || {
            /// Also when the work panics.
            struct Guard<'d>(&'d AtomicBool);
            impl Drop for Guard<'_> {
                fn drop(&mut self) {
                    AT_WORK.set(false);
                    self.0.store(true, Ordering::Release);
                }
            }
            AT_WORK.set(true);
            let _guard = Guard(&done);
            work()
        };
        share_out((rayon::current_num_threads() - 1).min(OTHERS_MAX), work, &done)
    }

    fn share_out<R: Send>(others: usize, work: impl FnOnce() -> R + Send, done: &AtomicBool) -> R {
        if others == 0 {
            return work();
        }
        rayon::join(|| share_out(others - 1, work, done), || stay(done)).0
    }

    /// Does what there is to do in the pool until it is done.
    fn stay(done: &AtomicBool) {
        let mut since = Instant::now();
        while !done.load(Ordering::Acquire) && !AT_WORK.get() && since.elapsed() < PATIENCE {
            match rayon::yield_now() {
                Some(Yield::Executed) => since = Instant::now(),
                _ => std::thread::yield_now(),
            }
        }
    }
}

/// Whether so many elements are worth another thread, there is one, and it may be asked.
#[cfg(feature = "rayon")]
pub(crate) fn share(elements: usize, enough: usize) -> bool {
    elements >= enough && rayon::current_num_threads() > 1 && !ALONE.get()
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
            assert_eq!(first_part_where(&numbers, 7, 1, |part| part[0] >= 20), Some(20));
            assert_eq!(first_part_where(&numbers, 7, 1, |part| part[0] > 1000), None);
            let (mut one, mut other) = (0, 0);
            for worth in [true, false] {
                both(worth, || one += 1, || other += 2);
            }
            assert_eq!((one, other), (2, 4));
        };
        run();
        alone(run);
        #[cfg(feature = "rayon")]
        rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap().install(run);
    }

    /// Also when it is not worth it, when others stay awake for the same work already, and from outside of a pool; and then from a
    /// thread that found it among other work.
    #[test]
    fn what_others_stay_awake_for_is_done_once() {
        use std::sync::atomic::{AtomicUsize, Ordering};
        let run = || {
            let times = AtomicUsize::new(0);
            for worth in [true, false] {
                let answer = with_others_awake(worth, || {
                    let mut parts = [0; 100];
                    for_each_part(&mut parts, 10, 1, |i, part| {
                        times.fetch_add(1, Ordering::Relaxed);
                        part.fill(with_others_awake(worth, || i));
                    });
                    parts[99]
                });
                assert_eq!(answer, 9);
            }
            assert_eq!(times.into_inner(), 20);
        };
        run();
        #[cfg(feature = "rayon")]
        for threads in [1, 2, 20] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(run);
            pool.install(|| for_each_part(&mut [0; 50], 1, 1, |_, _| run()));
        }
    }

    /// A panic is passed on, and the threads are then as they were.
    #[cfg(feature = "rayon")]
    #[test]
    fn nobody_stays_awake_for_what_panicked() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
        for _ in 0..10 {
            let panics = || pool.install(|| with_others_awake(true, || panic!("no")));
            let caught = std::panic::catch_unwind(std::panic::AssertUnwindSafe(panics));
            assert!(caught.is_err());
            assert!(pool.broadcast(|_| !awake::AT_WORK.get()).into_iter().all(|idle| idle));
        }
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
