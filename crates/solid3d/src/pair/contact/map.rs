//! The map of a shape to the common frame of a pair.

use std::cell::OnceCell;

use glam::{DAffine3, DMat3, DVec3};

use crate::placement::{direction, inverse_linear};

/// Takes local points to the common frame.
pub(super) struct Map {
    pub affine: DAffine3,
    /// The inverse of the linear part, once it was asked for: faces of triangles and balls need none.
    inverse: OnceCell<DMat3>,
}

impl Map {
    pub fn new(affine: DAffine3) -> Map {
        Map { affine, inverse: OnceCell::new() }
    }

    #[inline]
    pub fn point(&self, local: DVec3) -> DVec3 {
        self.affine.transform_point3(local)
    }

    /// The linear part.
    pub fn linear(&self) -> &DMat3 {
        &self.affine.matrix3
    }

    pub fn inverse(&self) -> &DMat3 {
        self.inverse.get_or_init(|| inverse_linear(&self.affine.matrix3))
    }

    /// The image of a normal: by the inverse transposed, whose entries may be so large that their squares are not numbers.
    #[inline]
    pub fn normal(&self, local: DVec3) -> DVec3 {
        unit(self.inverse().transpose() * local)
    }
}

/// The direction of a normal; zero of one that is.
#[inline]
pub(super) fn unit(normal: DVec3) -> DVec3 {
    direction(normal).unwrap_or(DVec3::ZERO)
}
