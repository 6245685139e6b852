//! What is in a region of a world.

use glam::DAffine3;

use super::{ObjectId, World};
use crate::error::Result;
use crate::pair::{self, Placed, Scratch, world_bounds};
use crate::placement;
use crate::shape::Shape;

impl World {
    /// The objects that have a point in common with a region: any shape, a box, a ball, a convex hull, a solid mesh. In the
    /// order of pairs.
    ///
    /// As [`query::intersects`](crate::query::intersects) says for each, where the objects are now, whatever their response. Cost:
    /// follows the objects whose boxes overlap that of the region; those that were added or moved since the last test or
    /// [`refresh`](World::refresh) are looked at one by one.
    ///
    /// ```
    /// use solid3d::{Shape, World, glam::{DAffine3, DVec3}};
    /// let (mut world, ball) = (World::new(), Shape::sphere(1.0)?);
    /// let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
    /// let ids = [0.0, 4.0, 8.0].map(|x| world.add(&ball, at(x)).unwrap());
    /// let block = Shape::cuboid([6.0, 1.0, 1.0])?;
    /// assert_eq!(world.objects_in(&block, &at(2.0))?, ids[..2]);
    /// // The corners of the balls' boxes do not count.
    /// let small = Shape::sphere(0.1)?;
    /// assert!(world.objects_in(&small, &DAffine3::from_translation(DVec3::splat(0.9)))?.is_empty());
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn objects_in(&self, region: &Shape, at: &DAffine3) -> Result<Vec<ObjectId>> {
        let region = Placed { shape: region, placement: placement::checked("at", at)? };
        let bounds = world_bounds(region);
        let mut found = Vec::new();
        Scratch::with(|scratch| {
            let mut look_at = |id| {
                if pair::intersects(self.objects[id].placed(), region, scratch) {
                    found.push(id);
                }
            };
            let elsewhere = self.elsewhere().filter(|(_, other)| other.overlaps(&bounds));
            elsewhere.for_each(|(id, _)| look_at(id));
            self.broad
                .for_each_in(&bounds, &mut |proxy| self.in_place(proxy).into_iter().for_each(&mut look_at));
        });
        found.sort_unstable_by_key(|&id| self.objects[id].order);
        Ok(found)
    }
}
