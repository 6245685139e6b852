//! Wherever two surfaces meet there is a contact.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use glam::{DAffine3, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::{direction, in_cube, log_uniform, seeded};
use solid3d::query;
use solid3d::{Aabb, Shape, glam};

use super::{SEED, contacts};
use crate::common::{Soup, convex_of_kind, random_mesh, sheet, torus};

/// A primitive of each of two shapes; 0 of a body.
type Two = [u32; 2];

/// The triangles of two shapes; of a body one with one corner.
type Surfaces<'a> = [&'a [[u32; 3]]; 2];

/// Those of some pairs that are connected with the first, by corners that they have in common on both sides.
fn connected(surfaces: Surfaces, pairs: &mut Vec<Two>) -> Vec<Two> {
    let have_common = |side: usize, i: u32, j: u32| {
        let [i, j] = [i, j].map(|i| surfaces[side][i as usize]);
        i.iter().any(|corner| j.contains(corner))
    };
    let (mut found, mut next) = (vec![pairs.remove(0)], 0);
    while let Some(&pair) = found.get(next) {
        next += 1;
        let is_beside = |other: &mut Two| (0..2).all(|side| have_common(side, pair[side], other[side]));
        found.extend(pairs.extract_if(.., is_beside));
    }
    found
}

/// In how many places two shapes meet, if in several; fails where one has no contact, nor has what is connected with it and `near`.
fn several_places(shapes: [(&Shape, &DAffine3); 2], surfaces: Surfaces, near: &[Two], case: u32) -> usize {
    let ([(a, at_a), (b, at_b)], mut met) = (shapes, Vec::new());
    let each = |i, j| {
        met.push([i, j]);
        ControlFlow::Continue(())
    };
    query::intersecting_primitives(a, at_a, b, at_b, each).unwrap();
    let found = contacts(a, at_a, b, at_b);
    let told: Vec<Two> =
        found.iter().flat_map(|region| region.points.iter().map(|point| point.primitives)).collect();
    let mut places = 0;
    while !met.is_empty() {
        let mut around = connected(surfaces, &mut met);
        around.extend(near);
        let place = connected(surfaces, &mut around);
        assert!(told.iter().any(|pair| place.contains(pair)), "case {case}: {place:?} in {told:?}");
        places += 1;
    }
    if places > 1 { places } else { 0 }
}

/// A body of any kind or a ring, thin or flat, with its triangles.
fn spear(rng: &mut StdRng, case: u32) -> (Shape, Vec<[u32; 3]>) {
    let sizes = [(); 3].map(|()| log_uniform(rng, 1e-3, 2.0));
    match case % 7 {
        6 => {
            let ring = torus(8, 6, 0.4);
            let stretched = ring.vertices.iter().map(|&corner| corner * DVec3::from_array(sizes));
            (Soup::mesh(stretched.collect(), ring.triangles()).shape(), ring.triangles())
        }
        kind => (convex_of_kind(rng, kind, sizes, sizes[0]), vec![[0; 3]]),
    }
}

/// Law: there is a contact of primitives that are connected with those that meet, also where a spear is through several walls, and its ends are over none of
/// them.
#[test]
fn every_place_has_a_contact() {
    let mut rng = seeded(SEED);
    let (ring, here, mut several) = (torus(12, 8, 0.4), DAffine3::IDENTITY, 0);
    let (wall, triangles) = (ring.shape(), ring.triangles());
    for case in 0..8_000 {
        let (spear, of_spear) = spear(&mut rng, case);
        let turned = DAffine3::from_axis_angle(direction(&mut rng), rng.random_range(0.0..TAU));
        let placed = DAffine3::from_translation(in_cube(&mut rng)) * turned;
        // The way out may lead across an edge that a body is only near.
        let around = query::bounds(&spear, &placed).unwrap();
        let is_near = |triangle: [u32; 3]| {
            Aabb::of_points(triangle.map(|i| ring.vertices[i as usize])).overlaps(&around)
        };
        let near = (0..).zip(&triangles).filter(|&(_, &triangle)| of_spear.len() == 1 && is_near(triangle));
        let near: Vec<Two> = near.map(|(i, _)| [i, 0]).collect();
        several += several_places([(&wall, &here), (&spear, &placed)], [&triangles, &of_spear], &near, case);
    }
    println!("{several} places, of two and more");
    assert!(several > 600, "{several} places");
}

/// Law: so there is of two meshes, of which one is rough ground.
#[test]
fn every_place_of_a_mesh_on_rough_ground_has_a_contact() {
    let mut rng = seeded(SEED + 1);
    let (here, mut several) = (DAffine3::IDENTITY, 0);
    for case in 0..2_000 {
        let squares = [3, 6, 12][case as usize % 3];
        let ground = sheet(squares, squares, [false, false], |u, v| {
            DVec3::new(4.0 * v - 2.0, rng.random_range(-0.1..0.1), 4.0 * u - 2.0)
        });
        let (count, ring) = (rng.random_range(1..12), torus(10, 6, 0.4));
        let other = if case % 2 == 0 { random_mesh(&mut rng, count) } else { ring };
        let turned = DAffine3::from_axis_angle(direction(&mut rng), rng.random_range(0.0..TAU));
        let placed = DAffine3::from_translation(in_cube(&mut rng)) * turned;
        let (shapes, of_each) = ([&ground, &other].map(Soup::shape), [&ground, &other].map(Soup::triangles));
        let (placed, surfaces) =
            ([(&shapes[0], &here), (&shapes[1], &placed)], [&of_each[0][..], &of_each[1]]);
        several += several_places(placed, surfaces, &[], case);
    }
    println!("{several} places, of two and more");
    assert!(several > 300, "{several} places");
}
