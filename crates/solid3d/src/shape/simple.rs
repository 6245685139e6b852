//! The kinds whose pairs have closed forms.

use glam::DVec3;

use super::{Geometry, Shape};

/// A shape that a few numbers describe.
#[derive(Clone, Copy)]
pub(crate) enum Simple {
    Round(Round),
    /// A box along the axes, centred at the origin.
    Cuboid {
        half: DVec3,
    },
}

/// All points within a radius of a segment on the axis y, centred at the origin: a capsule, or a ball, of which the segment is a point.
#[derive(Clone, Copy)]
pub(crate) struct Round {
    pub radius: f64,
    pub half_height: f64,
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
            Geometry::Sphere(sphere) => Simple::Round(Round { radius: sphere.radius(), half_height: 0.0 }),
            Geometry::Capsule(capsule) => {
                Simple::Round(Round { radius: capsule.radius(), half_height: capsule.half_height() })
            }
            Geometry::Cuboid(cuboid) => Simple::Cuboid { half: 0.5 * cuboid.size() },
            _ => return None,
        })
    }

    /// Whether it is a ball.
    #[inline]
    pub(crate) fn is_ball(&self) -> bool {
        matches!(self.geometry, Geometry::Sphere(_))
    }

    /// The radius of a ball, or of a point at the local origin, which is 0; `None` for other shapes.
    #[inline]
    pub(crate) fn ball_radius(&self) -> Option<f64> {
        match &self.geometry {
            Geometry::Sphere(sphere) => Some(sphere.radius()),
            Geometry::Polytope(hull) if *hull.points() == [DVec3::ZERO] => Some(0.0),
            _ => None,
        }
    }
}

impl Simple {
    /// The radius of a ball around the local origin that contains the shape.
    #[inline(always)]
    pub(crate) fn radius(&self) -> f64 {
        match self {
            Simple::Round(round) => round.reach(),
            Simple::Cuboid { half } => half.element_sum(),
        }
    }
}

impl Round {
    #[inline(always)]
    pub(crate) fn is_ball(&self) -> bool {
        self.half_height == 0.0
    }

    /// [`Simple::radius`] of it.
    #[inline(always)]
    pub(crate) fn reach(&self) -> f64 {
        self.radius + self.half_height
    }
}
