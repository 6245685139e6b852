//! The capped cone.

use glam::{DMat3, DVec3};

use super::image::reach;
use crate::direction::length;
use crate::gjk::{Ball, Balls};
use crate::size::positive;
use crate::support::rim;
use crate::{Locus, SizeError, Support};

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

    fn locus(&self, point: DVec3) -> Locus {
        if point.y < 0.0 { Locus::Circle { radius: self.radius } } else { Locus::Point }
    }

    #[inline(always)]
    fn image_bounds(&self, linear: &DMat3) -> [DVec3; 2] {
        let base = reach([linear.x_axis, linear.z_axis]) * self.radius;
        let apex = linear.y_axis * self.half_height;
        [apex.min(-apex - base), apex.max(base - apex)]
    }

    fn balls(&self) -> Option<Balls> {
        let Cone { radius, half_height, .. } = *self;
        // As far from the apex as from the rim; about the base, if that is wide.
        let around = (-radius * (radius / (4.0 * half_height))).max(-half_height);
        let outer = (half_height - around).max(length(DVec3::new(radius, half_height + around, 0.0)));
        // Of the triangle that is a cut along the axis, the circle that touches all three sides.
        let inner =
            2.0 * half_height * (radius / (radius + length(DVec3::new(radius, 2.0 * half_height, 0.0))));
        let on_axis = |y: f64, radius: f64| Ball { center: DVec3::new(0.0, y, 0.0), radius };
        Some(Balls { inner: on_axis(inner - half_height, inner), outer: on_axis(around, outer) })
    }

    fn contains_ball(&self, Ball { center, radius }: Ball) -> bool {
        let Cone { radius: base, half_height, .. } = *self;
        let height = 2.0 * half_height;
        let off_axis = center.with_y(0.0).length();
        // Times the length of the side.
        let to_side = base * (half_height - center.y) - height * off_axis;
        center.y - radius >= -half_height && to_side >= radius * length(DVec3::new(base, height, 0.0))
    }
}
