use super::{ConvexTest, Counters, Memory, Pair};
use crate::comparators::bsp::Merge;

/// Polytopes as trees of planes, merged: what tests any two solids (thesis, section 5.1.3), here on convex ones. Polytopes that touch are apart;
/// the tree of each is made at the first test.
#[derive(Clone, Debug, Default)]
pub struct BspTrees {
    tests: u64,
    merge: Merge,
}

impl ConvexTest for BspTrees {
    fn name(&self) -> &'static str {
        "BSP trees"
    }

    /// Needs solid polytopes, of dimension three; iterations are cells cut in two.
    fn intersects(&mut self, pair: &Pair, _: &mut Memory) -> bool {
        self.tests += 1;
        let b_to_a = pair.placement_a.inverse() * *pair.placement_b;
        self.merge.intersect(pair.a.bsp_tree(), pair.b.bsp_tree(), &b_to_a)
    }

    fn counters(&self) -> Counters {
        Counters { tests: self.tests, iterations: self.merge.counters().cuts, gave_up: 0 }
    }
}
