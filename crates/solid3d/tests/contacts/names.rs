//! Points that keep their names from frame to frame, and the contacts of a world.

use std::collections::BTreeSet;

use glam::{DAffine3, DQuat, DVec3};
use solid_oracle::generate::{in_cube, seeded};
use solid3d::query::{self, ContactOptions, Feature, Manifold};
use solid3d::{Motion, Response, Shape, When, World, WorldOptions, glam};

use super::{SEED, assert_flat, cube, cube_mesh, floor, within};
use crate::common::at;

fn names(manifold: &Manifold) -> BTreeSet<([u32; 2], [Feature; 2])> {
    manifold.points.iter().map(|point| (point.primitives, point.features)).collect()
}

/// While the same parts are in contact, the same names: each its own.
#[test]
fn names_persist() {
    let plate = Shape::cuboid([4.0, 1.0, 4.0]).unwrap();
    let shapes = [cube(), Shape::cylinder(0.5, 1.0).unwrap(), cube_mesh(), Shape::capsule(0.2, 0.6).unwrap()];
    for (k, shape) in shapes.iter().enumerate() {
        let mut before = None;
        for frame in 0..50 {
            let t = f64::from(frame);
            let turn =
                DQuat::from_rotation_y(0.3 + 0.001 * t) * DQuat::from_rotation_z(1e-4 * (0.1 * t).sin());
            let place = DAffine3::from_rotation_translation(turn, DVec3::new(0.002 * t, 0.95, 0.1));
            let found = query::contacts(shape, &place, &plate, &DAffine3::IDENTITY, &within(0.1)).unwrap();
            let now = names(&found[0]);
            if k < 3 {
                assert_eq!(now.len(), found[0].points.len(), "shape {k}: {found:#?}");
            }
            assert!(before.is_none_or(|before| before == now), "shape {k}, frame {frame}: {found:#?}");
            before = Some(now);
        }
    }
}

#[test]
fn at_most_so_many_points() {
    let (plate, here) = (Shape::cuboid([9.0, 1.0, 9.0]).unwrap(), DAffine3::IDENTITY);
    let cylinder = Shape::cylinder(0.5, 1.0).unwrap();
    for most in [0, 1, 2, 4, 7] {
        let options = ContactOptions { max_points: Some(most), ..ContactOptions::default() };
        let found = query::contacts(&cylinder, &at(0.0, 0.9, 0.0), &plate, &here, &options).unwrap();
        assert_eq!(found[0].points.len(), most.max(1));
        if most == 4 {
            let middle: DVec3 = found[0].points.iter().map(|point| point.point_on_a).sum();
            assert!((middle / 4.0).with_y(0.0).length() < 1e-9, "four that carry it: {found:?}");
        }
    }
}

/// They are the same ones from frame to frame, where these differ by rounding.
#[test]
fn at_most_so_many_points_persist() {
    let mut rng = seeded(SEED);
    let (plate, options) =
        (Shape::cuboid([9.0, 1.0, 9.0]).unwrap(), ContactOptions { max_points: Some(4), ..within(0.01) });
    for shape in [Shape::cylinder(0.5, 1.0).unwrap(), Shape::cone(0.5, 1.0).unwrap()] {
        let mut before = None;
        for frame in 0..100 {
            let turn = DQuat::from_scaled_axis(in_cube(&mut rng) * 1e-14) * DQuat::from_rotation_y(0.3);
            let beside = DVec3::new(0.2, 0.999, 0.1) + in_cube(&mut rng) * 1e-14;
            let place = DAffine3::from_rotation_translation(turn, beside);
            let found = query::contacts(&shape, &place, &plate, &DAffine3::IDENTITY, &options).unwrap();
            let now = names(&found[0]);
            assert!(before.is_none_or(|before| before == now), "frame {frame}: {found:#?}");
            before = Some(now);
        }
    }
}

#[test]
fn a_world_has_contacts() {
    let mut world = World::new();
    let ground = world.add(&floor(10), DAffine3::IDENTITY).unwrap();
    let block = world.add(&cube(), at(0.0, 0.49, 0.0)).unwrap();
    let found = world.contacts(ground, block, &ContactOptions::default()).unwrap();
    assert_flat(&found[0], DVec3::NEG_Y, 0.01, 4);
    assert!(world.contacts(ground, ground, &ContactOptions::default()).is_err());
    assert!(world.contacts(ground, block, &within(f64::NAN)).is_err());
}

