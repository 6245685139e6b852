//! The box.

use glam::{DMat3, DVec3};

use super::image::symmetric;
use crate::gjk::Balls;
use crate::size::positive;
use crate::support::with_sign;
use crate::{SizeError, Support};

/// A box centred at the origin, along the axes (thesis, section 4.4.2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    half: DVec3,
}

impl Cuboid {
    /// A box of the given full size; each coordinate from [`MAGNITUDE_MIN`](crate::MAGNITUDE_MIN) to [`MAGNITUDE_MAX`](crate::MAGNITUDE_MAX).
    pub fn new(size: DVec3) -> Result<Self, SizeError> {
        let size =
            DVec3::new(positive("size.x", size.x)?, positive("size.y", size.y)?, positive("size.z", size.z)?);
        Ok(Cuboid { half: 0.5 * size })
    }

    /// The full size.
    pub fn size(&self) -> DVec3 {
        2.0 * self.half
    }
}

impl Support for Cuboid {
    fn support(&self, direction: DVec3) -> DVec3 {
        DVec3::new(
            with_sign(self.half.x, direction.x),
            with_sign(self.half.y, direction.y),
            with_sign(self.half.z, direction.z),
        )
    }

    fn reach(&self) -> DVec3 {
        self.half
    }

    #[inline(always)]
    fn image_bounds(&self, linear: &DMat3) -> [DVec3; 2] {
        let half = self.half;
        symmetric(linear.x_axis.abs() * half.x + linear.y_axis.abs() * half.y + linear.z_axis.abs() * half.z)
    }

    fn balls(&self) -> Option<Balls> {
        Some(Balls::about_origin(self.half.min_element(), self.half.length()))
    }

    fn is_polytope(&self) -> bool {
        true
    }

    fn half_edges(&self) -> Option<[DVec3; 3]> {
        let DVec3 { x, y, z } = self.half;
        Some([DVec3::X * x, DVec3::Y * y, DVec3::Z * z])
    }
}
