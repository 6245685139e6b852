//! Shapes that move along straight lines.

use glam::{DAffine3, DVec3};
use solid_convex::Impact;

use super::{placed, unchecked};
use crate::error::{Result, bounded};
use crate::pair::{self, Placed, Scratch};
use crate::shape::Shape;

/// When and where two moving shapes first meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeCast {
    /// The time, from 0 to 1.
    pub time: f64,
    /// Where they meet, at that time. Space: world.
    pub point: DVec3,
    /// The common normal of the surfaces there, a unit vector pointing from `b` to `a`; `None` when they intersect or touch at the start,
    /// where [`penetration`](super::penetration()) tells the way out. Space: world.
    pub normal: Option<DVec3>,
}

/// When two shapes that move along straight lines, without turning, first meet between time 0 and 1; `None` when they do not.
///
/// Each is at its placement at time 0, and moved by its motion at time 1. Every pair of kinds. Shapes that intersect at the start
/// meet at time 0, also where one is inside of the other, a solid.
///
/// Conservative: the time is never later than the first contact, up to the rounding of positions, and no contact is missed. At that
/// time the shapes are nearer to each other than [`CAST_ERROR`](solid_convex::gjk::CAST_ERROR) of the size of the data, or 1e-14 of how far
/// apart they start. So the way from there to the contact is as short when they meet head on; when they only graze, up to about the
/// square root of it. They may count as touching there, and a motion that goes on from there along the surface meets it at once: what is to slide
/// stops a little sooner, as in [`World::cast_shape`](crate::World::cast_shape). Of contacts at the same time, one is reported. Cost: some ten times [`intersects`](super::intersects) for convex
/// shapes; for meshes, branch and bound over their trees.
///
/// ```
/// use solid3d::{Shape, query, glam::{DAffine3, DVec3}};
/// let (ball, wall) = (Shape::sphere(1.0)?, Shape::cuboid([0.1, 10.0, 10.0])?);
/// let at = DAffine3::from_translation(DVec3::X * 9.05);
/// let still = DVec3::ZERO;
/// let cast = query::cast_shape(&ball, &DAffine3::IDENTITY, DVec3::X * 20.0, &wall, &at, still)?.unwrap();
/// assert!((cast.time - 0.4).abs() < 1e-9 && (cast.point - DVec3::X * 9.0).length() < 1e-6);
/// assert!((cast.normal.unwrap() + DVec3::X).length() < 1e-6);
/// assert_eq!(query::cast_shape(&ball, &DAffine3::IDENTITY, DVec3::Y * 20.0, &wall, &at, still)?, None);
/// # Ok::<(), solid3d::Error>(())
/// ```
pub fn cast_shape(
    a: &Shape,
    placement_a: &DAffine3,
    motion_a: DVec3,
    b: &Shape,
    placement_b: &DAffine3,
    motion_b: DVec3,
) -> Result<Option<ShapeCast>> {
    bounded("motion_a", motion_a)?;
    bounded("motion_b", motion_b)?;
    let (a, b, motions) = (unchecked(a, placement_a), unchecked(b, placement_b), [motion_a, motion_b]);
    pair::by_cast(
        a,
        motion_a - motion_b,
        b,
        #[inline(always)]
        |impact| Ok(impact.map(|impact| ShapeCast::new(a, b, motions, &impact))),
        || cast_at_length(a, b, motions),
    )
}

/// The same, of whatever has no closed form.
#[inline(never)]
fn cast_at_length(a: Placed, b: Placed, motions: [DVec3; 2]) -> Result<Option<ShapeCast>> {
    let (a, b) = (placed("placement_a", a.shape, a.placement)?, placed("placement_b", b.shape, b.placement)?);
    let impact = Scratch::with(|scratch| pair::cast(a, motions[0] - motions[1], b, scratch));
    Ok(impact.map(|impact| ShapeCast::new(a, b, motions, &impact)))
}

/// The same of a shape that moves and one that stands still, whose placements were checked.
pub(crate) fn cast_of(a: Placed, motion: DVec3, b: Placed, scratch: &mut Scratch) -> Option<ShapeCast> {
    let impact = pair::by_cast(a, motion, b, Some, || None);
    let impact = impact.unwrap_or_else(|| pair::cast(a, motion, b, scratch));
    impact.map(|impact| ShapeCast::new(a, b, [motion, DVec3::ZERO], &impact))
}

impl ShapeCast {
    #[inline(always)]
    fn new(a: Placed, b: Placed, [motion_a, motion_b]: [DVec3; 2], impact: &Impact) -> ShapeCast {
        let moved = motion_a * (0.5 * impact.time) + motion_b * (0.5 * impact.time);
        ShapeCast {
            time: impact.time,
            point: pair::midpoint(a, b, &impact.points) + moved,
            normal: impact.normal,
        }
    }
}
