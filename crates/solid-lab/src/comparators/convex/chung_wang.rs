use solid3d::glam::DVec3;

use super::cone::Cone;
use super::gjk_distance::ITERATIONS_MAX;
use super::{ConvexTest, Counters, Memory, Pair};

/// The Chung-Wang algorithm: the axis is reflected at the support point until it weakly separates (thesis, section 4.2.2). What
/// Q-COLLIDE tests polytopes with.
///
/// Source: Chung and Wang, *Quick collision detection of polytopes in virtual environments*, 1996.
#[derive(Clone, Debug, Default)]
pub struct ChungWang {
    counters: Counters,
    cone: Cone,
    met: Vec<DVec3>,
}

impl ConvexTest for ChungWang {
    fn name(&self) -> &'static str {
        "Chung-Wang"
    }

    fn intersects(&mut self, pair: &Pair, memory: &mut Memory) -> bool {
        self.counters.tests += 1;
        self.cone.clear();
        self.met.clear();
        let start = if memory.axis == DVec3::ZERO { pair.center() } else { memory.axis };
        let mut v = start.normalize();
        // Reflecting has a support point twice: from then on axes come from the cone, which ends.
        let mut by_cone = false;
        for _ in 0..ITERATIONS_MAX {
            self.counters.iterations += 1;
            let w = pair.support_against(v).w;
            memory.axis = v;
            if v.dot(w) >= 0.0 {
                return false;
            }
            if self.met.contains(&w) {
                if by_cone {
                    // It was cut off, up to rounding.
                    return false;
                }
                by_cone = true;
            } else {
                self.met.push(w);
                if !self.cone.cut(w) {
                    return true;
                }
            }
            if by_cone {
                v = self.cone.inside();
            } else {
                let r = w.normalize();
                v = (v - 2.0 * r.dot(v) * r).normalize();
            }
        }
        self.counters.gave_up += 1;
        false
    }

    fn counters(&self) -> Counters {
        self.counters
    }
}
