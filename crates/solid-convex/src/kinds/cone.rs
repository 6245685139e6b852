//! The capped cone.

use glam::DVec3;

use crate::gjk::Balls;
use crate::size::positive;
use crate::support::rim;
use crate::{SizeError, Support};

/// A capped cone on the axis y, centred at the origin: apex at +height/2, base at -height/2 (thesis, section 4.4.2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    radius: f64,
    half_height: f64,
}

impl Cone {
    /// A cone; `radius` at the base. Both sizes from [`MAGNITUDE_MIN`](crate::MAGNITUDE_MIN) to [`MAGNITUDE_MAX`](crate::MAGNITUDE_MAX).
    pub fn new(radius: f64, height: f64) -> Result<Self, SizeError> {
        Ok(Cone { radius: positive("radius", radius)?, half_height: 0.5 * positive("height", height)? })
    }

    /// The radius at the base.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The height.
    pub fn height(&self) -> f64 {
        2.0 * self.half_height
    }
}

impl Support for Cone {
    // The thesis compares the direction with the top angle; comparing the two candidates is the same and rounds less.
    fn support(&self, direction: DVec3) -> DVec3 {
        let (x, z) = rim(self.radius, direction.x, direction.z);
        let rim_over_apex = direction.x * x + direction.z * z - 2.0 * self.half_height * direction.y;
        if rim_over_apex >= 0.0 {
            DVec3::new(x, -self.half_height, z)
        } else {
            DVec3::new(0.0, self.half_height, 0.0)
        }
    }

    fn reach(&self) -> DVec3 {
        DVec3::new(self.radius, self.half_height, self.radius)
    }

    fn balls(&self) -> Option<Balls> {
        let slant = self.radius.hypot(2.0 * self.half_height);
        let outer = self.radius.hypot(self.half_height);
        // Nearer to its side than to its base, always.
        Some(Balls { center: DVec3::ZERO, inner: self.half_height * (self.radius / slant), outer })
    }
}
