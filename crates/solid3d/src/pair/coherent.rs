//! The same two shapes, asked again and again: the table's answers, with what is kept from one question to the next.

use solid_convex::gjk::Memory;
use solid_convex::{Closest, Penetration};

use super::table::convex;
use super::{Placed, Scratch, closed_form, closest, intersects, penetration};

/// What [`intersects`] says, found faster. The memory must be of the same two shapes, and say nothing by itself, nor a
/// [`glance`](super::glance()).
pub(crate) fn intersects_again(a: Placed, b: Placed, memory: &mut Memory, scratch: &mut Scratch) -> bool {
    if let (Some(on_a), Some(on_b)) = (a.shape.polytope(), b.shape.polytope()) {
        return memory.intersects_anew(on_a, a.placement, on_b, b.placement);
    }
    if a.shape.is_simple()
        && b.shape.is_simple()
        && let Some(answer) = closed_form::closely_intersects(a, b)
    {
        memory.rest();
        return answer;
    }
    let Some(((on_a, _), (on_b, _))) = convex(a, b) else { return intersects(a, b, scratch) };
    memory.intersects_anew(on_a, a.placement, on_b, b.placement)
}

/// What [`closest`] says within the same error, found faster. The memory must be of the same two shapes, and say nothing of polytopes by itself.
pub(crate) fn closest_again(a: Placed, b: Placed, memory: &mut Memory, scratch: &mut Scratch) -> Closest {
    // Of known types, without calls through a table of functions.
    if let (Some(on_a), Some(on_b)) = (a.shape.polytope(), b.shape.polytope()) {
        return memory.closest_points(on_a, a.placement, on_b, b.placement);
    }
    let Some(((on_a, _), (on_b, _))) = convex(a, b) else { return closest(a, b, scratch) };
    closed_form::closest(a, b).unwrap_or_else(|| memory.closest_points(on_a, a.placement, on_b, b.placement))
}

/// What [`penetration`] says within the same error, found faster. The memory must be of the same two shapes.
pub(crate) fn penetration_again(
    a: Placed,
    b: Placed,
    memory: &mut Memory,
    scratch: &mut Scratch,
) -> Option<Penetration> {
    let Some(((on_a, _), (on_b, _))) = convex(a, b) else { return penetration(a, b, scratch) };
    let of_simple = closed_form::penetration(a, b);
    of_simple.or_else(|| memory.penetration(on_a, a.placement, on_b, b.placement))
}
