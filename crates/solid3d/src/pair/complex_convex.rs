//! A complex shape against a convex one: the tree is walked with the convex shape's box (thesis, section 6.3.4).

use std::ops::ControlFlow;

use solid_convex::{Closest, Support, Witness, gjk};

use super::containment::PlacedSolid;
use super::frame::Frame;
use super::reach::convex_bounds;
use super::table::{PlacedComplex, PlacedConvex};
use super::{Relation, Scratch};
use crate::bounds::Aabb;
use crate::shape::Complex;

pub(super) fn intersection(
    (complex, at_complex): PlacedComplex,
    (convex, at_convex): PlacedConvex,
    scratch: &mut Scratch,
) -> Relation {
    let (query, frame) = convex_in_complex((complex, at_complex), (convex, at_convex));
    let found = meetings_in((complex, at_complex), (convex, at_convex), &query, scratch, |_, w| {
        ControlFlow::Break(w)
    });
    let common = found.break_value().or_else(|| contained(complex, convex, &frame, scratch));
    common.map_or(Relation::Separated { axis: None }, Relation::Common)
}

/// Visits the primitives that the convex shape meets.
pub(super) fn meetings(
    complex: PlacedComplex,
    convex: PlacedConvex,
    scratch: &mut Scratch,
    mut visit: impl FnMut(u32),
) {
    let (query, _) = convex_in_complex(complex, convex);
    let _ = meetings_in(complex, convex, &query, scratch, |primitive, _| {
        visit(primitive);
        ControlFlow::<()>::Continue(())
    });
}

/// Visits the primitives that the convex shape, which is in this box, meets, each with a common point.
fn meetings_in<B>(
    (complex, at_complex): PlacedComplex,
    (convex, at_convex): PlacedConvex,
    query: &Aabb,
    scratch: &mut Scratch,
    mut visit: impl FnMut(u32, Witness) -> ControlFlow<B>,
) -> ControlFlow<B> {
    let Scratch { traversal, primitive_tests, .. } = scratch;
    complex.tree().overlapping(query, traversal, |leaf| {
        for &primitive in leaf {
            if complex.primitive_bounds(primitive).overlaps(query) {
                *primitive_tests += 1;
                let points = complex.primitive_hull(primitive);
                if let Some(witness) = gjk::intersection(&points, at_complex, convex, at_convex).witness() {
                    visit(primitive, *witness)?;
                }
            }
        }
        ControlFlow::Continue(())
    })
}

pub(super) fn closest_within(
    (complex, at_complex): PlacedComplex,
    (convex, at_convex): PlacedConvex,
    bound: f64,
    scratch: &mut Scratch,
) -> Option<Closest> {
    let (query, frame) = convex_in_complex((complex, at_complex), (convex, at_convex));
    if let Some(points) = contained(complex, convex, &frame, scratch) {
        return Some(Closest { distance: 0.0, points });
    }
    let gap = |node: &Aabb| frame.stretch[0].at_least(node.gap(&query));
    let Scratch { traversal, primitive_tests, .. } = scratch;
    // The best distance so far is kept in the common frame, as the bounds are.
    let (mut best, mut answer) = (frame.beyond(bound), None);
    complex.tree().nearest(gap, &mut best, traversal, |leaf, best| {
        for &primitive in leaf {
            if gap(&complex.primitive_bounds(primitive)) < *best {
                *primitive_tests += 1;
                let points = complex.primitive_hull(primitive);
                let closest = gjk::closest_points(&points, at_complex, convex, at_convex);
                let distance = closest.distance * frame.scale;
                if distance < *best {
                    *best = distance;
                    answer = Some(closest);
                }
            }
        }
    });
    answer.filter(|closest| closest.distance <= bound)
}

/// The centre of the convex shape, when it is in a solid. (A part of the solid inside the convex shape meets it.)
fn contained(
    complex: &Complex,
    convex: &dyn Support,
    frame: &Frame,
    scratch: &mut Scratch,
) -> Option<Witness> {
    let [from_complex, from_convex] = &frame.common;
    let (solid, center) = (PlacedSolid::new(complex, from_complex)?, convex.center());
    let inside = solid.contains(from_convex.transform_point3(center), scratch);
    inside.then(|| Witness { on_a: frame.relative.b_to_a.transform_point3(center), on_b: center })
}

/// A box around the convex shape in the space of the complex one, grown by the error of the map.
pub(super) fn convex_in_complex(complex: PlacedComplex, convex: PlacedConvex) -> (Aabb, Frame) {
    let frame = Frame::new(complex.1, complex.0.reach(), convex.1, convex.0.reach());
    let map = frame.relative.b_to_a;
    let bounds = convex_bounds(convex.0, &map.matrix3);
    let query = Aabb::new(bounds.min + map.translation, bounds.max + map.translation);
    (query.inflated(frame.relative.slack_in_a), frame)
}
