//! The table.

use glam::{DAffine3, DVec3};
use solid_convex::gjk::{self, Decision, Proof};
use solid_convex::{Closest, Penetration, Support};

use super::{
    Mirror, Placed, Relation, Scratch, closed_form, complex_complex, complex_convex, convex_convex, depth,
    still_separated,
};
use crate::shape::{Class, Complex};

/// A convex shape at a place.
pub(super) type PlacedConvex<'a> = (&'a dyn Support, &'a DAffine3);
/// A complex shape at a place.
pub(super) type PlacedComplex<'a> = (&'a Complex, &'a DAffine3);

/// A row of the table: an algorithm for each pair of classes. The fourth pair is the second one mirrored.
struct Row<T> {
    convex_convex: fn(PlacedConvex, PlacedConvex, &mut Scratch) -> T,
    complex_convex: fn(PlacedComplex, PlacedConvex, &mut Scratch) -> T,
    complex_complex: fn(PlacedComplex, PlacedComplex, &mut Scratch) -> T,
}

impl<T: Mirror> Row<T> {
    fn apply(&self, a: Placed, b: Placed, scratch: &mut Scratch) -> T {
        let (at_a, at_b) = (a.placement, b.placement);
        match (a.shape.class(), b.shape.class()) {
            (Class::Convex(a), Class::Convex(b)) => (self.convex_convex)((a, at_a), (b, at_b), scratch),
            (Class::Complex(a), Class::Convex(b)) => (self.complex_convex)((a, at_a), (b, at_b), scratch),
            (Class::Convex(a), Class::Complex(b)) => {
                (self.complex_convex)((b, at_b), (a, at_a), scratch).mirrored()
            }
            (Class::Complex(a), Class::Complex(b)) => (self.complex_complex)((a, at_a), (b, at_b), scratch),
        }
    }
}

/// Whether they intersect: what [`intersection`] says, without a common point.
pub(crate) fn intersects(a: Placed, b: Placed, scratch: &mut Scratch) -> bool {
    match closed_form::intersects(a, b).or_else(|| convex_intersects(a, b)) {
        Some(answer) => {
            scratch.primitive_tests += 1;
            answer
        }
        None => intersects_by_class(a, b, scratch),
    }
}

/// The same of shapes for which nothing more particular is known: one of them is complex at least.
pub(crate) fn intersects_by_class(a: Placed, b: Placed, scratch: &mut Scratch) -> bool {
    const ROW: Row<bool> = Row {
        convex_convex: |a, b, _| convex_convex::intersects(a, b),
        complex_convex: complex_convex::intersects,
        complex_complex: complex_complex::intersects,
    };
    ROW.apply(a, b, scratch)
}

/// What [`intersects`] says of convex shapes, for which no working memory is needed; `None` for others.
pub(crate) fn convex_intersects(a: Placed, b: Placed) -> Option<bool> {
    let (on_a, on_b) = convex(a, b)?;
    // Of a hull, the planes told at a glance what they tell.
    let of_hull = a.shape.polytope().is_some() | b.shape.polytope().is_some();
    let of_ball = if of_hull { None } else { closed_form::ball_intersects(a, b) };
    Some(of_ball.unwrap_or_else(|| convex_convex::intersects(on_a, on_b)))
}

/// What [`closest_within`] says of convex shapes, for which no working memory is needed; `None` for others.
pub(crate) fn convex_closest_within(a: Placed, b: Placed, bound: f64) -> Option<Option<Closest>> {
    // Of known types, without a call through a table of functions.
    if let (Some(on_a), Some(on_b)) = (a.shape.polytope(), b.shape.polytope()) {
        return Some(gjk::closest_points_within(on_a, a.placement, on_b, b.placement, bound));
    }
    if let Some(closest) = closed_form::closest(a, b) {
        return Some((closest.distance <= bound).then_some(closest));
    }
    let (on_a, on_b) = convex(a, b)?;
    Some(convex_convex::closest_within(on_a, on_b, bound))
}

/// Two shapes as convex ones, if they are.
pub(super) fn convex<'a>(a: Placed<'a>, b: Placed<'a>) -> Option<(PlacedConvex<'a>, PlacedConvex<'a>)> {
    match (a.shape.class(), b.shape.class()) {
        (Class::Convex(on_a), Class::Convex(on_b)) => Some(((on_a, a.placement), (on_b, b.placement))),
        _ => None,
    }
}

/// Whether they intersect. Of complex shapes, the common point is one of the first pair of primitives found.
pub(crate) fn intersection(a: Placed, b: Placed, scratch: &mut Scratch) -> Relation {
    if let Some(relation) = closed_form::intersection(a, b) {
        scratch.primitive_tests += 1;
        return relation;
    }
    const ROW: Row<Relation> = Row {
        convex_convex: convex_convex::intersection,
        complex_convex: complex_convex::intersection,
        complex_complex: complex_complex::intersection,
    };
    ROW.apply(a, b, scratch)
}

