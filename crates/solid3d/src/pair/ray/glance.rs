//! A glance at the image of a leaf: which of its triangles a ray surely passes.
//!
//! As in [`triangle`](super::triangle) the ray runs along an axis of a sheared space, through its origin; here in tree coordinates and `f32`.
//! There a corner is at `X = at_min + step * q + lean * r`, where q and r are its coordinates on the grid of the image, across the ray and
//! along it; and so is its Y. Of a triangle that the ray meets no two edges pass the origin on different sides.
//!
//! # The error
//!
//! `X` is to be compared with the coordinate that `Shear::hit` computes, in `f64`, of the corner itself: its edges have exact signs.
//!
//! - The corner is within [`HALF_STEP`] of its image on both axes: `HALF_STEP * (step + |lean|)`.
//! - In `f32`, with u = 2^-24, the coefficients and both products are off by u each, the two sums by u each, relative to at most the sum R of
//!   the magnitudes of all terms: below 6u R, for which [`ROUNDING`] is 8u.
//! - In `f64`, the offset of the grid, the coefficients and the coordinates that are compared with take less than 24 roundings of
//!   2^-53, of numbers up to that of the offset and 2, as the tree lies within 1 and shears are at most 1: [`ROUNDING_F64`] is 32 of them.
//!
//! Let the sum of these be E and F for X and Y, and let |X| <= M, |Y| <= N for all points of the box, both with the error. The
//! determinant of two corners is then off by less than `2 (E N + M F + E F)`, and by three roundings in `f32` of numbers up to 2 M N: less
//! than 6u M N, for which [`ROUNDING`] stands again. What underflows loses less than the least normal number.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};

use super::triangle::Shear;
use crate::tree::{HALF_STEP, Image, Normal, STEPS};

/// 8u: see the module.
const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;

/// 32 roundings: see the module.
const ROUNDING_F64: f64 = 16.0 * f64::EPSILON;

/// A sheared space as seen from tree coordinates.
pub(super) struct Glance {
    axes: [usize; 3],
    shear: [f64; 2],
    /// From the origin of the ray to that of the tree coordinates, in their unit; by axis of space.
    offset: [f64; 3],
    /// What `f64` loses.
    slack: f64,
}

/// A coordinate of the sheared space, over the grid of an image.
struct Across<S: Simd> {
    axis: usize,
    at_min: f32x8<S>,
    step: f32x8<S>,
    lean: f32x8<S>,
    /// How far from the ray its box reaches.
    reach: f64,
    error: f64,
}

impl<S: Simd> Across<S> {
    /// For the axis of a shear given by number.
    #[inline(always)]
    fn new(simd: S, glance: &Glance, image: &Image, i: usize) -> Self {
        let [axis, along] = [glance.axes[i], glance.axes[2]];
        let ((min, step), (min_along, step_along)) = (image.axis(axis), image.axis(along));
        let shear = glance.shear[i];
        let lean = -shear * step_along;
        let at_min = (glance.offset[axis] + min) - shear * (glance.offset[along] + min_along);
        let half = (0.5 * f64::from(STEPS)) * (step + lean.abs());
        let center = at_min + (0.5 * f64::from(STEPS)) * (step + lean);
        let error = HALF_STEP * (step + lean.abs()) + ROUNDING * (at_min.abs() + 2.0 * half) + glance.slack;
        let splat = |x: f64| f32x8::splat(simd, x as f32);
        Across {
            axis,
            at_min: splat(at_min),
            step: splat(step),
            lean: splat(lean),
            reach: center.abs() + half + error,
            error,
        }
    }
}

impl Glance {
    pub fn new(shear: &Shear, normal: &Normal) -> Glance {
        let offset = (normal.origin - shear.origin) * normal.inverse;
        Glance {
            axes: shear.axes,
            shear: shear.shear.to_array(),
            offset: offset.to_array(),
            slack: ROUNDING_F64 * (offset.abs().max_element() + 2.0),
        }
    }

