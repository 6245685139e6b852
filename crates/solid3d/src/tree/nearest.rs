//! Branch and bound for one query that is a function.

use super::insertion::push_unless_far;
use super::node::{Child, Kind, WIDTH};
use super::{Place, Traversal, Tree};
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
        let Traversal { counters, nearest: stack, .. } = traversal;
        stack.clear();
        stack.push((f64::NEG_INFINITY, Place::ROOT));
        while let Some((least, place)) = stack.pop() {
            // Bounds below zero are as good as zero.
            if *best == 0.0 {
                return;
            }
            if least >= *best {
                continue;
            }
            match self.child_at(place).kind() {
                Kind::Empty => {}
                Kind::Leaf(range) => {
                    counters.leaf_visits += 1;
                    visit(self.leaf(range), best);
                }
                Kind::Inner(index) => {
                    counters.box_tests += 1;
                    let (node, from) = (&self.nodes[index], stack.len());
                    for lane in (0..WIDTH).filter(|&lane| node.child[lane] != Child::EMPTY) {
                        let least = bound(&self.normal.unpack(&node.lane(lane)));
                        push_unless_far((least, Place::lane(index, lane)), *best, stack, from);
                    }
                }
            }
        }
    }
}
