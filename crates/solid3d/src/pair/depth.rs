//! How deep two shapes are in each other (thesis, section 2.3).
//!
//! A convex shape is a body, and so is each primitive of a surface with whatever it meets: a translation that leaves the two
//! touching is well defined. A surface has no inside to leave; the answer is that for the deepest pair of primitives. A
//! solid mesh counts as its convex hull, which is the same body when it is convex, and contains it when it is not.

use glam::DVec3;
use solid_convex::{Outcome, Penetration, epa, gjk};

use super::deepest::{deepest_pair, deepest_primitive};
use super::table::{PlacedComplex, PlacedConvex};
use super::{Mirror, Placed, Scratch, complex_complex, complex_convex};
use crate::shape::Class;

pub(super) fn convex_convex(a: PlacedConvex, b: PlacedConvex, scratch: &mut Scratch) -> Option<Penetration> {
    scratch.primitive_tests += 1;
    epa::penetration(a.0, a.1, b.0, b.1)
}

pub(super) fn complex_convex(
    a: PlacedComplex,
    b: PlacedConvex,
    scratch: &mut Scratch,
) -> Option<Penetration> {
    if a.0.is_solid() {
        return complex_convex::intersects(a, b, scratch).then(|| of_common((&a.0.hull(), a.1), b));
    }
    deepest_primitive(a, b, |_| true, scratch).map(|(_, found)| found)
}

pub(super) fn complex_complex(
    a: PlacedComplex,
    b: PlacedComplex,
    scratch: &mut Scratch,
) -> Option<Penetration> {
    if !a.0.is_solid() && !b.0.is_solid() {
        return deepest_pair(a, b, |_| true, scratch).map(|pair| of_primitives(a, b, pair));
    }
    if !complex_complex::intersects(a, b, scratch) {
        return None;
    }
    let deepest = match (a.0.is_solid(), b.0.is_solid()) {
        (true, false) => {
            deepest_primitive(b, (&a.0.hull(), a.1), |_| true, scratch).map(|(_, found)| found.mirrored())
        }
        (false, true) => deepest_primitive(a, (&b.0.hull(), b.1), |_| true, scratch).map(|(_, found)| found),
        _ => None,
    };
    // Also when rounding keeps the hull of a solid apart from what it meets.
    deepest.or_else(|| Some(of_common((&a.0.hull(), a.1), (&b.0.hull(), b.1))))
}

/// Of the pairs of primitives that are to be looked at and intersect the deepest, and their penetration; `None` when none does. Solids are taken for surfaces.
pub(super) fn of_deepest(
    [a, b]: [Placed; 2],
    is_among: impl Fn([u32; 2]) -> bool,
    scratch: &mut Scratch,
) -> Option<([u32; 2], Penetration)> {
    match (a.shape.class(), b.shape.class()) {
        (Class::Complex(x), Class::Complex(y)) => {
            let (x, y) = ((x, a.placement), (y, b.placement));
            deepest_pair(x, y, is_among, scratch).map(|pair| (pair, of_primitives(x, y, pair)))
        }
        (Class::Complex(x), Class::Convex(y)) => {
            deepest_primitive((x, a.placement), (y, b.placement), |i| is_among([i, 0]), scratch)
                .map(|(i, found)| ([i, 0], found))
        }
        (Class::Convex(x), Class::Complex(y)) => {
            deepest_primitive((y, b.placement), (x, a.placement), |j| is_among([0, j]), scratch)
                .map(|(j, found)| ([0, j], found.mirrored()))
        }
        (Class::Convex(_), Class::Convex(_)) => None,
    }
}

fn of_primitives(a: PlacedComplex, b: PlacedComplex, [i, j]: [u32; 2]) -> Penetration {
    of_common((&a.0.whole_hull(i), a.1), (&b.0.whole_hull(j), b.1))
}

/// The penetration of two convex objects, placed as these are, that are known to have a point in common. Where exact signs say so and GJK
/// keeps them apart by the rounding error, they touch.
pub(super) fn of_common((a, at_a): PlacedConvex, (b, at_b): PlacedConvex) -> Penetration {
    epa::penetration(a, at_a, b, at_b).unwrap_or_else(|| {
        let direction = match gjk::intersection(a, at_a, b, at_b) {
            Outcome::Separated { axis } => axis,
            Outcome::Touching(_) | Outcome::Intersecting(_) => DVec3::X,
        };
        let points = gjk::closest_points(a, at_a, b, at_b).points;
        Penetration { depth: 0.0, lower: 0.0, upper: 0.0, direction, points }
    })
}

impl Mirror for Penetration {
    fn mirrored(self) -> Self {
        Penetration { direction: -self.direction, points: self.points.mirrored(), ..self }
    }
}
