//! Signed distances.

use glam::{DAffine3, DVec3};

use super::point::as_shape;
use super::{placed, unchecked};
use crate::error::Result;
use crate::pair::{self, Placed, Scratch, SignedDistance};
use crate::shape::Shape;

/// How far a point is from the surface of a placed shape: positive outside, negative inside, with the nearest point of the surface
/// and the outward normal there. Of several nearest points it is one, the same for the same input.
///
/// - **Convex shapes**, under any placement. Inside, it is the shortest way out. A shape without thickness has no inside; on it the
///   distance is 0, and the normal one of two.
/// - **A [solid](Shape::into_solid) mesh**, convex or not: the nearest triangle, with the sign by the exact winding number, as
///   [`contains_point`](super::contains_point). Whichever way round its triangles are, the normal leads out. Triangles wholly
///   inside, as where parts overlap, count too.
/// - **A mesh that is not solid** is a surface without an inside: the distance is at least 0, and the normal points to the side of
///   the point. Of a mesh that is nearly closed, the sign may be guessed by the [`winding_number`](super::winding_number).
/// - **A complex shape** is a union of convex parts, and the answer is the least of theirs. Outside that is exact. Where parts
///   overlap, the surface of the one may be inside the other, and the way out of all of them longer: the distance is then
///   a bound, no deeper than the truth.
///
/// The distance is negative or 0 if and only if [`contains_point`](super::contains_point) holds, beyond the errors of both. It
/// changes by no more than the point is moved.
///
/// The error is 1e-12 of the size of the data, and outside also 1e-12 of the distance; inside cones, cylinders, balls and capsules that
/// their placement stretches unevenly it is that of [`penetration`](super::penetration()). On curved surfaces that are stretched, the
/// nearest point may be off by the square root of that. At an edge or a corner the normal leads to the point, or, within
/// 1e-11 of the size of the data, is that of one of the faces there.
///
/// Cost: below a microsecond for what its placement leaves a ball, box, cone, cylinder or capsule, and for a point inside of an ellipsoid; some microseconds, deep
/// inside up to a hundred, for other convex shapes; for a mesh, by branch and bound over its tree.
///
/// ```
/// use solid3d::{Shape, query, glam::{DAffine3, DVec3}};
/// let block = Shape::cuboid([2.0, 4.0, 4.0])?;
/// let here = DAffine3::IDENTITY;
/// let inside = query::signed_distance(&block, &here, DVec3::new(0.75, 0.5, 0.0))?;
/// assert_eq!((inside.distance, inside.normal), (-0.25, DVec3::X));
/// assert_eq!(inside.point, DVec3::new(1.0, 0.5, 0.0));
/// let outside = query::signed_distance(&block, &here, DVec3::new(4.0, 0.5, 6.0))?;
/// assert!((outside.distance - 5.0).abs() < 1e-12 && (outside.point - DVec3::new(1.0, 0.5, 2.0)).length() < 1e-12);
/// # Ok::<(), solid3d::Error>(())
/// ```
pub fn signed_distance(shape: &Shape, placement: &DAffine3, point: DVec3) -> Result<SignedDistance> {
    pair::nearest_on_surface(unchecked(shape, placement), point, || at_length(shape, placement, point))
}

/// The same, of whatever has no closed form.
#[inline(never)]
fn at_length(shape: &Shape, placement: &DAffine3, point: DVec3) -> Result<SignedDistance> {
    let shape = placed("placement", shape, placement)?;
    let (of_point, at) = as_shape(point)?;
    let of_point = Placed { shape: of_point, placement: &at };
    Ok(Scratch::with(|scratch| pair::surface_point(shape, of_point, scratch)))
}
