//! New boxes in the same topology (thesis, 5.2.5).

use super::Tree;
use super::build::proper;
use super::node::Kind;
use super::normal::Normal;
use crate::Aabb;

impl Tree {
    /// Gives every node the box of its primitives as they are now: linear, bottom-up, without allocation.
    ///
    /// Calls `box_of` once for each primitive, and once more when the root has left the coordinates of the tree, or has
    /// become small in them. Ask [`degraded`](Tree::degraded) afterwards.
    ///
    /// # Panics
    ///
    /// As [`build`](Tree::build), for boxes that are none. The tree is then unfit for queries.
    ///
    /// ```
    /// # use solid3d::{Aabb, glam::DVec3, tree::Tree};
    /// let at = |x: f64| Aabb::new(DVec3::splat(x), DVec3::splat(x + 1.0));
    /// let mut tree = Tree::build(&[at(0.0), at(2.0)]);
    /// tree.refit(|i| at(f64::from(i) + 50.0));
    /// assert_eq!(tree.bounds(), Aabb::new(DVec3::splat(50.0), DVec3::splat(52.0)));
    /// ```
    pub fn refit(&mut self, box_of: impl Fn(u32) -> Aabb) {
        self.refit_leaves(|leaf| {
            leaf.iter().fold(Aabb::EMPTY, |sum, &primitive| sum.union(proper(&box_of(primitive))))
        });
    }

    /// The same, from the box around the primitives of each leaf.
    pub(crate) fn refit_leaves(&mut self, box_of: impl Fn(&[u32]) -> Aabb) {
        self.bounds = self.refit_in(self.normal, &box_of);
        if !self.normal.suits(&self.bounds) {
            let normal = Normal::of(&self.bounds);
            if normal != self.normal {
                self.normal = normal;
                self.refit_in(normal, &box_of);
            }
        }
        self.root = self.nodes[0].union();
        self.cost = self.cost_relative();
    }

    /// Refits all nodes in given tree coordinates and returns the tight union.
    fn refit_in(&mut self, normal: Normal, box_of: &impl Fn(&[u32]) -> Aabb) -> Aabb {
        let mut total = Aabb::EMPTY;
        for index in (0..self.nodes.len()).rev() {
            for lane in 0..self.nodes[index].child.len() {
                let bounds = match self.nodes[index].child[lane].kind() {
                    Kind::Empty => break,
                    Kind::Inner(child) => self.nodes[child].union(),
                    Kind::Leaf(range) => {
                        // Rounding is monotone, so packing the union gives the bits of the union of the packed.
                        let tight = *proper(&box_of(&self.order[range]));
                        total.grow(tight.min);
                        total.grow(tight.max);
                        normal.pack(&tight)
                    }
                };
                self.nodes[index].set_lane(lane, &bounds);
            }
        }
        total
    }
}
