use parry3d_f64::math::{Pose as ParryPose, Vector};
use parry3d_f64::query::{
    ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher, Ray as ParryRay, ShapeCastOptions,
    cast_shapes, cast_shapes_nonlinear, contact, distance, intersection_test,
};
use solid3d::glam::DVec3;
use solid3d::query::{self, ContactOptions, ImpactOptions, Ray, RayOptions};

use super::kinds::Kind;
use super::poses::{Placed, Poses, Sight};
use crate::peers::contestants::parry::double::vector;

/// Asks for one of several poses; the number keeps the compiler from leaving it out.
pub type Asker<'q> = Box<dyn Fn(usize) -> f64 + 'q>;

/// A question to ours, and to parry where it has an answer.
type OfPair = for<'q> fn(&'q Kind, &'q Kind, &'q Poses) -> (Asker<'q>, Option<Asker<'q>>);
type OfOne = for<'q> fn(&'q Kind, &'q [Sight]) -> (Asker<'q>, Option<Asker<'q>>);

/// Of two shapes.
pub const OF_PAIRS: [(&str, OfPair); 7] = [
    ("meet, where they do", |a, b, poses| meet(a, b, &poses.meeting)),
    ("meet, where they do not", |a, b, poses| meet(a, b, &poses.apart)),
    ("distance", apart),
    ("depth", depth),
    ("contacts", contacts),
    ("cast, straight", straight),
    ("time of impact, turning", turning),
];

/// Of one shape.
pub const ALONE: [(&str, OfOne); 5] = [
    ("ray", ray),
    ("bounds", |kind, sights| {
        (
            Box::new(|i| query::bounds(&kind.ours, &sights[i].ours).expect(VALID).min.x),
            Some(Box::new(|i| kind.theirs.compute_aabb(&sights[i].theirs).mins.x)),
        )
    }),
    ("contains a point", contains),
    ("closest to a point", |kind, sights| {
        let ours = |i: usize| query::closest_point(&kind.ours, &sights[i].ours, sights[i].point);
        let theirs = |i: usize| kind.theirs.distance_to_point(&sights[i].theirs, at(&sights[i]), true);
        (Box::new(move |i| ours(i).expect(VALID).distance), Some(Box::new(theirs)))
    }),
    ("signed distance", |kind, sights| {
        let ours = |i: usize| query::signed_distance(&kind.ours, &sights[i].ours, sights[i].point);
        let theirs = |i: usize| kind.theirs.distance_to_point(&sights[i].theirs, at(&sights[i]), false);
        (Box::new(move |i| ours(i).expect(VALID).distance), Some(Box::new(theirs)))
    }),
];

pub const VALID: &str = "the poses are valid";
pub const SUPPORTED: &str = "the pair is supported";

pub fn number(answer: bool) -> f64 {
    f64::from(u8::from(answer))
}

fn at(sight: &Sight) -> Vector {
    vector(sight.point)
}

fn meet<'q>(a: &'q Kind, b: &'q Kind, poses: &'q [Placed]) -> (Asker<'q>, Option<Asker<'q>>) {
    let ours = move |i: usize| {
        let [at_a, at_b] = &poses[i].ours;
        number(query::intersects(&a.ours, at_a, &b.ours, at_b).expect(VALID))
    };
    let theirs = move |i: usize| {
        let [at_a, at_b] = &poses[i].theirs;
        number(intersection_test(at_a, &*a.theirs, at_b, &*b.theirs).expect(SUPPORTED).intersecting)
    };
    (Box::new(ours), Some(Box::new(theirs)))
}

fn apart<'q>(a: &'q Kind, b: &'q Kind, poses: &'q Poses) -> (Asker<'q>, Option<Asker<'q>>) {
    let ours = move |i: usize| {
        let [at_a, at_b] = &poses.apart[i].ours;
        query::distance(&a.ours, at_a, &b.ours, at_b).expect(VALID).distance
    };
    let theirs = move |i: usize| {
        let [at_a, at_b] = &poses.apart[i].theirs;
        distance(at_a, &*a.theirs, at_b, &*b.theirs).expect(SUPPORTED).distance
    };
    (Box::new(ours), Some(Box::new(theirs)))
}

fn depth<'q>(a: &'q Kind, b: &'q Kind, poses: &'q Poses) -> (Asker<'q>, Option<Asker<'q>>) {
    let ours = move |i: usize| {
        let [at_a, at_b] = &poses.meeting[i].ours;
        query::penetration(&a.ours, at_a, &b.ours, at_b).expect(VALID).map_or(0.0, |found| found.depth)
    };
    let theirs = move |i: usize| {
        let [at_a, at_b] = &poses.meeting[i].theirs;
        let found = contact(at_a, &*a.theirs, at_b, &*b.theirs, 0.0).expect(SUPPORTED);
        found.map_or(0.0, |found| found.dist)
    };
    (Box::new(ours), both(a, b, theirs))
}

