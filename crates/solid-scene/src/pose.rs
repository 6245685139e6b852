//! A scene at a time.

use glam::{DAffine3, DVec3};

/// Where an object is at a time, and which form it has.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectPose {
    /// Local to world. An object that is scaled to nothing, as animators hide one, or flattened is placed so: a world refuses that with
    /// [`Error::SingularPlacement`](solid3d::Error::SingularPlacement), and who plays the scene says what it means; for the command `solid` the
    /// object is not there.
    pub placement: DAffine3,
    /// For an object that deforms: the positions of the vertices of its shape, in its local space. Empty for one that
    /// does not.
    pub positions: Vec<DVec3>,
}

/// A scene at a time: one entry per object, in the scene's order. Reused from sample to sample, it allocates nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    /// The objects.
    pub objects: Vec<ObjectPose>,
}

impl Default for ObjectPose {
    fn default() -> Self {
        ObjectPose { placement: DAffine3::IDENTITY, positions: Vec::new() }
    }
}
