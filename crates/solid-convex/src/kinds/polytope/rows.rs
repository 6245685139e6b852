//! All points, compared by vector instructions.

use fearless_simd::{Simd, f64x4, prelude::*};
use glam::DVec3;

use crate::simd::{Level, dispatch};

/// Points that are compared at once.
const LANES: usize = 4;

/// The coordinates of four points: their x, their y, their z.
type Row = [[f64; LANES]; 3];

/// Points with their coordinates in rows, two by two. Invariant: there is at least one; the last pair is filled up with
/// the last point.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    pairs: Vec<[Row; 2]>,
}

impl Rows {
    /// `None` for no points.
    pub fn new(points: &[DVec3]) -> Option<Rows> {
        let last = *points.last()?;
        let pair = |chunk: &[DVec3]| {
            let lane = |i: usize| *chunk.get(i).unwrap_or(&last);
            let row = |start: usize| [0, 1, 2].map(|axis| std::array::from_fn(|i| lane(start + i)[axis]));
            [row(0), row(LANES)]
        };
        Some(Rows { pairs: points.chunks(2 * LANES).map(pair).collect() })
    }

    /// The index of the point furthest along a direction, the first of equals; past the end when the direction is not finite.
    pub fn furthest(&self, level: Level, direction: DVec3) -> usize {
        dispatch!(level, simd => furthest(simd, &self.pairs, direction))
    }
}

/// Each lane of the two rows of a pair keeps its own furthest point, the first of equals; then they are compared.
#[inline(always)]
fn furthest<S: Simd>(simd: S, pairs: &[[Row; 2]], direction: DVec3) -> usize {
    let (x, y, z) =
        (f64x4::splat(simd, direction.x), f64x4::splat(simd, direction.y), f64x4::splat(simd, direction.z));
    let along = |[xs, ys, zs]: &Row| {
        f64x4::simd_from(simd, *xs) * x + f64x4::simd_from(simd, *ys) * y + f64x4::simd_from(simd, *zs) * z
    };
    let least = f64x4::splat(simd, f64::NEG_INFINITY);
    let mut index = f64x4::simd_from(simd, [0.0, 1.0, 2.0, 3.0]);
    let second = f64x4::splat(simd, LANES as f64);
    let step = f64x4::splat(simd, 2.0 * LANES as f64);
    let (mut best, mut best_index) = ([least; 2], [index; 2]);
    for [even, odd] in pairs {
        for (k, (row, index)) in [(even, index), (odd, index + second)].into_iter().enumerate() {
            let dot = along(row);
            let further = dot.simd_gt(best[k]);
            best[k] = further.select(dot, best[k]);
            best_index[k] = further.select(index, best_index[k]);
        }
        index += step;
    }
    let greatest = best[0].max(best[1]).reduce_max();
    // The first of equals: of the lanes that have the greatest, the least index.
    let greatest = f64x4::splat(simd, greatest);
    let none = f64x4::splat(simd, f64::INFINITY);
    let first = |k: usize| best[k].simd_eq(greatest).select(best_index[k], none);
    first(0).min(first(1)).reduce_min() as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::levels;

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
                    assert_eq!(rows.furthest(level, direction), first, "{level:?}");
                }
            }
        }
    }
}
