//! Pairs that need no search: balls, capsules and boxes that their placements leave what they are; and balls and points beside cones and cylinders. Beside
//! hulls, where no face is nearest, one for the centre alone. Of a ball or point in an ellipsoid, how deep it is.
//!
//! A closed form speaks only where it is sure: the placements, but that of a ball that is an ellipsoid, must be rotations with a uniform scale, up to
//! [`SKEW_MAX`](solid_convex::similarity::SKEW_MAX), and the gap or overlap more than [`GAP_MIN`] of the size of the data, beyond which GJK is right too
//! ([`TOUCHING_ERROR`](solid_convex::gjk::TOUCHING_ERROR)). So both say the same, and GJK decides the rest.

mod ball;
mod boxes;
mod cast;
mod ellipsoid;
mod foot;
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
use solid_convex::{Closest, Impact, Penetration, unit_scale};

use super::{Mirror, Placed, Relation};
use crate::shape::{ShapeKind, Simple};
use ball::BallAndBody;
use boxes::PlacedBox;
use cast::cast;
pub(super) use ellipsoid::Ellipsoid;
pub(super) use foot::foot;
pub use point::ClosestPoint;
pub(crate) use point::{closest_to, contains, nearest_on_surface};
use round::{Cores, PlacedRound};
pub(super) use similarity::{Similarity, to_body, to_world};

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

/// Whether both are [`Simple`].
#[inline(always)]
fn are_simple(a: Placed, b: Placed) -> bool {
    a.shape.is_simple() && b.shape.is_simple()
}

