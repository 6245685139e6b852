//! Of what does not touch, within a margin.

use std::f64::consts::TAU;

use glam::{DAffine3, DMat3, DVec3};
use rand::Rng;
use solid_oracle::generate::{direction, seeded};
use solid3d::query::{self, ContactPoint};
use solid3d::{ComplexShapeBuilder, Shape, glam};

use super::{SEED, assert_flat, assert_laws, contacts, cube, deepest, floor, within};
use crate::common::{self, at, placement, random_complex, random_mesh, sheet, size_of};

/// A box a little off a floor, tilted: all four corners within the margin, with their gaps.
#[test]
fn gaps_within_the_margin_are_contacts() {
    let (plate, here) = (Shape::cuboid([9.0, 1.0, 9.0]).unwrap(), DAffine3::IDENTITY);
    let tilted = at(0.0, 1.01, 0.0) * DAffine3::from_rotation_z(0.005);
    for floor in [&plate, &floor(4)] {
        let lift = if floor.triangles().is_some() { -0.5 } else { 0.0 };
        let place = at(0.0, lift, 0.0) * tilted;
        assert!(contacts(&cube(), &place, floor, &here).is_empty());
        let found = query::contacts(&cube(), &place, floor, &here, &within(0.05)).unwrap();
        assert_eq!((found.len(), found[0].points.len()), (1, 4), "{found:?}");
        assert_laws(&found, 0.05, 10.0, "tilted");
        let mut depths: Vec<f64> = found[0].points.iter().map(|point| point.depth).collect();
        depths.sort_by(f64::total_cmp);
        assert!((depths[3] - depths[0] - 0.005).abs() < 1e-5 && depths[3] < 0.0, "{depths:?}");
        let near = query::contacts(&cube(), &place, floor, &here, &within(0.008)).unwrap();
        assert_eq!(near[0].points.len(), 2, "{near:?}");
    }
    for gap in [1e-13, 1e-11, 1e-9, 1e-6] {
        let found = query::contacts(&cube(), &at(0.0, 1.0 + gap, 0.0), &plate, &here, &within(0.01)).unwrap();
        assert_eq!((found[0].points.len(), found[0].normal), (4, DVec3::Y), "{gap}: {found:?}");
    }
}

/// Law: what is nearer than a margin has a contact there, as deep as the gap is wide, however small that is: down to 1e-11 of the size, also of
/// shapes of which one is small.
#[test]
fn what_is_nearer_than_the_margin_has_a_contact() {
    let mut rng = seeded(SEED + 10);
    let (mut apart, cases) = (0, 6_000);
    for case in 0..cases {
        let soup = match case % 4 {
            0 => random_mesh(&mut rng, 12),
            1 => random_complex(&mut rng, 6),
            _ => common::grid(&mut rng, 4, 4),
        };
        let (a, b) = (soup.shape(), common::some_shape(&mut rng, case / 4));
        let [pa, mut pb] = [0, 1].map(|_| placement(&mut rng, 1.0));
        if case % 3 == 0 {
            pb.matrix3 *= 10f64.powf(rng.random_range(-3.0..0.0));
        }
        let size = size_of(&a, &pa, &b, &pb);
        pb.translation = pa.translation + direction(&mut rng) * size;
        let between = query::distance(&a, &pa, &b, &pb).unwrap();
        let Some(way) = (between.point_on_b - between.point_on_a).try_normalize() else { continue };
        let gap = size * 10f64.powf(rng.random_range(-11.0..-6.0));
        pb.translation -= way * (between.distance - gap);
        let distance = query::distance(&a, &pa, &b, &pb).unwrap().distance;
        if distance == 0.0 {
            continue;
        }
        apart += 1;
        let found = query::contacts(&a, &pa, &b, &pb, &within(0.05 * size)).unwrap();
        let context =
            format!("case {case}: {} {pa:?} {} {pb:?}, {distance:e} apart of {size}", a.kind(), b.kind());
        assert_laws(&found, 0.05 * size, size, &context);
        let deepest = deepest(&found);
        assert!((deepest + distance).abs() <= 1e-8 * size, "{context}: {deepest}, {found:?}");
    }
    println!("{apart} of {cases} are apart");
    assert!(apart * 10 > cases * 9, "{apart} of {cases}");
}

