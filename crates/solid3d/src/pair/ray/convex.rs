//! A ray against a convex shape.

use glam::{DAffine3, DVec3};
use solid_convex::{Line, Support, gjk};

use super::super::reach::image_reach;
use super::super::{POINT, Placed};
use super::{Faces, Hits, SurfaceHit, Wanted, world_normal};
use crate::placement::inverse_linear;

/// Where a ray meets a surface from outside or inside, and a vector that tells the outward normal there.
type End = (f64, DVec3);

pub(super) fn hits(placed: Placed, shape: &dyn Support, hits: &mut Hits) {
    let DAffine3 { matrix3, translation } = placed.placement;
    let to_local_linear = inverse_linear(matrix3);
    let origin = to_local_linear * (hits.ray.origin - *translation);
    let direction = to_local_linear * hits.ray.direction;
    let Some(chord) = Line::new(origin, direction).and_then(|line| placed.shape.chord(&line)) else {
        return hull_hits(shape, placed.placement, 0, hits);
    };
    let Some(chord) = chord else { return };
    let end = |end: solid_convex::End| (end.t, end.normal);
    let (enter, leave) = (end(chord.enter), end(chord.leave));
    if enter.0 <= 0.0 && leave.0 >= 0.0 {
        hits.add_inside();
    }
    // A normal of a flattened apex may vanish; then the way of the ray will do.
    let way = hits.ray.direction;
    let placed = |local| world_normal(&to_local_linear, local).unwrap_or_else(|| way.normalize_or_zero());
    report(hits, 0, Some(enter), || Some(leave), placed);
}

/// A ray against the hull of points, or any other support mapping: casts of a point from either end.
pub(super) fn hull_hits(shape: &dyn Support, at: &DAffine3, primitive: u32, hits: &mut Hits) {
    let ray = *hits.ray;
    let cast = |from: DVec3, direction: DVec3, until: f64| {
        gjk::cast(&*POINT, &DAffine3::from_translation(from), direction, shape, at, until)
    };
    let Some(impact) = cast(ray.origin, ray.direction, hits.until.max(0.0)) else { return };
    let enter = impact.normal.map(|normal| (impact.time, normal));
    if enter.is_none() {
        hits.add_inside();
    }
    let leave = || {
        // From a place that is surely beyond the shape.
        let extent = image_reach(&at.matrix3, shape.reach()).max_element();
        let away = (at.translation - ray.origin).abs().max_element() + extent;
        let beyond = 4.0 * away / ray.direction.abs().max_element();
        let impact = cast(ray.at(beyond), -ray.direction, f64::INFINITY)?;
        Some((beyond - impact.time, impact.normal?))
    };
    report(hits, primitive, enter, leave, |normal| normal);
}

/// Reports where a ray comes into a convex shape, and where it leaves it, as far as that is wanted; `placed` makes outward unit normals of the
/// world of what the ends tell.
fn report(
    hits: &mut Hits,
    primitive: u32,
    enter: Option<End>,
    leave: impl FnOnce() -> Option<End>,
    placed: impl Fn(DVec3) -> DVec3,
) {
    let faces = hits.options.faces;
    let add = |hits: &mut Hits, end: Option<End>, back: bool| {
        let end = end.filter(|&(t, _)| hits.options.faces.includes(back) && hits.wants(t, primitive));
        if let Some((t, normal)) = end {
            let normal = if back { -placed(normal) } else { placed(normal) };
            hits.add(t, Some(SurfaceHit { normal, back, primitive, barycentric: None }));
        }
        end.is_some()
    };
    let entered = add(hits, enter, false);
    // A ray leaves later than it enters, also what is so thin that rounding would turn that round.
    if faces != Faces::Front && hits.until >= 0.0 && (!entered || hits.wanted == Wanted::All) {
        let least = enter.map_or(f64::NEG_INFINITY, |(t, _)| t);
        add(hits, leave().map(|(t, normal)| (t.max(least), normal)), true);
    }
}
