use solid3d::glam::DVec3;

use super::isa_gjk::separating_axis;
use super::{ConvexTest, Counters, Memory, Pair};

/// ISA-GJK with support points by hill climbing from the vertices of the time before, as in enhanced GJK (thesis, section
/// 4.4.2).
///
/// Source: Cameron, *Enhancing GJK: computing minimum and penetration distances between convex polyhedra*, 1997.
#[derive(Clone, Copy, Debug, Default)]
pub struct EnhancedGjk {
    counters: Counters,
}

impl ConvexTest for EnhancedGjk {
    fn name(&self) -> &'static str {
        "ISA-GJK, hill climbing"
    }

    fn intersects(&mut self, pair: &Pair, memory: &mut Memory) -> bool {
        let Memory { axis, vertices, .. } = memory;
        if *axis == DVec3::ZERO {
            *axis = pair.center();
        }
        separating_axis(|v| pair.climb_against(v, vertices), axis, &mut self.counters)
    }

    fn counters(&self) -> Counters {
        self.counters
    }
}
