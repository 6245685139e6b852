//! A small ball around a polytope, and a large one in it. With any centres they are right; with good ones less is left between them, and more
//! pairs are decided without a search: of 20 points on a sphere, balls about their mean leave twice as many open.

use glam::DVec3;

use super::plane::Plane;
use crate::direction::length;
use crate::gjk::Ball;

/// Steps of a search for a centre, and how long each is beside the one before.
const STEPS: usize = 24;
const SHRINK: f64 = 0.8;

/// The first step, beside the radius of the ball around the mean: all together are as long as that.
const FIRST_STEP: f64 = 0.2;

/// A ball around points, of which there are some, with their mean. Cost: O(n).
pub(super) fn around(points: &[DVec3], mean: DVec3) -> Ball {
    let ball = |center| Ball { center, radius: farthest(points, center) };
    let first = ball(mean);
    let center = least(first, |center| {
        let way = points.iter().map(|&p| center - p).fold(DVec3::ZERO, |most, way| {
            if way.length_squared() > most.length_squared() { way } else { most }
        });
        (way.length_squared(), way.normalize_or_zero())
    });
    let found = ball(center);
    if found.radius < first.radius { found } else { first }
}

/// A ball in the hull of points, with their mean, of which these are the planes of all faces; of radius 0 where it is flat, or no face is known.
/// Cost: O(n).
pub(super) fn inside(points: &[DVec3], mean: DVec3, planes: &[Plane]) -> Ball {
    let lowest = |point: DVec3| {
        planes.iter().fold((f64::INFINITY, DVec3::ZERO), |lowest, plane| {
            let height = plane.height(point);
            if height < lowest.0 { (height, plane.inward) } else { lowest }
        })
    };
    let ball = |center| Ball { center, radius: lowest(center).0 };
    let first = ball(mean);
    if !(first.radius > 0.0 && first.radius.is_finite()) {
        return Ball { radius: 0.0, ..first };
    }
    let wide = Ball { radius: farthest(points, mean), ..first };
    let found = ball(least(wide, |center| {
        let (height, inward) = lowest(center);
        (-height, -inward)
    }));
    if found.radius > first.radius { found } else { first }
}

/// How far the farthest point is from another.
pub(super) fn farthest(points: &[DVec3], from: DVec3) -> f64 {
    points.iter().map(|&p| length(p - from)).fold(0.0, f64::max)
}

/// Where in a ball a convex function is nearly least, beginning at the centre: by steps against the direction in which it grows, which the
/// function gives with its value (the subgradient method).
fn least(ball: Ball, function: impl Fn(DVec3) -> (f64, DVec3)) -> DVec3 {
    let (mut point, mut step) = (ball.center, FIRST_STEP * ball.radius);
    let mut best = (f64::INFINITY, point);
    for _ in 0..STEPS {
        let (value, growth) = function(point);
        if value < best.0 {
            best = (value, point);
        }
        point -= growth * step;
        step *= SHRINK;
    }
    best.1
}

#[cfg(test)]
mod tests {
    use rand::Rng;
    use solid_oracle::generate::{in_cube, seeded};

    use super::super::super::points::mean;
    use super::*;
    use crate::testing::block;

    fn around(points: &[DVec3]) -> Ball {
        super::around(points, mean(points.iter().copied()))
    }

    fn inside(points: &[DVec3], faces: &[[u32; 3]]) -> Ball {
        super::inside(points, mean(points.iter().copied()), &Plane::all(points, faces))
    }

    /// Law: the balls of a box, whatever points are added that are not corners, are nearly the best there are, of any size and anywhere.
    #[test]
    fn balls_of_a_box_are_nearly_the_best() {
        let mut rng = seeded(31);
        for case in 0..300 {
            let size = DVec3::ONE + 3.0 * in_cube(&mut rng).abs();
            let (mut points, faces) = block(size);
            // A crowd near a corner, which the mean is near to then.
            points.extend((0..case % 100).map(|_| size * (1.0 - 0.1 * in_cube(&mut rng).abs())));
            let unit = 10f64.powi(rng.random_range(-95..95));
            let far = [0.0, 1e3][case % 2] * in_cube(&mut rng);
            let placed: Vec<DVec3> = points.iter().map(|&p| (p + far) * unit).collect();
            let (outer, inner) = (around(&placed), inside(&placed, &faces));
            let around = outer.radius / (0.5 * size.length() * unit);
            assert!((1.0 - 1e-12..1.03).contains(&around), "{case}: {around}");
            let inside = inner.radius / (0.5 * size.min_element() * unit);
            assert!((0.95..1.0 + 1e-12).contains(&inside), "{case}: {inside}");
            assert!(placed.iter().all(|&p| length(p - outer.center) <= outer.radius));
            let least = inner.center / unit - far - inner.radius / unit;
            let most = inner.center / unit - far + inner.radius / unit;
            assert!(least.min_element() > -1e-10 && (size - most).min_element() > -1e-10, "{case}");
        }
    }

    /// What is flat, a point, or has no faces, has a ball around it and none in it.
    #[test]
    fn nothing_is_in_what_is_flat() {
        for size in [DVec3::new(1.0, 1.0, 0.0), DVec3::X, DVec3::ZERO, DVec3::new(1.0, 1.0, 1e-17)] {
            let (points, faces) = block(size);
            assert!(inside(&points, &faces).radius <= 0.5 * size.min_element(), "{size}");
            assert!((around(&points).radius - 0.5 * size.length()).abs() < 0.01, "{size}");
        }
        let (points, faces) = block(DVec3::ONE);
        assert_eq!(inside(&points, &[]).radius, 0.0);
        assert!(inside(&points, &faces).radius > 0.49);
        let turned: Vec<[u32; 3]> = faces.iter().map(|&[i, j, k]| [i, k, j]).collect();
        assert_eq!(inside(&points, &turned).radius, 0.0);
        // Triangles anywhere, whose mean is rounded to one side of them or the other.
        let mut rng = seeded(32);
        for _ in 0..1000 {
            let far = 10f64.powi(rng.random_range(-3..6)) * in_cube(&mut rng);
            let corners: Vec<DVec3> = (0..3).map(|_| far + in_cube(&mut rng)).collect();
            assert_eq!(inside(&corners, &[[0, 1, 2], [0, 2, 1]]).radius, 0.0, "{corners:?}");
        }
    }
}
