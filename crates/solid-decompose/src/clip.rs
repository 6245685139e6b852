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

/// The area of a convex polygon.
pub fn area(polygon: &[DVec3]) -> f64 {
    let Some((&first, rest)) = polygon.split_first() else { return 0.0 };
    rest.windows(2).map(|pair| 0.5 * (pair[0] - first).cross(pair[1] - first).length()).sum()
}

/// Adds the corners of what of a triangle is in a region, and gives its area. Corners of the triangle are not rounded.
pub fn clip(triangle: &[DVec3; 3], Region(region): &Region, cloud: &mut Vec<Corner>) -> f64 {
    if !Aabb::of_points(*triangle).overlaps(region) {
        return 0.0;
    }
    let mut polygon = triangle.to_vec();
    let mut kept = Vec::new();
    for axis in 0..3 {
        for (sign, bound) in [(1.0, region.min[axis]), (-1.0, region.max[axis])] {
            let beyond = |p: DVec3| sign * (p[axis] - bound);
            kept.clear();
            for (i, &p) in polygon.iter().enumerate() {
                let next = polygon[(i + 1) % polygon.len()];
                let (of_p, of_next) = (beyond(p), beyond(next));
                if of_p >= 0.0 {
                    kept.push(p);
                }
                if (of_p > 0.0 && of_next < 0.0) || (of_p < 0.0 && of_next > 0.0) {
                    let mut crossing = p.lerp(next, of_p / (of_p - of_next));
                    crossing[axis] = bound;
                    kept.push(crossing);
                }
            }
            std::mem::swap(&mut polygon, &mut kept);
        }
    }
    cloud.extend(polygon.iter().map(|&at| Corner { at, is_cut: !triangle.contains(&at) }));
    area(&polygon)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Eight boxes around a point divide a triangle: nothing is lost, nothing is twice.
    #[test]
    fn regions_share_a_triangle() {
        let triangle = [DVec3::new(-1.0, -0.9, -0.7), DVec3::new(0.9, -0.2, 0.3), DVec3::new(-0.3, 1.0, 0.6)];
        for middle in [DVec3::ZERO, DVec3::new(0.1, -0.2, 0.05), triangle[0], DVec3::splat(3.0)] {
            let mut sum = 0.0;
            for i in 0..8 {
                let corner =
                    middle + DVec3::from([0, 1, 2].map(|k| if i >> k & 1 == 0 { -9.0 } else { 9.0 }));
                let mut cloud = Vec::new();
                sum += clip(&triangle, &Region::new(middle.min(corner), middle.max(corner)), &mut cloud);
                assert!(cloud.iter().all(|corner| corner.is_cut || triangle.contains(&corner.at)));
            }
            assert!((sum - area(&triangle)).abs() < 1e-14, "{middle}: {sum}");
        }
    }
}
