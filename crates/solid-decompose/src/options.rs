//! How to decompose.

use crate::error::{Error, Result};

/// The most pieces that may be asked for: twice as many are made first, and joined.
pub const PIECES_MAX: usize = 128;
/// The least resolution.
pub const RESOLUTION_MIN: u32 = 8;
/// The greatest resolution: two million voxels.
pub const RESOLUTION_MAX: u32 = 128;
/// The most tests of a triangle and a voxel: some ten seconds.
pub const TESTS_MAX: u64 = 1 << 27;

/// How to decompose a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// How many pieces there may be at most: from 1, which gives the convex hull, to [`PIECES_MAX`]. Default: 32.
    pub pieces_max: usize,
    /// How much the pieces may cover that the mesh does not, while there may be more of them: the part of a piece that is its hull's
    /// alone, in volumes of the mesh's convex hull. From 0 to 1; less than the error of the voxels has no effect. Default: 0.01.
    pub concavity: f64,
    /// Into how many voxels the longest side of the mesh's box is cut: from [`RESOLUTION_MIN`] to [`RESOLUTION_MAX`]. Notches and walls
    /// thinner than two voxels may be closed. Default: 64.
    pub resolution: u32,
}

impl Default for Options {
    fn default() -> Self {
        Options { pieces_max: 32, concavity: 0.01, resolution: 64 }
    }
}

impl Options {
    pub(crate) fn check(&self) -> Result<()> {
        within("pieces_max", self.pieces_max as f64, 1.0, PIECES_MAX as f64)?;
        within("concavity", self.concavity, 0.0, 1.0)?;
        within("resolution", self.resolution.into(), RESOLUTION_MIN.into(), RESOLUTION_MAX.into())
    }
}

fn within(argument: &'static str, value: f64, least: f64, most: f64) -> Result<()> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(Error::Option { argument, value, least, most })
}
