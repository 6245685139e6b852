//! The convex hull of many points, laid out for speed.

use glam::DVec3;

use super::points::{mean, reach};
use crate::Support;

/// Points that are compared at once.
const LANES: usize = 8;

/// The convex hull of points, as [`Points`](super::Points), with the same answers to the bit: it owns its points, with the
/// coordinates in rows of eight, so that the furthest is found by vector instructions.
///
/// ```
/// use solid_convex::{Polytope, Support};
/// use glam::DVec3;
/// let corner = Polytope::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]).unwrap();
/// assert_eq!(corner.support(DVec3::new(1.0, 2.0, 3.0)), DVec3::Z);
/// assert!(Polytope::new(Vec::new()).is_none());
/// ```
#[derive(Clone, Debug)]
pub struct Polytope {
    points: Vec<DVec3>,
    /// The same, eight at a time; the last row is filled up with the last point.
    rows: Vec<[[f64; LANES]; 3]>,
    reach: DVec3,
    center: DVec3,
}

impl Polytope {
    /// The hull of `points`; `None` for no points.
    pub fn new(points: Vec<DVec3>) -> Option<Self> {
        let last = *points.last()?;
        let row = |chunk: &[DVec3]| {
            let lane = |i: usize| *chunk.get(i).unwrap_or(&last);
            [0, 1, 2].map(|axis| std::array::from_fn(|i| lane(i)[axis]))
        };
        let rows = points.chunks(LANES).map(row).collect();
        let (reach, center) = (reach(points.iter().copied()), mean(points.iter().copied()));
        Some(Polytope { points, rows, reach, center })
    }

    /// The points.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }
}

impl Support for Polytope {
    fn support(&self, direction: DVec3) -> DVec3 {
        // Each lane keeps its own furthest point, the first of equals; then the lanes are compared.
        let mut best = [f64::NEG_INFINITY; LANES];
        let mut best_row = [0u64; LANES];
        for (row, [x, y, z]) in (0u64..).zip(&self.rows) {
            for i in 0..LANES {
                let dot = x[i] * direction.x + y[i] * direction.y + z[i] * direction.z;
                let further = dot > best[i];
                best[i] = if further { dot } else { best[i] };
                best_row[i] = if further { row } else { best_row[i] };
            }
        }
        let index = |lane: usize| best_row[lane] as usize * LANES + lane;
        let further = |x: usize, y: usize| best[y] > best[x] || (best[y] == best[x] && index(y) < index(x));
        let lane = (1..LANES).fold(0, |x, y| if further(x, y) { y } else { x });
        self.points[index(lane).min(self.points.len() - 1)]
    }

    fn reach(&self) -> DVec3 {
        self.reach
    }

    fn center(&self) -> DVec3 {
        self.center
    }

    fn is_polytope(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Points;

    /// The slow twin is the scan over the points in order; grids have many ties.
    #[test]
    fn same_as_the_scan() {
        for count in 1..60 {
            let coordinate = |i: usize| ((i * 7919) % 5) as f64 - 2.0;
            let points: Vec<DVec3> =
                (0..count).map(|i| DVec3::new(coordinate(i), coordinate(i / 3), coordinate(i * i))).collect();
            let polytope = Polytope::new(points.clone()).unwrap();
            for d in 0..125 {
                let direction = DVec3::new((d % 5) as f64, (d / 5 % 5) as f64, (d / 25) as f64) - 2.0;
                assert_eq!(polytope.support(direction), Points::new(&points).unwrap().support(direction));
            }
        }
    }
}