/// So has what reaches around the end of a plate, and is for the most part on its other side.
#[test]
fn a_hook_over_the_end_of_a_plate_is_within_the_margin() {
    let here = DAffine3::IDENTITY;
    for width in [1.0, 4.0, 30.0] {
        let ends = [DVec3::new(-width, 0.0, -width), DVec3::new(-width, 0.0, width), DVec3::X];
        let plate = Shape::mesh(ends, [[0, 1, 2]]).unwrap();
        for bend in [3.0, -3.0, -9.0] {
            let corners = [
                DVec3::new(0.0, 0.125, 0.0),
                DVec3::new(3.0, 0.5, -0.5),
                DVec3::new(3.0, 0.5, 0.5),
                DVec3::new(3.0, bend, 0.0),
            ];
            let hook = Shape::mesh(corners, [[0, 1, 2], [1, 2, 3]]).unwrap();
            for (a, b, normal) in [(&hook, &plate, DVec3::Y), (&plate, &hook, DVec3::NEG_Y)] {
                let found = query::contacts(a, &here, b, &here, &within(0.5)).unwrap();
                let context = format!("{width} wide, bent to {bend}: {found:?}");
                assert_laws(&found, 0.5, width, &context);
                assert!(found.len() == 1 && (deepest(&found) + 0.125).abs() < 1e-12, "{context}");
                assert!((found[0].normal - normal).length() < 1e-12, "{context}");
            }
        }
    }
}

/// A needle stands on its end, also over a floor that it does not meet yet.
#[test]
fn a_needle_over_a_floor_is_within_the_margin() {
    let needle = Shape::convex_hull(&[DVec3::Y, -DVec3::Y]).unwrap();
    let segment = ComplexShapeBuilder::new([DVec3::Y, -DVec3::Y]).segment([0, 1]).build().unwrap();
    for tilt in [0.0, 1e-9, 1e-7, 1e-6, 1e-3] {
        let place = at(0.3, 1e-4 + f64::cos(tilt), 0.2) * DAffine3::from_rotation_z(tilt);
        for shape in [&needle, &segment] {
            let found =
                query::contacts(shape, &place, &floor(8), &DAffine3::IDENTITY, &within(1e-3)).unwrap();
            assert_eq!(found.len(), 1, "tilted by {tilt}");
            assert_flat(&found[0], DVec3::Y, -1e-4, 1);
        }
    }
}

/// What is inside a surface that is closed and convex, but not solid, is beside its triangles: as near as it is to them, and no nearer.
#[test]
fn what_is_inside_a_surface_is_near_its_triangles() {
    let (hollow, ball) = (common::cube(1.0).shape(), Shape::sphere(0.25).unwrap());
    let (here, inside) = (at(0.0, 0.0, 0.0), at(0.625, 0.125, 0.25));
    let near = |margin| query::contacts(&ball, &inside, &hollow, &here, &within(margin)).unwrap();
    assert!(near(0.0).is_empty() && near(0.1).is_empty());
    let found = near(0.25);
    assert_eq!((found.len(), found[0].normal, found[0].points.len()), (1, DVec3::NEG_X, 1));
    let ContactPoint { point_on_a, point_on_b, depth, .. } = found[0].points[0];
    assert!((depth + 0.125).abs() < 1e-12, "{depth}");
    assert!(point_on_a.distance(DVec3::new(0.875, 0.125, 0.25)) < 1e-6, "{point_on_a}");
    assert!(point_on_b.distance(DVec3::new(1.0, 0.125, 0.25)) < 1e-6, "{point_on_b}");
    // So it is of two such surfaces, whichever is inside. A solid has the other in it.
    let small = common::cube(0.5).shape();
    assert!(query::contacts(&small, &here, &hollow, &here, &within(0.25)).unwrap().is_empty());
    let found = query::contacts(&hollow, &here, &small, &here, &within(0.625)).unwrap();
    assert_eq!(found.len(), 6);
    assert!(
        found.iter().flat_map(|m| &m.points).all(|point| (point.depth + 0.5).abs() < 1e-12),
        "{found:#?}"
    );
    // And of a solid that is not convex: a shell, thin as a leaf, in a box that is sheared.
    let shell = common::joined([common::cube(1.0), common::cube(-0.25)]).shape().into_solid().unwrap();
    let leaf = DMat3::from_cols_array_2d(&[
        [0.0008, -0.0004, -0.0012],
        [-0.045, 0.0056, -0.0059],
        [0.057, 0.0096, -0.005],
    ]);
    let sheared =
        DMat3::from_cols_array_2d(&[[-0.145, -0.127, -0.084], [0.772, -1.295, 0.631], [-0.272, 0.037, 0.41]]);
    let [leaf, sheared] = [leaf, sheared].map(DAffine3::from_mat3);
    let gap = query::distance(&shell, &leaf, &hollow, &sheared).unwrap().distance;
    let found = query::contacts(&shell, &leaf, &hollow, &sheared, &within(1.5 * gap)).unwrap();
    assert!((deepest(&found) + gap).abs() < 1e-12, "{found:#?}, {gap}");
    let solid = hollow.into_solid().unwrap();
    assert!(deepest(&query::contacts(&solid, &here, &ball, &inside, &within(0.25)).unwrap()) > 0.5);
}

