//! The closest points of two polytopes, from the features that they were on to those nearby (thesis, section 4.4.3).

use std::ops::RangeInclusive;

use fearless_simd::{Simd, f64x4, prelude::*};
use glam::{DAffine3, DVec3};

use super::coherent::Memory;
use super::pairs::{Pairs, Points, images, point, put};
use super::{ClosestInWorld, DISTANCE_TOLERANCE};
use crate::Polytope;
use crate::difference::SUPPORT_ERROR;
use crate::feature::{
    VOLUME_ERROR, Within, opposite_of_furthest, sides_of_origin, weights_of_origin, within_edge, within_face,
};
use crate::polytope_difference::is_plain;
use crate::similarity::rough_squares;

/// Features that are looked at before it gives up. From one frame to the next nine of ten closest points stay on theirs, and nearly all of the
/// others are on the second or third; more cost objects that jumped more than they spare others.
const FEATURES_MAX: usize = 4;

/// Where a support point of objects that are apart is nearer than the feature by more than this part of the size of the data, they jumped: a search
/// from nothing is better.
const JUMP_MIN: f64 = 1.0 / 16.0;

/// The square of the sine of an angle below which a face is not measured: of another, what is found is off by at most some 64 times rounding.
const SLIVER_SINE_SQUARED: f64 = 1.0 / 4096.0;

/// Sizes of the data of which a product of four lengths neither overflows nor loses digits.
const PLAIN_SIZES: RangeInclusive<f64> = 1e-35..=1e35;

