//! A row of placements.

use solid3d::glam::DAffine3;

/// An object's placement from a frame on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    pub frame: u64,
    /// Its place in the scene.
    pub object: usize,
    pub placement: DAffine3,
    /// The line of the file, from 1.
    pub line: u64,
}
