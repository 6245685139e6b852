//! How far a placed shape reaches.

use glam::{DAffine3, DMat3, DVec3};
use solid_convex::{Support, gjk};

use super::Placed;
use crate::bounds::{Aabb, abs};
use crate::shape::Class;

/// How much a world box is grown, relative to the object's extent and position: more than the narrow phase's
/// [`TOUCHING_ERROR`](solid_convex::gjk::TOUCHING_ERROR), so that objects whose boxes are apart are never touching.
const BOUNDS_MARGIN: f64 = 4.0 * gjk::TOUCHING_ERROR;

/// A box of the world around a placed shape. For a complex shape, around its tree's root box (thesis, section 6.3.4).
pub(crate) fn world_bounds(placed: Placed) -> Aabb {
    let (linear, translation) = (&placed.placement.matrix3, placed.placement.translation);
    let bounds = match placed.shape.class() {
        Class::Convex(convex) => convex_bounds(convex, linear),
        Class::Complex(complex) => complex.bounds().transformed(&DAffine3::from_mat3(*linear)),
    };
    let extent = bounds.min.abs().max(bounds.max.abs()).max_element();
    let margin = bounds_margin(extent + 1e-3 * translation.abs().max_element());
    Aabb::new(bounds.min + translation, bounds.max + translation).inflated(margin)
}

/// How much a world box is grown that has this part in the size of the data.
pub(super) fn bounds_margin(size: f64) -> f64 {
    BOUNDS_MARGIN * size
}

/// The smallest box around the image of a convex shape under a linear map, up to rounding.
pub(super) fn convex_bounds(shape: &dyn Support, linear: &DMat3) -> Aabb {
    if let Some(edges) = shape.half_edges() {
        let [x, y, z] = edges.map(|edge| (*linear * edge).abs());
        let (center, half) = (*linear * shape.center(), x + y + z);
        return Aabb::new(center - half, center + half);
    }
    if let Some((ends, radius)) = core(shape) {
        let rows = linear.transpose();
        let half = radius * DVec3::new(length(rows.x_axis), length(rows.y_axis), length(rows.z_axis));
        let Aabb { min, max } = Aabb::of_points(ends.map(|end| *linear * end));
        return Aabb::new(min - half, max + half);
    }
    let [min, max] = shape.image_bounds(linear);
    Aabb::new(min, max)
}

/// The core of what is round, and its radius: of a capsule the ends of a segment on the axis y, of a ball twice its centre.
pub(super) fn core(shape: &dyn Support) -> Option<([DVec3; 2], f64)> {
    let radius = shape.core_radius();
    (radius > 0.0).then(|| ([shape.core_support(DVec3::NEG_Y), shape.core_support(DVec3::Y)], radius))
}

/// The length of a vector whose square may not be a number.
fn length(v: DVec3) -> f64 {
    let largest = v.abs().max_element();
    if largest > 0.0 { largest * (v / largest).length() } else { 0.0 }
}

/// The largest magnitude of each coordinate over the image of a box under a linear map.
pub(super) fn image_reach(linear: &DMat3, reach: DVec3) -> DVec3 {
    abs(linear) * reach
}
