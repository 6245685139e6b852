//! The closest points of two polytopes, where they are on the features that they were on (thesis, section 4.4.3).

use std::ops::RangeInclusive;

use fearless_simd::{Simd, f64x4, prelude::*};
use glam::{DAffine3, DVec3};

use super::pairs::{Pairs, images};
use super::{ClosestInWorld, DISTANCE_TOLERANCE};
use crate::difference::SUPPORT_ERROR;
use crate::polytope_difference::is_plain;
use crate::similarity::rough_squares;
use crate::simplex::{VOLUME_ERROR, Within, sides_of_origin, weights_of_origin, within_edge, within_face};
use crate::{Polytope, Support};

/// Sizes of the data of which a product of four lengths neither overflows nor loses digits.
const PLAIN_SIZES: RangeInclusive<f64> = 1e-35..=1e35;

/// The closest points between the kept pairs of points, if no support point is nearer; of four pairs, a common point, if they have the
/// origin between them. `None` says nothing. Placements of an answer are finite, far from singular and of plain size.
///
/// Everything is measured in the world, so that nothing waits for a unit of length.
#[inline(always)]
pub(super) fn closest<S: Simd>(
    simd: S,
    pairs: &Pairs,
    (a, at_a): (&Polytope, &DAffine3),
    (b, at_b): (&Polytope, &DAffine3),
) -> Option<ClosestInWorld> {
    let [stretch_a, stretch_b] = rough_squares(simd, [at_a, at_b]).or_else(
        #[inline(always)]
        || squares_if_plain(simd, [at_a, at_b]),
    )?;
    let offset = at_b.translation - at_a.translation;
    let (on_a, on_b) = (images(simd, &at_a.matrix3, &pairs.a), images(simd, &at_b.matrix3, &pairs.b));
    let mut w = [[0.0; 4]; 3];
    for i in 0..3 {
        (on_a[i] - (on_b[i] + f64x4::splat(simd, offset[i]))).store_slice(&mut w[i]);
    }
    // As much as any coordinate of the difference.
    let size = (stretch_a * a.reach().length_squared()).sqrt()
        + (stretch_b * b.reach().length_squared()).sqrt()
        + offset.abs().max_element();
    let (v, weights) = nearest(&w, pairs.len(), VOLUME_ERROR * size * size * size)?;
    let square = v.length_squared();
    let error = SUPPORT_ERROR * size;
    let sure = if pairs.len() < 4 {
        // One support point of each shows that nothing is nearer.
        let along = [at_a.matrix3.mul_transpose_vec3(-v), at_b.matrix3.mul_transpose_vec3(v)];
        let [of_a, of_b] = Polytope::greatest_of_both(simd, [a, b], along);
        let least = -(of_a + of_b + v.dot(offset));
        (least > error * v.abs().element_sum()) & (square - least <= DISTANCE_TOLERANCE * square)
    } else {
        square <= error * error
    };
    let weights = f64x4::simd_from(simd, weights);
    (sure & PLAIN_SIZES.contains(&size)).then(
        #[inline(always)]
        || ClosestInWorld {
            distance: if pairs.len() < 4 { square.sqrt() } else { 0.0 },
            point_on_a: combination(on_a, weights) + at_a.translation,
            point_on_b: combination(on_b, weights) + at_b.translation,
        },
    )
}

/// Bounds on the squares of how much plain placements stretch; `None` unless both are plain.
#[inline(always)]
fn squares_if_plain<S: Simd>(simd: S, placements: [&DAffine3; 2]) -> Option<[f64; 2]> {
    let [a, b] = placements;
    let squares = placements.map(|at| {
        let axes = &at.matrix3;
        axes.x_axis.length_squared() + axes.y_axis.length_squared() + axes.z_axis.length_squared()
    });
    (is_plain(simd, a) & is_plain(simd, b)).then_some(squares)
}

