use solid3d::convex::Support;
use solid3d::glam::DVec3;

use super::gjk_distance::{ITERATIONS_MAX, ORIGIN};
use super::{ConvexTest, Counters, Johnson, Memory, Pair, SupportPoint};

/// ISA-GJK: the GJK separating-axis algorithm, started from the axis of the frame before (thesis, Algorithm 4.2). What SOLID
/// tests convex pairs with.
#[derive(Clone, Copy, Debug, Default)]
pub struct IsaGjk {
    counters: Counters,
}

impl IsaGjk {
    /// For any convex shapes. `axis` is where the search starts, zero for anywhere, and where it ended.
    pub fn intersects_convex<A, B>(&mut self, pair: &Pair<A, B>, axis: &mut DVec3) -> bool
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        if *axis == DVec3::ZERO {
            *axis = pair.center();
        }
        separating_axis(|v| pair.support_against(v), axis, &mut self.counters)
    }
}

impl ConvexTest for IsaGjk {
    fn name(&self) -> &'static str {
        "ISA-GJK"
    }

    fn intersects(&mut self, pair: &Pair, memory: &mut Memory) -> bool {
        self.intersects_convex(pair, &mut memory.axis)
    }

    fn counters(&self) -> Counters {
        self.counters
    }
}

/// Algorithm 4.2 over any support mapping of A-B, from and to `v`.
pub(super) fn separating_axis(
    mut support_against: impl FnMut(DVec3) -> SupportPoint,
    v: &mut DVec3,
    counters: &mut Counters,
) -> bool {
    counters.tests += 1;
    let mut simplex = Johnson::default();
    for _ in 0..ITERATIONS_MAX {
        counters.iterations += 1;
        let point = support_against(*v);
        if v.dot(point.w) > 0.0 {
            return false;
        }
        if simplex.contains(point.w) {
            break;
        }
        simplex.push(point);
        let Some(closest) = simplex.reduce() else { break };
        if simplex.is_full() || closest.length_squared() <= ORIGIN * ORIGIN * simplex.length_squared_max() {
            return true;
        }
        *v = closest;
    }
    // Rounding hides which it is: SOLID takes them to be apart.
    counters.gave_up += 1;
    false
}