/// Whether they intersect, as [`gjk::glance`](solid_convex::gjk::glance): placements have yet to be checked.
#[inline(always)]
pub(super) fn glance<S: Simd>(simd: S, a: Placed, b: Placed) -> Glance {
    // Most pairs are of other shapes: nothing is looked at for them.
    if are_simple(a, b) {
        quick::intersects(simd, a, b)
    } else if a.shape.is_ball() || b.shape.is_ball() {
        quick::ball_intersects(simd, a, b)
    } else {
        Glance::Unusual
    }
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
fn of_ball<T: Mirror + Lengths>(a: Placed, b: Placed, what: impl Fn(&BallAndBody) -> Option<T>) -> Option<T> {
    let in_order = ball_is_first(a, b)?;
    let find = |a: Placed, b: Placed| quickly_of_ball(a, b, &what);
    let (ball, body) = if in_order { (a, b) } else { (b, a) };
    // Of plain sizes another unit tells no more.
    let is_plain = || dispatch!(simd => ball::plain_view(simd, ball, body).is_some());
    find(a, b).or_else(|| if is_plain() { None } else { in_unit(a, b, find) })
}

/// The same of plain sizes. Placements need not have been checked: those of an answer are good.
#[inline]
fn quickly_of_ball<T: Mirror>(a: Placed, b: Placed, what: impl Fn(&BallAndBody) -> Option<T>) -> Option<T> {
    let in_order = ball_is_first(a, b)?;
    let (ball, body) = if in_order { (a, b) } else { (b, a) };
    let found = dispatch!(simd => what(&BallAndBody::new(simd, ball, body)?))?;
    Some(if in_order { found } else { found.mirrored() })
}

/// Of a ball, or a point, and a body, whether it is the first; `None` for other shapes.
#[inline]
pub(super) fn ball_is_first(a: Placed, b: Placed) -> Option<bool> {
    let is_ball = |of: Placed| of.shape.ball_radius().is_some();
    let is_body = |of: Placed| !matches!(of.shape.kind(), ShapeKind::Mesh | ShapeKind::Complex);
    if is_body(b) && is_ball(a) { Some(true) } else { (is_body(a) && is_ball(b)).then_some(false) }
}

/// Whether a ball, or a point, and a body intersect; `None` for other shapes, and where GJK has to say.
pub(super) fn ball_intersects(a: Placed, b: Placed) -> Option<bool> {
    of_ball(a, b, |pair| pair.intersects())
}

/// How deep shapes are in each other that are known to intersect; `None` where EPA has to say.
pub(super) fn penetration(a: Placed, b: Placed) -> Option<Penetration> {
    let of_rounds = || quickly_penetration(a, b).or_else(|| in_unit(a, b, quickly_penetration));
    let found = if are_round(a, b) { of_rounds() } else { None };
    found.or_else(|| Some(depth_of_ball(a, b)?.found)).or_else(|| ellipsoid::penetration(a, b))
}

/// What [`penetration`] says of sizes that are plain. Placements need not have been checked: those of an answer are good.
pub(crate) fn quickly_penetration(a: Placed, b: Placed) -> Option<Penetration> {
    if are_round(a, b) {
        by_depth_of_rounds(a, b, |found| Some(*found))
    } else if is_apart_from_hull(a, b) {
        None
    } else {
        quickly_of_ball(a, b, |pair| pair.penetration())
    }
}

/// What `found` makes of how deep two balls or capsules are in each other, in one kernel; `None` of other shapes. The placements as in [`quickly_penetration`].
#[inline(always)]
pub(super) fn by_depth_of_rounds<T>(
    a: Placed,
    b: Placed,
    found: impl Fn(&Penetration) -> Option<T>,
) -> Option<T> {
    let (Simple::Round(of_a), Simple::Round(of_b)) = (a.shape.simple()?, b.shape.simple()?) else {
        return None;
    };
    dispatch!(simd => found(&quick::penetration(simd, [a.placement, b.placement], [of_a, of_b])?))
}

/// What `found` makes of how deep a ball and a body are in each other, and of the outward normal of the body in its own directions where that is nearest, in one kernel;
/// of plain sizes. The placements as in [`quickly_penetration`].
#[inline(always)]
pub(super) fn by_depth_of_ball<T>(
    ball: Placed,
    body: Placed,
    found: impl Fn(&Penetration, DVec3) -> Option<T>,
) -> Option<T> {
    if is_apart_from_hull(ball, body) {
        return None;
    }
    dispatch!(simd => {
        let pair = BallAndBody::new(simd, ball, body)?;
        found(&pair.penetration()?, pair.own_normal())
    })
}

/// The same of any sizes, of a body and a ball mirrored. The placements must have been checked.
pub(super) fn depth_of_ball(a: Placed, b: Placed) -> Option<DepthOfBall> {
    if is_apart_from_hull(a, b) {
        return None;
    }
    of_ball(a, b, |pair| Some(DepthOfBall { found: pair.penetration()?, own_normal: pair.own_normal() }))
}

/// How deep a ball and a body are in each other.
pub(super) struct DepthOfBall {
    pub found: Penetration,
    /// The outward normal of the body in its own directions where that is nearest.
    pub own_normal: DVec3,
}

impl Mirror for DepthOfBall {
    fn mirrored(self) -> Self {
        DepthOfBall { found: self.found.mirrored(), ..self }
    }
}

/// Whether a ball and a hull clearly are apart: then no search is worth it that would find how far.
fn is_apart_from_hull(a: Placed, b: Placed) -> bool {
    let of_hull = a.shape.polytope().is_some() | b.shape.polytope().is_some();
    of_hull && dispatch!(simd => glance(simd, a, b)) == Glance::Sure(false)
}

/// Whether both are balls or capsules.
pub(super) fn are_round(a: Placed, b: Placed) -> bool {
    [a, b].iter().all(|of| matches!(of.shape.kind(), ShapeKind::Sphere | ShapeKind::Capsule))
}

/// What `found` makes of when two balls first meet, as [`cast`](cast::cast) says it, in one kernel; `otherwise` where that says nothing.
#[inline(always)]
pub(crate) fn by_cast<T>(
    a: Placed,
    motion: DVec3,
    b: Placed,
    found: impl Fn(Option<Impact>) -> T,
    otherwise: impl Fn() -> T,
) -> T {
    if a.shape.ball_radius().is_none() || b.shape.ball_radius().is_none() {
        return otherwise();
    }
    dispatch!(simd => match cast(simd, a, motion, b) {
        Some(impact) => found(impact),
        None => otherwise(),
    })
}

/// Whether they intersect, with the evidence; `None` where GJK has to say.
pub(super) fn intersection(a: Placed, b: Placed) -> Option<Relation> {
    of_simple(a, b).or_else(|| of_ball(a, b, |pair| pair.relation()))
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
    let of_simple = || quickly_closest(a, b).or_else(|| in_unit(a, b, quickly_closest));
    let found = if are_simple(a, b) { of_simple() } else { None };
    found.or_else(|| of_ball(a, b, |pair| pair.closest()))
}

/// What [`closest`] says of sizes that are plain. Placements need not have been checked: those of an answer are good.
pub(crate) fn quickly_closest(a: Placed, b: Placed) -> Option<Closest> {
    by_quickly_closest(a, b, |closest| Some(*closest), || None)
}

/// What `found` makes of that, in one kernel with it, so that it is written once, where the caller has it; `otherwise` where nothing is said.
#[inline(always)]
pub(crate) fn by_quickly_closest<T>(
    a: Placed,
    b: Placed,
    found: impl Fn(&Closest) -> T,
    otherwise: impl Fn() -> T,
) -> T {
    if are_simple(a, b) {
        return dispatch!(simd => match quick::closest(simd, a, b) {
            Some(closest) => found(&closest),
            None => otherwise(),
        });
    }
    let order = if a.shape.is_ball() || b.shape.is_ball() { ball_is_first(a, b) } else { None };
    let Some(in_order) = order else { return otherwise() };
    let (ball, body) = if in_order { (a, b) } else { (b, a) };
    dispatch!(simd => match BallAndBody::quickly_closest(simd, ball, body) {
        Some(closest) => found(&if in_order { closest } else { closest.mirrored() }),
        None => otherwise(),
    })
}

/// What is found in a unit of length near the size of the data, so that answers do not depend on the unit.
#[inline(never)]
fn in_unit<T: Lengths>(a: Placed, b: Placed, find: impl Fn(Placed, Placed) -> Option<T>) -> Option<T> {
    let [reach_a, reach_b] = [reach(a)?, reach(b)?];
    let offset = b.placement.translation - a.placement.translation;
    let scale = unit_scale(reach_a + reach_b + offset.abs().element_sum());
    let at_a = DAffine3 { matrix3: a.placement.matrix3 * scale, translation: DVec3::ZERO };
    let at_b = DAffine3 { matrix3: b.placement.matrix3 * scale, translation: offset * scale };
    let found = find(Placed { placement: &at_a, ..a }, Placed { placement: &at_b, ..b })?;
    Some(found.divided(scale))
}

/// How far a shape reaches from its origin, or a bound on that; `None` for a hull or a complex shape, and for what its placement does not leave what it is.
fn reach(placed: Placed) -> Option<f64> {
    let radius = placed.shape.ball_radius().or_else(|| foot::extent(&placed.shape.body()?))?;
    Some(radius * Similarity::new(&placed.placement.matrix3)?.stretch)
}

/// What has lengths of the world.
trait Lengths {
    /// The same with all of these divided.
    fn divided(self, by: f64) -> Self;
}

impl Lengths for bool {
    fn divided(self, _: f64) -> Self {
        self
    }
}

impl Lengths for Relation {
    fn divided(self, _: f64) -> Self {
        self
    }
}

impl Lengths for Closest {
    fn divided(self, by: f64) -> Self {
        Closest { distance: self.distance / by, ..self }
    }
}

impl Lengths for DepthOfBall {
    fn divided(self, by: f64) -> Self {
        DepthOfBall { found: self.found.divided(by), ..self }
    }
}

impl Lengths for Penetration {
    fn divided(self, by: f64) -> Self {
        let [depth, lower, upper] = [self.depth, self.lower, self.upper].map(|length| length / by);
        Penetration { depth, lower, upper, ..self }
    }
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
