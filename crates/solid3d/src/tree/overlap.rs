//! The leaves whose box overlaps one box.

use solid_convex::simd::dispatch;

use super::crossing::Crossing;
use super::lanes::{bits, overlapping_box, overlapping_probe};
use super::node::{Kind, Node};
use super::normal::Normal;
use super::packed::PackedBox;
use super::relative::PlacedBox;
use super::{Traversal, Tree};
use crate::Aabb;
use std::ops::ControlFlow;

impl Tree {
    /// Visits the leaves whose box overlaps a box of the same space: all primitives that do, and some that do not.
    /// An empty query overlaps nothing.
    ///
    /// ```
    /// # use solid3d::{Aabb, glam::DVec3, tree::{Traversal, Tree}};
    /// # use std::ops::ControlFlow;
    /// let tree = Tree::build(&[Aabb::new(DVec3::ZERO, DVec3::ONE)]);
    /// let touches = Aabb::new(DVec3::ONE, DVec3::splat(2.0));
    /// let hit = tree.overlapping(&touches, &mut Traversal::default(), |leaf| ControlFlow::Break(leaf.to_vec()));
    /// assert_eq!(hit, ControlFlow::Break(vec![0]));
    /// ```
    pub fn overlapping<B>(
        &self,
        query: &Aabb,
        traversal: &mut Traversal,
        visit: impl FnMut(&[u32]) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        let Some(query) = self.pack_clipped(query) else { return ControlFlow::Continue(()) };
        dispatch!(simd => self.walk(|node| overlapping_box(simd, node, &query), traversal, visit))
    }

    /// Like [`overlapping`](Tree::overlapping), but only through boxes that `meets` does not refuse: for a query of which the box
    /// is but the bounds. It is asked about boxes around one primitive or more, in local coordinates.
    ///
    /// ```
    /// # use solid3d::{Aabb, glam::DVec3, tree::{Traversal, Tree}};
    /// # use std::ops::ControlFlow;
    /// let unit = Aabb::new(DVec3::ZERO, DVec3::ONE);
    /// let tree = Tree::build(&[unit]);
    /// let refused = tree.overlapping_where(&unit, |_| false, &mut Traversal::default(), |_| ControlFlow::Break(()));
    /// assert_eq!(refused, ControlFlow::Continue(()));
    /// ```
    pub fn overlapping_where<B>(
        &self,
        query: &Aabb,
        meets: impl Fn(&Aabb) -> bool,
        traversal: &mut Traversal,
        visit: impl FnMut(&[u32]) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        let Some(query) = self.pack_clipped(query) else { return ControlFlow::Continue(()) };
        let met = |hits: u32, node: &Node| {
            let met = |lane: &usize| meets(&self.normal.unpack(&node.lane(*lane)));
            bits(hits).filter(met).fold(0, |hits, lane| hits | 1 << lane)
        };
        dispatch!(simd => {
            self.walk(
                #[inline(always)]
                |node| met(overlapping_box(simd, node, &query), node),
                traversal,
                visit,
            )
        })
    }

    /// Visits the leaves whose box may overlap a box of another space (six facet axes): all primitives whose box does, and some
    /// whose box does not.
    ///
    /// The box must be one that [`Tree::build`] would take. See [`PlacedBox`] for an example.
    pub fn overlapping_box<B>(
        &self,
        query: &PlacedBox,
        traversal: &mut Traversal,
        visit: impl FnMut(&[u32]) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        let normal = Normal::of(&query.bounds);
        let crossing = Crossing::new(&query.relative, &normal, &self.normal);
        let bounds = normal.pack(&query.bounds);
        dispatch!(simd => {
            let probe = crossing.probe(simd, &bounds);
            self.walk(|node| overlapping_probe(simd, node, &crossing, &probe).0, traversal, visit)
        })
    }

    /// The part of a box that is within the bounds, where there is neither infinity nor overflow.
    fn pack_clipped(&self, query: &Aabb) -> Option<PackedBox> {
        let clipped = || Aabb::new(query.min.max(self.bounds.min), query.max.min(self.bounds.max));
        query.overlaps(&self.bounds).then(|| self.normal.pack(&clipped()))
    }

    /// Visits the leaves among the lanes that `test` names, depth first, lanes in order.
    #[inline(always)] // into the function that is compiled for a level of instructions
    fn walk<B>(
        &self,
        test: impl Fn(&Node) -> u32,
        traversal: &mut Traversal,
        mut visit: impl FnMut(&[u32]) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        let Traversal { counters, nodes: stack, .. } = traversal;
        stack.clear();
        stack.push(0);
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index as usize];
            counters.box_tests += 1;
            for lane in bits(test(node)) {
                match node.child[lane].kind() {
                    Kind::Empty => {}
                    Kind::Inner(child) => stack.push(child as u32),
                    Kind::Leaf(range) => {
                        counters.leaf_visits += 1;
                        visit(self.leaf(range))?;
                    }
                }
            }
        }
        ControlFlow::Continue(())
    }
}
