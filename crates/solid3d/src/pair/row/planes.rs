//! The lanes that a plane parts from a triangle: the first two signs of the exact test, where rounding cannot change them.
//!
//! The corners `p` of one triangle lie to the plane of another, through `o` along the edges `e` and `f`, as the sign of
//! the determinant of `p - o`, `e`, `f`, expanded by its first row. Shewchuk (*Adaptive precision floating-point
//! arithmetic*, 1997, section 4.3) bounds the error of that, with u = 2^-53, by (7 + 56u) u times the same expression of
//! magnitudes. Here the magnitudes of `p - o` are the greatest over the three corners, and 10u is taken, which pays for the
//! rounding of the bound. What underflows loses less than [`UNDERFLOW`], as coordinates of the common frame are below 2.

use fearless_simd::Simd;
use fearless_simd::prelude::*;

use super::{Row, Vector, cross, dot, minus, one, splat_triangle, steps};
use crate::pair::triangle_triangle::Triangle;

/// 10u: see the module.
const ROUNDING: f64 = 5.0 * f64::EPSILON;

/// More than a dozen of the least numbers.
const UNDERFLOW: f64 = f64::MIN_POSITIVE;

/// The lanes whose triangle is certainly apart from `x`, by the plane of either, as bits.
#[inline(never)] // see `distances`
pub(crate) fn parted<S: Simd>(simd: S, x: &Triangle, row: &Row) -> u32 {
    simd.vectorize(
        #[inline(always)]
        || parted_on(simd, x, row),
    )
}

#[inline(always)]
fn parted_on<S: Simd>(simd: S, x: &Triangle, row: &Row) -> u32 {
    let x = splat_triangle(simd, x);
    let mut lanes = 0;
    for from in steps::<S>() {
        let y = row.corners(simd, from);
        lanes |= (by_plane(simd, &y, &x) | by_plane(simd, &x, &y)) << from;
    }
    lanes
}

/// The lanes in which the plane of one triangle has the other wholly on one side, as bits.
#[inline(always)]
fn by_plane<S: Simd>(simd: S, plane: &[Vector<S>; 3], corners: &[Vector<S>; 3]) -> u32 {
    let (e, f) = (minus(plane[1], plane[0]), minus(plane[2], plane[0]));
    let normal = cross(e, f);
    let [p, q, r] = [minus(corners[0], plane[0]), minus(corners[1], plane[0]), minus(corners[2], plane[0])];
    let mut magnitude = one(simd, 0.0);
    for axis in 0..3 {
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        let minor = (e.0[j] * f.0[k]).abs() + (e.0[k] * f.0[j]).abs();
        magnitude += minor * p.0[axis].abs().max(q.0[axis].abs()).max(r.0[axis].abs());
    }
    let error = magnitude * one(simd, ROUNDING) + one(simd, UNDERFLOW);
    let (p, q, r) = (dot(normal, p), dot(normal, q), dot(normal, r));
    let above = p.min(q).min(r).simd_gt(error);
    let below = p.max(q).max(r).simd_lt(-error);
    (above | below).to_bitmask() as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair::row::tests::row_of;
    use crate::pair::triangle_triangle::intersect;
    use glam::DVec3;
    use rand::Rng;
    use solid_convex::simd::dispatch;
    use solid_convex::simd::levels;
    use solid_oracle::generate::seeded;

    /// Triangles one unit in the last place from touching: what is said to be parted is apart, and most that are apart far
    /// enough are said to be. All levels of instructions say the same.
    #[test]
    fn nothing_that_meets_is_parted_even_at_the_last_bit() {
        let seed = 30;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let (mut apart, mut hits, mut parted_lanes) = (0, 0, 0);
        for case in 0..6000 {
            let mut point = || DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)));
            let x: Triangle = [point(), point(), point()];
            let normal = (x[1] - x[0]).cross(x[2] - x[0]).normalize();
            // Corners near the plane of x, off by rounding or by a little more; the rest on one side.
            let off = [0.0, 1e-16, 1e-15, 1e-3, -1e-6, -1e-7][case % 6];
            let ys = std::array::from_fn(|lane| {
                let (s, t) = ((lane as f64 + 0.5) / 16.0, 0.3);
                let near = x[0] + (x[1] - x[0]) * s + (x[2] - x[0]) * t * (1.0 - s) + normal * off;
                let tiny = if lane % 2 == 0 { 1.0 } else { 1e-5 };
                [near, near + (normal + point() * 0.3) * tiny, near + (normal * 2.0 + point() * 0.3) * tiny]
            });
            let row = row_of(&ys);
            let lanes = levels().map(|level| dispatch!(level, simd => parted(simd, &x, &row)));
            assert!(lanes.iter().all(|&l| l == lanes[0]), "{lanes:?}");
            for (lane, y) in ys.iter().enumerate() {
                let meet = intersect(&x, y);
                let parted = lanes[0] >> lane & 1 == 1;
                assert!(!(meet && parted), "case {case}, lane {lane}: {x:?} {y:?}");
                hits += i32::from(meet);
                apart += i32::from(!meet);
                parted_lanes += i32::from(parted);
            }
        }
        println!("{hits} meet, {apart} are apart, {parted_lanes} of them parted");
        assert!((48_000 * 3 / 10..48_000 * 7 / 10).contains(&hits) && parted_lanes * 3 > apart);
    }
}
