//! Vectors that grow by an eighth.
//!
//! To double them leaves up to half of what they hold of the machine's memory unused. This leaves a ninth at most, and moves
//! each element some nine times in all, in long runs, which is little beside what is done with it.

/// A full vector grows by one in this many of its elements.
const GROWTH_ONE_IN: usize = 8;

/// Makes room for `len` elements in all, and some more; but no more than that where it becomes more than twice as long, as one does that is
/// filled at once.
pub(crate) fn room<T>(vector: &mut Vec<T>, len: usize) {
    /// A small vector grows by as much as this.
    const GROWTH_MIN: usize = 8;
    if len > vector.capacity() {
        let more = if len / 2 > vector.capacity() { 0 } else { (len / GROWTH_ONE_IN).max(GROWTH_MIN) };
        vector.reserve_exact(len + more - vector.len());
    }
}

/// Adds an element.
#[inline]
pub(crate) fn push<T>(vector: &mut Vec<T>, element: T) {
    if vector.len() == vector.capacity() {
        room_for_one(vector);
    }
    vector.push(element);
}

/// Apart, so that nothing is prepared for it where there is room.
#[cold]
#[inline(never)]
fn room_for_one<T>(vector: &mut Vec<T>) {
    room(vector, vector.len() + 1);
}

/// Adds an element of a word or two. Where it is the last thing to do, nothing is kept for after a call that is seldom made; a larger element
/// would be put together elsewhere for that call, always.
#[inline]
pub(crate) fn push_word<T>(vector: &mut Vec<T>, element: T) {
    if vector.len() == vector.capacity() {
        push_word_to_full(vector, element);
    } else {
        vector.push(element);
    }
}

#[cold]
#[inline(never)]
fn push_word_to_full<T>(vector: &mut Vec<T>, element: T) {
    push(vector, element);
}

/// Adds elements.
pub(crate) fn extend<T: Copy>(vector: &mut Vec<T>, elements: &[T]) {
    room(vector, vector.len() + elements.len());
    vector.extend_from_slice(elements);
}

/// Gives back most of what is unused of a vector, where it is [much](is_much).
pub(crate) fn give_back<T>(vector: &mut Vec<T>) {
    if is_much(vector.capacity(), vector.len()) {
        vector.shrink_to(2 * vector.len());
    }
}

/// Whether there is room for many elements, and for many times as many as there are.
pub(crate) fn is_much(capacity: usize, len: usize) -> bool {
    const MANY: usize = 1 << 12;
    const TIMES: usize = 8;
    capacity > MANY.max(TIMES * len)
}

/// Makes a vector longer.
pub(crate) fn resize<T: Clone>(vector: &mut Vec<T>, len: usize, element: T) {
    room(vector, len);
    vector.resize(len, element);
}

/// The same, of many elements on the threads of the current pool: memory that the machine gives for the first time it has to clear,
/// which takes as long as to fill it.
pub(crate) fn resize_on_threads<T: Clone + Send + Sync>(vector: &mut Vec<T>, len: usize, element: T) {
    #[cfg(feature = "rayon")]
    {
        use rayon::prelude::*;
        /// Fewer bytes than this are not worth another thread.
        const BYTES_MANY: usize = 1 << 16;
        let added = len.saturating_sub(vector.len());
        if crate::threads::share(added * size_of::<T>(), BYTES_MANY) {
            room(vector, len);
            return vector.par_extend(rayon::iter::repeat_n(element, added));
        }
    }
    resize(vector, len, element);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: what is unused is at most an eighth of what is used, but for a few elements; and a vector grows seldom.
    #[test]
    fn little_is_unused_and_growth_is_seldom() {
        let (mut pushed, mut resized, mut growths) = (Vec::new(), Vec::new(), 0);
        for len in 1..=100_000 {
            let capacity = pushed.capacity();
            push(&mut pushed, len);
            resize(&mut resized, len, 0);
            growths += usize::from(pushed.capacity() != capacity);
            assert!(pushed.capacity() <= len + len / GROWTH_ONE_IN + 9, "{len}: {}", pushed.capacity());
            assert!(resized.capacity() <= len + len / GROWTH_ONE_IN + 9, "{len}: {}", resized.capacity());
        }
        assert!(growths < 100, "{growths} growths");
        assert!(pushed.iter().copied().eq(1..=100_000));
    }

    /// Law: on threads or not, a vector is made longer by the same elements, and shorter.
    #[test]
    fn threads_make_a_vector_as_long() {
        let run = || {
            let mut vector = vec![1_u64; 10];
            for len in [10, 100_000, 100_001, 50, 200_000] {
                resize_on_threads(&mut vector, len, 7);
                assert_eq!(vector.len(), len);
                assert!(vector.iter().zip(0..).all(|(&x, i)| x == if i < 10 { 1 } else { 7 }), "{len}");
            }
        };
        run();
        #[cfg(feature = "rayon")]
        rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap().install(run);
    }
}
