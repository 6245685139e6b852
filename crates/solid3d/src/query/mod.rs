//! Questions about two placed shapes, without a world.
//!
//! Every pair of kinds, through the same algorithm table that a [`World`](crate::World) uses. Placements are affine maps from
//! local space to the world: rotation, translation, scale, non-uniform scale, shear, mirroring. A placement that is not
//! finite or is singular is an [`Error`](crate::Error).
//!
//! **How exact.** Relative to the size of the data (the sum of the two shapes' extents and of the distance between
//! their local origins), answers are right beyond 1e-12, at any size: scaling everything by a power of two changes no
//! answer. Within it, shapes may count as touching, and touching shapes intersect. Of shapes for which [`intersects`] is true the
//! [`distance`](distance()) is 0, always; it may also be 0 for some that it keeps apart. Which of two convex shapes is the first changes no
//! answer but the last digits of numbers; of meshes it may, where they touch up to the rounding of positions. See
//! [`TOUCHING_ERROR`](solid_convex::gjk::TOUCHING_ERROR).

mod cast;
mod contacts;
mod distance;
mod impact;
mod pair_cache;
mod penetration;
mod point;
mod ray;
mod surface;

use std::ops::ControlFlow;

use glam::{DAffine3, DVec3};
use solid_convex::Closest;
use solid_convex::gjk::{self, ClosestInWorld, Glance};
use solid_convex::simd::dispatch;

use crate::bounds::Aabb;
use crate::error::Result;
use crate::pair::{self, Placed, Relation, Scratch};
pub use crate::pair::{ClosestPoint, SignedDistance};
pub use crate::pair::{ContactOptions, ContactPoint, Feature, Manifold};
pub use crate::pair::{Faces, FromInside, Ray, RayHit, RayOptions, SurfaceHit};
pub use crate::pair::{IntersectionCurve, Path, Polyline, PrimitivePair, Segment};
use crate::placement;
use crate::shape::Shape;
pub(crate) use cast::cast_of;
pub use cast::{ShapeCast, cast_shape};
pub use contacts::contacts;
pub use distance::distance_within;
pub(crate) use impact::impact_of;
pub use impact::{Impact, ImpactOptions, time_of_impact, time_of_impact_deforming};
pub use pair_cache::PairCache;
pub use penetration::{Penetration, penetration};
pub use point::{closest_point, contains_point, winding_number};
pub use ray::{cast_ray, cast_ray_all, ray_meets};
pub use surface::signed_distance;

/// The distance of two placed shapes, with their closest points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// The distance, at least 0; 0 when they intersect or touch. World units.
    pub distance: f64,
    /// The closest point of the first shape. Space: world.
    pub point_on_a: DVec3,
    /// The closest point of the second shape. Space: world. The same point up to rounding when the distance is 0.
    pub point_on_b: DVec3,
}

/// Whether two placed shapes have a point in common.
///
/// ```
/// use solid3d::{Shape, query, glam::{DAffine3, DVec3}};
/// let (ball, block) = (Shape::sphere(1.0)?, Shape::cuboid([1.0, 1.0, 1.0])?);
/// let at = |x: f64| DAffine3::from_translation(DVec3::new(x, 0.0, 0.0));
/// assert!(query::intersects(&ball, &at(0.0), &block, &at(1.5))?); // they touch
/// assert!(!query::intersects(&ball, &at(0.0), &block, &at(1.500001))?);
/// # Ok::<(), solid3d::Error>(())
/// ```
pub fn intersects(a: &Shape, placement_a: &DAffine3, b: &Shape, placement_b: &DAffine3) -> Result<bool> {
    let pair = [unchecked(a, placement_a), unchecked(b, placement_b)];
    dispatch!(move simd => match pair::glance(simd, pair[0], pair[1]) {
        Glance::Sure(answer) => Ok(answer),
        seen => intersects_at_length(&pair, seen),
    })
}

