//! Branch and bound for one query.

use fearless_simd::Simd;
use solid_convex::simd::{Level, dispatch};

use super::lanes::distances_squared_to_box;
use super::metric::{Folded, PairMetric};
use super::node::{Child, Kind, Node};
use super::packed::PackedBox;
use super::traversal::STACK_USUAL;
use super::{Traversal, Tree};
use crate::Aabb;

/// What is done with leaves, in vectors of the level of instructions that the walk runs on.
pub(crate) trait NearLeaves {
    /// A lower bound of the distance to anything in a local box, of which `bound` is one. What is no greater than 0 says in
    /// which order to look, the least first. Bounds of `best` and more are all the same.
    fn raise(&self, bounds: &Aabb, bound: f64, best: f64) -> f64;

    /// Called with the leaves that may hold something nearer than `best`; lowers it.
    fn visit<S: Simd>(&mut self, simd: S, leaf: &[u32], best: &mut f64);
}

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
        let bounds = |_: &(), node: &Node, _: f64, bounds: &mut [f64; 8]| {
            for (lane, least) in bounds.iter_mut().enumerate() {
                if node.child[lane] != Child::EMPTY {
                    *least = bound(&self.normal.unpack(&node.lane(lane)));
                }
            }
        };
        let visit = |_: &mut (), leaf: &[u32], best: &mut f64| visit(leaf, best);
        self.walk_near(&mut (), bounds, best, traversal, visit);
    }

    /// As [`nearest`](Tree::nearest), for a query in a box of local coordinates, on a level of instructions. Of `metric`, the
    /// half for `a` counts.
    pub(crate) fn nearest_on(
        &self,
        level: Level,
        query: &Aabb,
        metric: &PairMetric,
        best: &mut f64,
        traversal: &mut Traversal,
        visitor: &mut impl NearLeaves,
    ) {
        let query = self.normal.pack_any(query);
        let metric = Folded::new(metric, &self.normal, &self.normal);
        dispatch!(level, simd => {
            self.walk_near(
                visitor,
                #[inline(always)]
                |visitor, node, best, bounds| {
                    bound_lanes(simd, node, &query, &metric, bounds);
                    for (lane, least) in bounds.iter_mut().enumerate() {
                        if *least < best && node.child[lane] != Child::EMPTY {
                            *least = visitor.raise(&self.normal.unpack(&node.lane(lane)), *least, best);
                        }
                    }
                },
                best,
                traversal,
                #[inline(always)]
                |visitor, leaf, best| visitor.visit(simd, leaf, best),
            );
        });
    }

    /// `bounds` fills in the lower bounds of the lanes in use; what it makes of those that are not below `best` does not count.
    #[inline(always)] // into the function that is compiled for a level of instructions
    fn walk_near<V>(
        &self,
        visitor: &mut V,
        bounds: impl Fn(&V, &Node, f64, &mut [f64; 8]),
        best: &mut f64,
        traversal: &mut Traversal,
        mut visit: impl FnMut(&mut V, &[u32], &mut f64),
    ) {
        let Traversal { counters, near: stack, .. } = traversal;
        stack.clear();
        stack.reserve(STACK_USUAL);
        stack.push((0.0, Child::inner(0)));
        while let Some((least, child)) = stack.pop() {
            // Bounds below zero are as good as zero.
            if least >= *best || *best == 0.0 {
                continue;
            }
            match child.kind() {
                Kind::Empty => {}
                Kind::Leaf(range) => {
                    counters.leaf_visits += 1;
                    visit(visitor, self.leaf(range), best);
                }
                Kind::Inner(index) => {
                    counters.box_tests += 1;
                    let node = &self.nodes[index];
                    let from = stack.len();
                    let mut of_lanes = [0.0; 8];
                    bounds(visitor, node, *best, &mut of_lanes);
                    for (&child, least) in node.child.iter().zip(of_lanes) {
                        if child != Child::EMPTY {
                            push_unless_far((least, child), *best, stack, from);
                        }
                    }
                }
            }
        }
    }
}

#[inline(always)]
fn bound_lanes<S: Simd>(simd: S, node: &Node, query: &PackedBox, metric: &Folded, bounds: &mut [f64; 8]) {
    let squared = distances_squared_to_box(simd, node, query, &metric.a);
    for (bound, squared) in bounds.iter_mut().zip(squared) {
        *bound = metric.world(squared);
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
