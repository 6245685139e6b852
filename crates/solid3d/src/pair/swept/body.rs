//! A convex object on its way, at a time: where its points are, and how they move.

use glam::{DAffine3, DMat3, DVec3};
use solid_convex::{Points, Support};

use super::path::Way;
use crate::pair::reach::{convex_bounds, image_reach};
use crate::shape::Complex;

/// A shape whose middle is further from its local origin than so many of its half extents is far.
const FAR: f64 = 16.0;

/// A convex object on its way. Space: along the world's axes, in a unit of length near the size of the data, seen from the local
/// origin of the other object, which may itself be on its way: only relative motion counts. What it says of points holds at the time to
/// which it was last brought by [`seek`](Self::seek).
pub(super) struct Body<'a> {
    geometry: Geometry<'a>,
    way: Way,
    /// Bounds the acceleration of its points.
    acceleration: f64,
    /// Where the local origin is at the time, and how it moves.
    origin: [DVec3; 2],
}

enum Geometry<'a> {
    /// A convex shape: the linear part of its placement, and how that changes.
    Shape { shape: &'a dyn Support, linear: [DMat3; 2], far: Option<Far<'a>> },
    /// A primitive of a complex shape.
    Vertices(Vertices),
}

/// A convex shape that is far from its local origin, as seen from its middle: what is found of it is then as exact as of one that is near.
struct Far<'a> {
    shape: &'a dyn Support,
    middle: DVec3,
    half_extents: DVec3,
}

impl<'a> Far<'a> {
    /// `None` for a shape that is near.
    fn new(shape: &'a dyn Support) -> Option<Self> {
        let bounds = convex_bounds(shape, &DMat3::IDENTITY);
        let middle = bounds.center();
        let is_far = middle.abs().max_element() > FAR * bounds.half_extents().max_element();
        // Grown by what the difference from the middle is rounded.
        let half_extents = bounds.half_extents() + middle.abs() * f64::EPSILON;
        is_far.then_some(Far { shape, middle, half_extents })
    }
}

impl Support for Far<'_> {
    fn support(&self, direction: DVec3) -> DVec3 {
        self.shape.support(direction) - self.middle
    }

    fn reach(&self) -> DVec3 {
        self.half_extents
    }

    fn center(&self) -> DVec3 {
        self.shape.center() - self.middle
    }

    fn is_polytope(&self) -> bool {
        self.shape.is_polytope()
    }
}

/// The vertices of a primitive, as seen from the local origin.
#[derive(Default)]
struct Vertices {
    /// At both ends of the way, but for the turn.
    ends: [Vec<DVec3>; 2],
    /// Now, and how they move.
    positions: Vec<DVec3>,
    velocities: Vec<DVec3>,
    /// Now, as seen from the first: the local origin may be far.
    around: Vec<DVec3>,
}

/// The way of a body's local origin, in its space.
type OriginWay = [DVec3; 2];

impl<'a> Body<'a> {
    /// A convex shape, on a way in the world.
    pub fn shape(shape: &'a dyn Support, way: &Way, origin: OriginWay, scale: f64) -> Self {
        let way = way.seen_from(origin, scale);
        let reach = |linear: &DMat3| image_reach(linear, shape.reach()).length();
        let [from, to] = way.linear;
        let acceleration = way.acceleration(reach(&from).max(reach(&to)), reach(&(to - from)));
        let geometry = Geometry::Shape { shape, linear: [DMat3::IDENTITY; 2], far: Far::new(shape) };
        Body { geometry, way, acceleration, origin }
    }

    /// A primitive of a complex shape; [`set_primitive`](Self::set_primitive) says which.
    pub fn primitive(way: &Way, origin: OriginWay, scale: f64) -> Self {
        let geometry = Geometry::Vertices(Vertices::default());
        Body { geometry, way: way.seen_from(origin, scale), acceleration: 0.0, origin }
    }

