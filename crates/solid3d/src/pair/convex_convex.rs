//! Convex against convex: GJK (thesis, chapter 4).

use glam::DVec3;
use solid_convex::{Closest, Outcome, gjk};

use super::table::PlacedConvex;
use super::{Relation, Scratch};

pub(super) fn intersects(a: PlacedConvex, b: PlacedConvex) -> bool {
    gjk::intersects(a.0, a.1, b.0, b.1)
}

pub(super) fn intersection(a: PlacedConvex, b: PlacedConvex, scratch: &mut Scratch) -> Relation {
    scratch.primitive_tests += 1;
    match gjk::intersection(a.0, a.1, b.0, b.1) {
        Outcome::Separated { axis } => Relation::Separated { axis: Some(axis) },
        Outcome::Touching(witness) | Outcome::Intersecting(witness) => Relation::Common(witness),
    }
}

pub(super) fn closest_within(a: PlacedConvex, b: PlacedConvex, bound: f64) -> Option<Closest> {
    gjk::closest_points_within(a.0, a.1, b.0, b.1, bound)
}

pub(super) fn axis(a: PlacedConvex, b: PlacedConvex, scratch: &mut Scratch) -> Option<DVec3> {
    scratch.primitive_tests += 1;
    gjk::separating_axis(a.0, a.1, b.0, b.1)
}
