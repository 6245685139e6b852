//! A triangle within a box: what is cut off goes plane by plane (Sutherland and Hodgman, *Reentrant Polygon Clipping*, 1974).

use solid3d::Aabb;
use solid3d::glam::DVec3;

use crate::piece::Corner;

/// A box of the grid.
#[derive(Clone, Copy, Debug)]
pub struct Region(Aabb);

impl Region {
    pub fn new(min: DVec3, max: DVec3) -> Region {
        Region(Aabb::new(min, max))
    }

    /// How far a point is from it.
    pub fn distance(&self, p: DVec3) -> f64 {
        p.distance(p.clamp(self.0.min, self.0.max))
    }
}

/// Adds the corners of what of a triangle is in a region. Corners of the triangle are not rounded.
pub fn clip(triangle: &[DVec3; 3], Region(region): &Region, cloud: &mut Vec<Corner>) {
    if !Aabb::of_points(*triangle).overlaps(region) {
        return;
    }
    let mut inside = triangle.to_vec();
    for side in sides(region) {
        inside = side.inner(&inside);
    }
    cloud.extend(inside.iter().map(|&at| Corner { at, is_cut: !triangle.contains(&at) }));
}

/// Whether some of a triangle is in no region: what is in one is cut off, region by region.
pub fn is_left<'a>(triangle: &[DVec3; 3], regions: impl Iterator<Item = &'a Region>) -> bool {
    let mut left = vec![triangle.to_vec()];
    for Region(region) in regions {
        for polygon in std::mem::take(&mut left) {
            if !Aabb::of_points(polygon.iter().copied()).overlaps(region) {
                left.push(polygon);
                continue;
            }
            let mut inside = polygon;
            for side in sides(region) {
                if inside.iter().any(|&p| side.height(p) < 0.0) {
                    left.push(side.outer().inner(&inside));
                    inside = side.inner(&inside);
                }
            }
        }
    }
    !left.is_empty()
}

/// A side of a box: a half space along an axis.
struct Side {
    axis: usize,
    sign: f64,
    bound: f64,
}

fn sides(Aabb { min, max }: &Aabb) -> impl Iterator<Item = Side> {
    let side = |axis, sign, bound| Side { axis, sign, bound };
    (0..3).flat_map(move |axis| [side(axis, 1.0, min[axis]), side(axis, -1.0, max[axis])])
}

impl Side {
    /// How far inside a point is.
    fn height(&self, p: DVec3) -> f64 {
        self.sign * (p[self.axis] - self.bound)
    }

    /// The other side of the same plane.
    fn outer(&self) -> Side {
        Side { sign: -self.sign, ..*self }
    }

    /// What of a polygon is inside.
    fn inner(&self, polygon: &[DVec3]) -> Vec<DVec3> {
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (i, &p) in polygon.iter().enumerate() {
            let next = polygon[(i + 1) % polygon.len()];
            let (of_p, of_next) = (self.height(p), self.height(next));
            if of_p >= 0.0 {
                kept.push(p);
            }
            if (of_p > 0.0 && of_next < 0.0) || (of_p < 0.0 && of_next > 0.0) {
                let mut crossing = p.lerp(next, of_p / (of_p - of_next));
                crossing[self.axis] = self.bound;
                kept.push(crossing);
            }
        }
        kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(polygon: &[Corner]) -> f64 {
        let Some((first, rest)) = polygon.split_first() else { return 0.0 };
        rest.windows(2).map(|pair| 0.5 * (pair[0].at - first.at).cross(pair[1].at - first.at).length()).sum()
    }

    /// Eight boxes around a point divide a triangle: nothing is lost, nothing is twice.
    #[test]
    fn regions_share_a_triangle() {
        let triangle = [DVec3::new(-1.0, -0.9, -0.7), DVec3::new(0.9, -0.2, 0.3), DVec3::new(-0.3, 1.0, 0.6)];
        for middle in [DVec3::ZERO, DVec3::new(0.1, -0.2, 0.05), triangle[0], DVec3::splat(3.0)] {
            let mut regions = Vec::new();
            for i in 0..8 {
                let corner =
                    middle + DVec3::from([0, 1, 2].map(|k| if i >> k & 1 == 0 { -9.0 } else { 9.0 }));
                let mut cloud = Vec::new();
                let region = Region::new(middle.min(corner), middle.max(corner));
                clip(&triangle, &region, &mut cloud);
                regions.push((area(&cloud), region));
                assert!(cloud.iter().all(|corner| corner.is_cut || triangle.contains(&corner.at)));
            }
            let sum: f64 = regions.iter().map(|(area, _)| area).sum();
            let whole = area(&triangle.map(|at| Corner { at, is_cut: false }));
            assert!((sum - whole).abs() < 1e-14, "{middle}: {sum}");
            assert!(!is_left(&triangle, regions.iter().map(|(_, region)| region)), "{middle}");
            for (i, (area, _)) in regions.iter().enumerate() {
                let others =
                    regions.iter().enumerate().filter(|&(j, _)| j != i).map(|(_, (_, region))| region);
                assert_eq!(is_left(&triangle, others), *area > 0.0, "{middle}: without region {i}");
            }
        }
    }
}