/// Near a solid that is not convex, what is apart is in none of its walls, also where the margin reaches through them.
#[test]
fn a_margin_does_not_lead_through_walls() {
    let mut rng = seeded(SEED + 9);
    let ring = common::torus(24, 8, 0.25).shape().into_solid().unwrap();
    let (mut near, cases) = (0, 300);
    for case in 0..cases {
        let (at_ring, mut at_box) = (placement(&mut rng, 0.0), placement(&mut rng, 0.0));
        at_box.translation = common::in_cube(&mut rng);
        let block = Shape::cuboid([0.2, 0.3, 0.4]).unwrap();
        if query::intersects(&ring, &at_ring, &block, &at_box).unwrap() {
            continue;
        }
        let distance = query::distance(&ring, &at_ring, &block, &at_box).unwrap().distance;
        let found = query::contacts(&ring, &at_ring, &block, &at_box, &within(distance + 0.5)).unwrap();
        near += 1;
        let deepest = deepest(&found);
        assert!((deepest + distance).abs() < 1e-9, "case {case}: {deepest}, {distance} apart");
    }
    println!("{near} of {cases} are apart");
    assert!(near > cases / 3);
}

/// What is wholly inside a solid leaves it by the shortest way out, with any margin: also where that reaches a wall, from inside.
#[test]
fn a_margin_does_not_turn_what_is_inside() {
    let ring = [(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (2.0, 2.0), (2.0, 4.0), (0.0, 4.0)];
    let level = |z: f64| ring.map(|(x, y)| DVec3::new(x, y, z));
    let caps = [[0_u32, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
    let caps = caps.into_iter().flat_map(|[i, j, k]| [[i, k, j], [i + 6, j + 6, k + 6]]);
    let sides = (0..6).map(|i| [i, (i + 1) % 6]).flat_map(|[i, j]| [[i, j, i + 6], [j, j + 6, i + 6]]);
    let corner = Shape::mesh([level(0.0), level(1.0)].concat(), caps.chain(sides).collect::<Vec<_>>());
    let corner = corner.unwrap().into_solid().unwrap();
    let place = at(1.0, 1.0, 0.8);
    for shape in [Shape::sphere(0.1).unwrap(), Shape::cuboid([0.2; 3]).unwrap()] {
        for margin in [0.0, 0.05, 0.15, 0.5] {
            let found =
                query::contacts(&shape, &place, &corner, &DAffine3::IDENTITY, &within(margin)).unwrap();
            assert_eq!((found.len(), found[0].normal), (1, DVec3::Z), "{margin}: {found:#?}");
            assert!((deepest(&found) - 0.3).abs() < 1e-12, "{margin}: {found:#?}");
        }
    }
}

/// What leans over is as deep with a margin as without.
#[test]
fn a_margin_loses_nothing_of_what_leans_over() {
    let plate =
        DMat3::from_cols(DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.0, -0.5, -3.0), DVec3::new(0.0, 0.0, 0.03));
    let plate = DAffine3::from_mat3(plate);
    let corners =
        [(-64.0, -64.0), (-64.0, 64.0), (64.0, -64.0), (64.0, 64.0)].map(|(x, z)| DVec3::new(x, 0.0, z));
    let (ground, below) = (Shape::mesh(corners, [[0, 1, 2], [1, 3, 2]]).unwrap(), at(0.3, -0.3, -2.0));
    for margin in [0.0, 1e-6, 0.01, 0.05, 0.075, 0.2] {
        let found = query::contacts(&cube(), &plate, &ground, &below, &within(margin)).unwrap();
        assert!((deepest(&found) - 0.45).abs() < 1e-12, "{margin}: {found:#?}");
    }
}

/// What stands on hills, below others that are within the margin, is not in those.
#[test]
fn a_ceiling_within_the_margin_is_not_what_stands_on_the_floor() {
    let hill = |x: f64, z: f64| 0.01 * (9.0 * x).sin() * (7.0 * z).cos();
    // Down one sheet, and back by the other.
    let cave = sheet(42, 21, [false, false], |u, v| {
        let (x, z) = (4.0 * if u < 0.5 { u } else { 1.0 - u } - 1.0, 2.0 * v - 1.0);
        DVec3::new(x, hill(x, z) + if u < 0.5 { 0.0 } else { 1.08 }, z)
    });
    let cave = cave.shape();
    let mut rng = seeded(SEED);
    for i in 0..100 {
        let turn = DAffine3::from_rotation_y(rng.random_range(0.0..TAU));
        let place = at(0.0, 0.5, 0.0) * turn;
        let found = query::contacts(&cube(), &place, &cave, &DAffine3::IDENTITY, &within(0.1)).unwrap();
        let points = || found.iter().flat_map(|manifold| &manifold.points);
        assert!(deepest(&found) < 0.0101, "box {i}: {found:#?}");
        assert!(points().any(|point| point.depth > 0.0 && point.point_on_b.y < 0.1), "box {i}: {found:#?}");
        assert!(points().any(|point| point.depth < 0.0 && point.point_on_b.y > 1.0), "box {i}: {found:#?}");
    }
}
