//! The kinds whose pairs have closed forms.

use glam::DVec3;

use super::{Geometry, Shape};

/// A shape that a few numbers describe.
#[derive(Clone, Copy)]
pub(crate) enum Simple {
    /// All points within a radius of a segment on the axis y, centred at the origin; of a point, for a ball.
    Round { radius: f64, half_height: f64 },
    /// A box along the axes, centred at the origin.
    Cuboid { half: DVec3 },
}

impl Shape {
    /// The shape as a simple one, if it is one.
    pub(crate) fn simple(&self) -> Option<Simple> {
        Some(match &self.geometry {
            Geometry::Sphere(sphere) => Simple::Round { radius: sphere.radius(), half_height: 0.0 },
            Geometry::Capsule(capsule) => {
                Simple::Round { radius: capsule.radius(), half_height: 0.5 * capsule.height() }
            }
            Geometry::Cuboid(cuboid) => Simple::Cuboid { half: 0.5 * cuboid.size() },
            _ => return None,
        })
    }
}
