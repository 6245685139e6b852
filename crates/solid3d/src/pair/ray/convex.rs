//! A ray against a convex shape.

use fearless_simd::Simd;
use glam::{DAffine3, DVec3};
use solid_convex::simd::dispatch;
use solid_convex::similarity::plain_square;
use solid_convex::{Chord, Line, Support, gjk, unit_scale};

use super::super::closed_form::{to_body, to_world};
use super::super::reach::{image_reach, world_bounds};
use super::super::{POINT, Placed};
use super::{Faces, FromInside, Hits, Ray, RayHit, RayOptions, SurfaceHit, Wanted, facing, world_normal};
use crate::bounds::Aabb;
use crate::error::Result;
use crate::placement::{direction, inverse_linear};
use crate::shape::{Class, Shape};
use crate::tree::entry;

/// Where a ray meets a surface from outside or inside, and a vector that tells the outward normal there.
type End = (f64, DVec3);

/// What a placement leaves what it is, as a ray sees it.
struct Similar<'a> {
    at: &'a DAffine3,
    /// The square of the scale.
    square: f64,
    /// The power of two by which the linear part of the placement was multiplied.
    unit: f64,
}

impl<'a> Similar<'a> {
    /// `None` for what is not a rotation with a uniform scale of a plain size: of a good placement then.
    #[inline(always)]
    fn new<S: Simd>(simd: S, at: &'a DAffine3) -> Option<Self> {
        Some(Similar { at, square: plain_square(simd, at)?, unit: 1.0 })
    }

    #[inline(always)]
    fn chord(&self, shape: &Shape, ray: &Ray) -> Option<Option<Chord>> {
        let inverse = self.unit / self.square;
        let to_local = |v: DVec3| to_body(&self.at.matrix3, v) * inverse;
        chord(shape, to_local(ray.origin - self.at.translation), to_local(ray.direction))
    }

    /// The world's unit normal, by that in local space; of one that vanishes the way of the ray. What is seen from so far that its digits are few may tell one that
    /// is not of length one.
    #[inline(always)]
    fn normal(&self, local: DVec3, way: DVec3) -> DVec3 {
        direction(to_world(&self.at.matrix3, local)).unwrap_or_else(|| way.normalize_or_zero())
    }
}

/// The part of a ray's line in a convex shape, in whose space the ray is given; `None` where there is no closed form, or where that does not tell.
#[inline(always)]
fn chord(shape: &Shape, origin: DVec3, way: DVec3) -> Option<Option<Chord>> {
    shape.chord(&Line::new(origin, way)?)
}

/// The first hit of a ray on a body that has a closed form, and that its placement leaves what it is, which need not have been checked: that of an answer is good.
/// Of others what `otherwise` says.
pub(crate) fn first_hit(
    body: Placed,
    ray: &Ray,
    options: &RayOptions,
    otherwise: impl Fn() -> Result<Option<RayHit>>,
) -> Result<Option<RayHit>> {
    if let Class::Complex(_) = body.shape.class() {
        return otherwise();
    }
    // What is given back is written once, where the caller has it.
    dispatch!(simd => {
        let Some(similar) = Similar::new(simd, body.placement) else { return otherwise() };
        let Some(chord) = similar.chord(body.shape, ray) else { return otherwise() };
        let Some(Chord { enter, leave }) = chord else { return Ok(None) };
        if options.from_inside == FromInside::Hits && enter.t <= 0.0 && leave.t >= 0.0 {
            return Ok(Some(RayHit { t: 0.0, point: ray.origin, surface: None }));
        }
        let counts = |t: f64, back: bool| options.faces.includes(back) && (0.0..=ray.max).contains(&t);
        let (t, normal, back) = if counts(enter.t, false) {
            (enter.t, enter.normal, false)
        } else if counts(leave.t.max(enter.t), true) {
            // As [`report`] has it.
            (leave.t.max(enter.t), leave.normal, true)
        } else {
            return Ok(None);
        };
        let normal = facing(similar.normal(normal, ray.direction), back);
        let surface = SurfaceHit { normal, back, primitive: 0, barycentric: None };
        Ok(Some(RayHit::on(ray, t, Some(surface))))
    })
}

