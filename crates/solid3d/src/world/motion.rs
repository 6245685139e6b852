//! Fast objects: what is tested between two frames (thesis, section 2.2.2).

use super::stirred::Staleness;
use super::{ObjectId, World};
use crate::error::Result;
use crate::pair::Scratch;
use crate::query::{Impact, ImpactOptions, impact_of};

/// Where an object is tested.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Motion {
    /// Where it is. What it passed on the way from the previous frame is not noticed.
    #[default]
    Sampled,
    /// Where it is, and also on the way from the previous frame: the volume that it swept is tested, so that a bullet does not
    /// pass a wall at any speed. Collisions that are found only so are marked [`When::OnTheWay`].
    ///
    /// On the way, each point of the object (each vertex, when it is deformed) moves straight, at constant speed; for two
    /// swept objects it is the relative motion that counts. What is tested encloses that: exactly, for convex shapes
    /// and for the primitives of a mesh, when neither turns, is scaled or deformed within the frame; else some more. A
    /// turning object has its points on the chords of their arcs: at a distance r from the axis, a turn by the angle t leaves
    /// out r (1 - cos(t/2)), and half a turn goes straight through the axis.
    Swept,
}

/// When two objects collide.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum When {
    /// As they are now.
    Now,
    /// Not now, but on the way from the previous frame, of which at least one has [`Motion::Swept`].
    OnTheWay,
}

/// # Fast objects
///
/// The previous frame is that of the last [`proceed`](World::proceed), or of the object's addition. An object that is
/// [`Sampled`](Motion::Sampled) is, for a swept one, where it is now. A shape that was set within the frame and is no
/// deformation of the one before counts as having come all the way.
///
/// ```
/// use solid3d::{Motion, Shape, When, World, glam::{DAffine3, DVec3}};
/// let mut world = World::new();
/// let wall = world.add(&Shape::cuboid([0.1, 4.0, 4.0])?, DAffine3::IDENTITY)?;
/// let bullet = world.add(&Shape::sphere(0.01)?, DAffine3::from_translation(DVec3::X * -100.0))?;
/// world.set_motion(bullet, Motion::Swept)?;
///
/// world.set_placement(bullet, DAffine3::from_translation(DVec3::X * 700.0))?;
/// let collisions = world.test();
/// assert_eq!((collisions[0].a, collisions[0].b, collisions[0].when), (wall, bullet, When::OnTheWay));
/// assert!(collisions[0].point().unwrap().x.abs() < 0.051); // in the wall
///
/// world.proceed();
/// assert!(world.test().is_empty()); // that was the frame before
/// # Ok::<(), solid3d::Error>(())
/// ```
impl World {
    /// Sets where an object is tested: [`WorldOptions::motion`](super::WorldOptions::motion) for one that is new.
    ///
    /// An object that is to be elsewhere without having moved there is [`Sampled`](Motion::Sampled) until the next
    /// [`proceed`](World::proceed).
    pub fn set_motion(&mut self, id: ObjectId, motion: Motion) -> Result<()> {
        self.object_mut(id)?.set_motion(motion);
        self.stir(id, Staleness::Bounds);
        Ok(())
    }

    /// When two objects first met on their way from the previous frame to where they are: at time 0 in the previous frame, at time 1
    /// now; `None` when they did not. [`query::time_of_impact_deforming`](crate::query::time_of_impact_deforming) says more.
    ///
    /// An object that is [`Sampled`](Motion::Sampled) has been where it is; one that was set to another shape has come as that shape. On a
    /// [straight](crate::query::Path::Straight) path, only pairs that collide, now or [on the way](When::OnTheWay), can have an answer, and
    /// those that come nearer than the tolerance: so this tells those that met from those of which but what was tested encloses a contact.
    ///
    /// ```
    /// use solid3d::{Motion, Shape, World, glam::{DAffine3, DVec3}, query::ImpactOptions};
    /// let mut world = World::new();
    /// let wall = world.add(&Shape::cuboid([0.1, 4.0, 4.0])?, DAffine3::IDENTITY)?;
    /// let bullet = world.add(&Shape::sphere(0.01)?, DAffine3::from_translation(DVec3::X * -1.06))?;
    /// world.set_motion(bullet, Motion::Swept)?;
    /// world.set_placement(bullet, DAffine3::from_translation(DVec3::X * 3.0))?;
    /// let impact = world.time_of_impact(wall, bullet, &ImpactOptions::default())?.unwrap();
    /// assert!((impact.time - 1.0 / 4.06).abs() < 1e-6 && (impact.point.x + 0.05).abs() < 1e-6);
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// An object that is not in the world, a pair of an object with itself, a tolerance out of range.
    pub fn time_of_impact(
        &self,
        a: ObjectId,
        b: ObjectId,
        options: &ImpactOptions,
    ) -> Result<Option<Impact>> {
        self.check_pair(a, b)?;
        let [a, b] = [a, b].map(|id| self.objects[id].moving());
        Scratch::with(|scratch| impact_of(&a, &b, options, scratch))
    }

    /// Where an object is tested.
    pub fn motion(&self, id: ObjectId) -> Result<Motion> {
        Ok(self.object(id)?.motion())
    }
}