/// The closest points, by a walk that begins with the pairs of points that were kept, and keeps those that it ends with. Where the closest point of
/// their hull needs all of them, a support point of each object shows that nothing is nearer, or is one pair more; where it does not, the corner is
/// dropped beyond whose opposite it is. Four with the origin between them make a common point. `None` says nothing. Placements of an answer are
/// finite, far from singular and of plain size.
///
/// The steps are those of Wolfe's algorithm (Finding the nearest point in a polytope, 1976, Math. Programming 11), but for the one that makes each
/// shorten the distance: a walk of few features does without. Everything is measured in the world, so that nothing waits for a unit of length.
#[inline(always)]
pub(super) fn closest<S: Simd>(
    simd: S,
    memory: &mut Memory,
    (a, at_a): (&Polytope, &DAffine3),
    (b, at_b): (&Polytope, &DAffine3),
) -> Option<ClosestInWorld> {
    let [stretch_a, stretch_b] = rough_squares(simd, [at_a, at_b]).or_else(
        #[inline(always)]
        || squares_if_plain(simd, [at_a, at_b]),
    )?;
    let offset = at_b.translation - at_a.translation;
    // As much as any coordinate of the difference.
    let size = stretch_a.sqrt() * a.farthest() + stretch_b.sqrt() * b.farthest() + offset.abs().max_element();
    if !PLAIN_SIZES.contains(&size) {
        return None;
    }
    let (error, volume_error) = (SUPPORT_ERROR * size, VOLUME_ERROR * size * size * size);
    let mut corners = Corners::new(simd, &memory.pairs, [at_a, at_b], offset);
    // Of few points, to find the greatest product alone is faster; of many, its point comes with it.
    let few = Polytope::are_few([a, b]);
    let mut furthest = [DVec3::ZERO; 2];
    let mut moved = false;
    for _ in 0..FEATURES_MAX {
        let (v, weights) = match corners.nearest(memory.pairs.len(), volume_error) {
            Nearest::Inside(v, weights) => (v, weights),
            Nearest::Beyond(corner) => {
                corners.remove(simd, memory.pairs_to_change(), corner);
                moved = true;
                continue;
            }
            Nearest::Unknown => return None,
        };
        let square = v.length_squared();
        if memory.pairs.len() == 4 {
            return (square <= error * error).then(
                #[inline(always)]
                || corners.closest(simd, (0.0, v), weights, at_a),
            );
        }
        let along = [at_a.matrix3.mul_transpose_vec3(-v), at_b.matrix3.mul_transpose_vec3(v)];
        let [of_a, of_b] = Polytope::greatest_of_both(simd, [a, b], along, &mut furthest);
        let least = -(of_a + of_b + v.dot(offset));
        if (least > error * v.abs().element_sum()) & (square - least <= DISTANCE_TOLERANCE * square) {
            let distance = square.sqrt();
            if moved {
                memory.axis = v / distance;
            }
            return Some(corners.closest(simd, (distance, v), weights, at_a));
        }
        let (nearer, far) = (square - least, JUMP_MIN / SUPPORT_ERROR * error);
        if (least > 0.0) & (nearer * nearer > far * far * square) {
            memory.pairs_to_change().set_len(0);
            return None;
        }
        if few {
            let [on_a, on_b] = Polytope::furthest_of_both(simd, [a, b], along);
            furthest = [on_a.point, on_b.point];
        }
        let [on_a, on_b] = furthest;
        corners.add(simd, memory.pairs_to_change(), [on_a, on_b], [at_a, at_b], offset);
        moved = true;
    }
    None
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

/// The kept pairs where they are now. Space: world.
struct Corners {
    /// The points of `A`, less its translation.
    on_a: Points,
    /// From those of `B`.
    w: Points,
}

/// Where the point closest to the origin is, of the hull of some corners.
enum Nearest {
    /// It needs all of them, with these weights.
    Inside(DVec3, [f64; 4]),
    /// It is beyond what is opposite this corner.
    Beyond(usize),
    /// Not known.
    Unknown,
}

impl Corners {
    #[inline(always)]
    fn new<S: Simd>(simd: S, pairs: &Pairs, [at_a, at_b]: [&DAffine3; 2], offset: DVec3) -> Corners {
        let (on_a, on_b) = (images(simd, &at_a.matrix3, &pairs.a), images(simd, &at_b.matrix3, &pairs.b));
        let mut corners = Corners { on_a: Points::default(), w: Points::default() };
        for i in 0..3 {
            on_a[i].store_slice(&mut corners.on_a[i]);
            (on_a[i] - (on_b[i] + f64x4::splat(simd, offset[i]))).store_slice(&mut corners.w[i]);
        }
        corners
    }

    /// Of the first `len`; of four, the origin, as it is by the weights, if it is inside by more than an error of six times a volume.
    #[inline(always)]
    fn nearest(&self, len: usize, volume_error: f64) -> Nearest {
        let [p, q, r, s] = [point(&self.w, 0), point(&self.w, 1), point(&self.w, 2), point(&self.w, 3)];
        match len {
            1 => Nearest::Inside(p, [1.0, 0.0, 0.0, 0.0]),
            2 => match within_edge([p, q]) {
                Ok((v, [x, y])) => Nearest::Inside(v, [x, y, 0.0, 0.0]),
                Err(end) => Nearest::Beyond(1 - end),
            },
            3 => match within_face([p, q, r], SLIVER_SINE_SQUARED) {
                Within::Face(v, [x, y, z]) => Nearest::Inside(v, [x, y, z, 0.0]),
                Within::Beyond(corner) => Nearest::Beyond(corner),
                Within::Sliver => Nearest::Unknown,
            },
            4 => {
                let (sides, least) = sides_of_origin([p, q, r, s]);
                if sides[0].min(sides[1]).min(sides[2].min(sides[3])) <= 0.0 {
                    return Nearest::Beyond(opposite_of_furthest([p, q, r, s], sides));
                }
                let weights = weights_of_origin(sides);
                let v = p * weights[0] + q * weights[1] + r * weights[2] + s * weights[3];
                if least > volume_error { Nearest::Inside(v, weights) } else { Nearest::Unknown }
            }
            _ => Nearest::Unknown,
        }
    }

    /// Adds a pair.
    #[inline(always)]
    fn add<S: Simd>(
        &mut self,
        simd: S,
        pairs: &mut Pairs,
        [a, b]: [DVec3; 2],
        [at_a, at_b]: [&DAffine3; 2],
        offset: DVec3,
    ) {
        let (on_a, on_b) = (at_a.matrix3 * a, at_b.matrix3 * b);
        let at = pairs.len();
        put(simd, &mut pairs.a, at, a);
        put(simd, &mut pairs.b, at, b);
        put(simd, &mut self.on_a, at, on_a);
        put(simd, &mut self.w, at, on_a - (on_b + offset));
        pairs.set_len(at + 1);
    }

    /// Removes a pair: the last takes its place.
    #[inline(always)]
    fn remove<S: Simd>(&mut self, simd: S, pairs: &mut Pairs, corner: usize) {
        let last = pairs.len() - 1;
        for points in [&mut self.on_a, &mut self.w, &mut pairs.a, &mut pairs.b] {
            let p = point(points, last);
            put(simd, points, corner, p);
        }
        pairs.set_len(last);
    }

    /// The closest points, at their distance and with the way from that of `B`, by the weights of the corners.
    #[inline(always)]
    fn closest<S: Simd>(
        &self,
        simd: S,
        (distance, v): (f64, DVec3),
        weights: [f64; 4],
        at_a: &DAffine3,
    ) -> ClosestInWorld {
        let point_on_a = combination(simd, &self.on_a, f64x4::simd_from(simd, weights)) + at_a.translation;
        ClosestInWorld { distance, point_on_a, point_on_b: point_on_a - v }
    }
}

/// The sum of points, each times its weight.
#[inline(always)]
fn combination<S: Simd>(simd: S, [x, y, z]: &Points, weights: f64x4<S>) -> DVec3 {
    let x = f64x4::simd_from(simd, *x) * weights;
    let y = f64x4::simd_from(simd, *y) * weights;
    let z = f64x4::simd_from(simd, *z) * weights;
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
    use crate::gjk::pairs::Pair;
    use crate::gjk::{Memory, closest_points};
    use crate::simd::{dispatch, levels};
    use crate::testing::placement;

    /// What a placement does to an object beside turning it.
    const LINEARS: [DMat3; 3] = [
        DMat3::IDENTITY,
        DMat3::from_cols(DVec3::new(2.0, 0.0, 0.0), DVec3::new(0.0, 0.5, 0.0), DVec3::new(0.0, 0.0, 1.0)),
        DMat3::from_cols(DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.9, 0.7, 0.0), DVec3::new(-0.3, 0.8, 0.6)),
    ];

    /// Law: after a motion, in any unit, stretched and sheared, it says what a search from nothing says, within its error, and each level the
    /// same to the bit, and keeps the same. After a small one it nearly always says something, and mostly after a large one.
    #[test]
    fn it_says_what_a_search_from_nothing_says() {
        let cloud = |count: u32, seed: u32| {
            Polytope::new((seed..seed + count).map(|k| placement(k).translation).collect()).unwrap()
        };
        let (mut asked, mut hits) = (0, 0);
        let mut told = [0, 0];
        for (i, (count, other)) in [(1, 20), (4, 8), (20, 20), (24, 25), (100, 60)].into_iter().enumerate() {
            let (a, b) = (cloud(count, 1), cloud(other, 500));
            for k in 0..600 {
                let unit = [1.0, 1e-9, 1e28, 1e9][k as usize % 4];
                let place = |seed: u32, linear: usize, moved: f64| {
                    let (at, way) = (placement(seed), placement(seed + 5));
                    let turn = DMat3::from_axis_angle(way.translation.normalize(), moved);
                    let spread = [1.0, 3.0][k as usize / 4 % 2];
                    DAffine3 {
                        matrix3: turn * at.matrix3 * LINEARS[linear] * unit,
                        translation: (at.translation * spread + way.translation * moved) * unit,
                    }
                };
                let moves = [0.0, [0.004, 0.3][k as usize / 8 % 2]];
                let [a_before, a_now] = moves.map(|moved| place(k, k as usize % 3, moved));
                let [b_before, b_now] = moves.map(|moved| place(3 * k + 1, (i + k as usize / 3) % 3, moved));
                let mut memory = Memory::default();
                memory.closest_points(&a, &a_before, &b, &b_before);
                let (on_a, on_b) = ((&a, &a_now), (&b, &b_now));
                let [found, wide] = levels().map(|level| {
                    let mut memory = memory;
                    let found = dispatch!(level, simd => closest(simd, &mut memory, on_a, on_b));
                    (found, memory.pairs.all().map(|Pair { a, b, .. }| [a, b]))
                });
                assert_eq!(found, wide, "{count} and {other}, {k}");
                let expected = closest_points(&a, &a_now, &b, &b_now).distance;
                asked += 1;
                hits += usize::from(expected == 0.0);
                let Some(found) = found.0 else { continue };
                told[k as usize / 8 % 2] += 1;
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
        assert!(
            100 * told[0] > 49 * asked && 100 * told[1] > 30 * asked,
            "{told:?} of {asked} were told, half of which moved little"
        );
    }

    /// Law: what touches for a search from nothing has no distance here either, whatever was near before.
    #[test]
    fn what_touches_is_at_no_distance() {
        let block = |seed: u32| {
            let corner =
                |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) - 0.5;
            let turn = placement(seed).matrix3;
            Polytope::new((0..8).map(|i| turn * corner(i)).collect()).unwrap()
        };
        let mut touching = 0;
        for k in 0..2_000 {
            let (a, turn) = (block(k), placement(k).matrix3);
            let at = |x: f64| DAffine3::from_translation(turn * DVec3::new(x, 0.3, -0.2));
            let here = DAffine3::IDENTITY;
            let mut memory = Memory::default();
            memory.closest_points(&a, &here, &a, &at(1.01));
            let gap = [1e-15, 3e-16, -1e-16, 1e-9][k as usize % 4];
            let expected = closest_points(&a, &here, &a, &at(1.0 + gap)).distance;
            let found = memory.quickly_closest(&a, &here, &a, &at(1.0 + gap));
            touching += u32::from(expected == 0.0);
            assert!(
                found.is_none_or(|found| (found.distance == 0.0) == (expected == 0.0)),
                "{k}: {found:?}, {expected:e}"
            );
        }
        assert!(touching > 1_000, "{touching}");
    }

    /// Of sizes whose products overflow or vanish it says nothing.
    #[test]
    fn it_tells_of_plain_sizes_alone() {
        for unit in [1e-90, 1e-60, 1.0, 1e60, 1e90] {
            let cloud = |seed: u32| {
                Polytope::new((seed..seed + 20).map(|k| placement(k).translation * unit).collect()).unwrap()
            };
            let (a, b) = (cloud(1), cloud(50));
            let at = |x: f64| DAffine3::from_translation(DVec3::new(x, 0.1, 0.2) * unit);
            let mut memory = Memory::default();
            memory.closest_points(&a, &at(0.0), &b, &at(4.0));
            let (on_a, there) = ((&a, &at(0.0)), at(4.01));
            let found = dispatch!(levels()[1], simd => closest(simd, &mut memory, on_a, (&b, &there)));
            assert_eq!(found.is_some(), unit == 1.0, "{unit:e}: {found:?}");
        }
    }
}
