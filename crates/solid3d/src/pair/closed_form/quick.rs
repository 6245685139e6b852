//! Whether two simple shapes intersect, without a common space: squares of lengths against squares, no root, and no evidence.

use std::ops::RangeInclusive;

use glam::{DAffine3, DVec3};

use super::similarity::Similarity;
use super::{GAP_MIN, round::closest_on_segments};
use crate::shape::Simple;

/// Sizes of the data whose squares and the products of these neither overflow nor vanish.
const PLAIN_SIZES: RangeInclusive<f64> = 1e-30..=1e30;

/// Whether they intersect; `None` where a closer look has to say. With the scales of the placements.
#[inline]
pub(super) fn intersects(
    [a, b]: [Simple; 2],
    [at_a, at_b]: [&DAffine3; 2],
    [stretch_a, stretch_b]: [f64; 2],
) -> Option<bool> {
    let offset = at_b.translation - at_a.translation;
    let (reach_a, reach_b) = (a.radius() * stretch_a, b.radius() * stretch_b);
    let size = reach_a + reach_b + offset.abs().element_sum();
    let margin = GAP_MIN * size;
    let far = reach_a + reach_b + margin;
    let square = offset.length_squared();
    if !PLAIN_SIZES.contains(&size) {
        None
    } else if square > far * far {
        // Balls around them are apart.
        Some(false)
    } else {
        match (a, b) {
            (
                Simple::Round { radius: radius_a, half_height: height_a },
                Simple::Round { radius: radius_b, half_height: height_b },
            ) => {
                let radii = radius_a * stretch_a + radius_b * stretch_b;
                if height_a == 0.0 && height_b == 0.0 {
                    return meet_within(square, radii - margin);
                }
                let (axis_a, axis_b) = (at_a.matrix3.y_axis * height_a, at_b.matrix3.y_axis * height_b);
                segments(-offset, axis_a, axis_b).decide(radii, margin)
            }
            (Simple::Round { radius, half_height: 0.0 }, Simple::Cuboid { half }) => {
                let at_b = Similarity::of_stretch(at_b, stretch_b);
                center_and_box(-offset, &at_b, half).decide(radius * stretch_a, margin)
            }
            (Simple::Cuboid { half }, Simple::Round { radius, half_height: 0.0 }) => {
                let at_a = Similarity::of_stretch(at_a, stretch_a);
                center_and_box(offset, &at_a, half).decide(radius * stretch_b, margin)
            }
            (Simple::Round { .. }, Simple::Cuboid { .. })
            | (Simple::Cuboid { .. }, Simple::Round { .. } | Simple::Cuboid { .. }) => None,
        }
    }
}

/// The distance of two cores, between bounds.
struct Cores {
    /// The gap along a vector between two of their points, times its length.
    gap: f64,
    /// The square of its length.
    square: f64,
}

impl Cores {
    /// Whether what is within the radii of the cores intersects.
    #[inline]
    fn decide(&self, radii: f64, margin: f64) -> Option<bool> {
        let far = radii + margin;
        if self.gap > 0.0 && self.gap * self.gap > far * far * self.square {
            Some(false)
        } else {
            meet_within(self.square, radii - margin)
        }
    }
}

/// Whether two points are so near, by the square of their distance; if not, that says nothing.
#[inline]
fn meet_within(square: f64, near: f64) -> Option<bool> {
    (near > 0.0 && square < near * near).then_some(true)
}

/// Two segments, by their half axes; `between` leads from the middle of the second to that of the first.
#[inline]
fn segments(between: DVec3, a: DVec3, b: DVec3) -> Cores {
    let (s, t) = closest_on_segments(between, a, b);
    let v = between + a * s - b * t;
    Cores { gap: v.dot(between) - v.dot(a).abs() - v.dot(b).abs(), square: v.length_squared() }
}

/// A point, seen from the centre of a box, and the box.
#[inline]
fn center_and_box(center: DVec3, at: &Similarity, half: DVec3) -> Cores {
    let local = at.local(center);
    // In the box's own space exactly along its axes, where the point is beyond a face.
    let v = at.apply(local - local.clamp(-half, half));
    Cores { gap: v.dot(center) - at.reach_along(v, half), square: v.length_squared() }
}
