//! What of a world is nearest to a point or a shape.

use glam::{DAffine3, DVec3};

use super::{ObjectId, World};
use crate::bounds::Aabb;
use crate::broad::matters;
use crate::error::{Result, at_least_zero, bounded};
use crate::pair::Placed;
use crate::query::{self, ClosestPoint, Distance};
use crate::shape::Shape;

/// The point of an object that is closest to another point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectPoint {
    /// The object.
    pub object: ObjectId,
    /// Where, and how far away.
    pub closest: ClosestPoint,
}

/// How far an object is from a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectDistance {
    /// The object.
    pub object: ObjectId,
    /// The distance; `point_on_a` is on the shape, `point_on_b` on the object.
    pub distance: Distance,
}

/// By what part a distance, as a question about one shape tells it, may be less than that of the boxes, at most: ten times what such a distance may be off. The part that
/// is relative to the size of the data is in the boxes.
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
        counts: impl FnMut(ObjectId) -> bool,
    ) -> Result<Option<ObjectPoint>> {
        bounded("point", point)?;
        let from = Aabb::new(point, point);
        let closest_of = |of: Placed| {
            let closest = query::closest_point(of.shape, of.placement, point)?;
            Ok((closest.distance, closest))
        };
        let nearest = self.nearest(&from, within, counts, closest_of)?;
        Ok(nearest.map(|(object, closest)| ObjectPoint { object, closest }))
    }

    /// The object that is nearest to a shape, up to a distance, among those that `counts` lets through, and how far it is; `None` when none is as
    /// near. Of objects as near as each other, as all are that intersect the shape, one that comes first in the order of pairs.
    ///
    /// As [`query::distance`] says of the shape and each object, which tells what the errors are; else as for [`closest_point`](World::closest_point).
    ///
    /// Errors: a placement that is not finite or is singular; a distance that is negative or not a number.
    ///
    /// ```
    /// use solid3d::{Shape, World, glam::{DAffine3, DVec3}};
    /// let mut world = World::new();
    /// let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
    /// let [left, right] = [-5.0, 4.0].map(|x| world.add(&Shape::sphere(1.0).unwrap(), at(x)).unwrap());
    /// let arm = Shape::cuboid([1.0, 2.0, 2.0])?;
    /// let nearest = world.closest_object(&arm, &at(0.0), f64::INFINITY, |_| true)?.unwrap();
    /// assert_eq!((nearest.object, nearest.distance.distance), (right, 2.5));
    /// assert_eq!((nearest.distance.point_on_a, nearest.distance.point_on_b), (DVec3::X * 0.5, DVec3::X * 3.0));
    /// assert_eq!(world.closest_object(&arm, &at(0.0), 3.5, |object| object != right)?.unwrap().object, left);
    /// assert!(world.closest_object(&arm, &at(0.0), 2.4, |_| true)?.is_none());
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn closest_object(
        &self,
        shape: &Shape,
        placement: &DAffine3,
        within: f64,
        counts: impl FnMut(ObjectId) -> bool,
    ) -> Result<Option<ObjectDistance>> {
        let from = query::bounds(shape, placement)?;
        let distance_of = |of: Placed| {
            let distance = query::distance(shape, placement, of.shape, of.placement)?;
            Ok((distance.distance, distance))
        };
        let nearest = self.nearest(&from, within, counts, distance_of)?;
        Ok(nearest.map(|(object, distance)| ObjectDistance { object, distance }))
    }

    /// The object of which `answer` tells the least distance from what is in a box, among those that are within a distance and that `counts` lets through,
    /// with the answer.
    fn nearest<T: Copy>(
        &self,
        from: &Aabb,
        within: f64,
        mut counts: impl FnMut(ObjectId) -> bool,
        answer: impl Fn(Placed) -> Result<(f64, T)>,
    ) -> Result<Option<(ObjectId, T)>> {
        at_least_zero("within", within)?;
        let (mut until, mut best) = (within, None::<(ObjectId, T)>);
        let mut look_at = |object: ObjectId, until: &mut f64| -> Result<()> {
            let (distance, answer) = answer(self.objects[object].placed())?;
            let order = |id: ObjectId| self.objects[id].order;
            let is_better = match best {
                None => distance <= *until,
                Some((best, _)) => (distance, order(object)) < (*until, order(best)),
            };
            if is_better {
                best = Some((object, answer));
                *until = distance;
            }
            Ok(())
        };
        let bound = |bounds: &Aabb| gap(from, bounds) * (1.0 - ERROR);
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

/// The distance of two boxes, or less.
fn gap(a: &Aabb, b: &Aabb) -> f64 {
    let gap = a.gap(b);
    // Where squares are no numbers of `f64` any more, infinity would be for a box that does not matter.
    let length = Some(gap.length()).filter(|length| length.is_finite());
    length.unwrap_or(gap.max_element())
}
