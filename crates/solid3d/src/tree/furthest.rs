//! What is furthest along a direction.

use glam::DVec3;

use super::Tree;
use super::node::{Kind, Node, WIDTH};

/// Relative to the sum of its terms, more than what a height computed in `f64` is off: that of a box, or that of a point in it.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// A direction, in tree coordinates.
struct Probe {
    /// Times coordinates of the tree, heights above its origin.
    along: DVec3,
    /// The height of the origin, with the error of all.
    base: f64,
}

impl Tree {
    /// Visits the leaves that may hold a point whose height along a direction is `best` or more, the highest boxes first. `visit` raises `best` to
    /// the greatest height that it finds.
    ///
    /// Cost: some nodes on the way to the highest leaf, where points at that height are few; follows how many there are.
    pub(crate) fn furthest(
        &self,
        direction: DVec3,
        best: &mut f64,
        visit: &mut impl FnMut(&[u32], &mut f64),
    ) {
        let along = direction * self.normal.scale;
        let terms = (direction * self.normal.origin).abs().element_sum() + along.abs().element_sum();
        let base = direction.dot(self.normal.origin) + ROUNDING * terms + f64::MIN_POSITIVE;
        self.visit_furthest(0, &Probe { along, base }, best, visit);
    }

    fn visit_furthest(
        &self,
        node: usize,
        probe: &Probe,
        best: &mut f64,
        visit: &mut impl FnMut(&[u32], &mut f64),
    ) {
        let node = &self.nodes[node];
        let mut heights = probe.heights(node);
        loop {
            let (lane, height) = highest(&heights);
            // What is no number may be anywhere.
            if height < *best || height == f64::NEG_INFINITY {
                return;
            }
            heights[lane] = f64::NEG_INFINITY;
            match node.child[lane].kind() {
                Kind::Empty => {}
                Kind::Inner(child) => self.visit_furthest(child, probe, best, visit),
                Kind::Leaf(range) => visit(self.leaf(range), best),
            }
        }
    }
}

impl Probe {
    /// How high the boxes of a node reach, at most.
    fn heights(&self, node: &Node) -> [f64; WIDTH] {
        let mut heights = [self.base; WIDTH];
        for axis in 0..3 {
            let along = self.along[axis];
            let side = if along < 0.0 { &node.min[axis] } else { &node.max[axis] };
            for (height, side) in heights.iter_mut().zip(side) {
                *height += along * f64::from(*side);
            }
        }
        heights
    }
}

fn highest(heights: &[f64; WIDTH]) -> (usize, f64) {
    let higher = |x: (usize, f64), y: (usize, f64)| if y.1.total_cmp(&x.1).is_gt() { y } else { x };
    heights.iter().copied().enumerate().reduce(higher).expect("there are eight")
}
