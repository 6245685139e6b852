//! How far the images of what the kinds consist of reach, under linear maps: closed forms of [`image_bounds`](crate::Support::image_bounds).

use glam::DVec3;

use crate::size::PLAIN;
use crate::unit_scale;

/// How far the image of a segment, disc or ball of radius 1 reaches along each axis, from the images of one, two or three unit vectors that
/// span it at right angles: the lengths of the rows of the map. Rows are right up to a rounding error of the longest.
#[inline(always)] // into a kernel
pub(super) fn reach<const N: usize>(spanning: [DVec3; N]) -> DVec3 {
    let squares = squared_rows(&spanning);
    if PLAIN.contains(&squares.max_element()) {
        return DVec3::new(squares.x.sqrt(), squares.y.sqrt(), squares.z.sqrt());
    }
    scaled_reach(spanning)
}

#[inline(always)]
fn squared_rows(spanning: &[DVec3]) -> DVec3 {
    let mut squares = DVec3::ZERO;
    for &column in spanning {
        squares += column * column;
    }
    squares
}

/// The same by the largest coordinate.
#[cold]
fn scaled_reach<const N: usize>(spanning: [DVec3; N]) -> DVec3 {
    let largest = spanning.iter().fold(0.0, |largest, column| column.abs().max_element().max(largest));
    let scale = unit_scale(largest);
    let squares = squared_rows(&spanning.map(|column| column * scale));
    DVec3::new(squares.x.sqrt(), squares.y.sqrt(), squares.z.sqrt()) / scale
}

/// What reaches as far to either side.
#[inline(always)]
pub(super) fn symmetric(half: DVec3) -> [DVec3; 2] {
    [-half, half]
}

#[cfg(test)]
mod tests {
    use glam::DMat3;
    use rand::Rng;
    use solid_oracle::generate::seeded;

    use crate::support::bounds_by_supports;
    use crate::testing::in_cube;
    use crate::{Capsule, Cone, Cuboid, Cylinder, Sphere, Support};

    /// Law: the closed form bounds what six support points do, up to rounding: at any size, under any linear map.
    #[test]
    fn closed_forms_bound_what_support_points_do() {
        /// Relative to the extent of the image: of a few sums of three products, and a root.
        const ERROR: f64 = 16.0 * f64::EPSILON;
        let mut rng = seeded(240);
        for case in 0..2000 {
            let scale = 10_f64.powi(rng.random_range(-90..90));
            let mut size = || scale * rng.random_range(0.01..1.0);
            let shapes: [&dyn Support; 5] = [
                &Sphere::new(size()).unwrap(),
                &Capsule::new(size(), size()).unwrap(),
                &Cuboid::new(glam::DVec3::new(size(), size(), size())).unwrap(),
                &Cylinder::new(size(), size()).unwrap(),
                &Cone::new(size(), size()).unwrap(),
            ];
            // Of every other case a map that leaves axes axes, as of what stands upright.
            let turn = if case % 2 == 0 {
                DMat3::IDENTITY
            } else {
                DMat3::from_cols_array(&std::array::from_fn(|_| rng.random_range(-1.0..1.0)))
            };
            let exponent = if case % 3 == 0 { 90 } else { 3 };
            let stretch = in_cube(&mut rng) * 10_f64.powi(rng.random_range(-exponent..=exponent));
            let linear = turn * DMat3::from_diagonal(stretch);
            for (kind, shape) in shapes.into_iter().enumerate() {
                let [closed, supports] = [shape.image_bounds(&linear), bounds_by_supports(shape, &linear)];
                let off = (closed[0] - supports[0]).abs().max((closed[1] - supports[1]).abs()).max_element();
                let extent = supports[0].abs().max(supports[1].abs()).max_element();
                assert!(off <= ERROR * extent, "{case}, shape {kind}: {:e} of the extent", off / extent);
            }
        }
    }
}
