//! What can be wrong with what is to be decomposed.

use solid3d::ShapeKind;

/// Bad input. The message names the argument, its value and its limit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A shape without triangles.
    #[error("a {kind} cannot be decomposed; only meshes can")]
    NotAMesh {
        /// The shape's kind.
        kind: ShapeKind,
    },
    /// An option is out of range, or not a number.
    #[error("{argument} is {value}; it must be from {least} to {most}")]
    Option {
        /// The option's name.
        argument: &'static str,
        /// Its value.
        value: f64,
        /// The least that it may be.
        least: f64,
        /// The most that it may be.
        most: f64,
    },
    /// The grid is too fine for so many, or so large, triangles.
    #[error(
        "{triangles} triangles on a grid of resolution {resolution} take {tests} tests of a triangle and a voxel; the limit is \
         {limit}: lower the resolution, or simplify the mesh"
    )]
    TooMuchWork {
        /// How many triangles the mesh has.
        triangles: usize,
        /// The resolution asked for.
        resolution: u32,
        /// How many tests that takes.
        tests: u64,
        /// How many may be made: [`TESTS_MAX`](crate::TESTS_MAX).
        limit: u64,
    },
    /// The library gave up on the voxels of the mesh, which is a defect of it.
    #[error(
        "the voxels of the mesh could not be decomposed at resolution {resolution}; another resolution may do"
    )]
    Voxels {
        /// The resolution asked for.
        resolution: u32,
    },
    /// A piece is no shape.
    #[error(transparent)]
    Shape(#[from] solid3d::Error),
}

/// A result whose error names what was wrong with the input.
pub type Result<T> = std::result::Result<T, Error>;
