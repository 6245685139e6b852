//! What became of the pairs that collide or did.

use super::{Collision, ObjectId, World};

/// What became of a pair since the last frame ended: see [`World::events`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Event {
    /// The object of the pair that was created first.
    pub a: ObjectId,
    /// The other.
    pub b: ObjectId,
    /// What became of it.
    pub kind: EventKind,
}

/// The kinds of [`Event`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EventKind {
    /// It collides, and did not when the last frame ended.
    Began,
    /// It collides, and did when the last frame ended.
    Persists,
    /// It does not collide, and did when the last frame ended. Objects that were removed since collide no more, and from the next test on
    /// neither do pairs whose response is to [ignore](super::Response::Ignore) them now.
    Ended,
}

/// # Events
///
/// ```
/// use solid3d::{EventKind, Shape, World, glam::{DAffine3, DVec3}};
/// let mut world = World::new();
/// let ball = Shape::sphere(1.0)?;
/// let resting = world.add(&ball, DAffine3::IDENTITY)?;
/// let passing = world.add(&ball, DAffine3::from_translation(DVec3::X * -3.0))?;
/// let mut kinds = Vec::new();
/// for x in [-3.0, -1.0, 1.0, 3.0, 5.0] {
///     world.set_placement(passing, DAffine3::from_translation(DVec3::X * x))?;
///     world.test();
///     for event in world.events() {
///         assert_eq!((event.a, event.b), (resting, passing));
///         kinds.push((x, event.kind));
///     }
///     world.proceed();
/// }
/// use EventKind::{Began, Ended, Persists};
/// assert_eq!(kinds, [(-1.0, Began), (1.0, Persists), (3.0, Ended)]);
/// # Ok::<(), solid3d::Error>(())
/// ```
impl World {
    /// What became of every pair that collides or did when the last frame ended: the collisions of the last test, against those
    /// that were the last when [`proceed`](World::proceed) was called. In the order of [`test`](World::test), each pair once.
    ///
    /// Tests within one frame are all held against the end of the frame before. An object that was removed ends its
    /// collisions at once; its id is then only a name. Nothing is computed here: cost as the number of events.
    pub fn events(&self) -> impl Iterator<Item = Event> {
        self.findings.events()
    }

    /// The collisions that the last test found, as [`test`](World::test) returned them, without those of objects removed since;
    /// nothing is copied. Of [`test_with`](World::test_with), those that were left when it ended: what `respond` moved may have parted some.
    ///
    /// ```
    /// use solid3d::{Shape, World, glam::DAffine3};
    /// let mut world = World::new();
    /// let ball = Shape::sphere(1.0)?;
    /// let [a, b] = [0, 1].map(|_| world.add(&ball, DAffine3::IDENTITY).unwrap());
    /// assert_eq!(world.collisions().count(), 0); // there was no test yet
    /// let found = world.test();
    /// assert!(world.collisions().eq(&found));
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn collisions(&self) -> impl Iterator<Item = &Collision> {
        self.findings.iter()
    }
}
