//! The capsule.

use glam::{DMat3, DVec3};

use super::image::{reach, symmetric};
use super::sphere::ball_support;
use crate::gjk::Balls;
use crate::size::positive;
use crate::support::with_sign;
use crate::{Locus, SizeError, Support};

/// All points within a radius of a segment on the axis y, centred at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    radius: f64,
    half_height: f64,
}

impl Capsule {
    /// A capsule; `height` is the distance between the centres of its round ends. Both sizes from
    /// [`MAGNITUDE_MIN`](crate::MAGNITUDE_MIN) to [`MAGNITUDE_MAX`](crate::MAGNITUDE_MAX).
    pub fn new(radius: f64, height: f64) -> Result<Self, SizeError> {
        Ok(Capsule { radius: positive("radius", radius)?, half_height: 0.5 * positive("height", height)? })
    }

    /// The radius.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The distance between the centres of the round ends.
    pub fn height(&self) -> f64 {
        2.0 * self.half_height
    }

    /// Half of that.
    pub fn half_height(&self) -> f64 {
        self.half_height
    }
}

impl Support for Capsule {
    fn support(&self, direction: DVec3) -> DVec3 {
        ball_support(self.radius, direction) + self.core_support(direction)
    }

    fn reach(&self) -> DVec3 {
        DVec3::new(self.radius, self.radius + self.half_height, self.radius)
    }

    fn locus(&self, point: DVec3) -> Locus {
        Locus::Sphere { center: DVec3::Y * with_sign(self.half_height, point.y), radius: self.radius }
    }

    #[inline(always)]
    fn image_bounds(&self, linear: &DMat3) -> [DVec3; 2] {
        let ends = reach([linear.x_axis, linear.y_axis, linear.z_axis]) * self.radius;
        symmetric(linear.y_axis.abs() * self.half_height + ends)
    }

    fn balls(&self) -> Option<Balls> {
        Some(Balls::about_origin(self.radius, self.radius + self.half_height))
    }

    fn core_radius(&self) -> f64 {
        self.radius
    }

    fn core_support(&self, direction: DVec3) -> DVec3 {
        DVec3::new(0.0, with_sign(self.half_height, direction.y), 0.0)
    }
}
