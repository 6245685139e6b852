//! The support mapping.

use glam::{DMat3, DVec3};

use crate::Polytope;
use crate::gjk::{Ball, Balls};
use crate::kinds::ball_support;

/// A convex object, known by its support mapping. Space: the object's own.
///
/// Laws, for every direction `d` and every point `x` of the object:
/// `d.dot(support(d)) >= d.dot(x)` up to a rounding error of a few ulps, `support(d)` is a point of the object up to
/// the same, and `reach()` bounds the magnitude of each coordinate.
pub trait Support: Send + Sync {
    /// A point of the object that lies furthest along `direction`, which need not be a unit vector. Any point of the
    /// object for the zero direction. The same direction gives the same point, always.
    fn support(&self, direction: DVec3) -> DVec3;

    /// The largest magnitude of each coordinate over the object.
    fn reach(&self) -> DVec3;

    /// A point of the object, well inside when it has an inside: where a search starts.
    fn center(&self) -> DVec3 {
        DVec3::ZERO
    }

    /// A ball around the object and one in it: where they tell, no search is needed.
    fn balls(&self) -> Option<Balls> {
        None
    }

    /// Whether it surely has all of a ball in it, up to rounding: by the ball of its [`balls`](Support::balls), where there is nothing better.
    ///
    /// ```
    /// use solid_convex::{Cylinder, Support, gjk::Ball, glam::DVec3};
    /// let drum = Cylinder::new(1.0, 2.0)?;
    /// let at_the_rim = |radius: f64| Ball { center: DVec3::new(0.75, 0.5, 0.0), radius };
    /// assert!(drum.contains_ball(at_the_rim(0.25)) && !drum.contains_ball(at_the_rim(0.3)));
    /// # Ok::<(), solid_convex::SizeError>(())
    /// ```
    fn contains_ball(&self, ball: Ball) -> bool {
        self.balls().is_some_and(|balls| balls.inner.contains(ball))
    }

    /// Whether it is the hull of finitely many points, which its support points are: then a search among them ends with the exact answer.
    fn is_polytope(&self) -> bool {
        false
    }

    /// The three half edges of a parallelepiped around its [`center`](Support::center), when the object is one.
    fn half_edges(&self) -> Option<[DVec3; 3]> {
        None
    }

    /// The least and the greatest coordinates of its image under a linear map, up to rounding: by six support points, where there
    /// is nothing better.
    fn image_bounds(&self, linear: &DMat3) -> [DVec3; 2] {
        bounds_by_supports(self, linear)
    }

    /// The object as a polytope that is laid out for speed, if it is one: a search then finds its support points without a call.
    /// They must be those that [`support`](Support::support) gives.
    fn as_polytope(&self) -> Option<&Polytope> {
        None
    }

    /// Where a support point moves as its direction turns a little. Of what says so, closest points are found in fewer steps.
    fn locus(&self, _point: DVec3) -> Locus {
        Locus::Point
    }

    /// The object is all that is within this distance of its core; 0 for one that is its own core.
    fn core_radius(&self) -> f64 {
        0.0
    }

    /// A support point of the core, a polytope that the object is rounded from: of a ball its centre.
    fn core_support(&self, direction: DVec3) -> DVec3 {
        self.support(direction)
    }
}

/// Where a support point moves as its direction turns a little: within the object, and where it is the furthest support points are. Space: local.
///
/// ```
/// use solid_convex::{Cone, Locus, Support, glam::DVec3};
/// let cone = Cone::new(1.0, 2.0)?;
/// assert_eq!(cone.locus(cone.support(DVec3::Y)), Locus::Point);
/// assert_eq!(cone.locus(cone.support(DVec3::X)), Locus::Circle { radius: 1.0 });
/// # Ok::<(), solid_convex::SizeError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Locus {
    /// It stays, as a vertex, or nothing is known of how it moves.
    Point,
    /// A circle around the axis y.
    Circle {
        /// Its radius.
        radius: f64,
    },
    /// A sphere.
    Sphere {
        /// Its middle.
        center: DVec3,
        /// Its radius.
        radius: f64,
    },
}

