//! The kinds whose pairs have closed forms.

use glam::DVec3;

use super::{Geometry, Shape};

/// A shape that a few numbers describe.
#[derive(Clone, Copy)]
pub(crate) enum Simple {
    /// All points within a radius of the origin.
    Ball { radius: f64 },
    /// All points within a radius of a segment on the axis y, centred at the origin.
    Capsule { radius: f64, half_height: f64 },
    /// A box along the axes, centred at the origin.
    Cuboid { half: DVec3 },
}

impl Shape {
    /// Whether it is one.
    #[inline(always)]
    pub(crate) fn is_simple(&self) -> bool {
        matches!(self.geometry, Geometry::Sphere(_) | Geometry::Capsule(_) | Geometry::Cuboid(_))
    }

    /// The shape as a simple one, if it is one.
    #[inline(always)]
    pub(crate) fn simple(&self) -> Option<Simple> {
        Some(match &self.geometry {
            Geometry::Sphere(sphere) => Simple::Ball { radius: sphere.radius() },
            Geometry::Capsule(capsule) => {
                Simple::Capsule { radius: capsule.radius(), half_height: 0.5 * capsule.height() }
            }
            Geometry::Cuboid(cuboid) => Simple::Cuboid { half: 0.5 * cuboid.size() },
            _ => return None,
        })
    }
}

impl Simple {
    /// The radius of a ball around the local origin that contains the shape.
    #[inline(always)]
    pub(crate) fn radius(&self) -> f64 {
        match self {
            Simple::Ball { radius } => *radius,
            Simple::Capsule { radius, half_height } => radius + half_height,
            Simple::Cuboid { half } => half.element_sum(),
        }
    }

    /// Of what is all points within a radius of a segment on the axis y: the radius, and half the segment's length.
    #[inline(always)]
    pub(crate) fn core(&self) -> Option<(f64, f64)> {
        match *self {
            Simple::Ball { radius } => Some((radius, 0.0)),
            Simple::Capsule { radius, half_height } => Some((radius, half_height)),
            Simple::Cuboid { .. } => None,
        }
    }
}
