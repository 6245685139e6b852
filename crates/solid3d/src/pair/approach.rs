//! How two shapes that collide came together: smart response (thesis, sections 2.3 and 6.2).
//!
//! The primitives that meet now are looked at as they were in the previous frame: the pair that was nearest, or, when some met
//! there already, the pair that was deepest. Deviation from SOLID 2.0, which takes the first pair found, and has no normal for
//! shapes that met already.

use std::ops::ControlFlow;

use glam::DVec3;
use solid_convex::{Closest, Penetration, Support, Witness, gjk, unit_scale};

use super::depth::{of_common, of_deepest};
use super::table::{PlacedConvex, axis, closest, closest_within, penetration};
use super::{Placed, Scratch, meeting_primitives};
use crate::shape::Class;

/// How two shapes came together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Approach {
    /// Their closest points in the previous frame, or the point of each that was deepest in the other.
    pub points: Witness,
    /// The distance of the points; negative when they are the deepest.
    pub distance: f64,
    /// The unit vector along which `A` was off `B`, or would have had to leave it. Space: world.
    pub normal: DVec3,
}

/// How two shapes that meet now, or did on the way, came together since the previous frame.
pub(crate) fn approach(now: [Placed; 2], before: [Placed; 2], scratch: &mut Scratch) -> Approach {
    let pairs = pairs_to_look_at(now, before, scratch);
    // In a solid, what is apart from its surface is deep.
    let found = match before.iter().any(is_solid) {
        false => of_surfaces(before, &pairs, scratch),
        true => nearest(before, &pairs)
            .filter(|(found, _)| {
                found.distance > 0.0 && closest(before[0], before[1], scratch).distance > 0.0
            })
            .map(|(found, _)| apart(before, found)),
    };
    scratch.meeting = pairs;
    found.unwrap_or_else(|| as_they_are(before, scratch))
}

/// The deepest of some pairs of primitives, or the nearest where none meet; `None` when there are none.
fn of_surfaces(before: [Placed; 2], pairs: &[[u32; 2]], scratch: &mut Scratch) -> Option<Approach> {
    if pairs.is_empty() {
        return None;
    }
    let is_among = |pair| pairs.binary_search(&pair).is_ok();
    if let Some((_, deepest)) = of_deepest(before, is_among, scratch) {
        return Some(deep(deepest));
    }
    let (found, pair) = nearest(before, pairs)?;
    Some(match found.distance > 0.0 {
        true => apart(before, found),
        // Only rounding keeps them apart.
        false => deep(with_primitives(before, pair, of_common)),
    })
}

/// The nearest of some pairs of primitives, or one that meets, which the others are not looked at after.
fn nearest(before: [Placed; 2], pairs: &[[u32; 2]]) -> Option<(Closest, [u32; 2])> {
    let mut nearest: Option<(Closest, [u32; 2])> = None;
    for &pair in pairs {
        let found = with_primitives(before, pair, closest_points);
        if nearest.is_none_or(|(least, _)| found.distance < least.distance) {
            nearest = Some((found, pair));
        }
        if found.distance == 0.0 {
            break;
        }
    }
    nearest
}

/// How near two shapes are to each other as they are, or how deep they are in each other; `None` when they are further apart than a bound.
pub(crate) fn proximity(a: Placed, b: Placed, bound: f64, scratch: &mut Scratch) -> Option<Approach> {
    closest_within(a, b, bound, scratch).map(|closest| of_closest([a, b], closest, scratch))
}

/// The pairs of primitives that meet now, those of the previous frame, in ascending order. None when the whole shapes are to be looked at: they
/// are convex, one is another than in the previous frame, one contains the other, or they met on the way.
fn pairs_to_look_at(now: [Placed; 2], before: [Placed; 2], scratch: &mut Scratch) -> Vec<[u32; 2]> {
    let mut pairs = std::mem::take(&mut scratch.meeting);
    pairs.clear();
    let convex = now.iter().all(|placed| matches!(placed.shape.class(), Class::Convex(_)));
    let same = || now.iter().zip(before).all(|(now, before)| now.shape.has_primitives_of(before.shape));
    if !convex && same() {
        let _ = meeting_primitives(now[0], now[1], scratch, &mut |i, j| {
            pairs.push([before[0].shape.whole(i), before[1].shape.whole(j)]);
            ControlFlow::Continue(())
        });
        pairs.sort_unstable();
        pairs.dedup();
    }
    pairs
}

/// The same without a bound.
fn as_they_are([a, b]: [Placed; 2], scratch: &mut Scratch) -> Approach {
    let closest = closest(a, b, scratch);
    of_closest([a, b], closest, scratch)
}

/// How deep two shapes are in each other; of shapes that are apart, or hardly touch, the closest points with distance 0.
pub(crate) fn overlap(a: Placed, b: Placed, scratch: &mut Scratch) -> Approach {
    match penetration(a, b, scratch) {
        Some(found) => deep(found),
        None => Approach { distance: 0.0, ..as_they_are([a, b], scratch) },
    }
}

/// The closest points of the whole shapes, or the deepest.
fn of_closest([a, b]: [Placed; 2], closest: Closest, scratch: &mut Scratch) -> Approach {
    if closest.distance > 0.0 {
        return apart([a, b], closest);
    }
    if let Some(found) = penetration(a, b, scratch) {
        return deep(found);
    }
    // Apart by less than the error of the distance.
    let normal = axis(a, b, scratch).unwrap_or(DVec3::X);
    Approach { points: closest.points, distance: 0.0, normal }
}

fn apart([a, b]: [Placed; 2], Closest { distance, points }: Closest) -> Approach {
    // Far from the world's origin, the difference of world positions would be coarser.
    let offset = a.placement.translation - b.placement.translation;
    let of_linear = a.placement.matrix3 * points.on_a - b.placement.matrix3 * points.on_b;
    let v = of_linear + offset;
    let unit = v * unit_scale(v.abs().max_element());
    // Points that are nowhere apart but in the digits of the distance have their direction from the shapes.
    let normal = unit.try_normalize().unwrap_or(DVec3::X);
    Approach { points, distance, normal }
}

fn deep(Penetration { depth, direction, points, .. }: Penetration) -> Approach {
    Approach { points, distance: -depth, normal: direction }
}

fn closest_points(a: PlacedConvex, b: PlacedConvex) -> Closest {
    gjk::closest_points(a.0, a.1, b.0, b.1)
}

/// Whether it is a mesh that has an inside.
pub(super) fn is_solid(placed: &Placed) -> bool {
    matches!(placed.shape.class(), Class::Complex(complex) if complex.is_solid())
}

/// Calls a function with a primitive of each shape; a convex shape is its only one.
pub(super) fn with_primitives<T>(
    [a, b]: [Placed; 2],
    [i, j]: [u32; 2],
    ask: impl FnOnce(PlacedConvex, PlacedConvex) -> T,
) -> T {
    let (of_a, of_b);
    let on_a: &dyn Support = match a.shape.class() {
        Class::Convex(convex) => convex,
        Class::Complex(complex) => {
            of_a = complex.whole_hull(i);
            &of_a
        }
    };
    let on_b: &dyn Support = match b.shape.class() {
        Class::Convex(convex) => convex,
        Class::Complex(complex) => {
            of_b = complex.whole_hull(j);
            &of_b
        }
    };
    ask((on_a, a.placement), (on_b, b.placement))
}
