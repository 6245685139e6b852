//! The Minkowski difference of two placed polytopes, for kernels.

use fearless_simd::{Simd, f64x4, prelude::*};
use glam::{DAffine3, DVec3};

use crate::difference::{Difference, MinkowskiDifference, NO_VERTEX, SupportPoint, start_along};
use crate::size::PLAIN_SQUARES;
use crate::{MAGNITUDE_MAX, Polytope, Support, unit_scale};

/// The least squared volume between the axes of a plain placement, brought to unit length. Far above what rounding makes of nothing.
const PLAIN_VOLUME_SQUARED: f64 = 1e-18;

/// A [`Difference`] of polytopes whose support points are found by a kernel.
pub(crate) struct Scanned<'d, A: ?Sized, B: ?Sized, S> {
    pub simd: S,
    pub difference: &'d Difference<'d, A, B>,
    /// Its objects.
    pub polytopes: [&'d Polytope; 2],
}

impl<A, B, S> MinkowskiDifference for Scanned<'_, A, B, S>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
    S: Simd,
{
    #[inline(always)]
    fn support_against(&self, v: DVec3) -> SupportPoint {
        let (simd, [a, b]) = (self.simd, self.polytopes);
        self.difference.point_against(
            v,
            #[inline(always)]
            |d| a.furthest(simd, d),
            #[inline(always)]
            |d| b.furthest(simd, d),
        )
    }

    #[inline(always)]
    fn point(&self, a: DVec3, b: DVec3) -> SupportPoint {
        self.difference.point(a, b)
    }

    fn vertices(&self, indices: [u16; 2]) -> Option<[DVec3; 2]> {
        self.difference.vertices(indices)
    }

    #[inline(always)]
    fn initial_direction(&self) -> DVec3 {
        self.difference.initial_direction()
    }

    #[inline(always)]
    fn scale(&self) -> f64 {
        self.difference.scale()
    }
}

/// The same as the [`Difference`] of two polytopes, to the bit, with its maps in vectors, and both support points found at once: a search waits less for each.
pub(crate) struct PolytopeDifference<'a, S: Simd> {
    simd: S,
    polytopes: [&'a Polytope; 2],
    linear: [Linear<S>; 2],
    offset: f64x4<S>,
    scale: f64,
}

/// A linear map. Of the fourth lane of a vector nothing is used.
#[derive(Clone, Copy)]
struct Linear<S: Simd> {
    columns: [f64x4<S>; 3],
    /// The columns of its transpose.
    rows: [f64x4<S>; 3],
}

