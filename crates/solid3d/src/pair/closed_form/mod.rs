//! Pairs that need no search: balls, capsules and boxes that their placements leave what they are; and balls and points beside cones and cylinders.
//!
//! A closed form speaks only where it is sure: the placements must be rotations with a uniform scale, up to
//! [`SKEW_MAX`](solid_convex::similarity::SKEW_MAX), and the gap or overlap more than [`GAP_MIN`] of the size of the data, beyond which GJK is right too
//! ([`TOUCHING_ERROR`](solid_convex::gjk::TOUCHING_ERROR)). So both say the same, and GJK decides the rest.

mod ball;
mod boxes;
mod cast;
mod point;
mod quick;
mod round;
mod similarity;
#[cfg(test)]
mod tests;

use fearless_simd::Simd;
use glam::{DAffine3, DVec3};
use solid_convex::gjk::Glance;
use solid_convex::simd::dispatch;
use solid_convex::{Closest, Penetration, unit_scale};

use super::{Mirror, Placed, Relation};
use crate::shape::{ShapeKind, Simple};
use ball::BallAndBody;
pub(crate) use ball::{closest_to, contains};
use boxes::PlacedBox;
pub(super) use cast::cast;
pub(super) use point::foot;
pub(crate) use point::nearest_on_surface;
use round::{Cores, PlacedRound};
pub(super) use similarity::Similarity;

/// The least gap or overlap that a closed form decides, relative to the size of the data, which here is that of the balls around
/// the shapes and of the distance of their origins: no less than GJK's. Beyond GJK's error, by more than the errors of a
/// closed form: some twenty roundings, and a few times [`SKEW_MAX`](solid_convex::similarity::SKEW_MAX).
const GAP_MIN: f64 = 4.0 * solid_convex::gjk::TOUCHING_ERROR;

/// Two simple shapes in one space: along the world's axes, the origin at that of `A`, in a unit of length that is a power of two
/// near the size of the data, which is then in [1, 2).
enum Pair {
    Rounds(PlacedRound, PlacedRound),
    RoundBox(PlacedRound, PlacedBox),
    BoxRound(PlacedBox, PlacedRound),
    Boxes(PlacedBox, PlacedBox),
}

/// Whether they intersect, as [`gjk::glance`](solid_convex::gjk::glance): placements have yet to be checked.
#[inline(always)]
pub(super) fn glance<S: Simd>(simd: S, a: Placed, b: Placed) -> Glance {
    // Most pairs are of other shapes: nothing is looked at for them.
    if a.shape.is_simple() && b.shape.is_simple() { quick::intersects(simd, a, b) } else { Glance::Unusual }
}

/// Whether they intersect; `None` where GJK has to say, and where placements have yet to be checked: those of an answer are good.
pub(super) fn intersects(a: Placed, b: Placed) -> Option<bool> {
    match dispatch!(simd => glance(simd, a, b)) {
        Glance::Sure(answer) => Some(answer),
        Glance::Open => closely_intersects(a, b),
        Glance::Unusual => None,
    }
}

/// Whether they intersect, of pairs that take a common space.
#[inline(never)]
pub(super) fn closely_intersects(a: Placed, b: Placed) -> Option<bool> {
    match Pair::new(a, b)?.0 {
        Pair::Rounds(a, b) => Cores::of_rounds(&a, &b).gap().intersects(),
        Pair::RoundBox(round, cuboid) | Pair::BoxRound(cuboid, round) => {
            Cores::of_round_and_box(&round, &cuboid)?.gap().intersects()
        }
        Pair::Boxes(a, b) => boxes::separation(&a, &b).intersects(),
    }
}

/// Something of a ball, or a point, and a body; of a body and a ball mirrored. `None` for other shapes, and where GJK has to say.
#[inline]
fn of_ball<T: Mirror>(a: Placed, b: Placed, what: impl Fn(&BallAndBody) -> Option<T>) -> Option<T> {
    // A point is a hull, which is no body here.
    let in_order = a.shape.ball_radius().is_some() && b.shape.kind() != ShapeKind::ConvexHull;
    let (ball, body) = if in_order { (a, b) } else { (b, a) };
    let found = what(&BallAndBody::new(ball, body)?)?;
    Some(if in_order { found } else { found.mirrored() })
}

/// Whether a ball, or a point, and a body intersect; `None` for other shapes, and where GJK has to say.
pub(super) fn ball_intersects(a: Placed, b: Placed) -> Option<bool> {
    of_ball(a, b, BallAndBody::intersects)
}

/// How deep shapes are in each other that are known to intersect; `None` where EPA has to say.
pub(super) fn penetration(a: Placed, b: Placed) -> Option<Penetration> {
    let is_round = |of: Placed| matches!(of.shape.simple(), Some(Simple::Round(_)));
    let of_rounds = || quick_penetration(a, b).or_else(|| penetration_in_unit(a, b));
    let found = if is_round(a) && is_round(b) { of_rounds() } else { None };
    found.or_else(|| of_ball(a, b, BallAndBody::penetration))
}

/// What [`penetration`] says of balls and capsules of plain sizes whose cores are apart.
fn quick_penetration(a: Placed, b: Placed) -> Option<Penetration> {
    let (Simple::Round(of_a), Simple::Round(of_b)) = (a.shape.simple()?, b.shape.simple()?) else {
        return None;
    };
    dispatch!(simd => quick::penetration(simd, [a.placement, b.placement], [of_a, of_b]))
}

/// The same in a unit of length near the size of the data.
fn penetration_in_unit(a: Placed, b: Placed) -> Option<Penetration> {
    let (found, scale) = in_unit(a, b, quick_penetration)?;
    let Penetration { depth, lower, upper, .. } = found;
    Some(Penetration { depth: depth / scale, lower: lower / scale, upper: upper / scale, ..found })
}