/// What [`intersects`] says where a glance does not tell. The pair is not taken apart for the call, which few reach.
#[inline(never)]
fn intersects_at_length(&[a, b]: &[Placed; 2], seen: Glance) -> Result<bool> {
    if seen == Glance::Open {
        return Ok(pair::intersects_closely(a, b));
    }
    let (a, b) = (placed("placement_a", a.shape, a.placement)?, placed("placement_b", b.shape, b.placement)?);
    let answer = pair::convex_intersects(a, b);
    Ok(answer.unwrap_or_else(|| Scratch::with(|scratch| pair::intersects_by_class(a, b, scratch))))
}

/// A point that two placed shapes have in common, in the world; `None` when they do not intersect.
///
/// Which of the common points is unspecified, but the same for the same input.
///
/// ```
/// use solid3d::{Shape, query, glam::{DAffine3, DVec3}};
/// let block = Shape::cuboid([2.0, 2.0, 2.0])?;
/// let corner = DAffine3::from_translation(DVec3::splat(2.0));
/// let point = query::common_point(&block, &DAffine3::IDENTITY, &block, &corner)?;
/// assert_eq!(point, Some(DVec3::ONE)); // where the corners meet
/// # Ok::<(), solid3d::Error>(())
/// ```
pub fn common_point(
    a: &Shape,
    placement_a: &DAffine3,
    b: &Shape,
    placement_b: &DAffine3,
) -> Result<Option<DVec3>> {
    let (a, b) = (placed("placement_a", a, placement_a)?, placed("placement_b", b, placement_b)?);
    Ok(match Scratch::with(|scratch| pair::intersection(a, b, scratch)) {
        Relation::Common(witness) => Some(pair::midpoint(a, b, &witness)),
        Relation::Separated { .. } => None,
    })
}

/// Calls `found` with every pair of primitives of two placed shapes that meet, by their numbers in `a` and `b`, until it
/// breaks off. The order is unspecified, but the same for the same input. The only primitive of a convex shape is 0; a simple
/// polygon may be named more than once; what lies wholly inside a solid mesh meets none of its triangles.
///
/// Cost: follows the number of pairs of primitives whose boxes overlap.
///
/// ```
/// use solid3d::{Shape, query, glam::{DAffine3, DVec3}};
/// use std::ops::ControlFlow;
/// let strip: Vec<DVec3> = (0..22).map(|i| DVec3::new(f64::from(i / 2), f64::from(i % 2), 0.0)).collect();
/// let strip = Shape::mesh(strip, (0..20).map(|i| [i, i + 1, i + 2]).collect::<Vec<_>>())?;
/// let wall = Shape::cuboid([0.5, 3.0, 3.0])?;
/// let at = DAffine3::from_translation(DVec3::new(4.5, 0.0, 0.0));
/// let mut met = Vec::new();
/// query::intersecting_primitives(&strip, &DAffine3::IDENTITY, &wall, &at, |i, _| {
///     met.push(i);
///     ControlFlow::Continue(())
/// })?;
/// met.sort();
/// assert_eq!(met, [8, 9]);
/// # Ok::<(), solid3d::Error>(())
/// ```
pub fn intersecting_primitives(
    a: &Shape,
    placement_a: &DAffine3,
    b: &Shape,
    placement_b: &DAffine3,
    mut found: impl FnMut(u32, u32) -> ControlFlow<()>,
) -> Result<()> {
    let (a, b) = (placed("placement_a", a, placement_a)?, placed("placement_b", b, placement_b)?);
    let mut found = |i, j| found(a.shape.owner(i), b.shape.owner(j));
    let _ = Scratch::with(|scratch| pair::meeting_primitives(a, b, scratch, &mut found));
    Ok(())
}

