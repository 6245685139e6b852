//! All points, compared by vector instructions.

use fearless_simd::{Simd, f64x4, i64x4, prelude::*};
use glam::{DMat3, DVec3};

/// Points that are compared at once.
const LANES: usize = 4;

/// Rows whose products all stay in registers.
const FEW: usize = 6;

/// The coordinates of four points: their x, their y, their z.
type Row = [[f64; LANES]; 3];

/// Points with their coordinates in rows. Invariant: there are at least two, and an even number where there are more than [`FEW`]; they are
/// filled up with the last point.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    rows: Vec<Row>,
}

impl Rows {
    /// `None` for no points.
    pub fn new(points: &[DVec3]) -> Option<Rows> {
        let last = *points.last()?;
        let lane = |i: usize| *points.get(i).unwrap_or(&last);
        let row = |first: usize| [0, 1, 2].map(|axis| std::array::from_fn(|i| lane(first + i)[axis]));
        let count = match points.len().div_ceil(LANES) {
            1 => 2,
            few @ 2..=FEW => few,
            many => many.next_multiple_of(2),
        };
        Some(Rows { rows: (0..count).map(|k| row(k * LANES)).collect() })
    }

    /// The index of the point furthest along a direction, the first of equals; past the end when the direction is not finite.
    #[inline(always)]
    pub fn furthest<S: Simd>(&self, simd: S, direction: DVec3) -> usize {
        match self.rows.as_slice() {
            [_, _] => self.furthest_of_few::<S, 2>(simd, direction),
            [_, _, _] => self.furthest_of_few::<S, 3>(simd, direction),
            [_, _, _, _] => self.furthest_of_few::<S, 4>(simd, direction),
            [_, _, _, _, _] => self.furthest_of_few::<S, 5>(simd, direction),
            [_, _, _, _, _, _] => self.furthest_of_few::<S, 6>(simd, direction),
            _ => self.furthest_of_many(simd, direction),
        }
    }

    /// Of `N` rows, whose products all stay in registers.
    #[inline(always)]
    fn furthest_of_few<S: Simd, const N: usize>(&self, simd: S, direction: DVec3) -> usize {
        let rows: &[Row; N] = self.rows.first_chunk().expect("the rows were counted");
        let along = products(simd, direction);
        let mut dots = [f64x4::splat(simd, 0.0); N];
        for (dot, row) in dots.iter_mut().zip(rows) {
            *dot = along(row);
        }
        let mut best = dots[0];
        for dot in &dots[1..] {
            best = best.max(*dot);
        }
        let greatest = f64x4::splat(simd, best.reduce_max());
        let mut equal = 0;
        for (k, dot) in dots.iter().enumerate() {
            equal |= dot.simd_eq(greatest).to_bitmask() << (k * LANES);
        }
        if equal == 0 { usize::MAX } else { equal.trailing_zeros() as usize }
    }

    /// Of any number of rows.
    #[inline(always)]
    fn furthest_of_many<S: Simd>(&self, simd: S, direction: DVec3) -> usize {
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
        for [xs, ys, zs] in &self.rows {
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

/// The products of the points of a row with a direction.
#[inline(always)]
fn products<S: Simd>(simd: S, direction: DVec3) -> impl Fn(&Row) -> f64x4<S> {
    let (x, y, z) =
        (f64x4::splat(simd, direction.x), f64x4::splat(simd, direction.y), f64x4::splat(simd, direction.z));
    #[inline(always)]
    move |[xs, ys, zs]: &Row| {
        f64x4::simd_from(simd, *xs) * x + f64x4::simd_from(simd, *ys) * y + f64x4::simd_from(simd, *zs) * z
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::{dispatch, levels};

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
                }
            }
        }
    }
}
