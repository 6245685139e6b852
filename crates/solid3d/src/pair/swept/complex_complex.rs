//! A complex shape against another.
//!
//! The primitives of one that the other as a whole may meet are found by its tree; each of these then goes through the tree of
//! the other. Walking the two trees together needs boxes grown to all sides by the length of the way, which for a fast
//! object is much more than what it sweeps.

use super::bodies::MovingComplex;
use super::query::{STRAIGHT, TreeSpace, size};
use super::{Encounter, complex_convex};
use crate::pair::Scratch;

pub(super) fn encounter(a: MovingComplex, b: MovingComplex, scratch: &mut Scratch) -> Encounter {
    // The first walk is through the larger tree: what it leaves out is most.
    let (large, small) = if a.to.0.tree().len() < b.to.0.tree().len() { (b, a) } else { (a, b) };
    let size = size(large.reaches(), small.reaches());
    let (in_large, in_small) =
        (TreeSpace::new(&large, size, STRAIGHT), TreeSpace::new(&small, size, STRAIGHT));
    let mut primitives = std::mem::take(&mut scratch.on_the_way);
    in_large.primitives(&in_large.query_of_complex(&small), &mut scratch.traversal, &mut primitives);
    let met = primitives.iter().find_map(|&primitive| {
        let hulls = large.primitive_hulls(primitive);
        match complex_convex::encounter_in(&in_small, &small, large.ends(&hulls), scratch) {
            Encounter::At(point) => Some(point),
            Encounter::None { .. } => None,
        }
    });
    scratch.on_the_way = primitives;
    met.map_or(Encounter::None { axis: None }, Encounter::At)
}
