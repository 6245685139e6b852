//! Branch and bound for one query.

use super::node::{Child, Kind};
use super::{Traversal, Tree};
use crate::Aabb;

impl Tree {
    /// Visits the leaves that may hold something nearer than `best`, the nearest child first.
    ///
    /// `bound` gives a lower bound of the distance of the query to anything in a local box. `visit` lowers the best distance as it
    /// finds nearer primitives; subtrees whose bound is not below it are skipped. At zero the query ends.
    ///
    /// ```
    /// use solid3d::{Aabb, glam::DVec3, tree::{Traversal, Tree}};
    /// let points: Vec<DVec3> = (0..100).map(|i| DVec3::new(f64::from(i), 0.0, 0.0)).collect();
    /// let tree = Tree::build(&points.iter().map(|&p| Aabb::new(p, p)).collect::<Vec<_>>());
    ///
    /// let query = DVec3::new(41.7, 3.0, 0.0);
    /// let bound = |b: &Aabb| query.distance(query.clamp(b.min, b.max));
    /// let (mut best, mut nearest) = (f64::INFINITY, None);
    /// tree.nearest(bound, &mut best, &mut Traversal::default(), |leaf, best| {
    ///     for &i in leaf {
    ///         let distance = points[i as usize].distance(query);
    ///         if distance < *best {
    ///             (*best, nearest) = (distance, Some(i));
    ///         }
    ///     }
    /// });
    /// assert_eq!(nearest, Some(42));
    /// ```
    pub fn nearest(
        &self,
        bound: impl Fn(&Aabb) -> f64,
        best: &mut f64,
        traversal: &mut Traversal,
        mut visit: impl FnMut(&[u32], &mut f64),
    ) {
        let Traversal { counters, near: stack, .. } = traversal;
        stack.clear();
        stack.push((0.0, Child::inner(0)));
        while let Some((least, child)) = stack.pop() {
            if least >= *best {
                continue;
            }
            match child.kind() {
                Kind::Empty => {}
                Kind::Leaf(range) => {
                    counters.leaf_visits += 1;
                    visit(self.leaf(range), best);
                }
                Kind::Inner(index) => {
                    counters.box_tests += 1;
                    let node = &self.nodes[index];
                    let from = stack.len();
                    for (lane, &child) in node.child.iter().enumerate().filter(|(_, c)| **c != Child::EMPTY) {
                        let least = bound(&self.normal.unpack(&node.lane(lane)));
                        push_unless_far((least, child), *best, stack, from);
                    }
                }
            }
        }
    }
}

/// Adds an entry nearer than `best` to those from `from` on, of which the nearest comes last.
///
/// An insertion, for at most eight. Of equal bounds, what was added first comes last.
#[inline]
pub(super) fn push_unless_far<T: Copy>(entry: (f64, T), best: f64, stack: &mut Vec<(f64, T)>, from: usize) {
    if entry.0 >= best {
        return;
    }
    stack.push(entry);
    let mut at = stack.len() - 1;
    while at > from && stack[at - 1].0 <= entry.0 {
        stack.swap(at - 1, at);
        at -= 1;
    }
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
}
