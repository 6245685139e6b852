use solid3d::convex::{Outcome, gjk};
use solid3d::glam::DVec3;

use super::{ConvexTest, Counters, Memory, Pair};

/// What this library does: the axis of the frame before may confirm, else GJK from scratch. Its iterations are not counted.
#[derive(Clone, Copy, Debug, Default)]
pub struct Library {
    counters: Counters,
}

impl ConvexTest for Library {
    fn name(&self) -> &'static str {
        "solid3d"
    }

    fn intersects(&mut self, pair: &Pair, memory: &mut Memory) -> bool {
        self.counters.tests += 1;
        let Pair { a, placement_a, b, placement_b } = *pair;
        if memory.axis != DVec3::ZERO && gjk::separates(&memory.axis, a, placement_a, b, placement_b) {
            return false;
        }
        match gjk::intersection(a, placement_a, b, placement_b) {
            Outcome::Separated { axis } => {
                memory.axis = axis;
                false
            }
            Outcome::Touching(_) | Outcome::Intersecting(_) => true,
        }
    }

    fn counters(&self) -> Counters {
        self.counters
    }
}
