//! One contact of two shapes as wholes: their deepest point, or the closest ones.

use glam::DVec3;
use solid_convex::Closest;

use super::super::approach::is_solid;
use super::super::{Scratch, depth, table};
use super::{Feature, Pair, Patch, Touch};

/// The deepest point of two shapes as wholes: of what is wholly inside a solid, or touches by so little that no pair of primitives
/// told. What is wholly inside meets no primitive.
pub(super) fn whole(pair: &Pair, scratch: &mut Scratch) -> Option<Patch> {
    let shapes = [pair.a, pair.b];
    let deepest = depth::of_deepest(shapes, |_| true, scratch);
    // A solid is as deep as its hull.
    let (primitives, found) = match deepest {
        Some(deepest) if !shapes.iter().any(is_solid) => deepest,
        _ => {
            let primitives = deepest.map(|(primitives, _)| primitives).unwrap_or_default();
            (primitives, table::penetration(pair.a, pair.b, scratch)?)
        }
    };
    Some(pair.patch_of_both(primitives, pair.placed(found.points), found.direction, found.depth))
}

/// The closest points of two shapes as wholes that are apart, within the margin.
pub(super) fn nearest(pair: &Pair, scratch: &mut Scratch) -> Option<Patch> {
    let margin = pair.margin / pair.frame.scale;
    let Closest { distance, points } = table::closest_within(pair.a, pair.b, margin, scratch)?;
    let [on_a, on_b] = pair.placed(points);
    Some(pair.patch_of_both([0, 0], [on_a, on_b], (on_a - on_b).try_normalize()?, -distance))
}

impl Pair<'_> {
    /// One contact of two shapes as wholes, of a depth in the world.
    fn patch_of_both(
        &self,
        primitives: [u32; 2],
        [on_a, on_b]: [DVec3; 2],
        normal: DVec3,
        depth: f64,
    ) -> Patch {
        let (depth, features) = (depth * self.frame.scale, [Feature::Face(0); 2]);
        let touch = Touch { on_a, on_b, depth, primitives, features };
        Patch { normal, touches: vec![touch], is_inward: false }
    }
}
