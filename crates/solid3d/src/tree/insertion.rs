//! Subtrees to be visited, sorted as they come.

/// Adds an entry nearer than `best` to those from `from` on, of which the nearest comes last.
///
/// An insertion, for at most eight. Of equal bounds, what was added first comes last. (Telling each its place by how many of eight
/// are farther, without a branch, took a fifth longer for a ray: most nodes give it one or two.)
#[inline]
pub fn push_unless_far<K: Copy + PartialOrd, T: Copy>(
    entry: (K, T),
    best: K,
    stack: &mut Vec<(K, T)>,
    from: usize,
) {
    // A bound that is no number is below everything.
    if entry.0 >= best {
        return;
    }
    stack.push(entry);
    let mut at = stack.len() - 1;
    while at > from && stack[at - 1].0 <= entry.0 {
        // Number by number: those just written apart, and then read as one, as a swap does, are waited for.
        let (bound, what) = stack[at - 1];
        stack[at] = (bound, what);
        at -= 1;
    }
    stack[at] = entry;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_kept_nearest_last() {
        let mut stack = vec![(0.5, 'z')];
        for entry in [(3.0, 'a'), (1.0, 'b'), (9.0, 'c'), (1.0, 'd'), (2.0, 'e')] {
            push_unless_far(entry, 9.0, &mut stack, 1);
        }
        assert_eq!(stack, [(0.5, 'z'), (3.0, 'a'), (2.0, 'e'), (1.0, 'd'), (1.0, 'b')]);
    }

    /// What is not known to be far may be near.
    #[test]
    fn an_entry_without_a_bound_is_kept() {
        let mut stack = vec![(0.5, 'z')];
        push_unless_far((f64::NAN, 'a'), 9.0, &mut stack, 1);
        assert_eq!(stack.last().map(|entry| entry.1), Some('a'));
    }
}