impl Locus {
    /// The point of the locus of a point that is furthest along a direction, which is not zero.
    pub(crate) fn furthest(self, point: DVec3, direction: DVec3) -> DVec3 {
        match self {
            Locus::Point => point,
            Locus::Circle { radius } => {
                let (x, z) = rim(radius, direction.x, direction.z);
                DVec3::new(x, point.y, z)
            }
            Locus::Sphere { center, radius } => center + ball_support(radius, direction),
        }
    }

    /// The curvature of the support function at a direction, its matrix of second derivatives: as up to two vectors of which it is the sum of
    /// squares.
    pub(crate) fn bends(self, direction: DVec3) -> [DVec3; 2] {
        match self {
            Locus::Circle { radius } => {
                let across = direction.with_y(0.0).length();
                let tangent = DVec3::new(-direction.z, 0.0, direction.x) / across;
                [tangent * (radius / across).sqrt(), DVec3::ZERO]
            }
            Locus::Sphere { radius, .. } => {
                let length = direction.length();
                let (s, t) = (direction / length).any_orthonormal_pair();
                let bend = (radius / length).sqrt();
                [s * bend, t * bend]
            }
            Locus::Point => [DVec3::ZERO; 2],
        }
    }
}

/// The least and the greatest coordinates of the image of an object under a linear map, by six support points.
pub(crate) fn bounds_by_supports<S: Support + ?Sized>(object: &S, linear: &DMat3) -> [DVec3; 2] {
    let transposed = linear.transpose();
    let furthest = |axis: DVec3| axis.dot(linear.mul_vec3(object.support(transposed * axis)));
    let along = |sign: f64| {
        let (x, y, z) = (DVec3::X * sign, DVec3::Y * sign, DVec3::Z * sign);
        sign * DVec3::new(furthest(x), furthest(y), furthest(z))
    };
    [along(-1.0), along(1.0)]
}

/// `-magnitude` for negative `sign`, else `magnitude`: the thesis's sgn, which is 1 at 0.
pub(crate) fn with_sign(magnitude: f64, sign: f64) -> f64 {
    if sign < 0.0 { -magnitude } else { magnitude }
}

/// The point at distance `radius` from the axis y in the direction (x, z); on the axis when there is none.
#[inline]
pub(crate) fn rim(radius: f64, x: f64, z: f64) -> (f64, f64) {
    let DVec3 { x, z, .. } = ball_support(radius, DVec3::new(x, 0.0, z));
    (x, z)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use rand::Rng;
    use solid_oracle::generate::seeded;

    use crate::Polytope;
    use crate::gjk::Ball;
    use crate::testing::{in_cube, octahedron_faces, shapes};

    /// Law: a ball is said to be in an object only if it reaches beyond no plane that bounds the object; and of cones, cylinders and hulls, if it
    /// does so by a hair's breadth, that is said.
    #[test]
    fn balls_inside_reach_beyond_no_plane() {
        let mut rng = seeded(154);
        let mut inside = 0;
        let corners = (0..6).map(|i| DVec3::AXES[i / 2] * if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let octahedron = Polytope::new(corners).unwrap().with_faces(&octahedron_faces());
        let mut objects = shapes();
        objects.push(Box::new(octahedron));
        for case in 0..24_000 {
            let object = &objects[case % 6];
            let ball =
                Ball { center: in_cube(&mut rng), radius: 0.3 * rng.random_range(0.0f64..1.0).powi(3) };
            let room = |n: DVec3| n.dot(object.support(n)) - n.dot(ball.center) - ball.radius;
            let outward = ball.center.with_y(0.0).normalize_or(DVec3::X);
            // Of the cone, the cylinder and the octahedron there.
            let side = DVec3::ONE.copysign(ball.center).normalize();
            let planes = [DVec3::Y, DVec3::NEG_Y, outward, (outward * 3.0 + DVec3::Y).normalize(), side];
            let least = planes.map(room).into_iter().fold(f64::INFINITY, f64::min);
            if object.contains_ball(ball) {
                inside += 1;
                let around = (0..20).map(|_| room(in_cube(&mut rng).normalize()));
                let least = around.fold(least, f64::min);
                assert!(least >= -1e-12, "case {case}: {ball:?}, {least:e}");
            } else if matches!(case % 6, 2 | 3 | 5) {
                assert!(least <= 1e-12, "case {case}: {ball:?}, {least:e}");
            }
        }
        assert!(inside > 1_000, "{inside}");
    }
}
