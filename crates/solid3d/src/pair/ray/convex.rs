//! A ray against a convex shape.

use glam::{DAffine3, DVec3};
use solid_convex::{Line, Points, Support, gjk};

use super::super::reach::image_reach;
use super::super::{Placed, to_local};
use super::{Faces, Hits, SurfaceHit, Wanted, world_normal};
use crate::placement::inverse_linear;

/// Where a ray meets a surface from outside or inside, and the outward unit normal there. Space: world.
type End = (f64, DVec3);

pub(super) fn hits(placed: Placed, shape: &dyn Support, hits: &mut Hits) {
    let to_local_linear = inverse_linear(&placed.placement.matrix3);
    let (origin, direction) = (to_local(placed, hits.ray.origin), to_local_linear * hits.ray.direction);
    let Some(chord) = Line::new(origin, direction).and_then(|line| placed.shape.chord(&line)) else {
        return hull_hits(shape, placed.placement, 0, hits);
    };
    let Some(chord) = chord else { return };
    let end = |end: solid_convex::End| {
        // A normal of a flattened apex may vanish; then the way of the ray will do.
        let normal = world_normal(&to_local_linear, end.normal);
        (end.t, normal.unwrap_or_else(|| hits.ray.direction.normalize_or_zero()))
    };
    let (enter, leave) = (end(chord.enter), end(chord.leave));
    if enter.0 <= 0.0 && leave.0 >= 0.0 {
        hits.add_inside();
    }
    report(hits, 0, Some(enter), || Some(leave));
}

/// A ray against the hull of points, or any other support mapping: casts of a point from either end.
pub(super) fn hull_hits(shape: &dyn Support, at: &DAffine3, primitive: u32, hits: &mut Hits) {
    let point = Points::new(&[DVec3::ZERO]).expect("it has a point");
    let ray = *hits.ray;
    let cast = |from: DVec3, direction: DVec3, until: f64| {
        gjk::cast(&point, &DAffine3::from_translation(from), direction, shape, at, until)
    };
    let Some(impact) = cast(ray.origin, ray.direction, hits.until.max(0.0)) else { return };
    let enter = impact.normal.map(|normal| (impact.time, normal));
    if enter.is_none() {
        hits.add_inside();
    }
    report(hits, primitive, enter, || {
        // From a place that is surely beyond the shape.
        let extent = image_reach(&at.matrix3, shape.reach()).max_element();
        let away = (at.translation - ray.origin).abs().max_element() + extent;
        let beyond = 4.0 * away / ray.direction.abs().max_element();
        let impact = cast(ray.at(beyond), -ray.direction, f64::INFINITY)?;
        Some((beyond - impact.time, impact.normal?))
    });
}

/// Reports where a ray comes into a convex shape, and where it leaves it, as far as that is wanted.
fn report(hits: &mut Hits, primitive: u32, enter: Option<End>, leave: impl FnOnce() -> Option<End>) {
    let faces = hits.options.faces;
    let add = |hits: &mut Hits, end: Option<End>, back: bool| {
        let end = end.filter(|&(t, _)| hits.options.faces.includes(back) && hits.wants(t, primitive));
        if let Some((t, normal)) = end {
            let normal = if back { -normal } else { normal };
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
