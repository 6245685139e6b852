//! The capped cylinder.

use glam::{DMat3, DVec3};

use super::image::{reach, symmetric};
use crate::direction::length;
use crate::gjk::{Ball, Balls};
use crate::size::positive;
use crate::support::{rim, with_sign};
use crate::{Locus, SizeError, Support};

/// A capped cylinder on the axis y, centred at the origin (thesis, section 4.4.2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    radius: f64,
    half_height: f64,
}

impl Cylinder {
    /// A cylinder; both sizes from [`MAGNITUDE_MIN`](crate::MAGNITUDE_MIN) to [`MAGNITUDE_MAX`](crate::MAGNITUDE_MAX).
    pub fn new(radius: f64, height: f64) -> Result<Self, SizeError> {
        Ok(Cylinder { radius: positive("radius", radius)?, half_height: 0.5 * positive("height", height)? })
    }

    /// The radius.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The height.
    pub fn height(&self) -> f64 {
        2.0 * self.half_height
    }
}

impl Support for Cylinder {
    fn support(&self, direction: DVec3) -> DVec3 {
        let (x, z) = rim(self.radius, direction.x, direction.z);
        DVec3::new(x, with_sign(self.half_height, direction.y), z)
    }

    fn reach(&self) -> DVec3 {
        DVec3::new(self.radius, self.half_height, self.radius)
    }

    fn locus(&self, _point: DVec3) -> Locus {
        Locus::Circle { radius: self.radius }
    }

    #[inline(always)]
    fn image_bounds(&self, linear: &DMat3) -> [DVec3; 2] {
        let discs = reach([linear.x_axis, linear.z_axis]) * self.radius;
        symmetric(linear.y_axis.abs() * self.half_height + discs)
    }

    fn balls(&self) -> Option<Balls> {
        let (inner, outer) =
            (self.radius.min(self.half_height), length(DVec3::new(self.radius, self.half_height, 0.0)));
        Some(Balls::about_origin(inner, outer))
    }

    fn contains_ball(&self, Ball { center, radius }: Ball) -> bool {
        let room = self.radius - radius;
        center.y.abs() + radius <= self.half_height
            && room >= 0.0
            && center.x * center.x + center.z * center.z <= room * room
    }
}
