//! The ball.

use glam::{DMat3, DVec3};

use super::image::{reach, symmetric};
use crate::gjk::Balls;
use crate::size::{PLAIN, positive};
use crate::{Locus, SizeError, Support, unit_scale};

/// A ball centred at the origin (thesis, section 4.4.2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    radius: f64,
}

impl Sphere {
    /// A ball; `radius` from [`MAGNITUDE_MIN`](crate::MAGNITUDE_MIN) to [`MAGNITUDE_MAX`](crate::MAGNITUDE_MAX).
    pub fn new(radius: f64) -> Result<Self, SizeError> {
        Ok(Sphere { radius: positive("radius", radius)? })
    }

    /// The radius.
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

/// The point at distance `radius` from the origin in `direction`; the origin for the zero direction.
#[inline]
pub(crate) fn ball_support(radius: f64, direction: DVec3) -> DVec3 {
    let square = direction.length_squared();
    if PLAIN.contains(&square) {
        return direction * (radius / square.sqrt());
    }
    scaled_ball_support(radius, direction)
}

/// The same, whose squares may overflow or underflow.
#[cold]
#[inline(never)]
fn scaled_ball_support(radius: f64, direction: DVec3) -> DVec3 {
    let largest = direction.abs().max_element();
    if largest == 0.0 {
        return DVec3::ZERO;
    }
    let direction = direction * unit_scale(largest);
    direction * (radius / direction.length())
}

impl Support for Sphere {
    fn support(&self, direction: DVec3) -> DVec3 {
        ball_support(self.radius, direction)
    }

    fn reach(&self) -> DVec3 {
        DVec3::splat(self.radius)
    }

    fn locus(&self, _point: DVec3) -> Locus {
        Locus::Sphere { center: DVec3::ZERO, radius: self.radius }
    }

    #[inline(always)]
    fn image_bounds(&self, linear: &DMat3) -> [DVec3; 2] {
        symmetric(reach([linear.x_axis, linear.y_axis, linear.z_axis]) * self.radius)
    }

    fn balls(&self) -> Option<Balls> {
        Some(Balls::about_origin(self.radius, self.radius))
    }

    fn core_radius(&self) -> f64 {
        self.radius
    }

    fn core_support(&self, _direction: DVec3) -> DVec3 {
        DVec3::ZERO
    }
}
