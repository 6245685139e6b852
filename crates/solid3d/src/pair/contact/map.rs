//! The map of a shape to the common frame of a pair.

use std::cell::OnceCell;

use glam::{DAffine3, DMat3, DVec3};

use super::super::closed_form::Similarity;
use crate::placement::{direction, inverse_linear};

/// Takes local points to the common frame.
pub(super) struct Map {
    pub affine: DAffine3,
    /// The inverse of the linear part, once it was asked for: faces of triangles and balls need none.
    inverse: OnceCell<DMat3>,
    /// By how much it stretches all lengths, if it does, once it was asked for.
    stretch: OnceCell<Option<f64>>,
}

impl Map {
    pub fn new(affine: DAffine3) -> Map {
        Map { affine, inverse: OnceCell::new(), stretch: OnceCell::new() }
    }

    /// One of which it is not known that it stretches all lengths alike.
    #[cfg(test)]
    pub fn of_any_shape(affine: DAffine3) -> Map {
        Map { stretch: OnceCell::from(None), ..Map::new(affine) }
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

    /// By how much it stretches all lengths; `None` for a map that is not a rotation with a uniform scale.
    pub fn stretch(&self) -> Option<f64> {
        *self.stretch.get_or_init(|| Similarity::new(&self.affine.matrix3).map(|similar| similar.stretch))
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