impl<'a, S: Simd> PolytopeDifference<'a, S> {
    #[inline(always)]
    pub fn new(
        simd: S,
        (a, placement_a): (&'a Polytope, &DAffine3),
        (b, placement_b): (&'a Polytope, &DAffine3),
    ) -> Self {
        let (linear_a, linear_b) = (Linear::new(simd, placement_a), Linear::new(simd, placement_b));
        let [to_a, to_b] = [placement_a, placement_b].map(|placement| placement.translation);
        let offset = to_b - to_a;
        let size =
            linear_a.extent(simd, a.reach()) + linear_b.extent(simd, b.reach()) + offset.abs().max_element();
        let scale = unit_scale(size);
        let unit = f64x4::splat(simd, scale);
        PolytopeDifference {
            simd,
            polytopes: [a, b],
            linear: [linear_a.times(unit), linear_b.times(unit)],
            offset: vector(simd, offset) * unit,
            scale,
        }
    }
}

/// Whether a placement is finite, far from singular and of plain size. Of one that is, no product below or in a search overflows.
#[inline(always)]
pub(crate) fn is_plain<S: Simd>(simd: S, placement: &DAffine3) -> bool {
    let Linear { rows: [x, y, z], .. } = Linear::new(simd, placement);
    // Of the axes: in each lane one.
    let squares = point(x * x + y * y + z * z);
    let DAffine3 { matrix3, translation } = placement;
    let volume = matrix3.x_axis.cross(matrix3.y_axis).dot(matrix3.z_axis);
    // No branches; and of what is no number nothing is true.
    let [x, y, z] = squares.to_array();
    PLAIN_SQUARES.contains(&x)
        & PLAIN_SQUARES.contains(&y)
        & PLAIN_SQUARES.contains(&z)
        & (volume * volume > PLAIN_VOLUME_SQUARED * x * y * z)
        & (translation.x.abs() <= MAGNITUDE_MAX)
        & (translation.y.abs() <= MAGNITUDE_MAX)
        & (translation.z.abs() <= MAGNITUDE_MAX)
}

/// A point of an object in the world.
#[inline(always)]
pub(crate) fn in_world<S: Simd>(simd: S, placement: &DAffine3, local: DVec3) -> DVec3 {
    let placed = combination(simd, &Linear::new(simd, placement).columns, local);
    point(placed + vector(simd, placement.translation))
}

impl<S: Simd> MinkowskiDifference for PolytopeDifference<'_, S> {
    #[inline(always)]
    fn support_against(&self, v: DVec3) -> SupportPoint {
        let (simd, [linear_a, linear_b]) = (self.simd, &self.linear);
        let along = [combination(simd, &linear_a.rows, -v), combination(simd, &linear_b.rows, v)];
        let [on_a, on_b] =
            Polytope::furthest_of_both(simd, self.polytopes, [point(along[0]), point(along[1])]);
        SupportPoint { indices: [on_a.index, on_b.index], ..self.point(on_a.point, on_b.point) }
    }

    #[inline(always)]
    fn point(&self, a: DVec3, b: DVec3) -> SupportPoint {
        let (simd, [linear_a, linear_b]) = (self.simd, &self.linear);
        let between = combination(simd, &linear_a.columns, a) - combination(simd, &linear_b.columns, b);
        SupportPoint { w: point(between - self.offset), a, b, indices: [NO_VERTEX; 2] }
    }

    #[inline(always)]
    fn vertices(&self, [i, j]: [u16; 2]) -> Option<[DVec3; 2]> {
        let [a, b] = self.polytopes;
        Some([a.vertex(i), b.vertex(j)])
    }

    #[inline(always)]
    fn initial_direction(&self) -> DVec3 {
        let [a, b] = self.polytopes;
        start_along(self.point(a.center(), b.center()).w)
    }

    #[inline(always)]
    fn scale(&self) -> f64 {
        self.scale
    }
}

impl<S: Simd> Linear<S> {
    /// That of a placement. Read as the numbers stand in memory, and turned in vectors: made of single numbers, it takes twice as long.
    #[inline(always)]
    fn new(simd: S, placement: &DAffine3) -> Self {
        let numbers: &[f64; 9] = placement.matrix3.as_ref();
        let x = f64x4::from_slice(simd, &numbers[..4]);
        let y = f64x4::from_slice(simd, &numbers[3..7]);
        let last = f64x4::from_slice(simd, &numbers[5..]);
        let z = last.slide::<1>(last);
        let ((x0y0, x1y1), (x2y2, _)) = (x.zip_low(y).split(), x.zip_high(y).split());
        let ((z0z1, z2), (_, z1z2)) = (z.split(), last.split());
        Linear { columns: [x, y, z], rows: [x0y0.combine(z0z1), x1y1.combine(z1z2), x2y2.combine(z2)] }
    }

    #[inline(always)]
    fn times(mut self, factor: f64x4<S>) -> Self {
        for k in 0..3 {
            self.columns[k] *= factor;
            self.rows[k] *= factor;
        }
        self
    }

