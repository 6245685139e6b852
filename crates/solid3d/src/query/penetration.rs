//! How deep two shapes are in each other.

use glam::{DAffine3, DVec3};

use solid_convex::epa;

use super::{placed, unchecked};
use crate::error::Result;
use crate::pair::{self, Placed, Scratch};
use crate::shape::Shape;

/// How deep two placed shapes are in each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penetration {
    /// The length of the shortest translation that leaves them touching, at least 0. World units.
    pub depth: f64,
    /// The depth is at least this. World units.
    pub depth_min: f64,
    /// The depth is at most this. World units.
    pub depth_max: f64,
    /// The unit vector along which the first shape is to move by the depth, from `b` to `a`. Space: world.
    pub normal: DVec3,
    /// The point of the first shape that is deepest in the second. Space: world.
    pub point_on_a: DVec3,
    /// The point of the second shape that is deepest in the first: `point_on_a` moved by the depth along the normal. On curved
    /// surfaces it may be off, along the surface, by the square root of what the bounds leave open. Space: world.
    pub point_on_b: DVec3,
}

/// How deep two placed shapes are in each other: the shortest translation of the first that leaves them touching (thesis, section 2.3), and
/// the points that then touch. `None` when they do not intersect.
///
/// - **Convex shapes**, also flat ones, of any size, and with their middles in one place. Of several shortest translations it is one,
///   the same for the same input. Shapes that touch have a depth of about 0, and the normal of their common plane. Two that lie in
///   one plane or on one line have depth 0 across it.
/// - **Meshes and complex shapes** are unions of primitives, without an inside. The answer is that of the pair of
///   primitives that are deepest in each other, over all pairs that intersect. The translation takes these two apart, and may leave
///   others in each other: the depth is a lower bound of that of the whole, for small triangles a poor one; how deep a body is in
///   a closed surface of many, its [`contacts`](super::contacts()) tell. A
///   [simple polygon](crate::ComplexShapeBuilder::simple_polygon) is one primitive where it is convex, else one of its triangles is.
/// - **A [solid](Shape::into_solid) mesh** counts as its convex hull, and so has a depth wherever something is in it. For
///   a convex solid that is exact. For others the translation leads out of the hull, which is further than need be; put such
///   a body together from convex parts when that matters.
///
/// The bounds are certain for the pair that the answer is of. Between polytopes, spheres and capsules they are 5e-13 of
/// the size of the data apart, and 1e-12 where one is a sliver or a needle, or flat. What is thinner than 1e-3 of its length and meets a
/// corner with its end may leave 1e-8 open, and what is thinner than 1e-10 of it, 1e-3. Where cones, cylinders or stretched round shapes
/// take part, they are within 1e-7 of the depth ([`DEPTH_TOLERANCE`](solid_convex::epa::DEPTH_TOLERANCE)), of which the upper is nearly
/// always exact to 1e-13 of the size. Where these have their shortest translations in a circle of directions at once, as coaxial cones
/// and cylinders do, the lower may be 1e-3 off; for concentric ellipsoids, which may have them in all directions, both 5e-2.
///
/// Cost: some hundred nanoseconds for two boxes, some microseconds for other convex shapes, less with a [`PairCache`](super::PairCache); for two
/// meshes little more than that of [`intersecting_primitives`](super::intersecting_primitives), as only a few pairs that may be the deepest
/// are asked; for a solid O(n) once, and a walk through its tree for each of its support points.
///
/// ```
/// use solid3d::{Shape, query, glam::{DAffine3, DVec3}};
/// let (block, ball) = (Shape::cuboid([2.0, 2.0, 2.0])?, Shape::sphere(1.0)?);
/// let above = DAffine3::from_translation(DVec3::new(0.0, 1.75, 0.0));
/// let found = query::penetration(&ball, &above, &block, &DAffine3::IDENTITY)?.unwrap();
/// assert!((found.depth - 0.25).abs() < 1e-14 && (found.normal - DVec3::Y).length() < 1e-14);
/// assert!((found.point_on_a - DVec3::Y * 0.75).length() < 1e-14); // the lowest point of the ball
/// assert!((found.point_on_b - DVec3::Y).length() < 1e-14); // the top of the block
/// # Ok::<(), solid3d::Error>(())
/// ```
pub fn penetration(
    a: &Shape,
    placement_a: &DAffine3,
    b: &Shape,
    placement_b: &DAffine3,
) -> Result<Option<Penetration>> {
    let (on_a, on_b) = (unchecked(a, placement_a), unchecked(b, placement_b));
    match pair::quickly_penetration(on_a, on_b) {
        Some(found) => Ok(Some(Penetration::new(on_a, on_b, &found))),
        None => penetration_at_length(on_a, on_b),
    }
}

/// What [`penetration`] says, where nothing was said yet.
#[inline(never)]
fn penetration_at_length(a: Placed, b: Placed) -> Result<Option<Penetration>> {
    let (a, b) = (placed("placement_a", a.shape, a.placement)?, placed("placement_b", b.shape, b.placement)?);
    let found = Scratch::with(|scratch| pair::penetration(a, b, scratch));
    Ok(found.map(|found| Penetration::new(a, b, &found)))
}

impl Penetration {
    /// In the world.
    pub(super) fn new(a: Placed, b: Placed, found: &epa::Penetration) -> Penetration {
        Penetration {
            depth: found.depth,
            depth_min: found.lower,
            depth_max: found.upper,
            normal: found.direction,
            point_on_a: a.placement.transform_point3(found.points.on_a),
            point_on_b: b.placement.transform_point3(found.points.on_b),
        }
    }
}