/// The point of the hull of the first `len` points nearest to the origin, with its weights, if it needs all of them; of four, the origin, as
/// it is by the weights, if it is inside by more than an error of six times a volume.
#[inline(always)]
fn nearest(w: &[[f64; 4]; 3], len: usize, volume_error: f64) -> Option<(DVec3, [f64; 4])> {
    let point = {
        #[inline(always)]
        |k: usize| DVec3::new(w[0][k], w[1][k], w[2][k])
    };
    let [p, q, r, s] = [point(0), point(1), point(2), point(3)];
    match len {
        1 => Some((p, [1.0, 0.0, 0.0, 0.0])),
        2 => match within_edge([p, q]) {
            Ok((v, [x, y])) => Some((v, [x, y, 0.0, 0.0])),
            Err(_) => None,
        },
        3 => match within_face([p, q, r]) {
            Within::Face(v, [x, y, z]) => Some((v, [x, y, z, 0.0])),
            Within::Outside | Within::Sliver => None,
        },
        4 => {
            let (sides, least) = sides_of_origin([p, q, r, s]);
            let inside = sides[0].min(sides[1]).min(sides[2].min(sides[3])) > 0.0;
            let weights = weights_of_origin(sides);
            let v = p * weights[0] + q * weights[1] + r * weights[2] + s * weights[3];
            if inside && least > volume_error { Some((v, weights)) } else { None }
        }
        _ => None,
    }
}

/// The sum of points by coordinate, each times its weight.
#[inline(always)]
fn combination<S: Simd>([x, y, z]: [f64x4<S>; 3], weights: f64x4<S>) -> DVec3 {
    let (x, y, z) = (x * weights, y * weights, z * weights);
    let (xy, more_xy) = (x.zip_low(y) + x.zip_high(y)).split();
    let (z, more_z) = z.split();
    let (xy, z) = (xy + more_xy, z + more_z);
    let (xy, z) = (xy.as_slice(), z.as_slice());
    DVec3::new(xy[0], xy[1], z[0] + z[1])
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::*;
    use crate::gjk::{Memory, closest_points};
    use crate::simd::{dispatch, levels};
    use crate::testing::placement;

    /// What a placement does to an object beside turning it.
    const LINEARS: [DMat3; 3] = [
        DMat3::IDENTITY,
        DMat3::from_cols(DVec3::new(2.0, 0.0, 0.0), DVec3::new(0.0, 0.5, 0.0), DVec3::new(0.0, 0.0, 1.0)),
        DMat3::from_cols(DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.9, 0.7, 0.0), DVec3::new(-0.3, 0.8, 0.6)),
    ];

    /// Law: after a small motion, in any unit, stretched and sheared, it says what a search from nothing says, within its error, and each level
    /// the same to the bit. And mostly it does say something.
    #[test]
    fn it_says_what_a_search_from_nothing_says() {
        let cloud = |count: u32, seed: u32| {
            Polytope::new((seed..seed + count).map(|k| placement(k).translation).collect()).unwrap()
        };
        let (mut asked, mut told, mut hits) = (0, 0, 0);
        for (i, (count, other)) in [(1, 20), (4, 8), (20, 20), (24, 25), (100, 60)].into_iter().enumerate() {
            let (a, b) = (cloud(count, 1), cloud(other, 500));
            for k in 0..600 {
                let unit = [1.0, 1e-9, 1e30, 1e9][k as usize % 4];
                let place = |seed: u32, linear: usize, moved: f64| {
                    let (at, way) = (placement(seed), placement(seed + 5));
                    let turn = DMat3::from_axis_angle(way.translation.normalize(), moved);
                    let spread = [1.0, 3.0][k as usize / 4 % 2];
                    DAffine3 {
                        matrix3: turn * at.matrix3 * LINEARS[linear] * unit,
                        translation: (at.translation * spread + way.translation * moved) * unit,
                    }
                };
                let [a_before, a_now] = [0.0, 0.004].map(|moved| place(k, k as usize % 3, moved));
                let [b_before, b_now] =
                    [0.0, 0.004].map(|moved| place(3 * k + 1, (i + k as usize / 3) % 3, moved));
                let mut memory = Memory::default();
                memory.closest_points(&a, &a_before, &b, &b_before);
                let (pairs, on_a, on_b) = (&memory.pairs, (&a, &a_now), (&b, &b_now));
                let [found, wide] =
                    levels().map(|level| dispatch!(level, simd => closest(simd, pairs, on_a, on_b)));
                assert_eq!(found, wide, "{count} and {other}, {k}");
                let expected = closest_points(&a, &a_now, &b, &b_now).distance;
                asked += 1;
                hits += usize::from(expected == 0.0);
                let Some(found) = found else { continue };
                told += 1;
                let between = found.point_on_a.distance(found.point_on_b);
                for distance in [found.distance, between] {
                    assert!(
                        (distance - expected).abs() <= 1e-12 * unit,
                        "{count} and {other}, {k}: {found:?}, {expected:e}"
                    );
                }
            }
        }
        assert!((20..=80).contains(&(100 * hits / asked)), "{hits} of {asked}: not representative");
        assert!(10 * told > 7 * asked, "{told} of {asked} were told");
    }
}