    /// The lanes of an image whose triangle the ray may meet, as bits; and any beyond those in use.
    #[inline(always)]
    pub fn candidates<S: Simd>(&self, simd: S, image: &Image) -> u32 {
        let (x, y) = (Across::new(simd, self, image, 0), Across::new(simd, self, image, 1));
        let doubt = 2.0 * (x.error * y.reach + x.reach * y.error + x.error * y.error)
            + ROUNDING * x.reach * y.reach
            + f64::from(f32::MIN_POSITIVE);
        // Rounded up.
        let doubt = f32x8::splat(simd, (doubt * (1.0 + ROUNDING)) as f32);
        // Loops, not closures: what is called from a closure is compiled for the baseline, and nothing of it is inlined.
        let mut points = [[doubt; 2]; 3];
        for (corner, point) in points.iter_mut().enumerate() {
            let corner = image.corner(simd, corner);
            let along = corner.along(simd, self.axes[2]);
            point[0] = corner.along(simd, x.axis) * x.step + along * x.lean + x.at_min;
            point[1] = corner.along(simd, y.axis) * y.step + along * y.lean + y.at_min;
        }
        let none = doubt.simd_lt(doubt);
        let (mut left, mut right) = (none, none);
        for [i, j] in [[1, 2], [2, 0], [0, 1]] {
            let area = points[i][0] * points[j][1] - points[i][1] * points[j][0];
            left |= area.simd_gt(doubt);
            right |= (-area).simd_gt(doubt);
        }
        !((left & right).to_bitmask() as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Aabb;
    use crate::tree::{LeafImages, Tree};
    use crate::triangle_triangle::Triangle;
    use glam::DVec3;
    use rand::Rng;
    use rand::rngs::StdRng;
    use solid_convex::simd::{dispatch, levels};
    use solid_oracle::generate::{in_cube, seeded};

    /// Up to eight triangles in a mesh of many, at a place and of a size of their own: near each other, thin, flat or of no area.
    fn leaf(rng: &mut StdRng, case: usize) -> Vec<Triangle> {
        let (place, size) = (in_cube(rng), 10f64.powi(-(case as i32 % 7)));
        (0..rng.random_range(1..=8))
            .map(|_| {
                let (p, q, r) = (in_cube(rng), in_cube(rng), in_cube(rng));
                let corners = match case % 5 {
                    0 => [p, q, p.lerp(q, 0.3) + r * 1e-6],
                    1 => [p, q, r].map(|corner| corner.with_z(0.3)),
                    2 => [p, q, if case % 10 == 2 { q } else { p }],
                    _ => [p, q, r],
                };
                corners.map(|corner| place + corner * size)
            })
            .collect()
    }

    /// Law: what is passed at a glance is not hit, where rays nearly miss too; and what is clearly passed is passed.
    #[test]
    fn what_is_passed_at_a_glance_is_not_hit() {
        let seed = 92;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let (mut candidates, mut hits, mut lanes) = (0, 0, 0);
        for case in 0..6000 {
            let mut triangles = leaf(&mut rng, case);
            let far = [0.0, 1e3, 1e9][case % 3];
            let size = 10f64.powi(rng.random_range(-80..80));
            // The tree lies around them all: two leaves of points.
            let count = triangles.len();
            triangles.extend([[DVec3::splat(-2.0); 3]; 8]);
            triangles.extend([[DVec3::splat(2.0); 3]; 8]);
            triangles.iter_mut().flatten().for_each(|corner| *corner = (*corner + far) * size);
            let boxes: Vec<Aabb> = triangles.iter().map(|corners| Aabb::of_points(*corners)).collect();
            let tree = Tree::build(&boxes);
            let images = LeafImages::new(&tree, triangles.as_flattened(), |i| [3 * i, 3 * i + 1, 3 * i + 2]);
            // At a corner, at an edge, or just beside; at a point inside, or in the box.
            let aimed = triangles[rng.random_range(0..count)];
            let [a, b, c] = aimed;
            let extent = (b - a).abs().max((c - a).abs()).max_element();
            let beside = in_cube(&mut rng) * extent * [0.0, 1e-12, 1e-5, 1e-3][case % 4];
            let inside = a.lerp(b, rng.random_range(0.0..1.0)).lerp(c, rng.random_range(0.0..1.0));
            let target = [a, a.lerp(b, 0.4), inside, a + in_cube(&mut rng) * extent][case / 4 % 4] + beside;
            let mut from =
                target + in_cube(&mut rng) * size * if case % 2 == 0 { 2.0 } else { extent / size };
            if case % 11 == 0 {
                from = target + DVec3::Z * size;
            }
            let direction = target - from;
            if direction == DVec3::ZERO {
                continue;
            }
            let shear = Shear::new(from, direction, DVec3::splat(size * (2.0 + far)));
            let glance = Glance::new(&shear, tree.normal());
            for leaf in tree.leaves() {
                let image = images.of(&leaf);
                let found = levels()
                    .map(|level| dispatch!(level, simd => glance.candidates(simd, &image)) & leaf.lanes());
                assert_eq!(found[0], found[1]);
                let ours = leaf.primitives.iter().enumerate().filter(|(_, i)| (**i as usize) < count);
                for (lane, &primitive) in ours {
                    let is_candidate = found[0] >> lane & 1 == 1;
                    let triangle = &triangles[primitive as usize];
                    let hit = shear.hit(triangle).is_some();
                    assert!(is_candidate || !hit, "case {case}: {triangle:?} from {from} along {direction}");
                    lanes += 1;
                    candidates += u32::from(is_candidate);
                    hits += u32::from(hit);
                }
            }
        }
        println!("{candidates} of {lanes} are candidates, {hits} hit");
        assert!(10 * hits > lanes && 4 * candidates < 3 * lanes);
    }
}
