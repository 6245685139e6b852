//! Options of a world.

use super::{Motion, Response};
use crate::broad::BroadPhaseKind;

/// Options of a world.
///
/// ```
/// use solid3d::{BroadPhaseKind, World, WorldOptions};
/// let options = WorldOptions { broad_phase: BroadPhaseKind::SweepAndPrune, ..Default::default() };
/// assert!(World::with_options(&options).is_empty());
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WorldOptions {
    /// The response for pairs without one of their own: [`Response::Witness`] by default.
    pub default_response: Response,
    /// The engine that finds the pairs whose boxes overlap; any gives the same answers.
    pub broad_phase: BroadPhaseKind,
    /// The boxes that it gets; any give the same answers.
    pub boxes: Boxes,
    /// How objects are tested that are added, until [`World::set_motion`](super::World::set_motion):
    /// [`Motion::Sampled`] by default.
    pub motion: Motion,
    /// Whether tests use what earlier tests found out: `true` by default; the answers are the same.
    pub caching: bool,
}

/// The boxes of objects in the broad phase (thesis, section 6.5).
///
/// ```
/// use solid3d::{Boxes, Shape, World, WorldOptions, glam::DAffine3};
/// let options = WorldOptions { boxes: Boxes::FixedSize, ..Default::default() };
/// let mut world = World::with_options(&options);
/// let needle = Shape::cuboid([0.1, 4.0, 0.1])?;
/// let [_, right] = [0.0, 1.0].map(|x| world.add(&needle, DAffine3::from_translation([x, 0.0, 0.0].into())).unwrap());
/// // Their boxes overlap, for these have room for any orientation; the answer is what it always is.
/// assert!(world.test().is_empty());
/// assert_eq!(world.statistics().candidates, 1);
/// world.set_placement(right, DAffine3::from_rotation_z(1.0))?;
/// assert_eq!(world.test().len(), 1);
/// # Ok::<(), solid3d::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Boxes {
    /// About as small as an object allows as it is placed, and computed whenever it moves.
    #[default]
    Dynamic,
    /// Large enough to enclose an object in any orientation, so that a rotation costs nothing. Better where objects turn
    /// much and are far apart.
    ///
    /// Objects that are not rigid have [`Dynamic`](Boxes::Dynamic) boxes all the same: under a placement that stretches
    /// some directions more than others, or once deformed.
    FixedSize,
}

impl Default for WorldOptions {
    fn default() -> Self {
        WorldOptions {
            default_response: Response::Witness,
            broad_phase: BroadPhaseKind::default(),
            boxes: Boxes::default(),
            motion: Motion::default(),
            caching: true,
        }
    }
}
