//! What a world keeps of its objects from frame to frame, and of one pair while it looks at the next.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{at, cube, torus};
use glam::{DAffine3, DVec3};
use solid3d::{Contact, ObjectId, Response, Shape, World, WorldOptions, glam, query};

/// A square of four corners, of two triangles that meet along one diagonal or the other.
fn square(other_diagonal: bool) -> Shape {
    let triangles = if other_diagonal { [[0, 1, 3], [1, 2, 3]] } else { [[0, 1, 2], [0, 2, 3]] };
    Shape::mesh(CORNERS, triangles).unwrap()
}

const CORNERS: [DVec3; 4] = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];

/// An object that got another shape, and deforms in a later frame, has the triangles of that shape.
#[test]
fn what_deforms_after_a_change_of_shape_has_the_new_triangles() {
    let ball = Shape::sphere(0.1).unwrap();
    let mut world = World::new();
    let sheet = world.add(&square(false), DAffine3::IDENTITY).unwrap();
    // Above the middle of the square, where the diagonal from the raised corners is.
    world.add(&ball, at(0.5, 0.5, 1.0)).unwrap();
    world.set_shape(sheet, &square(true)).unwrap();
    for _ in 0..3 {
        world.proceed();
        let raise = |corner: usize| CORNERS[corner] + if corner % 2 == 1 { DVec3::Z } else { DVec3::ZERO };
        world.deform(sheet, &[0, 1, 2, 3].map(raise)).unwrap();
        assert_eq!(world.test().len(), 1);
    }
}

/// A ridge of some triangles, one beside the other along x, the tops at z = 0.
fn ridge(count: u32) -> Shape {
    let corners = (0..count).flat_map(|i| {
        let x = f64::from(i);
        [DVec3::new(x, -1.0, -1.0), DVec3::new(x, 1.0, -1.0), DVec3::new(x, 0.0, 0.0)]
    });
    let triangles: Vec<[u32; 3]> = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Shape::mesh(corners.collect::<Vec<_>>(), triangles).unwrap()
}

fn world_of(response: Response) -> World {
    World::with_options(&WorldOptions { default_response: response, ..WorldOptions::default() })
}

/// How the only pair of a world came together.
fn approach(world: &mut World) -> (f64, DVec3) {
    let found = world.test();
    assert_eq!(found.len(), 1, "{found:?}");
    let Contact::Smart { distance, normal, .. } = found[0].contact else { panic!("{found:?}") };
    (distance, normal)
}

/// A floor of two triangles below z = 0.
fn floor() -> Shape {
    Shape::mesh(CORNERS.map(|corner| (corner - DVec3::new(0.5, 0.5, 0.0)) * 100.0), [[0, 1, 2], [0, 2, 3]])
        .unwrap()
}

/// Law: smart response says of an object that got another shape in the frame how that which it had came together with the other.
#[test]
fn smart_response_looks_at_the_shape_of_the_frame_before() {
    for (before, now) in [(2, 9), (9, 2)] {
        let mut world = world_of(Response::Smart);
        // The tops of an upright ridge are its highest points; upside down they are its lowest.
        let upside_down = |z: f64| at(0.0, 0.3, z) * DAffine3::from_rotation_x(std::f64::consts::PI);
        let thing = world.add(&ridge(before), upside_down(0.25)).unwrap();
        world.add(&floor(), DAffine3::IDENTITY).unwrap();
        assert!(world.test().is_empty());
        world.proceed();
        world.set_shape(thing, &ridge(now)).unwrap();
        world.set_placement(thing, upside_down(-0.125)).unwrap();
        let (distance, normal) = approach(&mut world);
        assert!(
            (distance - 0.25).abs() < 1e-12 && (normal - DVec3::Z).length() < 1e-12,
            "{distance} {normal}"
        );
    }
}

/// Law: what smart response says of a pair does not depend on those that were looked at before it.
#[test]
fn smart_response_says_of_a_pair_what_it_says_of_that_alone() {
    let mut rooms = [(9, 5.0), (2, 0.25), (5, 0.75), (1, 0.5)].map(|(count, height)| (ridge(count), height));
    let upside_down = |place: usize, z: f64| {
        at(0.0, 300.0 * place as f64, z) * DAffine3::from_rotation_x(std::f64::consts::PI)
    };
    for _ in 0..rooms.len() {
        let mut world = world_of(Response::Smart);
        let things: Vec<ObjectId> = (0..)
            .zip(&rooms)
            .map(|(place, (ridge, height))| {
                world.add(&floor(), at(0.0, 300.0 * f64::from(place), 0.0)).unwrap();
                world.add(ridge, upside_down(place as usize, *height)).unwrap()
            })
            .collect();
        assert!(world.test().is_empty());
        world.proceed();
        for (place, &thing) in things.iter().enumerate() {
            world.set_placement(thing, upside_down(place, -0.125)).unwrap();
        }
        let found = world.test();
        assert_eq!(found.len(), rooms.len());
        for (collision, (_, height)) in found.iter().zip(&rooms) {
            let Contact::Smart { distance, normal, .. } = collision.contact else { panic!("{collision:?}") };
            assert!(
                (distance - height).abs() < 1e-12 && (normal + DVec3::Z).length() < 1e-12,
                "{collision:?}"
            );
        }
        rooms.rotate_left(1);
    }
}

