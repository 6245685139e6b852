//! All points, compared by vector instructions.

use fearless_simd::{Simd, f64x4, i64x4, prelude::*};
use glam::{DMat3, DVec3};

/// Points that are compared at once.
const LANES: usize = 4;

/// Rows whose products all stay in registers.
const FEW: usize = 6;

/// The coordinates of four points: their x, their y, their z. Aligned, so that no vector lies in two lines of the cache.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
struct Row([[f64; LANES]; 3]);

/// Points with their coordinates in rows. Invariant: there are an even number of rows, and at least [`FEW`]; they are filled up with the
/// last point.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    rows: Vec<Row>,
    /// How many rows do not hold the last point alone; at least two.
    count: usize,
}

impl Rows {
    /// The memory that they own, in bytes.
    pub fn bytes(&self) -> usize {
        self.rows.capacity() * size_of::<Row>()
    }

    /// `None` for no points.
    pub fn new(points: &[DVec3]) -> Option<Rows> {
        let last = *points.last()?;
        let lane = |i: usize| *points.get(i).unwrap_or(&last);
        let row = |first: usize| Row([0, 1, 2].map(|axis| std::array::from_fn(|i| lane(first + i)[axis])));
        let count = points.len().div_ceil(LANES).max(2);
        let filled = count.max(FEW).next_multiple_of(2);
        Some(Rows { rows: (0..filled).map(|k| row(k * LANES)).collect(), count })
    }

    /// Whether there are so few that [`furthest_of_both`](Rows::furthest_of_both) may be asked.
    #[inline(always)]
    pub fn are_few(&self) -> bool {
        self.count <= FEW
    }

    /// The index of the point furthest along a direction, the first of equals; past the end when the direction is not finite.
    #[inline(always)]
    pub fn furthest<S: Simd>(&self, simd: S, direction: DVec3) -> usize {
        match self.count {
            2 => self.furthest_of_few::<S, 2>(simd, direction),
            3 => self.furthest_of_few::<S, 3>(simd, direction),
            4 => self.furthest_of_few::<S, 4>(simd, direction),
            5 => self.furthest_of_few::<S, 5>(simd, direction),
            FEW => self.furthest_of_few::<S, FEW>(simd, direction),
            _ => self.furthest_of_many(simd, direction),
        }
    }

    /// The same of two that are few, each along a direction of its own. Neither waits for the instructions of the other to be read.
    #[inline(always)]
    pub fn furthest_of_both<S: Simd>(simd: S, both: [&Rows; 2], along: [DVec3; 2]) -> [usize; 2] {
        match both[0].count.max(both[1].count) {
            2 => furthest_of_both::<S, 2>(simd, both, along),
            3 => furthest_of_both::<S, 3>(simd, both, along),
            4 => furthest_of_both::<S, 4>(simd, both, along),
            5 => furthest_of_both::<S, 5>(simd, both, along),
            _ => furthest_of_both::<S, FEW>(simd, both, along),
        }
    }

    /// The point of an index; of one past the end, the last. From the rows, which are at hand when all were just compared: elsewhere it would be
    /// waited for where the caches are short.
    #[inline(always)]
    pub fn point_at(&self, index: usize) -> DVec3 {
        let index = index.min(LANES * self.rows.len() - 1);
        let Row([xs, ys, zs]) = &self.rows[index / LANES];
        let lane = index % LANES;
        DVec3::new(xs[lane], ys[lane], zs[lane])
    }

    /// The products of those points with their directions.
    #[inline(always)]
    pub fn greatest_of_both<S: Simd>(simd: S, both: [&Rows; 2], along: [DVec3; 2]) -> [f64; 2] {
        if both[0].count.max(both[1].count) < FEW {
            greatest_of_both::<S, { FEW - 1 }>(simd, both, along)
        } else {
            greatest_of_both::<S, FEW>(simd, both, along)
        }
    }

    /// The first rows, so many as there are at least.
    #[inline(always)]
    fn first<const N: usize>(&self) -> &[Row; N] {
        self.rows.first_chunk().expect("there are at least FEW rows")
    }

    /// Of `N` rows, whose products all stay in registers.
    #[inline(always)]
    fn furthest_of_few<S: Simd, const N: usize>(&self, simd: S, direction: DVec3) -> usize {
        let along = products(simd, direction);
        let mut dots = [f64x4::splat(simd, 0.0); N];
        for (dot, row) in dots.iter_mut().zip(self.first::<N>()) {
            *dot = along(row);
        }
        first_of_greatest(simd, &dots)
    }

