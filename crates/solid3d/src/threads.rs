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
        };
        run();
        alone(run);
        #[cfg(feature = "rayon")]
        rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap().install(run);
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
