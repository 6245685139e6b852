//! A moving shape against all objects of a world.

use glam::{DAffine3, DVec3};
use solid_convex::gjk::CAST_ERROR;

use super::{ObjectId, World};
use crate::error::{Result, bounded};
use crate::pair::{Placed, world_bounds};
use crate::placement;
use crate::query::{ShapeCast, cast_of};
use crate::shape::Shape;
use crate::tree::TreeRay;

/// When and where a moving shape meets an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectCast {
    /// The object.
    pub object: ObjectId,
    /// When and where; the normal points from the object to the shape.
    pub cast: ShapeCast,
}

impl World {
    /// What a shape that moves along a straight line, without turning, meets first, among the objects that `counts` lets through;
    /// `None` when it meets nothing. It is at its placement at time 0, and moved by `motion` at time 1. Of objects that are met at the same
    /// time, one that comes first in the order of pairs.
    ///
    /// As [`query::cast_shape`](crate::query::cast_shape) says for each, which tells what the errors are; two objects that are met within
    /// these of each other count as met at the same time, and either may be told. Objects are where they are now, and stand still,
    /// whatever their response. Cost: follows the objects whose boxes the moving box of the shape meets up to then; those that were added or
    /// moved since the last test or [`refresh`](World::refresh) are looked at one by one.
    ///
    /// ```
    /// use solid3d::{Shape, World, glam::{DAffine3, DVec3}};
    /// let mut world = World::new();
    /// let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
    /// let walker = world.add(&Shape::capsule(0.5, 1.0)?, at(0.0))?;
    /// let [near, _] = [3.0, 6.0].map(|x| world.add(&Shape::cuboid([1.0, 4.0, 4.0]).unwrap(), at(x)).unwrap());
    /// let (shape, place) = (world.shape(walker)?, world.placement(walker)?);
    /// let first = world.cast_shape(shape, &place, DVec3::X * 4.0, |object| object != walker)?.unwrap();
    /// assert_eq!(first.object, near);
    /// assert!((first.cast.time - 0.5).abs() < 1e-9 && (first.cast.normal.unwrap() + DVec3::X).length() < 1e-6);
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    ///
    /// A character slides along what it meets. It keeps off by a skin, much more than the errors and too little to be seen: right at a
    /// surface it would count as touching, and be stopped by the next cast already, whichever way it wants to go.
    ///
    /// ```
    /// use solid3d::{Shape, World, glam::{DAffine3, DVec3}};
    ///
    /// /// Where a body ends that wants to go by `motion`.
    /// fn slide(world: &World, body: &Shape, mut from: DVec3, mut motion: DVec3) -> solid3d::Result<DVec3> {
    ///     const SKIN: f64 = 1e-4;
    ///     for _ in 0..4 {
    ///         let met = world.cast_shape(body, &DAffine3::from_translation(from), motion, |_| true)?;
    ///         let Some(cast) = met.map(|met| met.cast) else { return Ok(from + motion) };
    ///         let Some(normal) = cast.normal else { break }; // in something: `query::penetration` tells the way out
    ///         let time = (cast.time + SKIN / motion.dot(normal)).max(0.0);
    ///         from += motion * time;
    ///         motion = (motion * (1.0 - time)).reject_from_normalized(normal);
    ///     }
    ///     Ok(from)
    /// }
    ///
    /// let mut world = World::new();
    /// world.add(&Shape::cuboid([20.0, 1.0, 20.0])?, DAffine3::from_translation(DVec3::Y * -0.5))?;
    /// world.add(&Shape::cuboid([1.0, 4.0, 20.0])?, DAffine3::from_translation(DVec3::new(4.0, 2.0, 0.0)))?;
    /// let body = Shape::capsule(0.5, 1.0)?;
    /// let mut at = DVec3::Y * 3.0;
    /// for _ in 0..100 {
    ///     at = slide(&world, &body, at, DVec3::new(0.1, 0.0, 0.05))?;
    ///     at = slide(&world, &body, at, DVec3::Y * -0.1)?; // it falls
    /// }
    /// assert!((at - DVec3::new(3.0, 1.0, 5.0)).length() < 1e-3); // on the floor, along the wall
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn cast_shape(
        &self,
        shape: &Shape,
        placement: &DAffine3,
        motion: DVec3,
        mut counts: impl FnMut(ObjectId) -> bool,
    ) -> Result<Option<ObjectCast>> {
        bounded("motion", motion)?;
        let moving = Placed { shape, placement: placement::checked("placement", placement)? };
        let bounds = world_bounds(moving);
        // A cast ends before shapes touch, by up to its error of their size.
        let half_extents = bounds.half_extents() * (1.0 + CAST_ERROR);
        let path = TreeRay { origin: bounds.center(), direction: motion, half_extents };
        let mut best = None::<ObjectCast>;
        self.along(&path, 1.0, |object, until, scratch| {
            if !counts(object) {
                return until;
            }
            let Some(cast) = cast_of(moving, motion, self.objects[object].placed(), scratch) else {
                return until;
            };
            let order = |id: ObjectId| self.objects[id].order;
            if best.is_some_and(|best| (best.cast.time, order(best.object)) <= (cast.time, order(object))) {
                return until;
            }
            best = Some(ObjectCast { object, cast });
            cast.time
        });
        Ok(best)
    }
}