    /// Of any number of rows.
    #[inline(always)]
    pub fn furthest_of_many<S: Simd>(&self, simd: S, direction: DVec3) -> usize {
        let (first, second) = self.rows.split_at(self.rows.len() / 2);
        let along = products(simd, direction);
        // Each lane of either half keeps its own furthest point, the first of equals.
        let mut best = [f64x4::splat(simd, f64::NEG_INFINITY); 2];
        let mut best_index = [i64x4::splat(simd, 0); 2];
        let mut index = i64x4::simd_from(simd, [0, 1, 2, 3]);
        for rows in first.iter().zip(second) {
            let dots = [along(rows.0), along(rows.1)];
            for k in 0..2 {
                let further = dots[k].simd_gt(best[k]);
                best[k] = further.select(dots[k], best[k]);
                best_index[k] = further.select(index, best_index[k]);
            }
            index += i64x4::splat(simd, LANES as i64);
        }
        let from_second = best[1].simd_gt(best[0]);
        let best = from_second.select(best[1], best[0]);
        let in_second = best_index[1] + i64x4::splat(simd, (first.len() * LANES) as i64);
        let mut places = [0; LANES];
        from_second.select(in_second, best_index[0]).store_slice(&mut places);
        // Of the lanes that have the greatest, nearly always one; none, where that is no number.
        let greatest = f64x4::splat(simd, best.reduce_max());
        let lanes = best.simd_eq(greatest).to_bitmask();
        if lanes & lanes.wrapping_sub(1) != 0 {
            let equal = (0..LANES).filter(|lane| lanes >> lane & 1 == 1).map(|lane| places[lane]);
            return equal.min().map_or(usize::MAX, |place| place as usize);
        }
        if lanes == 0 { usize::MAX } else { places[lanes.trailing_zeros() as usize & (LANES - 1)] as usize }
    }

    /// The least and the greatest coordinates of the images of all points under a linear map.
    #[inline(always)]
    pub fn image_bounds<S: Simd>(&self, simd: S, linear: &DMat3) -> [DVec3; 2] {
        let column = |axis: DVec3| {
            [f64x4::splat(simd, axis.x), f64x4::splat(simd, axis.y), f64x4::splat(simd, axis.z)]
        };
        let (x, y, z) = (column(linear.x_axis), column(linear.y_axis), column(linear.z_axis));
        let mut least = [f64x4::splat(simd, f64::INFINITY); 3];
        let mut greatest = [f64x4::splat(simd, f64::NEG_INFINITY); 3];
        for Row([xs, ys, zs]) in &self.rows[..self.count] {
            let xs = f64x4::simd_from(simd, *xs);
            let ys = f64x4::simd_from(simd, *ys);
            let zs = f64x4::simd_from(simd, *zs);
            for axis in 0..3 {
                let image = xs * x[axis] + ys * y[axis] + zs * z[axis];
                least[axis] = least[axis].min(image);
                greatest[axis] = greatest[axis].max(image);
            }
        }
        let [x, y, z] = least;
        let min = DVec3::new(x.reduce_min(), y.reduce_min(), z.reduce_min());
        let [x, y, z] = greatest;
        [min, DVec3::new(x.reduce_max(), y.reduce_max(), z.reduce_max())]
    }
}

/// See [`Rows::furthest_of_both`]. Of `N` rows of each.
#[inline(always)]
fn furthest_of_both<S: Simd, const N: usize>(simd: S, [a, b]: [&Rows; 2], along: [DVec3; 2]) -> [usize; 2] {
    let (along_a, along_b) = (products(simd, along[0]), products(simd, along[1]));
    let (a, b) = (a.first::<N>(), b.first::<N>());
    let mut dots = [[f64x4::splat(simd, 0.0); N]; 2];
    for k in 0..N {
        dots[0][k] = along_a(&a[k]);
        dots[1][k] = along_b(&b[k]);
    }
    [first_of_greatest(simd, &dots[0]), first_of_greatest(simd, &dots[1])]
}

