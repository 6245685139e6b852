//! Shapes that are far from each other, beside how large they are.
//!
//! What is compared by squares of distances in single precision, as walks down trees do, is all alike from afar: of a mesh that is a million times as
//! far away as it is large every triangle would be looked at, and of two every pair. But from there which points are the closest hardly matters. With `n` a unit
//! vector from `B` to `A`, `p` the point of `A` that is furthest against it and `q` that of `B` furthest along it,
//!
//! ```text
//! n.(p - q)  <=  |x - y|  for all x of A and y of B,  the least of which is at most  |p - q|
//! ```
//!
//! so that `p` and `q` are the closest points up to the difference of the two. Mostly they are corners that stay the same when `n` leads from the one to the
//! other, and then there is none.

use glam::{DAffine3, DVec3};
use solid_convex::{Closest, Witness};

use super::reach::image_reach;
use super::table::{PlacedComplex, PlacedConvex};
use crate::bounds::Aabb;

/// How many times as far apart as they are large shapes are that are far. Up to there a walk down the trees looks at few leaves.
const FAR: f64 = 1024.0;

/// What is left open, relative to the distance: a tenth of what that may be off.
const ERROR: f64 = 1e-13;

/// How often the direction is taken that leads from one point to the other.
const ROUNDS: usize = 4;

/// A shape at a place, as it is seen from afar.
struct Seen<'a, F> {
    /// The point furthest along a direction. Space: local.
    furthest: F,
    /// A box around it. Space: local.
    bounds: Aabb,
    placement: &'a DAffine3,
}

impl<F: Fn(DVec3) -> DVec3> Seen<'_, F> {
    /// Its middle as seen from its local origin along the axes of the world, and how far it reaches from there.
    fn ball(&self) -> (DVec3, f64) {
        let linear = &self.placement.matrix3;
        (*linear * self.bounds.center(), image_reach(linear, self.bounds.half_extents()).length())
    }

    /// The point furthest along a direction of the world: in local space, and as seen from the local origin.
    fn furthest(&self, direction: DVec3) -> (DVec3, DVec3) {
        let linear = self.placement.matrix3;
        let point = (self.furthest)(linear.transpose() * direction);
        (point, linear * point)
    }
}

/// The closest points of two complex shapes, if they are far from each other and it is seen from there.
pub(super) fn complex_complex(a: PlacedComplex, b: PlacedComplex) -> Option<Closest> {
    closest(&seen(a), &seen(b))
}

/// The same of a complex and a convex shape.
pub(super) fn complex_convex(complex: PlacedComplex, convex: PlacedConvex) -> Option<Closest> {
    let reach = convex.0.reach();
    let furthest = |direction| convex.0.support(direction);
    closest(&seen(complex), &Seen { furthest, bounds: Aabb::new(-reach, reach), placement: convex.1 })
}

fn seen<'a>((complex, placement): PlacedComplex<'a>) -> Seen<'a, impl Fn(DVec3) -> DVec3> {
    Seen { furthest: |direction| complex.furthest(direction), bounds: complex.bounds(), placement }
}

fn closest<F: Fn(DVec3) -> DVec3, G: Fn(DVec3) -> DVec3>(a: &Seen<F>, b: &Seen<G>) -> Option<Closest> {
    let offset = a.placement.translation - b.placement.translation;
    let ((middle_a, radius_a), (middle_b, radius_b)) = (a.ball(), b.ball());
    let mut way = offset + middle_a - middle_b;
    let mut distance = way.length();
    let is_far = distance > FAR * (radius_a + radius_b) && distance.is_finite();
    if !is_far {
        return None;
    }
    for _ in 0..ROUNDS {
        let n = way / distance;
        let ((on_a, seen_a), (on_b, seen_b)) = (a.furthest(-n), b.furthest(n));
        way = offset + (seen_a - seen_b);
        distance = way.length();
        if distance - way.dot(n) <= ERROR * distance {
            return Some(Closest { distance, points: Witness { on_a, on_b } });
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Shape;
    use crate::pair::{Placed, Scratch, closest as closest_of};
    use rand::Rng;
    use solid_oracle::generate::{PlacementKind, grid, random_placement, seeded};

    /// Law: what is far away is found at a glance: few leaves are visited, whatever the distance; and no two corners are nearer.
    #[test]
    fn what_is_far_is_found_at_a_glance() {
        const SIDE: u32 = 40;
        let mut rng = seeded(2120);
        let bent = |i: u32| {
            let (x, y) = (f64::from(i % SIDE), f64::from(i / SIDE));
            DVec3::new(x, y, 9.0 * (0.3 * x).sin() * (0.2 * y).cos()) / f64::from(SIDE)
        };
        let mesh = Shape::mesh((0..SIDE * SIDE).map(bent).collect::<Vec<_>>(), grid(SIDE)).unwrap();
        let hull = Shape::convex_hull(&[DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]).unwrap();
        let ball = Shape::sphere(0.5).unwrap();
        let (mut scratch, mut cases) = (Scratch::default(), 0);
        for case in 0..300 {
            let kind = PlacementKind::ALL[case % PlacementKind::ALL.len()];
            let [at_a, mut at_b] = [0, 1].map(|_| random_placement(&mut rng, kind));
            let direction = DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)));
            let [size_a, size_b] = [&at_a, &at_b].map(|at| image_reach(&at.matrix3, DVec3::ONE).length());
            let size = (size_a + size_b) * 10f64.powi(4 + case as i32 % 9);
            at_b.translation = at_a.translation + direction.normalize() * size;
            let other = [&mesh, &hull, &ball][case % 3];
            let place = |shape, placement| Placed { shape, placement };
            let found = closest_of(place(&mesh, &at_a), place(other, &at_b), &mut scratch);
            let back = closest_of(place(other, &at_b), place(&mesh, &at_a), &mut scratch);
            assert!((found.distance - back.distance).abs() <= 2.0 * ERROR * size, "{case}");
            cases += 2;
            let Some(vertices) = other.vertices() else { continue };
            let corners = |shape: &[DVec3], at: &DAffine3, origin: DVec3| -> Vec<DVec3> {
                shape.iter().map(|v| at.matrix3 * *v + (at.translation - origin)).collect()
            };
            let of_a = corners(mesh.vertices().unwrap(), &at_a, at_a.translation);
            let of_b = corners(vertices, &at_b, at_a.translation);
            let pairs = of_a.iter().flat_map(|p| of_b.iter().map(|q| p.distance_squared(*q)));
            let least = pairs.fold(f64::INFINITY, f64::min).sqrt();
            // A corner may be nearer to a face than to its corners.
            assert!(found.distance <= least * (1.0 + 1e-12), "{case}: {} {least}", found.distance);
            assert!(found.distance >= least - (size_a + size_b), "{case}: {} {least}", found.distance);
        }
        let leaves = scratch.traversal.counters.leaf_visits;
        println!("{leaves} leaves in {cases} questions");
        assert!(leaves < 4 * cases, "{leaves}");
    }
}
