//! The plane of a face, and how well it is known.

use glam::DVec3;

use super::HEIGHT_ERROR;
use crate::Support;
use crate::difference::{Difference, SupportPoint};
use crate::direction::{direction, length_and_direction};

/// The plane of a face of the polytope.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    /// Outward, of unit length.
    pub normal: DVec3,
    /// How far it is from the origin along the normal; infinite where a face was replaced.
    pub offset: f64,
    /// How much less it may be.
    pub slack: f64,
    /// How much higher above the plane of its rounded corners, or lower, a vertex may be than its computed height says.
    pub blur: f64,
}

/// Roundings of 2^-53 of the normal of two edges, each relative to the parts that the edge is computed from: two products with
/// matrices and their difference for each edge, the cross product, the root and the scalar product with a corner.
const NORMAL_ROUNDINGS: f64 = 16.0 / (1u64 << 53) as f64;

/// No two points of the difference, whose coordinates are below 2, are further apart.
const DIAMETER: f64 = 8.0;

/// The square of the width of a triangle over its longest edge, in the difference's unit, beyond which the rounding of its corners does
/// not tilt it by more than some 1e-14.
const WIDE_SQUARED: f64 = 1.0 / 1024.0;

impl Plane {
    /// Beyond everything.
    pub const BEYOND: Plane = Plane { normal: DVec3::ZERO, offset: f64::INFINITY, slack: 0.0, blur: 0.0 };

    /// Lays it through three points, counterclockwise from outside: written where it stays, no load waits for what was just moved.
    #[inline]
    pub fn lay<A, B>(&mut self, difference: &Difference<A, B>, points: [&SupportPoint; 3])
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let [p, q, r] = points.map(|point| point.w);
        let (pq, pr) = (q - p, r - p);
        let normal = pq.cross(pr);
        let area_squared = normal.length_squared();
        let longest_squared = pq.length_squared().max(pr.length_squared()).max((r - q).length_squared());
        if area_squared <= WIDE_SQUARED * longest_squared {
            *self = Plane::narrow(difference, points);
            return;
        }
        let inverse = 1.0 / area_squared.sqrt();
        self.normal = normal * inverse;
        self.offset = self.normal.dot(p);
        // The corners are what they are: only the computation rounds.
        let tilt = NORMAL_ROUNDINGS * (1.0 + longest_squared * inverse);
        self.slack = tilt * p.abs().element_sum();
        self.blur = tilt * DIAMETER;
    }

    /// The plane of three points that are nearly in line, or near to each other. Its normal comes from the edges of the two objects, which
    /// are precise where the points are large and the face is small.
    #[inline(never)]
    fn narrow<A, B>(difference: &Difference<A, B>, points: [&SupportPoint; 3]) -> Self
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let [p, q, r] = points;
        let sides = [(p, q), (q, r), (r, p)];
        let squares = sides.map(|(x, y)| x.w.distance_squared(y.w));
        // The two shortest: see `feature::normal`.
        let longest = (1..3).fold(0, |i, j| if squares[j] > squares[i] { j } else { i });
        let edge = |i: usize| difference.edge_with_size(sides[i % 3].0, sides[i % 3].1);
        let [(x, size_x), (y, size_y)] = [edge(longest + 1), edge(longest + 2)];
        let normal = x.cross(y);
        let near = |x: DVec3, y: DVec3| if y.length_squared() < x.length_squared() { y } else { x };
        let nearest = near(near(p.w, q.w), r.w);
        let Some((length, unit)) = length_and_direction(normal) else {
            // So thin that its normal is lost: looked across once, along its nearest corner, and of no use as a bound.
            let normal = direction(nearest).unwrap_or(DVec3::X);
            let (slack, blur) = (f64::INFINITY, f64::INFINITY);
            return Plane { normal, offset: 0.0, slack, blur };
        };
        let tilt = NORMAL_ROUNDINGS * (1.0 + (size_x * y.length() + size_y * x.length()) / length);
        // The vertices are the rounded ones: their plane is turned by that over the width.
        let slack = tilt.min(2.0) * nearest.length() + HEIGHT_ERROR;
        let turned = 4.0 * HEIGHT_ERROR * squares[longest].sqrt() / length;
        let (offset, blur) = (unit.dot(nearest), (tilt + turned) * DIAMETER + HEIGHT_ERROR);
        Plane { normal: unit, offset, slack, blur }
    }

    /// How many times a direction the way along it to the plane is; infinite where it goes inward, and where the plane is lost.
    pub fn exit(&self, direction: DVec3) -> f64 {
        let along = self.normal.dot(direction);
        let known = along > 0.0 && self.slack < f64::INFINITY;
        if known { self.offset / along } else { f64::INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;
    use rand::Rng;
    use solid_oracle::generate::seeded;

    use super::super::polytope::side;
    use super::*;
    use crate::Points;
    use crate::testing::{in_cube, placement};

    /// Law: a point that is higher over a plane than its blur, or lower, is on that side of the rounded corners, however small or thin their
    /// triangle is.
    #[test]
    fn heights_beyond_the_blur_have_the_exact_sign() {
        let mut rng = seeded(153);
        let (mut sure, mut wrong) = (0, 0);
        for case in 0..40_000 {
            let ends = [in_cube(&mut rng), in_cube(&mut rng)];
            let object = Points::new(&ends).unwrap();
            let at: [DAffine3; 2] = std::array::from_fn(|i| placement(2 * case + i as u32));
            let difference = Difference::new(&object, &at[0], &object, &at[1]);
            let (size, thin) = (
                0.1f64.powi(rng.random_range(0..9)),
                DVec3::new(1.0, 0.1f64.powi(rng.random_range(0..4)), 1.0),
            );
            let around = [in_cube(&mut rng), in_cube(&mut rng)];
            let corners: [SupportPoint; 3] = std::array::from_fn(|_| {
                let [a, b] = around.map(|around| around + in_cube(&mut rng) * thin * size);
                difference.point(a, b)
            });
            let mut plane = Plane::BEYOND;
            plane.lay(&difference, [&corners[0], &corners[1], &corners[2]]);
            let [p, q, r] = corners.map(|corner| corner.w);
            let along = (q - p) * rng.random_range(-2.0..2.0) + (r - p) * rng.random_range(-2.0..2.0);
            let far = along / along.length().max(1e-300) * 0.1f64.powi(rng.random_range(0..6));
            let over = plane.blur * 0.1f64.powf(rng.random_range(-0.5..5.0));
            let s = p + far + plane.normal * over.copysign(rng.random_range(-1.0..1.0));
            let height = plane.normal.dot(s) - plane.offset;
            let is_above = side([p, q, r], s) < 0.0;
            if height.abs() > plane.blur {
                sure += 1;
                assert_eq!(height > 0.0, is_above, "case {case}: {height:e}, {plane:?}");
            } else {
                wrong += usize::from((height > 0.0) != is_above);
            }
        }
        assert!(sure > 1_500 && wrong > 100, "{sure}, {wrong}");
    }
}
