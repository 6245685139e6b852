//! How far a placed shape reaches.

use std::ops::RangeInclusive;

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
    let DAffine3 { matrix3: linear, translation } = placed.placement;
    match placed.shape.polytope() {
        // In one kernel: what is written by vectors and read by numbers is waited for.
        Some(polytope) => *bounds = enclosing(polytope.image_bounds_by(simd, linear), *translation),
        None => *bounds = others_world_bounds(placed),
    }
}

/// The same of what is no polytope.
#[inline(never)]
fn others_world_bounds(placed: Placed) -> Aabb {
    let DAffine3 { matrix3: linear, translation } = placed.placement;
    let Aabb { min, max } = match placed.shape.class() {
        Class::Convex(convex) => convex_bounds(convex, linear),
        Class::Complex(complex) => complex.bounds().transformed(&DAffine3::from_mat3(*linear)),
    };
    enclosing([min, max], *translation)
}

/// A box around a shape that is placed, from the least and the greatest coordinates of its image under the linear map.
#[inline(always)]
fn enclosing([min, max]: [DVec3; 2], translation: DVec3) -> Aabb {
    let extent = min.abs().max(max.abs()).max_element();
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
    /// Squares of lengths that lose no digits.
    const PLAIN: RangeInclusive<f64> = 1e-200..=1e200;
    let square = v.length_squared();
    if PLAIN.contains(&square) {
        return square.sqrt();
    }
    let largest = v.abs().max_element();
    if largest > 0.0 { largest * (v / largest).length() } else { 0.0 }
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

#[cfg(test)]
mod tests {
    use rand::Rng;
    use solid_convex::{Capsule, Cuboid, Sphere};
    use solid_oracle::generate::seeded;

    use super::*;

    /// Law: the box of a closed form is that of six support points, up to rounding: at any size, under any linear map.
    #[test]
    fn closed_forms_bound_what_support_points_do() {
        /// Relative to the extent of the image: of a few sums of three products, and a root.
        const ERROR: f64 = 16.0 * f64::EPSILON;
        let mut rng = seeded(240);
        for case in 0..1000 {
            let scale = 10_f64.powi(rng.random_range(-6..7));
            let mut size = || scale * rng.random_range(0.01..1.0);
            let shapes: [&dyn Support; 3] = [
                &Sphere::new(size()).unwrap(),
                &Capsule::new(size(), size()).unwrap(),
                &Cuboid::new(DVec3::new(size(), size(), size())).unwrap(),
            ];
            let stretch = DVec3::from_array(std::array::from_fn(|_| 10_f64.powi(rng.random_range(-3..4))));
            let mut column = || DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)));
            let linear = DMat3::from_cols(column(), column(), column()) * DMat3::from_diagonal(stretch);
            for (kind, shape) in shapes.into_iter().enumerate() {
                let closed = convex_bounds(shape, &linear);
                let [min, max] = shape.image_bounds(&linear);
                let off = (closed.min - min).abs().max((closed.max - max).abs()).max_element();
                let extent = min.abs().max(max.abs()).max_element();
                assert!(off <= ERROR * extent, "{case}, shape {kind}: {:e} of the extent", off / extent);
            }
        }
    }
}