/// A question that parry answers of all but two meshes.
fn both<'q>(a: &Kind, b: &Kind, theirs: impl Fn(usize) -> f64 + 'q) -> Option<Asker<'q>> {
    let meshes = a.theirs.as_trimesh().is_some() && b.theirs.as_trimesh().is_some();
    (!meshes).then(|| -> Asker { Box::new(theirs) })
}

fn contacts<'q>(a: &'q Kind, b: &'q Kind, poses: &'q Poses) -> (Asker<'q>, Option<Asker<'q>>) {
    let ours = move |i: usize| {
        let [at_a, at_b] = &poses.meeting[i].ours;
        let found = query::contacts(&a.ours, at_a, &b.ours, at_b, &ContactOptions::default());
        found.expect(VALID).iter().map(|manifold| manifold.points.len() as f64).sum()
    };
    let theirs = move |i: usize| {
        let [at_a, at_b] = &poses.meeting[i].theirs;
        contact_points([a, b], [at_a, at_b])
    };
    (Box::new(ours), both(a, b, theirs))
}

/// How many points parry's manifolds have.
pub fn contact_points([a, b]: [&Kind; 2], [at_a, at_b]: [&ParryPose; 2]) -> f64 {
    let (mut found, mut workspace): (Vec<ContactManifold<(), ()>>, _) = (Vec::new(), None);
    let between = at_a.inv_mul(at_b);
    let asked = DefaultQueryDispatcher.contact_manifolds(
        &between,
        &*a.theirs,
        &*b.theirs,
        0.0,
        &mut found,
        &mut workspace,
    );
    asked.expect(SUPPORTED);
    found.iter().map(|manifold| manifold.points.len() as f64).sum()
}

fn straight<'q>(a: &'q Kind, b: &'q Kind, poses: &'q Poses) -> (Asker<'q>, Option<Asker<'q>>) {
    let ours = move |i: usize| {
        let way = &poses.ways[i];
        let [at_a, at_b] = &way.from.ours;
        let cast = query::cast_shape(&a.ours, at_a, DVec3::ZERO, &b.ours, at_b, way.motion);
        cast.expect(VALID).map_or(1.0, |cast| cast.time)
    };
    let theirs = move |i: usize| {
        let way = &poses.ways[i];
        let [at_a, at_b] = &way.from.theirs;
        let options = ShapeCastOptions { max_time_of_impact: 1.0, ..ShapeCastOptions::default() };
        let (still, motion) = (Vector::ZERO, vector(way.motion));
        let cast = cast_shapes(at_a, still, &*a.theirs, at_b, motion, &*b.theirs, options);
        cast.expect(SUPPORTED).map_or(1.0, |cast| cast.time_of_impact)
    };
    (Box::new(ours), Some(Box::new(theirs)))
}

fn turning<'q>(a: &'q Kind, b: &'q Kind, poses: &'q Poses) -> (Asker<'q>, Option<Asker<'q>>) {
    let ours = move |i: usize| {
        let way = &poses.ways[i];
        let [at_a, at_b] = &way.from.ours;
        let options = ImpactOptions::default();
        let found = query::time_of_impact(&a.ours, at_a, at_a, &b.ours, at_b, &way.to, &options);
        found.expect(VALID).map_or(1.0, |found| found.time)
    };
    let theirs = move |i: usize| {
        let [of_a, of_b] = &poses.ways[i].turning;
        let found = cast_shapes_nonlinear(of_a, &*a.theirs, of_b, &*b.theirs, 0.0, 1.0, true);
        found.expect(SUPPORTED).map_or(1.0, |found| found.time_of_impact)
    };
    (Box::new(ours), both(a, b, theirs))
}

fn ray<'q>(kind: &'q Kind, sights: &'q [Sight]) -> (Asker<'q>, Option<Asker<'q>>) {
    // From the origin beyond the point.
    let ours = move |i: usize| {
        let ray = Ray::new(DVec3::ZERO, sights[i].point);
        let hit = query::cast_ray(&kind.ours, &sights[i].ours, &ray, &RayOptions::default());
        hit.expect(VALID).map_or(0.0, |hit| hit.t)
    };
    let theirs = move |i: usize| {
        let ray = ParryRay::new(Vector::ZERO, at(&sights[i]));
        let hit = kind.theirs.cast_ray_and_get_normal(&sights[i].theirs, &ray, f64::MAX, true);
        hit.map_or(0.0, |hit| hit.time_of_impact)
    };
    (Box::new(ours), Some(Box::new(theirs)))
}

fn contains<'q>(kind: &'q Kind, sights: &'q [Sight]) -> (Asker<'q>, Option<Asker<'q>>) {
    let ours = move |i: usize| {
        number(query::contains_point(&kind.ours, &sights[i].ours, sights[i].point).expect(VALID))
    };
    let theirs = move |i: usize| number(kind.theirs.contains_point(&sights[i].theirs, at(&sights[i])));
    (Box::new(ours), Some(Box::new(theirs)))
}
