use solid3d::glam::{DAffine3, DVec3};

use super::{Sat, Triangle};

/// A kind of bounding volume: how it fits triangles, and how two of them are tested.
pub trait Volume: Clone {
    /// How to fit.
    type Options: Copy;
    /// What is computed once for two placed trees.
    type Shared;
    /// What is handed down from pair to pair of volumes.
    type Frame: Copy;

    /// Around the triangles that `members` name; at least one.
    fn fit(triangles: &[Triangle], members: &[u32], options: Self::Options) -> Self;

    /// Where to split the triangles: a direction, and how far along it.
    fn split(&self, triangles: &[Triangle], members: &[u32]) -> (DVec3, f64);

    /// As a child of `parent` keeps it.
    fn within(&self, parent: &Self) -> Self {
        let _ = parent;
        self.clone()
    }

    /// The space it takes: the larger of two is unfolded first.
    fn size(&self) -> f64;

    /// For two trees, given the map from the space of B to that of A.
    fn shared(b_to_a: &DAffine3) -> Self::Shared;

    /// For the roots of two trees.
    fn frame(a: &Self, b: &Self, b_to_a: &DAffine3) -> Self::Frame;

    /// After unfolding the volume of A, for its child.
    fn frame_in_child_a(frame: &Self::Frame, child: &Self) -> Self::Frame;

    /// After unfolding the volume of B, for its child.
    fn frame_in_child_b(frame: &Self::Frame, child: &Self) -> Self::Frame;

    /// The number of the axis, from 1, that was found to separate them; 0 for none.
    fn exit_axis(a: &Self, b: &Self, shared: &Self::Shared, frame: &Self::Frame, sat: Sat) -> usize;
}
