//! Distance with a bound to stop at.

use glam::DAffine3;

use super::{Distance, placed};
use crate::error::{Result, at_least_zero};
use crate::pair::{self, Scratch};
use crate::shape::Shape;

/// The distance of two placed shapes, with their closest points, if it is at most `bound`, in world units; `None` if they are
/// further apart.
///
/// The same as [`distance`](super::distance()), of which only answers up to the bound are taken: for convex shapes to the bit, for meshes and
/// complex shapes up to the error of a distance. It costs less: of convex shapes the search ends as soon as a lower bound of the distance exceeds `bound` (the mu of Algorithm 4.1 of the
/// thesis), of meshes and complex shapes what is further apart than that is never opened. A bound of infinity is none. With a bound
/// of 0 it answers for shapes that intersect or touch.
///
/// Errors: a bound that is negative or not a number; a placement that is not finite or is singular.
///
/// ```
/// use solid3d::{Shape, query, glam::{DAffine3, DVec3}};
/// let ball = Shape::sphere(1.0)?;
/// let right = DAffine3::from_translation(DVec3::X * 5.0);
/// let near = query::distance_within(&ball, &DAffine3::IDENTITY, &ball, &right, 3.5)?.unwrap();
/// assert_eq!((near.distance, near.point_on_b), (3.0, DVec3::X * 4.0));
/// assert_eq!(query::distance_within(&ball, &DAffine3::IDENTITY, &ball, &right, 2.5)?, None);
///
/// let error = query::distance_within(&ball, &right, &ball, &right, -1.0).unwrap_err();
/// assert_eq!(error.to_string(), "bound is -1.0; it must be at least 0");
/// # Ok::<(), solid3d::Error>(())
/// ```
pub fn distance_within(
    a: &Shape,
    placement_a: &DAffine3,
    b: &Shape,
    placement_b: &DAffine3,
    bound: f64,
) -> Result<Option<Distance>> {
    at_least_zero("bound", bound)?;
    let (a, b) = (placed("placement_a", a, placement_a)?, placed("placement_b", b, placement_b)?);
    let closest = pair::convex_closest_within(a, b, bound)
        .unwrap_or_else(|| Scratch::with(|scratch| pair::closest_within(a, b, bound, scratch)));
    Ok(closest.map(|closest| Distance::new(a, b, &closest)))
}