    /// Makes the body another primitive of its shape, which is given as it was and as it is.
    pub fn set_primitive(&mut self, shape: [&Complex; 2], primitive: u32) {
        let Geometry::Vertices(Vertices { ends, .. }) = &mut self.geometry else {
            unreachable!("the body was made to be a primitive");
        };
        for end in 0..2 {
            let linear = self.way.linear[end];
            let indices = shape[end].primitive(primitive).iter();
            ends[end].clear();
            ends[end].extend(indices.map(|&i| linear * shape[end].vertices()[i as usize]));
        }
        let far = ends.iter().flatten().map(|p| p.length()).fold(0.0, f64::max);
        let change = ends[0].iter().zip(&ends[1]).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max);
        self.acceleration = self.way.acceleration(far, change);
    }

    /// Bounds the acceleration of its points along a unit vector, in the body's unit of length.
    pub fn acceleration_along(&self, n: DVec3) -> f64 {
        self.acceleration * self.way.share_along(n)
    }

    /// Goes to a time.
    pub fn seek(&mut self, t: f64) {
        self.origin = [self.way.origin_at(t), self.way.origin[1] - self.way.origin[0]];
        let (turn, rate) = (self.way.rotation(t), self.way.rotation_rate(t));
        match &mut self.geometry {
            Geometry::Shape { linear, .. } => {
                let [from, to] = self.way.linear;
                let between = from * (1.0 - t) + to * t;
                *linear = [turn * between, rate * between + turn * (to - from)];
            }
            Geometry::Vertices(Vertices { ends, positions, velocities, around }) => {
                positions.clear();
                velocities.clear();
                for (&from, &to) in ends[0].iter().zip(&ends[1]) {
                    let between = from * (1.0 - t) + to * t;
                    positions.push(turn * between);
                    velocities.push(rate * between + turn * (to - from));
                }
                around.clear();
                around.extend(positions.iter().map(|position| *position - positions[0]));
            }
        }
    }

    /// The largest of `direction . (x + ahead * v)` over all its points `x` and their velocities `v`.
    pub fn furthest(&self, direction: DVec3, ahead: f64) -> f64 {
        let of_points = match &self.geometry {
            Geometry::Shape { shape, linear, .. } => {
                let linear = linear[0] + linear[1] * ahead;
                (linear * shape.support(linear.transpose() * direction)).dot(direction)
            }
            Geometry::Vertices(Vertices { positions, velocities, .. }) => {
                let along = positions.iter().zip(velocities).map(|(x, v)| (*x + *v * ahead).dot(direction));
                along.fold(f64::NEG_INFINITY, f64::max)
            }
        };
        of_points + (self.origin[0] + self.origin[1] * ahead).dot(direction)
    }

    /// Calls a function with the body as it is now, and its placement.
    pub fn with_placed<T>(&self, ask: impl FnOnce(&dyn Support, &DAffine3) -> T) -> T {
        match &self.geometry {
            Geometry::Shape { shape, linear: [linear, _], far } => {
                let (shape, middle): (&dyn Support, _) = match far {
                    Some(far) => (far, *linear * far.middle),
                    None => (*shape, DVec3::ZERO),
                };
                ask(shape, &DAffine3 { matrix3: *linear, translation: self.origin[0] + middle })
            }
            Geometry::Vertices(Vertices { positions, around, .. }) => {
                let points = Points::new(around).expect("a primitive has a vertex");
                ask(&points, &DAffine3::from_translation(self.origin[0] + positions[0]))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Shape;
    use crate::pair::swept::path::{Path, Roundness};
    use crate::shape::{Class, ShapeKind};
    use rand::Rng;
    use solid_oracle::generate::{PlacementKind, random_placement, seeded};

    /// Law: a body reaches no further, after a time, than its velocities and the bound on its accelerations tell; and what is round, and turns about its axis or
    /// its middle, stays where it is.
    #[test]
    fn a_body_reaches_no_further_than_its_velocities_and_accelerations_tell() {
        let mut rng = seeded(2110);
        let shapes = [
            Shape::sphere(0.7).unwrap(),
            Shape::cone(0.6, 1.5).unwrap(),
            Shape::cylinder(0.4, 1.8).unwrap(),
            Shape::capsule(0.3, 1.2).unwrap(),
            Shape::cuboid([0.5, 1.1, 0.8]).unwrap(),
        ];
        let (mut spins, mut sharp) = (0, 0);
        for case in 0..20_000 {
            let shape = &shapes[case % shapes.len()];
            let Class::Convex(convex) = shape.class() else { unreachable!("none is a mesh") };
            let mut vector = || DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)));
            let (by, tilt, n) = (vector(), 0.3 * vector(), vector().normalize());
            let from = random_placement(&mut rng, PlacementKind::ALL[case / 5 % PlacementKind::ALL.len()]);
            let spindle = from.matrix3.y_axis.normalize();
            let (about, is_spin) = match case / 5 % 4 {
                0 => (by.normalize(), false),
                1 => (spindle, true),
                2 => ((spindle + tilt).normalize(), false),
                _ => ((spindle + 1e-3 * tilt).normalize(), false),
            };
            let to = DAffine3 {
                matrix3: DMat3::from_axis_angle(about, rng.random_range(0.0..3.0)) * from.matrix3,
                translation: from.translation + by,
            };
            let way = Way::new(&from, &to, Path::Turning).of_round(Roundness::of(shape.kind()));
            let mut body = Body::shape(convex, &way, way.origin, 1.0);
            let (t, after) = (rng.random_range(0.0..0.9), rng.random_range(0.0..0.1));
            body.seek(t);
            let (now, slow) = (body.furthest(n, 0.0), body.acceleration_along(n));
            let told = body.furthest(n, after) + 0.5 * after * after * slow;
            let speed = (way.origin[1] - way.origin[0]).dot(n);
            body.seek(t + after);
            let then = body.furthest(n, 0.0);
            let size = from.matrix3.to_cols_array().into_iter().fold(1.0, |most: f64, x| most.max(x.abs()));
            assert!(then <= told + 1e-11 * size, "{case} {}: {then} {told}", shape.kind());
            let rigid = (from.matrix3 * from.matrix3.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-12);
            let is_still = shape.kind() == ShapeKind::Sphere
                || is_spin && shape.kind() != ShapeKind::Cuboid && way.turn.is_some();
            if rigid && is_still {
                spins += 1;
                assert!((now + speed * after - then).abs() < 1e-12, "{case}");
                assert!((told - then).abs() < 1e-12, "{case} {}: {then} {told}", shape.kind());
            }
            sharp += usize::from(told - then < 0.1 * after * after);
        }
        println!("{spins} spin, {sharp} bounds are sharp");
        assert!(spins > 500 && sharp > 2000);
    }
}