/// Whether they intersect, as [`intersection`] says, by what showed it last or by something else, which takes its place.
pub(crate) fn decide(a: Placed, b: Placed, proof: &mut Proof, scratch: &mut Scratch) -> Decision {
    // Of known types, without a call through a table of functions.
    if let (Some(on_a), Some(on_b)) = (a.shape.polytope(), b.shape.polytope()) {
        let decision = proof.renew(on_a, a.placement, on_b, b.placement);
        scratch.primitive_tests += u64::from(!decision.by_the_same);
        return decision;
    }
    // Seen anew as quickly as by a proof.
    if let Some(intersect) = closed_form::intersects(a, b) {
        scratch.primitive_tests += 1;
        *proof = Proof::None;
        return Decision { intersect, by_the_same: false };
    }
    if let Proof::Apart(axis) = proof
        && still_separated(axis, a, b)
    {
        return Decision { intersect: false, by_the_same: true };
    }
    let (intersect, axis) = match convex(a, b) {
        Some((on_a, on_b)) => {
            let axis = convex_convex::axis(on_a, on_b, scratch);
            (axis.is_none(), axis)
        }
        None => (intersects_by_class(a, b, scratch), None),
    };
    *proof = axis.into();
    Decision { intersect, by_the_same: false }
}

/// The closest points.
pub(crate) fn closest(a: Placed, b: Placed, scratch: &mut Scratch) -> Closest {
    let closest = closest_within(a, b, f64::INFINITY, scratch);
    closest.expect("every shape has a primitive, and every distance is finite")
}

/// The closest points, if they are at most so far apart.
pub(crate) fn closest_within(a: Placed, b: Placed, bound: f64, scratch: &mut Scratch) -> Option<Closest> {
    if let Some(closest) = convex_closest_within(a, b, bound) {
        scratch.primitive_tests += 1;
        return closest;
    }
    let (at_a, at_b) = (a.placement, b.placement);
    match (a.shape.class(), b.shape.class()) {
        (Class::Convex(_), Class::Convex(_)) => unreachable!("convex shapes were answered"),
        (Class::Complex(a), Class::Convex(b)) => {
            complex_convex::closest_within((a, at_a), (b, at_b), bound, scratch)
        }
        (Class::Convex(a), Class::Complex(b)) => {
            complex_convex::closest_within((b, at_b), (a, at_a), bound, scratch).mirrored()
        }
        (Class::Complex(a), Class::Complex(b)) => {
            complex_complex::closest_within((a, at_a), (b, at_b), bound, scratch)
        }
    }
}

/// A separating axis of the shapes' convex hulls.
pub(crate) fn axis(a: Placed, b: Placed, scratch: &mut Scratch) -> Option<DVec3> {
    if let Some(Relation::Separated { axis }) = closed_form::intersection(a, b) {
        return axis;
    }
    const ROW: Row<Option<DVec3>> = Row {
        convex_convex: convex_convex::axis,
        complex_convex: |a, b, scratch| {
            axis_of_hulls((&a.0.hull(), a.1), b, scratch, |scratch| complex_convex::intersects(a, b, scratch))
        },
        complex_complex: |a, b, scratch| {
            let hulls = [a.0.hull(), b.0.hull()];
            axis_of_hulls((&hulls[0], a.1), (&hulls[1], b.1), scratch, |scratch| {
                complex_complex::intersects(a, b, scratch)
            })
        },
    };
    ROW.apply(a, b, scratch)
}

/// A separating axis of convex hulls, unless what they are hulls of is so near that it counts as touching.
fn axis_of_hulls(
    a: PlacedConvex,
    b: PlacedConvex,
    scratch: &mut Scratch,
    intersect: impl FnOnce(&mut Scratch) -> bool,
) -> Option<DVec3> {
    let axis = convex_convex::axis(a, b, scratch)?;
    (gjk::separates(&axis, a.0, a.1, b.0, b.1) || !intersect(scratch)).then_some(axis)
}

/// How deep they are in each other.
pub(crate) fn penetration(a: Placed, b: Placed, scratch: &mut Scratch) -> Option<Penetration> {
    if let found @ Some(_) = closed_form::penetration(a, b) {
        scratch.primitive_tests += 1;
        return found;
    }
    const ROW: Row<Option<Penetration>> = Row {
        convex_convex: depth::convex_convex,
        complex_convex: depth::complex_convex,
        complex_complex: depth::complex_complex,
    };
    ROW.apply(a, b, scratch)
}
