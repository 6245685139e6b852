//! Rays against a placed shape.

use glam::DAffine3;

use super::{Ray, RayHit, RayOptions, placed, unchecked};
use crate::error::Result;
use crate::pair::{self, Hits, Scratch, Wanted};
use crate::shape::Shape;

/// Where a ray or segment first meets a placed shape; `None` when it does not.
///
/// - Every kind of shape, under any affine placement. By default the answer is `None` if and only if the ray has no point of
///   the shape; see [`RayOptions`] for back faces, and for rays that start inside of a solid.
/// - `t` is in units of the direction. The normal is on the side that the ray comes from, right under non-uniform scale and shear.
/// - Meshes are watertight: no ray slips between triangles that share an edge or a corner. Where several triangles are hit at the
///   same `t`, the first in their order is reported. A triangle that is seen exactly edge on is hit at its first point.
/// - The error of the point is some 1e-14 of the size of the data (the shape's extent and the distance of the ray's
///   origin); for convex hulls of more than 384 faces, and next to edges of others, it is up to [`CAST_ERROR`](solid_convex::gjk::CAST_ERROR) of the
///   shape's extent more, never late.
///   A ray that touches a triangle or a convex shape with an end, or passes by an outer edge, closer than by that error may miss it; so may one that
///   starts at a triangle of a solid mesh and goes out. One that goes in does not: it hits there, or starts inside.
/// - What starts on a surface hits it. A ray that goes on from a hit, as a reflection or towards a light, starts off it, at `point + skin * normal`, with a
///   skin of some 1e-9 of the size.
///
/// A ray with a coordinate that is not finite or beyond 1e100, without a direction, or with a `max` that is negative or not a number
/// is an [`Error`](crate::Error). Cost: a constant for convex shapes, about log n for meshes.
///
/// ```
/// use solid3d::{Shape, glam::{DAffine3, DVec3}, query::{self, Ray, RayOptions}};
/// let sheet = [DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::new(0.0, 1.0, 1.0)];
/// let slope = Shape::mesh(sheet, [[0, 1, 2], [0, 2, 3]])?;
/// let ray = Ray::new(DVec3::new(0.25, 0.5, 3.0), DVec3::NEG_Z);
/// let hit = query::cast_ray(&slope, &DAffine3::IDENTITY, &ray, &RayOptions::default())?.unwrap();
/// assert_eq!((hit.t, hit.point), (2.5, DVec3::new(0.25, 0.5, 0.5)));
/// let surface = hit.surface.unwrap();
/// assert_eq!((surface.primitive, surface.back), (1, false));
/// assert_eq!(surface.barycentric, Some([0.5, 0.25, 0.25]));
/// assert!((surface.normal - DVec3::new(0.0, -1.0, 1.0).normalize()).length() < 1e-15);
///
/// let nowhere = Ray::new(DVec3::ZERO, DVec3::ZERO);
/// let error = query::cast_ray(&slope, &DAffine3::IDENTITY, &nowhere, &RayOptions::default()).unwrap_err();
/// assert!(error.to_string().starts_with("ray.direction is (0.0, 0.0, 0.0)"));
/// # Ok::<(), solid3d::Error>(())
/// ```
pub fn cast_ray(
    shape: &Shape,
    placement: &DAffine3,
    ray: &Ray,
    options: &RayOptions,
) -> Result<Option<RayHit>> {
    let at_length = || first_at_length(shape, placement, ray, options);
    pair::first_hit(unchecked(shape, placement), ray.checked()?, options, at_length)
}

/// The same, of whatever has no closed form.
#[inline(never)]
fn first_at_length(
    shape: &Shape,
    placement: &DAffine3,
    ray: &Ray,
    options: &RayOptions,
) -> Result<Option<RayHit>> {
    Ok(cast(shape, placement, ray, options, Wanted::First)?.found)
}

/// All places where a ray or segment meets the surface of a placed shape, in the order of `t`, then of primitives. Where it
/// passes through an edge or a corner of a mesh, each triangle there is one. A
/// [simple polygon](crate::ComplexShapeBuilder::simple_polygon) is hit once, as it is flat.
///
/// Of a ray that starts inside of a solid the first has no surface, unless [`RayOptions`] says otherwise. See
/// [`cast_ray`].
///
/// ```
/// use solid3d::{Shape, glam::{DAffine3, DVec3}, query::{self, Ray, RayOptions}};
/// let cone = Shape::cone(1.0, 2.0)?;
/// let ray = Ray::new(DVec3::new(-2.0, 0.0, 0.0), DVec3::X);
/// let hits = query::cast_ray_all(&cone, &DAffine3::IDENTITY, &ray, &RayOptions::default())?;
/// assert_eq!(hits.iter().map(|hit| hit.t).collect::<Vec<_>>(), [1.5, 2.5]);
/// assert!(!hits[0].surface.unwrap().back && hits[1].surface.unwrap().back);
/// # Ok::<(), solid3d::Error>(())
/// ```
pub fn cast_ray_all(
    shape: &Shape,
    placement: &DAffine3,
    ray: &Ray,
    options: &RayOptions,
) -> Result<Vec<RayHit>> {
    Ok(cast(shape, placement, ray, options, Wanted::All)?.sorted())
}

/// Whether a ray or segment meets a placed shape: as [`cast_ray`], but it ends with the first hit that it finds.
///
/// ```
/// use solid3d::{Shape, glam::{DAffine3, DVec3}, query::{self, Ray, RayOptions}};
/// let (block, here) = (Shape::cuboid([2.0, 2.0, 2.0])?, DAffine3::IDENTITY);
/// let view = Ray::segment(DVec3::X * -3.0, DVec3::X * 3.0);
/// assert!(query::ray_meets(&block, &here, &view, &RayOptions::default())?);
/// assert!(!query::ray_meets(&block, &here, &view.until(0.3), &RayOptions::default())?);
/// # Ok::<(), solid3d::Error>(())
/// ```
pub fn ray_meets(shape: &Shape, placement: &DAffine3, ray: &Ray, options: &RayOptions) -> Result<bool> {
    Ok(cast(shape, placement, ray, options, Wanted::Any)?.found.is_some())
}

#[inline(always)]
fn cast<'r>(
    shape: &Shape,
    placement: &DAffine3,
    ray: &'r Ray,
    options: &'r RayOptions,
    wanted: Wanted,
) -> Result<Hits<'r>> {
    let mut hits = Hits::new(ray.checked()?, options, wanted);
    let placed = placed("placement", shape, placement)?;
    Scratch::with(|scratch| pair::ray_hits(placed, &mut hits, scratch));
    Ok(hits)
}