/// An axis that separates two placed shapes: a unit vector in the world, pointing from `b` to `a`, along which every point
/// of `a` is further than every point of `b`. `None` when there is none: they intersect or touch; or, for meshes and
/// complex shapes, their convex hulls do.
///
/// ```
/// use solid3d::{Shape, query, glam::{DAffine3, DVec3}};
/// let ball = Shape::sphere(1.0)?;
/// let right = DAffine3::from_translation(DVec3::new(3.0, 0.0, 0.0));
/// let axis = query::separating_axis(&ball, &right, &ball, &DAffine3::IDENTITY)?;
/// assert_eq!(axis, Some(DVec3::X));
/// # Ok::<(), solid3d::Error>(())
/// ```
pub fn separating_axis(
    a: &Shape,
    placement_a: &DAffine3,
    b: &Shape,
    placement_b: &DAffine3,
) -> Result<Option<DVec3>> {
    let (a, b) = (placed("placement_a", a, placement_a)?, placed("placement_b", b, placement_b)?);
    Ok(Scratch::with(|scratch| pair::axis(a, b, scratch)))
}

/// The distance of two placed shapes, with their closest points. Meshes and complex shapes by branch and bound over their
/// trees.
///
/// The error of the distance is 1e-12 of the distance and of the size of the data. On curved surfaces the points may be off
/// by the square root of that along the surface, since the distance hardly depends on it.
///
/// ```
/// use solid3d::{Shape, query, glam::{DAffine3, DVec3}};
/// let (ball, block) = (Shape::sphere(1.0)?, Shape::cuboid([2.0, 2.0, 2.0])?);
/// let far = DAffine3::from_translation(DVec3::new(0.0, 5.0, 0.0));
/// let closest = query::distance(&ball, &DAffine3::IDENTITY, &block, &far)?;
/// assert!((closest.distance - 3.0).abs() < 1e-12);
/// assert!((closest.point_on_a - DVec3::Y).length() < 1e-5);
/// # Ok::<(), solid3d::Error>(())
/// ```
pub fn distance(a: &Shape, placement_a: &DAffine3, b: &Shape, placement_b: &DAffine3) -> Result<Distance> {
    let (on_a, on_b) = (unchecked(a, placement_a), unchecked(b, placement_b));
    if let (Some(on_a), Some(on_b)) = (a.polytope(), b.polytope())
        && let Some(found) = gjk::quickly_closest(on_a, placement_a, on_b, placement_b)
    {
        return Ok(found.into());
    }
    pair::by_quickly_closest(
        on_a,
        on_b,
        #[inline(always)]
        |closest| Ok(Distance::new(on_a, on_b, closest)),
        || distance_at_length(on_a, on_b),
    )
}

/// What [`distance`](distance()) says, where nothing was said yet.
#[inline(never)]
fn distance_at_length(a: Placed, b: Placed) -> Result<Distance> {
    let (a, b) = (placed("placement_a", a.shape, a.placement)?, placed("placement_b", b.shape, b.placement)?);
    let closest = pair::convex_closest_within(a, b, f64::INFINITY).flatten();
    let closest = closest.unwrap_or_else(|| Scratch::with(|scratch| pair::closest(a, b, scratch)));
    Ok(Distance::new(a, b, &closest))
}

impl From<ClosestInWorld> for Distance {
    fn from(found: ClosestInWorld) -> Distance {
        let ClosestInWorld { distance, point_on_a, point_on_b } = found;
        Distance { distance, point_on_a, point_on_b }
    }
}

impl Distance {
    #[inline(always)]
    fn new(a: Placed, b: Placed, closest: &Closest) -> Distance {
        Distance {
            distance: closest.distance,
            point_on_a: a.placement.transform_point3(closest.points.on_a),
            point_on_b: b.placement.transform_point3(closest.points.on_b),
        }
    }
}