/// All hits that are wanted on a convex shape.
pub(super) fn hits(placed: Placed, shape: &dyn Support, hits: &mut Hits) {
    let (at, ray) = (placed.placement, hits.ray);
    // Of any size: scaling by a power of two changes no bit.
    let unit = unit_scale(at.matrix3.x_axis.abs().max_element());
    let of_plain_size = DAffine3 { matrix3: at.matrix3 * unit, translation: at.translation };
    let told = if let Some(similar) = dispatch!(simd => Similar::new(simd, &of_plain_size)) {
        let similar = Similar { unit, ..similar };
        chord_hits(similar.chord(placed.shape, ray), hits, |local| similar.normal(local, ray.direction))
    } else {
        let to_local = inverse_linear(&at.matrix3);
        let origin = to_local * (ray.origin - at.translation);
        // A normal of a flattened apex may vanish; then the way of the ray will do.
        chord_hits(chord(placed.shape, origin, to_local * ray.direction), hits, |local| {
            world_normal(&to_local, local).unwrap_or_else(|| ray.direction.normalize_or_zero())
        })
    };
    if !told {
        hull_hits(shape, at, 0, || into_world_box(placed, ray), hits);
    }
}

/// The same by the chord, if that is known: whether it is.
fn chord_hits(chord: Option<Option<Chord>>, hits: &mut Hits, placed: impl Fn(DVec3) -> DVec3) -> bool {
    if let Some(Some(Chord { enter, leave })) = chord {
        if enter.t <= 0.0 && leave.t >= 0.0 {
            hits.add_inside();
        }
        report(hits, 0, Some((enter.t, enter.normal)), || Some((leave.t, leave.normal)), placed);
    }
    chord.is_some()
}

/// When a ray comes into the box around a placed shape: no hit is before, for what looks at boxes first.
pub(super) fn into_world_box(placed: Placed, ray: &Ray) -> f64 {
    into_box(&world_bounds(placed), ray.origin, ray.direction)
}

/// When a ray comes into a box; 0 where it passes by.
pub(super) fn into_box(bounds: &Aabb, origin: DVec3, direction: DVec3) -> f64 {
    entry(origin - bounds.center(), direction, bounds.half_extents()).unwrap_or(0.0)
}

/// A ray against the hull of points, or any other support mapping: casts of a point from either end. A cast may be early; no hit is before `earliest`.
pub(super) fn hull_hits(
    shape: &dyn Support,
    at: &DAffine3,
    primitive: u32,
    earliest: impl FnOnce() -> f64,
    hits: &mut Hits,
) {
    let ray = *hits.ray;
    let cast = |from: DVec3, direction: DVec3, until: f64| {
        gjk::cast(&*POINT, &DAffine3::from_translation(from), direction, shape, at, until)
    };
    let Some(impact) = cast(ray.origin, ray.direction, hits.until.max(0.0)) else { return };
    let enter = impact.normal.map(|normal| (impact.time.max(earliest()), normal));
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
    let entered = add(hits, primitive, enter, false, &placed);
    // A ray leaves later than it enters, also what is so thin that rounding would turn that round.
    if hits.options.faces != Faces::Front && hits.until >= 0.0 && (!entered || hits.wanted == Wanted::All) {
        let least = enter.map_or(f64::NEG_INFINITY, |(t, _)| t);
        let leave = leave().map(|(t, normal)| (t.max(least), normal));
        add(hits, primitive, leave, true, &placed);
    }
}

/// Adds an end, if it is wanted.
fn add(
    hits: &mut Hits,
    primitive: u32,
    end: Option<End>,
    back: bool,
    placed: &impl Fn(DVec3) -> DVec3,
) -> bool {
    let Some((t, normal)) = end else { return false };
    let is_wanted = hits.options.faces.includes(back) && hits.wants(t, primitive);
    if is_wanted {
        let normal = facing(placed(normal), back);
        hits.add(t, Some(SurfaceHit { normal, back, primitive, barycentric: None }));
    }
    is_wanted
}
