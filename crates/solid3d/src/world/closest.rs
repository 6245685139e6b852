//! What of a world is nearest to a point.

use glam::DVec3;

use super::{ObjectId, World};
use crate::bounds::Aabb;
use crate::broad::matters;
use crate::error::{Result, at_least_zero, bounded};
use crate::query::{self, ClosestPoint};

/// The point of an object that is closest to another point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectPoint {
    /// The object.
    pub object: ObjectId,
    /// Where, and how far away.
    pub closest: ClosestPoint,
}

/// By what part a distance, as a question about one shape tells it, may be less than that to its box, at most: ten times what such a distance may be off.
const ERROR: f64 = 1e-11;

impl World {
    /// The object that is nearest to a point, up to a distance, among those that `counts` lets through, and its closest point; `None` when none is as near.
    /// Of objects as near as each other, as all are that contain the point, one that comes first in the order of pairs.
    ///
    /// As [`query::closest_point`] says for each, which tells what the errors are. Objects are where they are now, whatever
    /// their response. A distance of infinity is no limit. Cost: follows the objects whose boxes are nearer than what is found; those that
    /// were added or moved since the last test or [`refresh`](World::refresh) are looked at one by one.
    ///
    /// Errors: a point that is not finite or out of range; a distance that is negative or not a number.
    ///
    /// ```
    /// use solid3d::{Shape, World, glam::{DAffine3, DVec3}};
    /// let (mut world, ball) = (World::new(), Shape::sphere(1.0)?);
    /// let [left, right] = [-5.0, 4.0].map(|x| world.add(&ball, DAffine3::from_translation(DVec3::X * x)).unwrap());
    /// let nearest = world.closest_point(DVec3::ZERO, f64::INFINITY, |_| true)?.unwrap();
    /// assert_eq!((nearest.object, nearest.closest.distance, nearest.closest.point), (right, 3.0, DVec3::X * 3.0));
    /// assert_eq!(world.closest_point(DVec3::ZERO, 4.5, |object| object != right)?.unwrap().object, left);
    /// assert!(world.closest_point(DVec3::ZERO, 2.9, |_| true)?.is_none());
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn closest_point(
        &self,
        point: DVec3,
        within: f64,
        mut counts: impl FnMut(ObjectId) -> bool,
    ) -> Result<Option<ObjectPoint>> {
        bounded("point", point)?;
        at_least_zero("within", within)?;
        let (mut until, mut best) = (within, None::<ObjectPoint>);
        let mut look_at = |object: ObjectId, until: &mut f64| -> Result<()> {
            let placed = self.objects[object].placed();
            let closest = query::closest_point(placed.shape, placed.placement, point)?;
            let order = |id: ObjectId| self.objects[id].order;
            let is_better = best.is_none_or(|best| {
                (closest.distance, order(object)) < (best.closest.distance, order(best.object))
            });
            if closest.distance <= *until && is_better {
                best = Some(ObjectPoint { object, closest });
                *until = closest.distance;
            }
            Ok(())
        };
        let bound = |bounds: &Aabb| {
            let gap = point - point.clamp(bounds.min, bounds.max);
            // Where squares are no numbers of `f64` any more, infinity would be for a box that does not matter.
            let length = Some(gap.length()).filter(|length| length.is_finite());
            length.unwrap_or(gap.abs().max_element()) * (1.0 - ERROR)
        };
        for (object, bounds) in self.elsewhere() {
            if matters(bound(&bounds), until) && counts(object) {
                look_at(object, &mut until)?;
            }
        }
        let mut failure = Ok(());
        self.broad.for_each_nearest(&bound, until, &mut |proxy| {
            if failure.is_ok()
                && let Some(object) = self.in_place(proxy).filter(|&object| counts(object))
            {
                failure = look_at(object, &mut until);
            }
            if failure.is_ok() { until } else { f64::NEG_INFINITY }
        });
        failure.map(|()| best)
    }
}
