//! Rays and regions of a world, and what is nearest to a point or a shape, against all objects one by one.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by panicking, and prints its hit rate"
)]

mod common;

use common::{convex_of_kind, cube, direction, in_cube, placement, random_mesh, shape_of, torus};
use glam::{DAffine3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::{random_shape, seeded};
use solid3d::query::{self, FromInside, Ray, RayHit, RayOptions};
use solid3d::{
    BroadPhaseKind, ComplexShapeBuilder, ObjectDistance, ObjectHit, ObjectId, ObjectPoint, Shape, World,
    WorldOptions, glam,
};

/// Adds a mesh or a convex shape, of one of two ranks.
fn add_random(world: &mut World, rng: &mut StdRng, i: u8) -> ObjectId {
    let shape = match i % 3 {
        0 => random_mesh(rng, 40).shape(),
        _ => shape_of(&random_shape(rng, 1.0)),
    };
    world.add_ranked(&shape, placement(rng, 4.5), i % 2).unwrap()
}

/// Adds so many objects, and in two of three rounds places them in the broad phase.
fn grow(world: &mut World, rng: &mut StdRng, count: u8, round: usize) {
    for i in 0..count {
        add_random(world, rng, i);
    }
    if !round.is_multiple_of(3) {
        world.refresh();
    }
}

/// All objects, or every other.
fn lets_through(objects: &[ObjectId], id: ObjectId, case: usize) -> bool {
    case.is_multiple_of(2) || objects.iter().position(|other| *other == id).unwrap().is_multiple_of(2)
}

/// With either broad phase, and whatever the world knows already: nothing tested, all tested, some moved since, some removed.
#[test]
fn a_world_sees_what_its_objects_show() {
    let options = RayOptions::default();
    for broad_phase in [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune] {
        let mut rng = seeded(111);
        let mut world = World::with_options(&WorldOptions { broad_phase, ..WorldOptions::default() });
        let mut ids: Vec<ObjectId> = Vec::new();
        let (mut hits, mut cases, mut in_region) = (0, 0, 0);
        for round in 0..12 {
            for i in 0..12 {
                ids.push(add_random(&mut world, &mut rng, i));
            }
            if round % 3 > 0 {
                world.test();
            }
            if round % 5 == 2 {
                world.refresh();
            }
            for _ in 0..6 {
                let id = ids[rng.random_range(0..ids.len())];
                world.set_placement(id, placement(&mut rng, 4.5)).unwrap();
            }
            if round % 2 == 1 {
                world.remove(ids.swap_remove(round)).unwrap();
            }
            if round % 4 == 3 {
                world.proceed();
            }
            let in_order = world.objects();
            for _ in 0..40 {
                let target = in_cube(&mut rng) * 4.0;
                let from = target + direction(&mut rng) * rng.random_range(4.0..16.0);
                let ray = Ray::new(from, target - from).until(rng.random_range(0.6..2.0));
                let odd = rng.random_range(0..4);
                let counts = |id: ObjectId| {
                    odd > 0 || in_order.iter().position(|other| *other == id).unwrap() % 2 == 0
                };
                let mut expected: Vec<ObjectHit> = Vec::new();
                for &object in in_order.iter().filter(|id| counts(**id)) {
                    let (shape, at) = (world.shape(object).unwrap(), world.placement(object).unwrap());
                    let all = query::cast_ray_all(shape, &at, &ray, &options).unwrap();
                    expected.extend(all.into_iter().map(|hit| ObjectHit { object, hit }));
                }
                expected.sort_by(|x, y| x.hit.t.total_cmp(&y.hit.t));
                let all = world.cast_ray_all(&ray, &options, counts).unwrap();
                // Those that start at once, inside of several, are in the order of pairs.
                let times = |hits: &[ObjectHit]| hits.iter().map(|hit| hit.hit.t).collect::<Vec<_>>();
                assert_eq!(times(&all), times(&expected));
                assert!(expected.iter().all(|hit| all.contains(hit)));
                let first = world.cast_ray(&ray, &options, counts).unwrap();
                assert_eq!(first, all.first().copied());
                assert_eq!(world.ray_meets(&ray, &options, counts).unwrap(), first.is_some());
                cases += 1;
                hits += u32::from(first.is_some());

                let (region, at) = (shape_of(&random_shape(&mut rng, 1.0)), placement(&mut rng, 4.5));
                let mut expected = in_order.clone();
                expected.retain(|&id| {
                    let (shape, placed) = (world.shape(id).unwrap(), world.placement(id).unwrap());
                    query::intersects(shape, &placed, &region, &at).unwrap()
                });
                let mut found = world.objects_in(&region, &at).unwrap();
                in_region += found.len();
                found.sort_by_key(|id| in_order.iter().position(|other| other == id));
                assert_eq!(found, expected);
            }
        }
        println!("{hits} of {cases} rays hit; {in_region} objects in regions");
        assert!((0.3..=0.7).contains(&(f64::from(hits) / f64::from(cases))) && in_region > 100);
    }
}

/// The same of what is nearest to a point or a shape, within a distance; of objects that are as near the first in the order of pairs.
#[test]
fn nearest_is_what_is_nearest_of_all() {
    for broad_phase in [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune] {
        let mut rng = seeded(114);
        let mut world = World::with_options(&WorldOptions { broad_phase, ..WorldOptions::default() });
        let (mut found, mut cases, mut inside) = (0, 0, 0);
        for round in 0..12 {
            grow(&mut world, &mut rng, 6, round);
            let ids = world.objects();
            for _ in 0..4 {
                world.set_placement(ids[rng.random_range(0..ids.len())], placement(&mut rng, 4.5)).unwrap();
            }
            if round % 4 == 1 {
                // In the place of another, of one shape with it: both are as near.
                let (shape, at) =
                    (world.shape(ids[round]).unwrap().clone(), world.placement(ids[round]).unwrap());
                world.add_ranked(&shape, at, (round / 4 % 2) as u8).unwrap();
            }
            if round % 2 == 1 {
                world.remove(ids[round]).unwrap();
            }
            let everywhere = Shape::sphere(100.0).unwrap();
            let in_order = world.objects_in(&everywhere, &DAffine3::IDENTITY).unwrap();
            let far = if round % 5 == 4 { 1e17 } else { 1.0 };
            for case in 0..60 {
                let point = in_cube(&mut rng) * 5.0 * far;
                let within = if case % 3 == 0 { f64::INFINITY } else { rng.random_range(0.0..4.0) * far };
                let counts = |id| lets_through(&in_order, id, case);
                let closest = in_order.iter().filter(|id| counts(**id)).map(|&object| {
                    let (shape, at) = (world.shape(object).unwrap(), world.placement(object).unwrap());
                    ObjectPoint { object, closest: query::closest_point(shape, &at, point).unwrap() }
                });
                // The first of equals.
                let expected = (closest.filter(|near| near.closest.distance <= within))
                    .reduce(|x, y| if y.closest.distance < x.closest.distance { y } else { x });
                let nearest = world.closest_point(point, within, counts).unwrap();
                assert_eq!(nearest, expected, "{point}, {within}");
                cases += 1;
                found += u32::from(nearest.is_some());
                inside += u32::from(nearest.is_some_and(|near| near.closest.distance == 0.0));

                let (shape, mut at) = (shape_of(&random_shape(&mut rng, 0.5)), placement(&mut rng, 1.0));
                at.translation = point;
                let distances = in_order.iter().filter(|id| counts(**id)).map(|&object| {
                    let (other, other_at) = (world.shape(object).unwrap(), world.placement(object).unwrap());
                    let distance = query::distance(&shape, &at, other, &other_at).unwrap();
                    ObjectDistance { object, distance }
                });
                let expected = (distances.filter(|near| near.distance.distance <= within))
                    .reduce(|x, y| if y.distance.distance < x.distance.distance { y } else { x });
                let nearest = world.closest_object(&shape, &at, within, counts).unwrap();
                assert_eq!(nearest, expected, "a shape at {point}, {within}");
            }
        }
        println!("{found} of {cases} points have something near, {inside} are inside");
        assert!((0.5..=0.95).contains(&(f64::from(found) / f64::from(cases))) && inside > 5);
    }
    // Also so far away that no square of the distance is a number.
    let (mut world, hull) = (World::new(), Shape::convex_hull(&[DVec3::X * 1e100]).unwrap());
    let object = world.add(&hull, DAffine3::from_scale(DVec3::splat(1e100))).unwrap();
    for _ in 0..2 {
        let nearest = world.closest_point(DVec3::ZERO, f64::INFINITY, |_| true).unwrap().unwrap();
        assert!(nearest.object == object && (nearest.closest.distance - 1e200).abs() < 1e188);
        world.refresh();
    }
    let world = World::new();
    assert_eq!(world.closest_point(DVec3::ZERO, f64::INFINITY, |_| true), Ok(None));
    let error =
        |point: DVec3, within: f64| world.closest_point(point, within, |_| true).unwrap_err().to_string();
    assert_eq!(error(DVec3::ZERO, -1.0), "within is -1.0; it must be at least 0");
    assert_eq!(error(DVec3::ZERO, f64::NAN), "within is NaN; it must be at least 0");
    assert!(error(DVec3::X * 1e101, 1.0).starts_with("point is "));
    let nearest = |at: DAffine3, within: f64| world.closest_object(&hull, &at, within, |_| true);
    assert_eq!(nearest(DAffine3::IDENTITY, 1.0), Ok(None));
    assert_eq!(
        nearest(DAffine3::IDENTITY, -1.0).unwrap_err().to_string(),
        "within is -1.0; it must be at least 0"
    );
    assert!(nearest(DAffine3::ZERO, 1.0).unwrap_err().to_string().starts_with("placement is "));
}

/// The same of a shape that moves: it meets first what the earliest of all its casts meets.
#[test]
fn a_shape_meets_first_what_the_earliest_cast_meets() {
    for broad_phase in [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune] {
        let mut rng = seeded(113);
        let mut world = World::with_options(&WorldOptions { broad_phase, ..WorldOptions::default() });
        let (mut met, mut cases, mut at_start) = (0, 0, 0);
        for round in 0..10 {
            grow(&mut world, &mut rng, 4, round);
            let objects = world.objects();
            world.set_placement(objects[round], placement(&mut rng, 4.5)).unwrap();
            for case in 0..20 {
                let (shape, mut at) = (shape_of(&random_shape(&mut rng, 1.0)), placement(&mut rng, 1.0));
                let from = direction(&mut rng) * rng.random_range(4.0..16.0);
                let motion = (in_cube(&mut rng) * 4.0 - from) * rng.random_range(0.0..1.5);
                at.translation += from;
                let counts = |id| lets_through(&objects, id, case);
                let cast = |object: ObjectId| {
                    let (other, placed) = (world.shape(object).unwrap(), world.placement(object).unwrap());
                    query::cast_shape(&shape, &at, motion, other, &placed, DVec3::ZERO).unwrap()
                };
                let casts = objects.iter().filter(|id| counts(**id)).filter_map(|&id| cast(id));
                let earliest = casts.map(|cast| cast.time).min_by(f64::total_cmp);
                let first = world.cast_shape(&shape, &at, motion, counts).unwrap();
                assert_eq!(first.is_some(), earliest.is_some());
                cases += 1;
                let (Some(first), Some(earliest)) = (first, earliest) else { continue };
                assert_eq!(Some(first.cast), cast(first.object));
                assert!(counts(first.object) && first.cast.time <= earliest + 1e-8);
                met += 1;
                at_start += u32::from(first.cast.time == 0.0);
            }
        }
        println!("{met} of {cases} shapes meet something, {at_start} where they start");
        assert!((0.3..=0.7).contains(&(f64::from(met) / f64::from(cases))) && at_start > 5);
    }
}

/// Of objects in one place, which a ray hits, the first in the order of pairs is told, and a ray to where it hits hits there.
fn assert_first_is_told(shape: &Shape, at: DAffine3, ray: &Ray, hit: RayHit, case: usize) {
    let options = RayOptions::default();
    assert_eq!(query::cast_ray(shape, &at, &ray.until(hit.t), &options).unwrap(), Some(hit), "case {case}");
    for broad_phase in [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune] {
        for known in [false, true] {
            let mut world = World::with_options(&WorldOptions { broad_phase, ..WorldOptions::default() });
            for _ in 0..3 {
                world.add_ranked(shape, at, 1).unwrap();
            }
            if known {
                world.refresh();
            }
            // Looked at with those or before them, then among them.
            let object = world.add(shape, at).unwrap();
            for refreshed in [false, true] {
                let found = world.cast_ray(ray, &options, |_| true).unwrap();
                let context = format!("case {case}, {broad_phase:?}, known: {known}, refreshed: {refreshed}");
                assert_eq!(found, Some(ObjectHit { object, hit }), "{context}");
                world.refresh();
            }
        }
    }
}

/// Law: of objects that are met at the same `t` the first in the order of pairs is told, by either broad phase, whether they were placed in it or not;
/// also from so far that rounding leaves few values of `t` for all of a shape.
#[test]
fn of_objects_met_at_the_same_t_the_first_is_told_from_any_distance() {
    let mut rng = seeded(112);
    let options = RayOptions::default();
    let shapes =
        [cube(0.5).shape(), Shape::cuboid([1.0; 3]).unwrap(), shape_of(&random_shape(&mut rng, 1.0))];
    let (mut hits, cases) = (0, 2400);
    for case in 0..cases {
        let shape = &shapes[[0, 0, 1, 2][case % 4]];
        let turn = DQuat::from_axis_angle(direction(&mut rng), rng.random_range(0.0..3.1));
        let at = DAffine3::from_rotation_translation(turn, in_cube(&mut rng) * 3.0);
        let from = direction(&mut rng) * [1.0, 1e6, 1e9, 3e9, 1e10, 1e11][case / 4 % 6];
        let ray = Ray::new(from, at.translation + in_cube(&mut rng) * 0.5 - from);
        let Some(hit) = query::cast_ray(shape, &at, &ray, &options).unwrap() else { continue };
        hits += 1;
        assert_first_is_told(shape, at, &ray, hit, case);
    }
    println!("{hits} of {cases} hit");
    assert!(hits > cases / 2);
}

/// The same of what is hit by casts, which may be early: hulls of many points, far from their local origin, and next to nothing.
#[test]
fn of_hulls_met_at_the_same_t_the_first_is_told() {
    let mut rng = seeded(115);
    let options = RayOptions::default();
    let (mut hits, cases) = (0, 3000);
    let ring = |at: f64, count: u32| -> Vec<DVec3> {
        let point = |i: u32| {
            let angle = f64::from(i / 2) / f64::from(count) * 4.0 * std::f64::consts::PI;
            DVec3::new(at + angle.cos(), f64::from(i % 2) * 2.0 - 1.0, angle.sin())
        };
        (0..count).map(point).collect()
    };
    let whole = |points: Vec<DVec3>| {
        let corners: Vec<u32> = (0..points.len() as u32).collect();
        ComplexShapeBuilder::new(points).polyhedron(&corners).build().unwrap()
    };
    let shapes = [
        ComplexShapeBuilder::new([DVec3::Y]).tetrahedron([0; 4]).build().unwrap(),
        Shape::convex_hull(&ring(0.0, 800)).unwrap(),
        whole(ring(6.4e6, 40)),
        Shape::convex_hull(&ring(1e5, 800)).unwrap(),
    ];
    for case in 0..cases {
        let shape = &shapes[case % 4];
        let turn = DQuat::from_rotation_y(if case % 8 < 4 { 0.0 } else { rng.random_range(-1.0..1.0) });
        let scale = if case % 3 == 0 { 1e-6 } else { 1.0 };
        let at = DAffine3::from_scale_rotation_translation(DVec3::splat(scale), turn, in_cube(&mut rng));
        let corners = shape.vertices().unwrap();
        let to = at.transform_point3(corners[rng.random_range(0..corners.len())]);
        let from = to + DVec3::Y * if case % 5 == 0 { 2.0 } else { rng.random_range(0.1..2.0) };
        let aside = if case % 2 == 0 { DVec3::ZERO } else { 0.1 * scale * in_cube(&mut rng) };
        let ray = Ray::new(from, to + aside - from);
        let Some(hit) = query::cast_ray(shape, &at, &ray, &options).unwrap() else { continue };
        hits += 1;
        assert_first_is_told(shape, at, &ray, hit, case);
    }
    println!("{hits} of {cases} hit");
    assert!(hits > cases / 3);
}

/// Law: of objects in one place the first is told, also where another was moved since the last test, and is looked at before it; what is exactly as far away as
/// asked for is told.
#[test]
fn of_objects_in_one_place_the_first_is_told() {
    let ball = Shape::sphere(1.0).unwrap();
    let [here, there] = [0.0, 4.0].map(|x| DAffine3::from_translation(DVec3::X * x));
    for moved in [None, Some(0), Some(1)] {
        let mut world = World::new();
        let objects = [(); 2].map(|()| world.add(&ball, there).unwrap());
        world.refresh();
        if let Some(moved) = moved {
            world.set_placement(objects[moved], here).unwrap();
            world.set_placement(objects[moved], there).unwrap();
        }
        let cast = world.cast_shape(&ball, &here, DVec3::X * 5.0, |_| true).unwrap().unwrap();
        let ray = Ray::new(DVec3::ZERO, DVec3::X);
        let hit = world.cast_ray(&ray, &RayOptions::default(), |_| true).unwrap().unwrap();
        let point = world.closest_point(DVec3::ZERO, 3.0, |_| true).unwrap().unwrap();
        let object = world.closest_object(&ball, &here, 2.0, |_| true).unwrap().unwrap();
        let told = [cast.object, hit.object, point.object, object.object];
        assert_eq!(told, [objects[0]; 4], "{moved:?}");
        // Also where each is met at once, or no farther away than at all.
        let inside = world.closest_point(DVec3::X * 4.5, 0.0, |_| true).unwrap().unwrap();
        let around = world.closest_object(&ball, &there, 0.0, |_| true).unwrap().unwrap();
        assert_eq!([inside.object, around.object], [objects[0]; 2], "{moved:?}");
        let all = world.cast_ray_all(&ray, &RayOptions::default(), |_| true).unwrap();
        let all: Vec<_> = all.iter().map(|found| (found.hit.t, found.object)).collect();
        let [first, second] = objects;
        assert_eq!(all, [(3.0, first), (3.0, second), (5.0, first), (5.0, second)], "{moved:?}");
    }
}

/// Law: what a world tells of a ray is what the query tells, to the bit, signs of zeros too.
#[test]
fn a_world_and_a_query_tell_the_same_bits() {
    let mut rng = seeded(113);
    let options = RayOptions { from_inside: FromInside::Passes, ..RayOptions::default() };
    let (mut backs, cases) = (0, 3000);
    for case in 0..cases {
        let shape = shape_of(&random_shape(&mut rng, 1.0));
        // Zeros are where rays and turns are about axes.
        let turn = DQuat::from_axis_angle(DVec3::AXES[case % 3], f64::from(case as u32 % 7));
        let at = DAffine3::from_rotation_translation(
            turn,
            DVec3::AXES[case / 3 % 3] * f64::from(case as u32 / 9 % 3),
        );
        let way = DVec3::AXES[case / 21 % 3] * [1.0, -1.0][case / 63 % 2];
        let ray = Ray::new(DVec3::AXES[case / 5 % 3] * f64::from(case as u32 / 15 % 2), way);
        let mut world = World::new();
        world.add(&shape, at).unwrap();
        let in_world = world.cast_ray(&ray, &options, |_| true).unwrap().map(|found| found.hit);
        let of_query = query::cast_ray(&shape, &at, &ray, &options).unwrap();
        // In words a zero has its sign.
        assert_eq!(format!("{in_world:?}"), format!("{of_query:?}"), "case {case}: {at:?} {ray:?}");
        backs += usize::from(of_query.and_then(|hit| hit.surface).is_some_and(|surface| surface.back));
    }
    println!("{backs} of {cases} hit from the back");
    assert!(backs > cases / 10);
}

/// Law: what starts off each surface by a skin bounces about in a closed room, and never hits where it comes from.
#[test]
fn with_a_skin_a_ray_bounces() {
    const SKIN: f64 = 1e-9;
    let mut rng = seeded(117);
    for solid in [false, true] {
        let mut world = World::new();
        world.add(&cube(5.0).shape(), DAffine3::IDENTITY).unwrap();
        for kind in 0..12 {
            let mut at = placement(&mut rng, 3.0);
            at.translation = 3.0 * in_cube(&mut rng);
            let soup = torus(16, 9, 0.3).shape();
            let shape = match kind % 6 {
                0 if solid => soup.into_solid().unwrap(),
                0 => soup,
                kind => convex_of_kind(&mut rng, kind, [0.6, 1.0, 0.8], 0.7),
            };
            world.add(&shape, at).unwrap();
        }
        let mut ray = Ray::new(DVec3::new(4.9, 4.8, 4.7), direction(&mut rng));
        for bounce in 0..4000 {
            let found = world.cast_ray(&ray, &RayOptions::default(), |_| true).unwrap();
            let hit = found.unwrap_or_else(|| panic!("bounce {bounce}: {ray:?} leaves the room")).hit;
            let normal = hit.surface.unwrap_or_else(|| panic!("bounce {bounce}: {ray:?} is inside")).normal;
            assert!(hit.t > 0.1 * SKIN, "bounce {bounce}: {ray:?} hits at {:e}", hit.t);
            let onward = ray.direction.reflect(normal).normalize();
            ray = Ray::new(hit.point + SKIN * normal, onward);
        }
    }
}

/// Of a ray without an end, too, only the objects are asked whose boxes it meets; in either broad phase, whether they were tested or not.
#[test]
fn objects_beside_a_ray_are_not_asked() {
    let ball = solid3d::Shape::sphere(0.3).unwrap();
    for broad_phase in [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune] {
        let mut world = World::with_options(&WorldOptions { broad_phase, ..WorldOptions::default() });
        for i in 0..1000 {
            let at = glam::DVec3::new(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100));
            world.add(&ball, DAffine3::from_translation(at)).unwrap();
        }
        for tested in [false, true] {
            let ray = Ray::new(glam::DVec3::new(-2.0, 5.0, 5.0), glam::DVec3::X);
            let mut asked = 0;
            let mut count = |_| {
                asked += 1;
                true
            };
            let options = RayOptions::default();
            assert_eq!(world.cast_ray_all(&ray, &options, &mut count).unwrap().len(), 20);
            assert!(world.cast_ray(&ray, &options, &mut count).unwrap().is_some());
            assert!(world.ray_meets(&ray, &options, &mut count).unwrap());
            let aside = Ray::new(ray.origin + 0.5, ray.direction);
            assert!(!world.ray_meets(&aside, &options, &mut count).unwrap());
            assert!(asked <= 30, "{broad_phase:?}, tested: {tested}: {asked} asked");
            world.test();
        }
    }
}

#[test]
fn bad_input_is_refused() {
    let world = World::new();
    let ray = Ray::new(glam::DVec3::NAN, glam::DVec3::X);
    assert!(world.cast_ray(&ray, &RayOptions::default(), |_| true).is_err());
    assert!(world.cast_ray_all(&ray, &RayOptions::default(), |_| true).is_err());
    assert!(world.ray_meets(&ray, &RayOptions::default(), |_| true).is_err());
    let region = solid3d::Shape::sphere(1.0).unwrap();
    let flat = DAffine3::from_scale(glam::DVec3::ZERO);
    assert!(world.objects_in(&region, &flat).is_err());
    let cast = |at: &DAffine3, motion| world.cast_shape(&region, at, motion, |_| true);
    assert_eq!(cast(&DAffine3::IDENTITY, glam::DVec3::ZERO), Ok(None));
    assert!(cast(&flat, glam::DVec3::X).unwrap_err().to_string().starts_with("placement is singular"));
    let error = cast(&DAffine3::IDENTITY, glam::DVec3::NAN).unwrap_err().to_string();
    assert!(error.starts_with("motion is (NaN, NaN, NaN)"), "{error}");
}
