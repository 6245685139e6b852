//! Newell's plane.

use glam::{DVec3, Vec3Swizzles};
use solid_convex::unit_scale;

/// Roundings of 2^-53 in a term of Newell's sum: two differences, the products and their difference.
const ROUNDINGS_OF_TERM: f64 = 6.0;

/// The plane `normal * x + offset = 0` that fits a closed chain of vertices best: its normal is by Newell's method, and it
/// passes through the mean of the vertices (thesis, section 2.1.1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Of length 1; from its tip the chain runs counter-clockwise. Zero for a polygon without an area.
    pub normal: DVec3,
    /// Minus the distance of the origin along the normal.
    pub offset: f64,
    /// Each coordinate of `normal` is within this of that of exact arithmetic. Grows as the polygon becomes a sliver:
    /// about 1e-16 times the squared extent over the area.
    pub normal_error: f64,
    /// How far the farthest vertex is off the plane.
    pub deviation: f64,
}

/// Newell's plane, twice the area, and the vertex farthest off the plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fit {
    pub plane: Plane,
    pub area: f64,
    pub farthest: usize,
}

impl Plane {
    /// The signed distance of a point; positive on the side of the normal.
    ///
    /// ```
    /// use solid3d::{glam::DVec3, polygon::Polygon};
    /// let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
    /// let plane = *Polygon::new(square)?.plane();
    /// assert_eq!((plane.normal, plane.distance(DVec3::splat(2.0))), (DVec3::Z, 2.0));
    /// # Ok::<(), solid3d::polygon::PolygonError>(())
    /// ```
    pub fn distance(&self, point: DVec3) -> f64 {
        self.normal.dot(point) + self.offset
    }
}

/// At least one vertex, all finite and in range.
pub(super) fn fit(vertices: &[DVec3], extent: f64) -> Fit {
    // A power of two, so that squares of areas neither overflow nor underflow.
    let scale = unit_scale(extent);
    let at = |i: usize| (vertices[i % vertices.len()] - vertices[0]) * scale;
    let (mut normal, mut magnitude, mut mean) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
    for i in 0..vertices.len() {
        let (p, q) = (at(i), at(i + 1));
        // Newell's sum, taken around the first vertex: far from the origin less cancels.
        normal += p.cross(q);
        let (p_abs, q_abs) = (p.abs(), q.abs());
        magnitude += p_abs.yzx() * q_abs.zxy() + p_abs.zxy() * q_abs.yzx();
        mean += p;
    }
    mean /= vertices.len() as f64;
    let length = normal.length();
    let error = (ROUNDINGS_OF_TERM + vertices.len() as f64) * (0.5 * f64::EPSILON) * magnitude.length();
    let (normal, normal_error) = if length > 0.0 {
        // The error of the sum, and once more for the length; then that of normalising.
        (normal / length, 2.0 * error / length + 2.0 * f64::EPSILON)
    } else {
        (DVec3::ZERO, 1.0)
    };
    let off = |i: usize| (normal.dot(at(i) - mean)).abs() / scale;
    let farthest = (0..vertices.len()).max_by(|&i, &j| off(i).total_cmp(&off(j))).unwrap_or(0);
    let offset = -normal.dot(vertices[0] + mean / scale);
    let plane = Plane { normal, offset, normal_error, deviation: off(farthest) };
    Fit { plane, area: 0.5 * length / scale / scale, farthest }
}

#[cfg(test)]
mod tests {
    use rand::Rng;
    use solid_oracle::generate::seeded;

    use super::*;

    /// Law: normal and area are as near to those of exact arithmetic as is said, of slivers too; and the vertex farthest off the plane is as far off it as
    /// is said.
    #[test]
    fn normal_and_area_are_as_exact_as_is_said() {
        let mut rng = seeded(180);
        let mut inexact = 0;
        for case in 0..2000 {
            // Whole numbers of which products take more than 53 bits; the sum is exact in 128.
            let mut whole = |most: i64| [0; 3].map(|_: i64| rng.random_range(-most..=most));
            let (along, off) = (whole(1 << 20), 1 << (case % 20));
            let chain: Vec<[i64; 3]> = (0..5)
                .map(|i| {
                    let beside = whole(off);
                    let t = (i * (5 - i)) << 14;
                    std::array::from_fn(|k| t * along[k] + beside[k])
                })
                .collect();
            let vertices: Vec<DVec3> = chain.iter().map(|p| DVec3::from_array(p.map(|x| x as f64))).collect();
            let exact: [i128; 3] = std::array::from_fn(|k| {
                let [y, z] = [(k + 1) % 3, (k + 2) % 3];
                let term = |(p, q): (&[i64; 3], &[i64; 3])| {
                    i128::from(p[y]) * i128::from(q[z]) - i128::from(p[z]) * i128::from(q[y])
                };
                chain.iter().zip(chain.iter().cycle().skip(1)).map(term).sum()
            });
            if exact == [0; 3] {
                continue;
            }
            let exact = DVec3::from_array(exact.map(|x| x as f64));
            let (exact, exact_area) = (exact.normalize(), 0.5 * exact.length());
            let extent = vertices.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
            let Fit { plane, area, farthest } = fit(&vertices, extent);
            let error = (plane.normal - exact).abs().max_element();
            let rounding = 2.0 * f64::EPSILON;
            assert!(error <= plane.normal_error + rounding, "case {case}: {error:e}, {plane:?}");
            let is_near = (area - exact_area).abs() <= (2.0 * plane.normal_error + rounding) * area;
            assert!(is_near, "case {case}: {area}, not {exact_area}");
            inexact += usize::from(error > 4.0 * rounding);
            let distances = vertices.iter().map(|&p| plane.distance(p).abs());
            let slack = 16.0 * f64::EPSILON * extent;
            assert!(distances.clone().all(|it| it <= plane.deviation + slack), "case {case}: {plane:?}");
            assert!(plane.distance(vertices[farthest]).abs() >= plane.deviation - slack, "case {case}");
        }
        assert!(inexact > 200, "{inexact}");
    }
}
