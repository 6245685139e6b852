//! All pairs of leaves whose boxes overlap: the tree against itself.

use fearless_simd::Simd;
use solid_convex::simd::{dispatch, prefetch};

use super::node::{Kind, Place};
use super::tree::Tree;
use crate::broad::Proxy;
use crate::tree::bits;

/// Two lanes whose boxes overlap.
pub(super) type Lanes = [Place; 2];

impl Tree {
    /// Visits every pair of leaves whose boxes overlap and whose last common node is `common`, each once. Over all nodes these
    /// are all pairs. Gives the number of nodes visited. `stack` is scratch.
    pub fn pairs_within(
        &self,
        common: u32,
        stack: &mut Vec<Lanes>,
        mut visit: impl FnMut(Proxy, Proxy),
    ) -> u64 {
        dispatch!(simd => self.pairs_within_with(simd, common, stack, &mut visit))
    }

    #[inline(always)]
    fn pairs_within_with<S: Simd>(
        &self,
        simd: S,
        common: u32,
        stack: &mut Vec<Lanes>,
        visit: &mut impl FnMut(Proxy, Proxy),
    ) -> u64 {
        stack.clear();
        let mut visits = 1;
        let node = &self.nodes[common as usize];
        for lane in 0..node.count() {
            let later = !0 << lane << 1;
            self.meet(simd, [common, common], lane, later, stack, visit);
        }
        // Ends, because each step goes down in one of the two.
        while let Some(places) = stack.pop() {
            let [a, b] = places.map(|place| self.lane(place));
            let [box_a, box_b] = places.map(|place| self.nodes[place.node() as usize].lane_box(place.lane()));
            match [a, b] {
                [Kind::Node(a), Kind::Node(b)] => {
                    visits += 2;
                    for lane in bits(self.nodes[a as usize].overlap_mask(simd, &box_b)) {
                        self.meet(simd, [a, b], lane, !0, stack, visit);
                    }
                }
                [Kind::Leaf(_), Kind::Node(below)] => {
                    visits += 1;
                    for lane in bits(self.nodes[below as usize].overlap_mask(simd, &box_a)) {
                        self.found([places[0], Place::new(below, lane)], stack, visit);
                    }
                }
                [Kind::Node(below), Kind::Leaf(_)] => {
                    visits += 1;
                    for lane in bits(self.nodes[below as usize].overlap_mask(simd, &box_b)) {
                        self.found([Place::new(below, lane), places[1]], stack, visit);
                    }
                }
                [Kind::Leaf(_), Kind::Leaf(_)] => unreachable!("two leaves are a pair at once"),
            }
        }
        visits
    }

    /// A lane of the first node against `others` of the second.
    #[inline(always)]
    fn meet<S: Simd>(
        &self,
        simd: S,
        [a, b]: [u32; 2],
        lane: usize,
        others: u32,
        stack: &mut Vec<Lanes>,
        visit: &mut impl FnMut(Proxy, Proxy),
    ) {
        let lane_box = self.nodes[a as usize].lane_box(lane);
        for other in bits(self.nodes[b as usize].overlap_mask(simd, &lane_box) & others) {
            self.found([Place::new(a, lane), Place::new(b, other)], stack, visit);
        }
    }

    #[inline(always)]
    fn found(&self, places: Lanes, stack: &mut Vec<Lanes>, visit: &mut impl FnMut(Proxy, Proxy)) {
        let kinds = places.map(|place| self.lane(place));
        match kinds {
            [Kind::Leaf(a), Kind::Leaf(b)] => visit(a, b),
            _ => {
                stack.push(places);
                // The search comes to them soon.
                for kind in kinds {
                    if let Kind::Node(node) = kind {
                        prefetch(&self.nodes[node as usize]);
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn lane(&self, place: Place) -> Kind {
        self.nodes[place.node() as usize].child(place.lane())
    }
}