/// Two teeth that point down, so high above z = 0.
fn teeth(tips: [f64; 2]) -> Shape {
    let tooth =
        |x: f64, tip: f64| [DVec3::new(x, -1.0, 2.0), DVec3::new(x, 1.0, 2.0), DVec3::new(x, 0.0, tip)];
    Shape::mesh([tooth(0.0, tips[0]), tooth(-5.0, tips[1])].concat(), [[0, 1, 2], [3, 4, 5]]).unwrap()
}

/// Law: of meshes that met in the frame before, smart response looks at those triangles that meet now, though others were deeper.
#[test]
fn smart_response_looks_at_what_meets_now() {
    let mut world = world_of(Response::Smart);
    // The second tooth reaches half as deep as the first.
    let thing = world.add(&teeth([0.0, 0.25]), at(10.0, 0.3, -0.5)).unwrap();
    world.add(&floor(), DAffine3::IDENTITY).unwrap();
    world.test();
    world.proceed();
    // Now the deeper one is beside the floor.
    world.set_placement(thing, at(52.0, 0.3, -0.5)).unwrap();
    let (distance, normal) = approach(&mut world);
    assert!((distance + 0.25).abs() < 1e-9 && (normal - DVec3::Z).length() < 1e-9, "{distance} {normal}");
}

/// Law: of what meets now, smart response tells the nearest.
#[test]
fn smart_response_tells_the_nearest_of_what_meets() {
    for tips in [[0.0, 0.25], [0.25, 0.0]] {
        let mut world = world_of(Response::Smart);
        let thing = world.add(&teeth(tips), at(10.0, 0.3, 0.5)).unwrap();
        world.add(&floor(), DAffine3::IDENTITY).unwrap();
        world.test();
        world.proceed();
        world.set_placement(thing, at(10.0, 0.3, -0.5)).unwrap();
        let (distance, normal) = approach(&mut world);
        assert!((distance - 0.5).abs() < 1e-9 && (normal - DVec3::Z).length() < 1e-9, "{distance} {normal}");
    }
}

/// Law: of what was wholly in a solid, smart response tells how deep it was, not how far from the surface.
#[test]
fn smart_response_tells_how_deep_in_a_solid_something_was() {
    let solid = cube(5.0).shape().into_solid().unwrap();
    let ball = Shape::sphere(0.5).unwrap();
    for solid_first in [false, true] {
        let mut world = world_of(Response::Smart);
        let mut add = |is_solid: bool| {
            let shape = if is_solid { &solid } else { &ball };
            world.add(shape, if is_solid { DAffine3::IDENTITY } else { at(4.0, 0.3, 0.2) }).unwrap()
        };
        let ids = [add(solid_first), add(!solid_first)];
        world.proceed();
        // Out through the surface.
        world.set_placement(ids[usize::from(solid_first)], at(4.75, 0.3, 0.2)).unwrap();
        let (distance, normal) = approach(&mut world);
        let out = if solid_first { DVec3::NEG_X } else { DVec3::X };
        assert!((distance + 1.5).abs() < 1e-9 && (normal - out).length() < 1e-9, "{distance} {normal}");
    }
}

/// Law: of what rests, smart response tells the deepest of all that meets, whichever is the first.
#[test]
fn smart_response_tells_the_deepest_of_what_rests() {
    let ring = torus(24, 12, 0.4).shape();
    let block = Shape::cuboid([1.0, 0.7, 0.9]).unwrap();
    for (other, place) in [&block, &ring].into_iter().flat_map(|it| [(it, 0.5), (it, 0.7), (it, 0.9)]) {
        let here = at(place, 0.1, 0.2) * DAffine3::from_rotation_y(place);
        let mut things = [(&ring, DAffine3::IDENTITY), (other, here)];
        for _ in 0..2 {
            let mut world = world_of(Response::Smart);
            let [(a, at_a), (b, at_b)] = things;
            world.add(a, at_a).unwrap();
            world.add(b, at_b).unwrap();
            let (distance, normal) = approach(&mut world);
            let deepest = query::penetration(a, &at_a, b, &at_b).unwrap().unwrap();
            assert_eq!((distance, normal), (-deepest.depth, deepest.normal), "{} at {place}", other.kind());
            things.reverse();
        }
    }
}