/// Law: `Response::Contacts` tells what `query::contacts` says, under names that stay while a block slides.
#[test]
fn a_test_tells_contacts_by_names_that_persist() {
    let ground = floor(10);
    let run = |caching: bool| {
        let default_response = Response::Contacts;
        let mut world =
            World::with_options(&WorldOptions { caching, default_response, ..WorldOptions::default() });
        world.add(&ground, DAffine3::IDENTITY).unwrap();
        let block = world.add(&cube(), at(0.0, 0.49, 0.0)).unwrap();
        let mut frames = Vec::new();
        for frame in 0..60 {
            // Within one square of the floor, then over its edge.
            let here = at(0.51 + 0.01 * f64::from(frame), 0.49, 0.52);
            world.set_placement(block, here).unwrap();
            let collisions = world.test();
            let expected =
                query::contacts(&ground, &DAffine3::IDENTITY, &cube(), &here, &ContactOptions::default());
            let found = collisions[0].manifolds().unwrap();
            assert_eq!(**found, expected.unwrap()[..], "frame {frame}");
            assert_flat(&found[0], DVec3::NEG_Y, 0.01, 4);
            frames.push(names(&found[0]));
            world.proceed();
        }
        frames
    };
    let frames = run(true);
    assert_eq!(frames, run(false));
    let changes = frames.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert!(
        (1..=4).contains(&changes),
        "names change {changes} times, where a corner comes onto another square"
    );
}

/// What is apart now has no contacts, but a point of the way.
#[test]
fn on_the_way_there_are_no_contacts() {
    let (motion, default_response) = (Motion::Swept, Response::Contacts);
    let mut world =
        World::with_options(&WorldOptions { motion, default_response, ..WorldOptions::default() });
    world.add(&floor(10), DAffine3::IDENTITY).unwrap();
    let block = world.add(&cube(), at(0.0, 2.0, 0.0)).unwrap();
    world.proceed();
    world.set_placement(block, at(0.0, -2.0, 0.0)).unwrap();
    let collisions = world.test();
    assert_eq!((collisions.len(), collisions[0].when), (1, When::OnTheWay));
    assert!(collisions[0].manifolds().unwrap().is_empty() && collisions[0].point().is_some());
    assert_eq!((collisions[0].depth(), collisions[0].normal()), (None, None));
}

/// Law: a point is on the primitive that it names, also where no primitive is left along a normal of its own: by a segment that ends just behind the
/// edges of rough ground.
#[test]
fn points_are_on_the_primitives_that_they_name() {
    let mut rng = seeded(SEED);
    let (n, here) = (8, DAffine3::IDENTITY);
    let triangles: Vec<[u32; 3]> = (0..n * n)
        .map(|cell| cell / n * (n + 1) + cell % n)
        .flat_map(|i| [[i, i + 1, i + n + 2], [i, i + n + 2, i + n + 1]])
        .collect();
    let mut points = 0;
    for _ in 0..3_000 {
        let vertices: Vec<DVec3> = (0..(n + 1) * (n + 1))
            .map(|i| DVec3::new(f64::from(i / (n + 1)), 2.0 * in_cube(&mut rng).y, f64::from(i % (n + 1))))
            .collect();
        let ground = Shape::mesh(vertices.clone(), triangles.clone()).unwrap();
        let corners = |triangle: u32| triangles[triangle as usize].map(|i| vertices[i as usize]);
        let [p, q, _] = corners((points % triangles.len()) as u32);
        let ends = [0, 1].map(|_| 0.5 * (p + q) + 0.2 * in_cube(&mut rng));
        let segment = Shape::convex_hull(&ends).unwrap();
        for mirrored in [false, true] {
            let [a, b] = if mirrored { [&segment, &ground] } else { [&ground, &segment] };
            let found = query::contacts(a, &here, b, &here, &ContactOptions::default()).unwrap();
            for point in found.iter().flat_map(|region| &region.points) {
                let on = if mirrored { point.point_on_b } else { point.point_on_a };
                let triangle = Shape::convex_hull(&corners(point.primitives[usize::from(mirrored)])).unwrap();
                let off = query::closest_point(&triangle, &here, on).unwrap().distance;
                assert!(off < 1e-9, "{off:e}: {point:?}");
                points += 1;
            }
        }
    }
    assert!(points > 2_000, "{points}");
}
