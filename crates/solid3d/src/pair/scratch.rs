//! Working memory of the algorithms, and what they count.

use glam::DVec3;

use super::triangle_triangle::Triangle;
use crate::bounds::Aabb;
use crate::tree::Traversal;

/// A primitive of a complex shape, in a frame that it shares with others.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedPrimitive {
    /// Its number.
    pub primitive: u32,
    /// Its box.
    pub bounds: Aabb,
    /// Its corners, when it has up to three vertices.
    pub triangle: Option<Triangle>,
}

impl PlacedPrimitive {
    /// The least coordinate along an axis, or a bound below it.
    pub fn least_along(&self, axis: DVec3) -> f64 {
        match &self.triangle {
            Some([p, q, r]) => p.dot(axis).min(q.dot(axis)).min(r.dot(axis)),
            None => self.bounds.center().dot(axis) - self.bounds.half_extents().dot(axis.abs()),
        }
    }
}

/// Working memory: kept from pair to pair, so that nothing is allocated once it has grown. One for each thread.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    /// For walks over trees.
    pub traversal: Traversal,
    /// The primitives of two leaves, in a common frame.
    pub leaves: [Vec<PlacedPrimitive>; 2],
    /// The primitives of one complex shape that the other may meet on its way.
    pub on_the_way: Vec<u32>,
    /// Tests of one primitive against another.
    pub primitive_tests: u64,
}

impl Scratch {
    /// Box tests and primitive tests so far.
    pub fn work(&self) -> (u64, u64) {
        (self.traversal.counters.box_tests, self.primitive_tests)
    }
}