/// See [`Rows::greatest_of_both`]. Of `N` rows of each.
#[inline(always)]
fn greatest_of_both<S: Simd, const N: usize>(simd: S, [a, b]: [&Rows; 2], along: [DVec3; 2]) -> [f64; 2] {
    let (along_a, along_b) = (products(simd, along[0]), products(simd, along[1]));
    let (a, b) = (a.first::<N>(), b.first::<N>());
    let mut best = [along_a(&a[0]), along_b(&b[0])];
    for k in 1..N {
        best[0] = best[0].max(along_a(&a[k]));
        best[1] = best[1].max(along_b(&b[k]));
    }
    [best[0].reduce_max(), best[1].reduce_max()]
}

/// The index of the greatest product, the first of equals; past the end when none is a number.
#[inline(always)]
fn first_of_greatest<S: Simd, const N: usize>(simd: S, dots: &[f64x4<S>; N]) -> usize {
    let mut best = dots[0];
    for dot in &dots[1..] {
        best = best.max(*dot);
    }
    let greatest = f64x4::splat(simd, best.reduce_max());
    // Every other row apart: masks side by side would be packed into one first, for which all wait.
    let mut equal = [0u64; 2];
    for (k, dot) in dots.iter().enumerate() {
        equal[k % 2] |= dot.simd_eq(greatest).to_bitmask() << (k * LANES);
    }
    (equal[0] | equal[1]).trailing_zeros() as usize
}

/// The products of the points of a row with a direction.
#[inline(always)]
fn products<S: Simd>(simd: S, direction: DVec3) -> impl Fn(&Row) -> f64x4<S> {
    let (x, y, z) =
        (f64x4::splat(simd, direction.x), f64x4::splat(simd, direction.y), f64x4::splat(simd, direction.z));
    #[inline(always)]
    move |Row([xs, ys, zs]): &Row| {
        f64x4::simd_from(simd, *xs) * x + f64x4::simd_from(simd, *ys) * y + f64x4::simd_from(simd, *zs) * z
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::{dispatch, levels};

    /// Law: an index has its point, and one that is past the end, as of a direction that is no number, the last.
    #[test]
    fn every_index_has_a_point() {
        for count in 1..40 {
            let points: Vec<DVec3> = (0..count).map(|i| DVec3::new(i as f64, 0.5, -(i as f64))).collect();
            let rows = Rows::new(&points).unwrap();
            for index in (0..100).chain([usize::MAX]) {
                assert_eq!(rows.point_at(index), points[index.min(count - 1)], "{index} of {count}");
            }
        }
    }

    #[test]
    fn every_level_finds_the_first_of_the_furthest() {
        for count in 1..80 {
            let coordinate = |i: usize| ((i * 7919) % 5) as f64 - 2.0;
            let points: Vec<DVec3> =
                (0..count).map(|i| DVec3::new(coordinate(i), coordinate(i / 3), coordinate(i * i))).collect();
            let rows = Rows::new(&points).unwrap();
            for d in 0..125 {
                let direction = DVec3::new((d % 5) as f64, (d / 5 % 5) as f64, (d / 25) as f64) - 2.0;
                let greatest = points.iter().map(|p| p.dot(direction)).fold(f64::NEG_INFINITY, f64::max);
                let first = points.iter().position(|p| p.dot(direction) == greatest).unwrap();
                for level in levels() {
                    let found = dispatch!(level, simd => rows.furthest(simd, direction));
                    assert_eq!(found, first, "{level:?}");
                    let many = dispatch!(level, simd => rows.furthest_of_many(simd, direction));
                    assert_eq!(many, first, "{level:?}");
                    assert_eq!(rows.point_at(found), points[first]);
                    if rows.are_few() {
                        let other = Rows::new(&points[..points.len() / 2 + 1]).unwrap();
                        let both = [(&rows, &other), (&other, &rows)].map(|(a, b)| {
                            dispatch!(level, simd => Rows::furthest_of_both(simd, [a, b], [direction, -direction]))
                        });
                        let alone = |rows: &Rows, along| dispatch!(level, simd => rows.furthest(simd, along));
                        assert_eq!(both[0], [first, alone(&other, -direction)], "{level:?}");
                        let products = dispatch!(level, simd => Rows::greatest_of_both(simd, [&rows, &other], [direction, -direction]));
                        let of_other = points[both[0][1]].dot(-direction);
                        assert_eq!(products, [greatest, of_other], "{level:?}");
                        assert_eq!(
                            both[1],
                            [alone(&other, direction), alone(&rows, -direction)],
                            "{level:?}"
                        );
                    }
                }
            }
        }
    }
}
