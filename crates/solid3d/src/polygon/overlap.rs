//! Algorithms 3.1 and 3.2 of the thesis: the overlap of two sorted sequences of intervals.

use std::cmp::Ordering;
use std::ops::ControlFlow;

/// An end of an overlap, and which sequence it is of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum End<S, T> {
    OfS(S),
    OfT(T),
}

/// Reports the overlaps of closed intervals of `s` with those of `t`, in order; each sequence is sorted and disjoint.
/// `order` says how an end of the first lies to one of the second.
///
/// Breaking at the first report makes Algorithm 3.1 of Algorithm 3.2. Cost: O(l + m).
pub(super) fn overlaps<S: Copy, T: Copy>(
    s: &[[S; 2]],
    t: &[[T; 2]],
    mut order: impl FnMut(&S, &T) -> Ordering,
    mut report: impl FnMut([End<S, T>; 2]) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let (mut i, mut j) = (0, 0);
    while i < s.len() && j < t.len() {
        let ([s_begin, s_end], [t_begin, t_end]) = (s[i], t[j]);
        if order(&s_end, &t_begin) == Ordering::Less {
            i += 1;
        } else if order(&s_begin, &t_end) == Ordering::Greater {
            j += 1;
        } else {
            let s_begins = order(&s_begin, &t_begin) == Ordering::Greater;
            let s_ends = order(&s_end, &t_end) == Ordering::Less;
            let begin = if s_begins { End::OfS(s_begin) } else { End::OfT(t_begin) };
            let end = if s_ends { End::OfS(s_end) } else { End::OfT(t_end) };
            report([begin, end])?;
            if s_ends {
                i += 1;
            } else {
                j += 1;
            }
        }
    }
    ControlFlow::Continue(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn common(s: &[[i32; 2]], t: &[[i32; 2]]) -> Vec<[i32; 2]> {
        let mut found = Vec::new();
        let all = overlaps(s, t, Ord::cmp, |ends| {
            found.push(ends.map(|end| match end {
                End::OfS(x) | End::OfT(x) => x,
            }));
            ControlFlow::Continue(())
        });
        assert!(all.is_continue());
        found
    }

    #[test]
    fn one_segment_may_overlap_many() {
        // Figure 3.5.
        assert_eq!(
            common(&[[0, 9], [12, 14]], &[[-1, 2], [3, 4], [8, 13]]),
            [[0, 2], [3, 4], [8, 9], [12, 13]]
        );
        assert_eq!(common(&[[0, 1]], &[[1, 1], [2, 3]]), [[1, 1]]);
        assert_eq!(common(&[[0, 1], [4, 5]], &[[2, 3]]), [[0; 2]; 0]);
    }
}
