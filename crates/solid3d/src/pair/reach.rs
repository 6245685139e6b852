//! How far a placed shape reaches.

use fearless_simd::Simd;
use glam::{DAffine3, DMat3, DVec3};
use solid_convex::simd::dispatch;
use solid_convex::{Support, gjk};

use super::Placed;
use crate::bounds::{Aabb, abs};
use crate::shape::{Class, Shape};

/// How much a world box is grown, relative to the object's extent and position: more than the narrow phase's
/// [`TOUCHING_ERROR`](solid_convex::gjk::TOUCHING_ERROR), so that objects whose boxes are apart are never touching.
const BOUNDS_MARGIN: f64 = 4.0 * gjk::TOUCHING_ERROR;

/// A box of the world around a placed shape. For a complex shape, around its tree's root box (thesis, section 6.3.4).
pub(crate) fn world_bounds(placed: Placed) -> Aabb {
    let mut bounds = Aabb::EMPTY;
    dispatch!(simd => world_bounds_into(simd, placed, &mut bounds));
    bounds
}

/// The [`world_bounds`], for kernels that they are a part of: put where they are to be.
#[inline(always)]
pub(crate) fn world_bounds_into<S: Simd>(simd: S, placed: Placed, bounds: &mut Aabb) {
    // In one kernel: what is written by vectors and read by numbers is waited for.
    let DAffine3 { matrix3: linear, translation } = placed.placement;
    *bounds = enclosing(placed.shape.image_bounds(simd, linear), *translation);
}

/// A box around a shape that is placed, from the least and the greatest coordinates of its image under the linear map.
#[inline(always)]
fn enclosing([min, max]: [DVec3; 2], translation: DVec3) -> Aabb {
    // As none of the least is above the greatest, without a look at signs.
    let extent = max.max(-min).max_element();
    let margin = bounds_margin(extent + 1e-3 * translation.abs().max_element());
    Aabb::new(min + translation - margin, max + translation + margin)
}

/// How much a world box is grown that has this part in the size of the data.
#[inline(always)]
pub(super) fn bounds_margin(size: f64) -> f64 {
    BOUNDS_MARGIN * size
}

/// The smallest box around the image of a convex shape under a linear map, up to rounding.
pub(super) fn convex_bounds(shape: &dyn Support, linear: &DMat3) -> Aabb {
    let [min, max] = shape.image_bounds(linear);
    Aabb::new(min, max)
}

/// The core of what is round, and its radius: of a capsule the ends of a segment on the axis y, of a ball twice its centre.
pub(super) fn core(shape: &dyn Support) -> Option<([DVec3; 2], f64)> {
    let radius = shape.core_radius();
    (radius > 0.0).then(|| ([shape.core_support(DVec3::NEG_Y), shape.core_support(DVec3::Y)], radius))
}

/// How far a shape reaches from its local origin.
pub(super) fn reach(shape: &Shape) -> DVec3 {
    match shape.class() {
        Class::Convex(convex) => convex.reach(),
        Class::Complex(complex) => complex.reach(),
    }
}

/// The largest magnitude of each coordinate over the image of a box under a linear map.
#[inline(always)]
pub(super) fn image_reach(linear: &DMat3, reach: DVec3) -> DVec3 {
    abs(linear) * reach
}
