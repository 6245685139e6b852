//! Contacts of objects.

use super::{ObjectId, World};
use crate::error::Result;
use crate::query::{self, ContactOptions, Manifold};

impl World {
    /// All contacts of two objects where they are now, whatever their response: see [`query::contacts`]. In the
    /// order in which they are given, normals point from `b` to `a`. Nothing is cached.
    ///
    /// ```
    /// use solid3d::{Shape, World, glam::{DAffine3, DVec3}, query::ContactOptions};
    /// let (mut world, block) = (World::new(), Shape::cuboid([1.0, 1.0, 1.0])?);
    /// world.add(&block, DAffine3::IDENTITY)?;
    /// world.add(&block, DAffine3::from_translation(DVec3::Y * 0.75))?;
    /// for collision in world.test() {
    ///     let contacts = world.contacts(collision.a, collision.b, &ContactOptions::default())?;
    ///     assert_eq!((contacts[0].normal, contacts[0].points.len()), (DVec3::NEG_Y, 4));
    /// }
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn contacts(&self, a: ObjectId, b: ObjectId, options: &ContactOptions) -> Result<Vec<Manifold>> {
        self.check_pair(a, b)?;
        let [of_a, of_b] = [a, b].map(|id| self.objects[id].placed());
        query::contacts(of_a.shape, of_a.placement, of_b.shape, of_b.placement, options)
    }
}
