//! What other libraries are known to get wrong: each a test here. Most were found in parry 0.31, some in FCL and Coal.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by panicking, and prints its hit rate"
)]

mod common;

use std::f64::consts::{FRAC_PI_4, PI};

use common::{assert_rate, at, cube, direction, in_cube, shape_of, sheet};
use glam::{DAffine3, DMat3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::seeded;
use solid_oracle::{Convex, distance_bounds, penetration_bounds, verdict};
use solid3d::query::{self, ContactOptions, ImpactOptions, Penetration, Ray, RayOptions};
use solid3d::{Shape, World, glam};

const SEED: u64 = 31;

fn turned(rng: &mut StdRng, translation: DVec3) -> DAffine3 {
    let turn = DQuat::from_axis_angle(direction(rng), rng.random_range(0.0..PI));
    DAffine3::from_rotation_translation(turn, translation)
}

fn ball_of_points(rng: &mut StdRng, count: usize, size: f64) -> Convex {
    Convex::Hull { points: (0..count).map(|_| direction(rng) * size).collect() }
}

/// Absolute tolerances: disjoint objects of a millimetre "meet", their distances are off, and their contacts are missed.
#[test]
fn small_objects_are_told_apart_as_large_ones_are() {
    println!("seed {SEED}");
    let mut rng = seeded(SEED);
    let (mut hits, mut cases) = (0, 0);
    for size in [1.0, 1e-2, 1e-3, 1e-4, 1e-6, 1e6] {
        for _ in 0..60 {
            let [a, b] = [20, 30].map(|count| ball_of_points(&mut rng, count, size));
            let apart = direction(&mut rng) * rng.random_range(1.2..2.2) * size;
            let [pa, pb] = [DVec3::ZERO, apart].map(|origin| turned(&mut rng, origin));
            let (shape_a, shape_b) = (shape_of(&a), shape_of(&b));
            let meet = query::intersects(&shape_a, &pa, &shape_b, &pb).unwrap();
            assert_eq!(verdict(&a, &pa, &b, &pb).shares_point(), Some(meet), "size {size}");
            let (least, greatest) = distance_bounds(&a, &pa, &b, &pb);
            let distance = query::distance(&shape_a, &pa, &shape_b, &pb).unwrap().distance;
            let error = 1e-11 * size;
            assert!((least - error..=greatest + error).contains(&distance), "size {size}: {distance}");
            let contacts = query::contacts(&shape_a, &pa, &shape_b, &pb, &ContactOptions::default()).unwrap();
            assert_eq!(contacts.is_empty(), !meet, "size {size}");
            hits += usize::from(meet);
            cases += 1;
        }
    }
    assert_rate("pairs of all sizes", hits, cases);
}

/// GJK stops at a point, an edge or a face when the origins coincide, and the depth comes out as 0.
#[test]
fn what_lies_on_itself_is_deep() {
    let of_itself = |shape: &Shape| {
        let here = DAffine3::IDENTITY;
        query::penetration(shape, &here, shape, &here).unwrap().unwrap()
    };
    let (r, h) = (0.5f64, 1.5f64);
    // The narrowest of the triangle that a cone is seen as from the side.
    let across_cone = (2.0 * r * h / (r * r + h * h).sqrt()).min(h);
    let expected = [
        (Shape::sphere(r), 2.0 * r),
        (Shape::cuboid([1.0, 2.0, 3.0]), 1.0),
        (Shape::cylinder(r, h), 2.0 * r),
        (Shape::cylinder(h, r), r),
        (Shape::capsule(r, h), 2.0 * r),
        (Shape::cone(r, h), across_cone),
    ];
    for (shape, expected) in expected {
        let shape = shape.unwrap();
        assert_certified(&of_itself(&shape), [expected; 2], shape.kind());
    }
}

/// As above, but a little off, and of two kinds.
#[test]
fn a_cone_in_a_box_is_as_deep_as_it_is() {
    let cone = Convex::Cone { radius: 0.5, half_height: 0.5 };
    let cuboid = Convex::Cuboid { half: DVec3::splat(1.0) };
    for offset in [DVec3::ZERO, DVec3::X * 0.25, DVec3::Y * 0.25, DVec3::splat(0.25), DVec3::X * 1e-9] {
        let (here, there) = (DAffine3::IDENTITY, DAffine3::from_translation(offset));
        let found = query::penetration(&shape_of(&cone), &here, &shape_of(&cuboid), &there).unwrap().unwrap();
        let (least, greatest) = penetration_bounds(&cone, &here, &cuboid, &there).unwrap();
        assert_certified(&found, [least, greatest], offset);
    }
}

/// The bounds of a depth agree with those of the truth, and are near each other.
fn assert_certified(found: &Penetration, [least, greatest]: [f64; 2], what: impl std::fmt::Display) {
    assert!(found.depth_min <= greatest + 1e-12 && least <= found.depth_max + 1e-12, "{what}: {found:?}");
    assert!(found.depth_max - found.depth_min <= 1e-3 * found.depth, "{what}: {found:?}");
}

/// Gaps of a hundred-thousandth of the size, and down to 1e-11 of it, are gaps.
#[test]
fn a_small_gap_is_a_gap() {
    println!("seed {SEED}");
    let mut rng = seeded(SEED);
    let cube = Shape::cuboid([1.0; 3]).unwrap();
    let mut hits = 0;
    const CASES: usize = 500;
    for _ in 0..CASES {
        // A corner straight above a face.
        let turn = DQuat::from_axis_angle(direction(&mut rng), rng.random_range(0.2..3.0));
        let corners = [[1, 1, 1], [1, 1, -1], [1, -1, 1], [-1, 1, 1]];
        let reach = corners
            .map(|corner| (turn * (0.5 * DVec3::from(corner.map(f64::from)))).y.abs())
            .into_iter()
            .fold(0.0, f64::max);
        let sign = if rng.random() { 1.0 } else { -1.0 };
        let gap = sign * 10f64.powf(rng.random_range(-11.0..-4.0));
        let here = DAffine3::from_rotation_translation(turn, DVec3::new(0.1, 0.5 + reach + gap, -0.1));
        let floor = Shape::cuboid([10.0, 1.0, 10.0]).unwrap();
        let meet = query::intersects(&floor, &DAffine3::IDENTITY, &cube, &here).unwrap();
        assert_eq!(meet, gap < 0.0, "a gap of {gap}");
        hits += usize::from(meet);
    }
    assert_rate("corners near a face", hits, CASES);
}

/// Normals multiplied by the scale, as if they were points.
#[test]
fn the_normal_of_a_scaled_wedge_is_across_its_face() {
    let corners = [[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 1], [2, 0, 1], [0, 2, 1]];
    let corners = corners.map(|corner: [i32; 3]| DVec3::from(corner.map(f64::from)));
    let wedge = Shape::convex_hull(&corners).unwrap();
    let scaled = DAffine3::from_scale(DVec3::new(1.0, 4.0, 1.0));
    let ray = Ray::new(DVec3::new(3.0, 4.0, 0.5), DVec3::new(-1.0, 0.0, 0.0));
    let hit = query::cast_ray(&wedge, &scaled, &ray, &RayOptions::default()).unwrap().unwrap();
    let normal = hit.surface.unwrap().normal;
    // The slope goes from (2, 0) to (0, 8).
    assert!(normal.dot(DVec3::new(-2.0, 8.0, 0.0)).abs() < 1e-12, "{normal}");
    assert!(normal.x > 0.0 && (normal.length() - 1.0).abs() < 1e-12, "{normal}");
}

/// A child that is turned within a parent that is scaled is sheared; scaling it along its own axes is another shape.
#[test]
fn a_turned_shape_under_a_scale_is_sheared() {
    let cube = Shape::cuboid([1.0; 3]).unwrap();
    let turn = DMat3::from_rotation_z(FRAC_PI_4);
    let sheared = DAffine3::from_mat3(DMat3::from_diagonal(DVec3::new(4.0, 1.0, 1.0)) * turn);
    let point = Shape::sphere(1e-6).unwrap();
    let half_diagonal = 0.5f64.sqrt();
    // The corners lie on the axes, four times as far along x.
    let meets = |x, y| query::intersects(&cube, &sheared, &point, &at(x, y, 0.0)).unwrap();
    assert!(meets(3.99 * half_diagonal, 0.0) && !meets(4.01 * half_diagonal, 0.0));
    assert!(meets(0.0, 0.99 * half_diagonal) && !meets(0.0, 1.01 * half_diagonal));
    assert!(!meets(2.1 * half_diagonal, 0.5 * half_diagonal));
}

/// The volume of flat boxes is 0 however they are cut: a tree built by it is a list.
#[test]
fn a_flat_floor_has_a_tree() {
    let floor = sheet(65, 65, [false, false], |u, v| DVec3::new(u, 0.0, v)).shape();
    assert_eq!(floor.primitive_count(), 8192);
    let mut world = World::new();
    world.add(&floor, DAffine3::IDENTITY).unwrap();
    let block = world.add(&Shape::cuboid([0.001; 3]).unwrap(), at(0.51, 0.0, 0.51)).unwrap();
    for frame in 0..100 {
        world.set_placement(block, at(0.005 + 0.0099 * f64::from(frame), 0.0, 0.37)).unwrap();
        assert_eq!(world.test().len(), 1);
    }
    let boxes = world.statistics().box_tests;
    // Of 8,192 triangles, eight to a leaf and eight to a node, a way down passes four nodes; some pass more than one way.
    assert!(boxes < 100 * 16, "{boxes} nodes in 100 frames");
}

/// The first four corners of a face, all on one half of it.
#[test]
fn a_face_of_eight_corners_stands_on_all_of_them() {
    let ring = |y: f64| {
        (0..8).map(move |i| DVec3::new((f64::from(i) * FRAC_PI_4).cos(), y, (f64::from(i) * FRAC_PI_4).sin()))
    };
    let prism = Shape::convex_hull(&ring(-0.5).chain(ring(0.5)).collect::<Vec<_>>()).unwrap();
    let table = Shape::cuboid([10.0, 1.0, 10.0]).unwrap();
    let manifolds =
        query::contacts(&table, &at(0.0, -0.99, 0.0), &prism, &at(0.0, 0.0, 0.0), &ContactOptions::default())
            .unwrap();
    assert_eq!(manifolds.len(), 1);
    let points = &manifolds[0].points;
    assert_eq!(points.len(), 8);
    let middle = points.iter().map(|point| point.point_on_b).sum::<DVec3>() / 8.0;
    assert!((middle - DVec3::NEG_Y * 0.5).length() < 1e-9, "{middle}");
}

/// An overlap that lasts a twentieth of the motion is passed over when the steps assume that nothing turns.
#[test]
fn a_ball_against_a_spinning_box_is_not_missed() {
    println!("seed {SEED}");
    let mut rng = seeded(SEED);
    let ball = Shape::sphere(0.5).unwrap();
    let blade = Shape::cuboid([4.0, 0.2, 0.4]).unwrap();
    let mut hits = 0;
    const CASES: usize = 400;
    for case in 0..CASES {
        let axis = direction(&mut rng);
        let angle = rng.random_range(1.0..3.0);
        let spun = |t: f64| DAffine3::from_axis_angle(axis, angle * t);
        let (from, way) = (direction(&mut rng) * rng.random_range(0.8..1.7), 0.8 * in_cube(&mut rng));
        let flown = |t: f64| DAffine3::from_translation(from + way * t);
        let found = query::time_of_impact(
            &blade,
            &spun(0.0),
            &spun(1.0),
            &ball,
            &flown(0.0),
            &flown(1.0),
            &ImpactOptions::default(),
        )
        .unwrap();
        const STEPS: u32 = 200;
        let seen = (0..=STEPS)
            .map(|step| f64::from(step) / f64::from(STEPS))
            .find(|&t| query::intersects(&blade, &spun(t), &ball, &flown(t)).unwrap());
        if let Some(seen) = seen {
            let time = found.map(|impact| impact.time);
            assert!(time.is_some_and(|time| time <= seen), "case {case}: {time:?}, but they meet at {seen}");
            hits += 1;
        }
    }
    assert_rate("balls and blades", hits, CASES);
}

/// Flat, straight and single points are hulls too, and lose none of their points.
#[test]
fn the_hull_of_flattened_points_keeps_all_of_them() {
    println!("seed {SEED}");
    let mut rng = seeded(SEED);
    for flatness in [1.0, 1e-6, 1e-12, 1e-15, 0.0] {
        for _ in 0..20 {
            let squash = DVec3::new(1.0, flatness, if rng.random() { 1.0 } else { flatness });
            let turn = DMat3::from_quat(DQuat::from_axis_angle(direction(&mut rng), 1.0));
            let points: Vec<DVec3> = (0..30).map(|_| turn * (in_cube(&mut rng) * squash)).collect();
            let hull = Shape::convex_hull(&points).unwrap();
            for &point in &points {
                assert!(query::contains_point(&hull, &DAffine3::IDENTITY, point).unwrap(), "{flatness}");
            }
        }
    }
}

/// Two surfaces with nothing in common, one inside the other, are in contact when they bound solids.
#[test]
fn a_mesh_wholly_inside_another_collides() {
    let surface = cube(0.5).shape();
    let solid = surface.clone().into_solid().unwrap();
    let (here, small) = (DAffine3::IDENTITY, DAffine3::from_scale(DVec3::splat(0.25)));
    assert!(!query::intersects(&surface, &here, &surface, &small).unwrap(), "they are surfaces");
    assert!(query::intersects(&solid, &here, &solid, &small).unwrap());
    let depth = query::penetration(&solid, &here, &solid, &small).unwrap().unwrap().depth;
    assert!((depth - 0.625).abs() < 1e-9, "{depth}");
}

/// With a bound of 0, boxes that are 0.25 apart were said to collide.
#[test]
fn a_bound_of_nothing_finds_nothing_apart() {
    let block = Shape::cuboid([0.75, 0.5, 0.5]).unwrap();
    let (upper, lower) = (at(-1.125, 0.5, 0.0), at(-1.125, 0.5, -0.75));
    let within = |bound: f64| query::distance_within(&block, &upper, &block, &lower, bound).unwrap();
    assert_eq!(within(0.0), None);
    assert_eq!(within(0.3).map(|found| found.distance), Some(0.25));
}

/// Triangles that are segments or points gave distances that are no numbers, and errors.
#[test]
fn triangles_without_area_have_distances_and_depths() {
    let corners = [DVec3::ZERO, DVec3::X * 0.5, DVec3::X, DVec3::Y];
    let segment = Shape::mesh(corners, [[0, 1, 2]]).unwrap();
    let point = Shape::mesh(corners, [[1, 1, 1]]).unwrap();
    let triangle = Shape::mesh(corners, [[0, 2, 3]]).unwrap();
    let ball = Shape::sphere(0.25).unwrap();
    let here = DAffine3::IDENTITY;
    let above = at(0.0, 0.0, 0.75);
    for (a, b, expected) in [
        (&segment, &segment, 0.75),
        (&segment, &point, 0.75),
        (&point, &point, 0.75),
        (&point, &triangle, 0.75),
        (&triangle, &segment, 0.75),
        (&segment, &ball, 0.5),
    ] {
        for (a, b) in [(a, b), (b, a)] {
            let found = query::distance(a, &here, b, &above).unwrap().distance;
            assert!((found - expected).abs() <= 1e-15, "{found}, not {expected}");
            // On each other they have no depth, but in the ball they have.
            let found = query::penetration(a, &here, b, &here).unwrap().unwrap();
            let depth = 0.75 - expected;
            assert!((found.depth - depth).abs() <= 1e-14, "{found:?}, not {depth}");
        }
    }
}
