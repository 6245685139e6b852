//! Corners of primitives that are in the convex shape.

use glam::{DAffine3, DVec3};
use solid_convex::gjk::Ball;
use solid_convex::{Support, Witness};

use super::super::frame::Frame;

/// The interior of the convex shape, seen from the complex one.
pub(super) struct Interior<'s> {
    shape: &'s dyn Support,
    to_shape: DAffine3,
    /// How far a point must be from the surface. Space: that of the shape.
    margin: f64,
}

impl<'s> Interior<'s> {
    /// By a margin in the common frame.
    pub fn new(shape: &'s dyn Support, frame: &Frame, margin: f64) -> Self {
        let relative = frame.relative();
        let margin = margin / frame.stretch_of_b().least + relative.slack_in_b;
        Interior { shape, to_shape: relative.a_to_b, margin }
    }

    /// The first corner of a primitive that is in the shape, as a point of either.
    pub fn corner_of(&self, mut corners: impl Iterator<Item = DVec3>) -> Option<Witness> {
        corners.find_map(|on_a| {
            let on_b = self.to_shape.transform_point3(on_a);
            let is_inside = self.shape.contains_ball(Ball { center: on_b, radius: self.margin });
            is_inside.then_some(Witness { on_a, on_b })
        })
    }
}
