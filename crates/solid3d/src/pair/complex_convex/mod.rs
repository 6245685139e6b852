//! A complex shape against a convex one: the tree is walked from the convex shape, nearest first (thesis, section 6.3.4).
//!
//! Balls, capsules and boxes are held against eight triangles at a time in closed form ([`direct`](super::direct)), and what is clear
//! is not asked of GJK; where any triangle that meets will do, images of triangles come first ([`glance`](mod@super::glance)). Of other
//! shapes, what parts one primitive mostly parts its neighbours too: so an axis is kept, and leaves are tested along it before GJK looks
//! at what remains, and has no corner in the shape ([`interior`]). Where the distance is sought, [`gaps`](super::gaps) bounds that of the boxes of a node and of the images of triangles, all
//! eight at a time, and only what may be nearest is placed and measured.

mod alike;
mod approach;
mod ball;
mod details;
mod interior;
mod meeting;
mod shadow;
mod sight;

use std::ops::ControlFlow;

use solid_convex::{Closest, Witness, gjk};

use super::containment::PlacedSolid;
use super::far;
use super::frame::Frame;
use super::table::{PlacedComplex, PlacedConvex};
use super::{Relation, Scratch};
use crate::bounds::Aabb;
pub(super) use ball::{is_confirmed, nearest_to, point_at};

/// A gap in the common frame, where the size of the data is from 1 to 2, at which GJK calls shapes separate without fail: four
/// times the one at which it does so by a cached axis.
pub(super) const CLEARLY_APART: f64 = 1.0 / (1u64 << 24) as f64;

/// Whether they intersect: as [`intersection`] says.
pub(super) fn intersects(complex: PlacedComplex, convex: PlacedConvex, scratch: &mut Scratch) -> bool {
    let mut found = |_, _| ControlFlow::Break(());
    meeting::primitives(complex, convex, true, scratch, &mut found).is_break()
        || contained(complex, convex, scratch).is_some()
}

pub(super) fn intersection(complex: PlacedComplex, convex: PlacedConvex, scratch: &mut Scratch) -> Relation {
    let mut first = None;
    let mut found = |primitive, witness: Option<Witness>| {
        first = Some((primitive, witness));
        ControlFlow::Break(())
    };
    let _ = meeting_primitives(complex, convex, scratch, &mut found);
    let common = match first {
        Some((primitive, witness)) => {
            Some(witness.unwrap_or_else(|| closest_to(complex, primitive, convex).points))
        }
        None => contained(complex, convex, scratch),
    };
    common.map_or(Relation::Separated { axis: None }, Relation::Common)
}

/// Calls `found` with the primitives that meet the convex shape, and a common point where GJK was asked: all of them unless it
/// breaks off.
pub(super) fn meeting_primitives(
    complex: PlacedComplex,
    convex: PlacedConvex,
    scratch: &mut Scratch,
    found: &mut dyn FnMut(u32, Option<Witness>) -> ControlFlow<()>,
) -> ControlFlow<()> {
    meeting::primitives(complex, convex, false, scratch, found)
}

pub(super) fn closest_within(
    complex: PlacedComplex,
    convex: PlacedConvex,
    bound: f64,
    scratch: &mut Scratch,
) -> Option<Closest> {
    if let Some(points) = contained(complex, convex, scratch) {
        return Some(Closest { distance: 0.0, points });
    }
    closest_to_surface(complex, convex, &frame(complex, convex), bound, scratch)
}

/// The same of the surface of the complex shape alone, for what is not inside; of what is, if it is clear of the surface.
pub(super) fn closest_to_surface(
    complex: PlacedComplex,
    convex: PlacedConvex,
    frame: &Frame,
    bound: f64,
    scratch: &mut Scratch,
) -> Option<Closest> {
    if let Some(closest) = far::complex_convex(complex, convex) {
        return (closest.distance <= bound).then_some(closest);
    }
    let (primitive, closest) = approach::closest_primitive(complex, convex, frame, bound, scratch)?;
    let mut closest = closest.unwrap_or_else(|| closest_to(complex, primitive, convex));
    // Of primitives as near as each other, another may be the one that touches.
    let may_touch = closest.distance > 0.0 && closest.distance * frame.scale <= 2.0 * gjk::TOUCHING_ERROR;
    if may_touch && intersects(complex, convex, scratch) {
        closest.distance = 0.0;
    }
    (closest.distance <= bound).then_some(closest)
}

/// The closest points of a primitive and the convex shape.
fn closest_to(complex: PlacedComplex, primitive: u32, convex: PlacedConvex) -> Closest {
    gjk::closest_points(&complex.0.primitive_hull(primitive), complex.1, convex.0, convex.1)
}

/// The centre of the convex shape, when it is in a solid. (A part of the solid inside the convex shape meets it.)
fn contained(
    (complex, at_complex): PlacedComplex,
    convex: PlacedConvex,
    scratch: &mut Scratch,
) -> Option<Witness> {
    if !complex.is_solid() {
        return None;
    }
    let frame = frame((complex, at_complex), convex);
    let [from_complex, from_convex] = &frame.common;
    let (solid, center) = (PlacedSolid::new(complex, from_complex)?, convex.0.center());
    let inside = solid.contains(from_convex.transform_point3(center), scratch);
    inside.then(|| Witness { on_a: frame.b_to_a.transform_point3(center), on_b: center })
}

#[inline(always)] // made where it stays: it is large
pub(super) fn frame(complex: PlacedComplex, convex: PlacedConvex) -> Frame {
    Frame::new(complex.1, complex.0.reach(), convex.1, convex.0.reach())
}

/// A box around the convex shape in the space of the complex one, grown by the error of the map.
pub(super) fn convex_in_complex(complex: PlacedComplex, convex: PlacedConvex) -> (Aabb, Frame) {
    let frame = frame(complex, convex);
    (shadow::bounds_in_complex(convex.0, &frame), frame)
}
