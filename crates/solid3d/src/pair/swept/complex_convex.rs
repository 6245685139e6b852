//! A complex shape against a convex one.

use std::ops::ControlFlow;

use super::bodies::{MovingComplex, MovingConvex};
use super::query::{STRAIGHT, TreeSpace, size};
use super::{Encounter, convex_convex};
use crate::bounds::Aabb;
use crate::pair::Scratch;

pub(super) fn encounter(complex: MovingComplex, convex: MovingConvex, scratch: &mut Scratch) -> Encounter {
    let size = size(complex.reaches(), convex.map(|(shape, at)| (shape.reach(), at)));
    encounter_in(&TreeSpace::new(&complex, size, STRAIGHT), &complex, convex, scratch)
}

/// The same in the space of the complex shape.
pub(super) fn encounter_in(
    space: &TreeSpace,
    complex: &MovingComplex,
    convex: MovingConvex,
    scratch: &mut Scratch,
) -> Encounter {
    let query = space.query_of_convex(convex);
    // The traversal is lent to the walk, and what is visited counts, too.
    let mut traversal = std::mem::take(&mut scratch.traversal);
    let meets = |bounds: &Aabb| query.meets(bounds);
    let found = space.shape.tree().overlapping_where(&query.bounds(), meets, &mut traversal, |leaf| {
        for &primitive in leaf {
            if query.meets(&space.shape.primitive_bounds(primitive)) {
                let hulls = complex.primitive_hulls(primitive);
                let met = convex_convex::encounter(complex.ends(&hulls), convex, scratch);
                if let Encounter::At(point) = met {
                    return ControlFlow::Break(point);
                }
            }
        }
        ControlFlow::Continue(())
    });
    scratch.traversal = traversal;
    found.break_value().map_or(Encounter::None { axis: None }, Encounter::At)
}