/// The curve in which the surfaces of two placed shapes meet: polylines, each segment with the primitives that it comes from
/// (thesis, section 6.5). Empty when they do not meet, also when one is inside the other.
///
/// Between meshes, complex shapes, boxes and convex hulls; the other kinds have no facets and are an
/// [`Error::NoFacets`](crate::Error::NoFacets). Tetrahedra and polyhedra count by their boundaries, a polygon by its triangles;
/// one whose vertices are not exactly coplanar is a thin polyhedron, of two sides.
///
/// - Which facets meet, and how segments join, is exact for their corners as placed, rounded; no tolerance joins or drops
///   anything. Facets that share positions, not only indices, are neighbours. Of two closed surfaces in general position all
///   polylines are closed.
/// - Points are off by at most 1e-14 of the size of the data.
/// - Two primitives that touch in a point alone give a polyline of one point.
/// - Coplanar facets, which SOLID 1.0 ignores, give the outline of what they have in common.
/// - Where more than two segments meet, polylines end.
///
/// For meshes, and complex shapes of points, segments and triangles, the curve is empty if and only if [`intersects`] is
/// false. Cost: follows the number of pairs of primitives whose boxes overlap, n log n; for a
/// convex hull also, at the first call, of its facets.
///
/// ```
/// use solid3d::{Shape, query, glam::{DAffine3, DVec3}};
/// let (block, plate) = (Shape::cuboid([2.0, 2.0, 2.0])?, Shape::cuboid([4.0, 0.5, 4.0])?);
/// let low = DAffine3::from_translation(DVec3::new(0.0, -0.9, 0.0));
/// let curve = query::intersection_curve(&block, &DAffine3::IDENTITY, &plate, &low)?;
/// // The top of the plate runs around the block; its bottom is below it.
/// assert_eq!(curve.polylines.len(), 1);
/// assert!(curve.polylines[0].closed && (curve.length() - 8.0).abs() < 1e-12);
/// assert!(curve.segments().all(|segment| (segment.ends[0].y + 0.65).abs() < 1e-12));
///
/// let ball = Shape::sphere(1.0)?;
/// let error = query::intersection_curve(&block, &DAffine3::IDENTITY, &ball, &low).unwrap_err();
/// assert!(error.to_string().starts_with("b is a sphere, whose surface is curved"));
/// # Ok::<(), solid3d::Error>(())
/// ```
pub fn intersection_curve(
    a: &Shape,
    placement_a: &DAffine3,
    b: &Shape,
    placement_b: &DAffine3,
) -> Result<IntersectionCurve> {
    let (a, b) = (placed("placement_a", a, placement_a)?, placed("placement_b", b, placement_b)?);
    Scratch::with(|scratch| pair::intersection_curve(a, b, scratch))
}

/// A box of the world around a placed shape: for a convex shape the smallest, up to a margin for rounding; for a mesh or a
/// complex shape the smallest around its local box, which is cheaper (thesis, section 6.3.4).
///
/// ```
/// use solid3d::{Shape, query, glam::{DAffine3, DVec3}};
/// let right = DAffine3::from_translation(DVec3::X * 3.0);
/// let bounds = query::bounds(&Shape::sphere(1.0)?, &right)?;
/// assert!((bounds.min.x - 2.0).abs() < 1e-9 && (bounds.max.x - 4.0).abs() < 1e-9);
/// # Ok::<(), solid3d::Error>(())
/// ```
pub fn bounds(shape: &Shape, placement: &DAffine3) -> Result<Aabb> {
    // In one kernel, and written once, where the caller has it.
    dispatch!(simd => if placement::is_plainly_good(simd, placement) {
        let mut bounds = Aabb::EMPTY;
        pair::world_bounds_into(simd, unchecked(shape, placement), &mut bounds);
        Ok(bounds)
    } else {
        bounds_at_length(shape, placement)
    })
}

/// The same of a placement that takes a closer look.
#[inline(never)]
fn bounds_at_length(shape: &Shape, placement: &DAffine3) -> Result<Aabb> {
    Ok(pair::world_bounds(placed("placement", shape, placement)?))
}

/// For a look that answers only where both placements are good.
fn unchecked<'a>(shape: &'a Shape, placement: &'a DAffine3) -> Placed<'a> {
    Placed { shape, placement }
}

#[inline]
fn placed<'a>(argument: &'static str, shape: &'a Shape, placement: &'a DAffine3) -> Result<Placed<'a>> {
    Ok(Placed { shape, placement: placement::checked(argument, placement)? })
}