    /// The largest coordinate of the image of a box of half extents `reach`.
    #[inline(always)]
    fn extent(&self, simd: S, reach: DVec3) -> f64 {
        let [x, y, z] = self.columns;
        point(combination(simd, &[x.abs(), y.abs(), z.abs()], reach)).max_element()
    }
}

/// The sum of columns, each times a coordinate.
#[inline(always)]
fn combination<S: Simd>(simd: S, [x, y, z]: &[f64x4<S>; 3], by: DVec3) -> f64x4<S> {
    *x * f64x4::splat(simd, by.x) + *y * f64x4::splat(simd, by.y) + *z * f64x4::splat(simd, by.z)
}

#[inline(always)]
fn vector<S: Simd>(simd: S, v: DVec3) -> f64x4<S> {
    f64x4::simd_from(simd, [v.x, v.y, v.z, 0.0])
}

#[inline(always)]
fn point<S: Simd>(v: f64x4<S>) -> DVec3 {
    let v = v.as_slice();
    DVec3::new(v[0], v[1], v[2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::{dispatch, levels};
    use crate::testing::placement;
    use glam::DMat3;

    /// The slow twin is the difference of any two objects: the same to the bit, but for the sign of zeros.
    #[test]
    fn it_is_the_difference() {
        let shear = DMat3::from_cols(DVec3::new(2.0, 0.1, 0.0), DVec3::new(0.0, 1e-4, 0.0), DVec3::ONE);
        for (count, other) in
            [(1, 4), (4, 9), (12, 20), (20, 20), (23, 16), (24, 25), (40, 8), (100, 60), (8, 300)]
        {
            let cloud = |count: u32, seed: u32| {
                Polytope::new((seed..seed + count).map(|k| placement(k).translation).collect()).unwrap()
            };
            let (a, b) = (cloud(count, 1), cloud(other, 500));
            for k in 0..40 {
                let unit = [1.0, 1e-9, 1e30][k as usize % 3];
                let (mut at_a, mut at_b) = (placement(k), placement(k + 1000));
                at_a.matrix3 *= if k % 2 == 0 { DMat3::IDENTITY } else { shear };
                for at in [&mut at_a, &mut at_b] {
                    *at = DAffine3 { matrix3: at.matrix3 * unit, translation: at.translation * unit };
                }
                let slow = Difference::new(&a, &at_a, &b, &at_b);
                let v = placement(k + 77).translation;
                for level in levels() {
                    let (scale, start, found) = dispatch!(level, simd => {
                        let fast = PolytopeDifference::new(simd, (&a, &at_a), (&b, &at_b));
                        (fast.scale(), fast.initial_direction(), fast.support_against(v))
                    });
                    assert_eq!(scale, slow.scale());
                    assert_eq!(start, slow.initial_direction());
                    let [i, j] = found.indices.map(usize::from);
                    assert_eq!((a.points()[i], b.points()[j]), (found.a, found.b));
                    let found = SupportPoint { indices: [NO_VERTEX; 2], ..found };
                    assert_eq!(found, slow.support_against(v), "{count} and {other} points, {k}");
                }
            }
        }
    }

    /// A placement is plain that has axes of plain lengths, a volume and a place, along each axis.
    #[test]
    fn what_is_plain_is_so_along_every_axis() {
        let plain = |at: DAffine3| {
            let [scalar, wide] = levels().map(|level| dispatch!(level, simd => is_plain(simd, &at)));
            assert_eq!(scalar, wide, "{at}");
            scalar
        };
        for k in 0..30 {
            let at = placement(k);
            let of = |linear: DMat3| DAffine3 { matrix3: at.matrix3 * linear, ..at };
            for scale in [1e-29, 1e-3, -1.0, 1e29] {
                assert!(plain(of(DMat3::IDENTITY * scale)), "{scale:e}");
            }
            for axis in DVec3::AXES {
                let scaled = |by: f64| of(DMat3::from_diagonal(DVec3::ONE + axis * (by - 1.0)));
                assert!([1e-31, 1e31, 0.0, f64::NAN].iter().all(|&by| !plain(scaled(by))), "{axis}");
                let moved = |by: f64| DAffine3 { translation: axis * by, ..at };
                assert!(plain(moved(1e100)) && plain(moved(-1e100)));
                assert!([1e101, -1e101, f64::NAN].iter().all(|&by| !plain(moved(by))), "{axis}");
            }
            let slanted = |z: f64| of(DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(1.0, 0.0, z)));
            assert!(plain(slanted(1e-7)) && !plain(slanted(1e-11)));
        }
    }
}