/// Whether they intersect, with the evidence; `None` where GJK has to say.
pub(super) fn intersection(a: Placed, b: Placed) -> Option<Relation> {
    of_simple(a, b).or_else(|| of_ball(a, b, BallAndBody::relation))
}

/// The same of simple shapes.
fn of_simple(a: Placed, b: Placed) -> Option<Relation> {
    match Pair::new(a, b)?.0 {
        Pair::Rounds(a, b) => Cores::of_rounds(&a, &b).relation(),
        Pair::RoundBox(a, b) => Cores::of_round_and_box(&a, &b)?.relation(),
        Pair::BoxRound(a, b) => Cores::of_round_and_box(&b, &a)?.relation().mirrored(),
        // A common point is for GJK to find.
        Pair::Boxes(a, b) => match boxes::separation(&a, &b) {
            boxes::Separation::Along(axis) => Some(Relation::Separated { axis: Some(axis) }),
            _ => None,
        },
    }
}

/// The closest points; `None` where GJK has to find them.
pub(super) fn closest(a: Placed, b: Placed) -> Option<Closest> {
    let of_simple = quickly_closest(a, b).or_else(|| closest_in_unit(a, b));
    of_simple.or_else(|| of_ball(a, b, BallAndBody::closest))
}

/// What [`closest`] says of sizes that are plain. Placements need not have been checked: those of an answer are good.
pub(crate) fn quickly_closest(a: Placed, b: Placed) -> Option<Closest> {
    let (Some(_), Some(_)) = (a.shape.simple(), b.shape.simple()) else { return None };
    dispatch!(simd => quick::closest(simd, a, b))
}

/// The same in a unit of length near the size of the data.
fn closest_in_unit(a: Placed, b: Placed) -> Option<Closest> {
    let (found, scale) = in_unit(a, b, quickly_closest)?;
    Some(Closest { distance: found.distance / scale, ..found })
}

/// What is found in a unit of length near the size of the data, so that answers do not depend on the unit; and that unit: world lengths times it are
/// lengths there.
#[inline(never)]
fn in_unit<T>(a: Placed, b: Placed, find: impl Fn(Placed, Placed) -> Option<T>) -> Option<(T, f64)> {
    let [of_a, of_b] = [a.shape.simple()?, b.shape.simple()?];
    let [at_a, at_b] = [a, b].map(|placed| &placed.placement.matrix3);
    let offset = b.placement.translation - a.placement.translation;
    let scale = unit_scale(size([of_a, of_b], [&Similarity::new(at_a)?, &Similarity::new(at_b)?], offset));
    let at_a = DAffine3 { matrix3: *at_a * scale, translation: DVec3::ZERO };
    let at_b = DAffine3 { matrix3: *at_b * scale, translation: offset * scale };
    Some((find(Placed { placement: &at_a, ..a }, Placed { placement: &at_b, ..b })?, scale))
}

/// The size of the data: of the balls around the shapes and of the distance of their origins.
fn size([of_a, of_b]: [Simple; 2], [at_a, at_b]: [&Similarity; 2], offset: DVec3) -> f64 {
    of_a.radius() * at_a.stretch + of_b.radius() * at_b.stretch + offset.abs().element_sum()
}

impl Pair {
    /// With its unit: world lengths times that are lengths of its space.
    #[inline(always)] // as `of`: made where it is looked at, since it is large
    fn new(a: Placed, b: Placed) -> Option<(Pair, f64)> {
        let kinds = [a.shape.simple()?, b.shape.simple()?];
        let at = [Similarity::new(&a.placement.matrix3)?, Similarity::new(&b.placement.matrix3)?];
        Pair::of(kinds, at, b.placement.translation - a.placement.translation)
    }

    /// Of two shapes under similarities; `offset` leads from the origin of the first to that of the second.
    #[inline(always)]
    fn of([of_a, of_b]: [Simple; 2], [at_a, at_b]: [Similarity; 2], offset: DVec3) -> Option<(Pair, f64)> {
        let scale = unit_scale(size([of_a, of_b], [&at_a, &at_b], offset));
        let (at_a, at_b) = (at_a.scaled(scale), at_b.scaled(scale));
        let offset = offset * scale;
        let pair = match (of_a, of_b) {
            (Simple::Cuboid { half: half_a }, Simple::Cuboid { half: half_b }) => Pair::Boxes(
                PlacedBox { half: half_a, at: at_a, center: DVec3::ZERO },
                PlacedBox { half: half_b, at: at_b, center: offset },
            ),
            (Simple::Round(a), Simple::Cuboid { half }) => Pair::RoundBox(
                PlacedRound::new(a, at_a, DVec3::ZERO),
                PlacedBox { half, at: at_b, center: offset },
            ),
            (Simple::Cuboid { half }, Simple::Round(b)) => Pair::BoxRound(
                PlacedBox { half, at: at_a, center: DVec3::ZERO },
                PlacedRound::new(b, at_b, offset),
            ),
            (Simple::Round(a), Simple::Round(b)) => {
                Pair::Rounds(PlacedRound::new(a, at_a, DVec3::ZERO), PlacedRound::new(b, at_b, offset))
            }
        };
        Some((pair, scale))
    }
}

/// The gap between two shapes: negative for an overlap.
#[derive(Clone, Copy)]
struct Gap {
    least: f64,
    greatest: f64,
}

impl Gap {
    /// `None` for a gap that is too small to tell.
    fn intersects(self) -> Option<bool> {
        if self.least > GAP_MIN {
            Some(false)
        } else if self.greatest < -GAP_MIN {
            Some(true)
        } else {
            None
        }
    }
}
