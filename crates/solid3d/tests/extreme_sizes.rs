//! Shapes of any size that a shape may have, under placements of any size that they may have, beside shapes of any other: answers are
//! numbers, directions are of length one, points are as far apart as is said, and the questions about one pair agree.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by panicking, and prints its seed"
)]

mod common;

use std::fmt::Debug;

use common::{
    Soup, convex_of_kind, cube, direction, grid, log_uniform, random_complex, random_mesh, sheet, torus,
};
use glam::{DAffine3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::seeded;
use solid3d::query::{self, ContactOptions, Ray, RayOptions};
use solid3d::{ComplexShapeBuilder, Shape, glam};

const PAIRS: usize = 8_000;

/// Points may be this far off, of the size of the data.
const ERROR: f64 = 1e-10;

/// Any size; the ends and the middle are likelier.
fn size(rng: &mut StdRng) -> f64 {
    match rng.random_range(0..6) {
        0 => 1e-99,
        1 => 1.0,
        2 => 3e99,
        _ => log_uniform(rng, 1e-99, 3e99),
    }
}

/// Any shape of about a size.
fn shape(rng: &mut StdRng, size: f64) -> Shape {
    let sizes = [0; 3].map(|_| size * rng.random_range(0.3..=1.5));
    let ring = || torus(9, 7, 0.4).scaled(size).shape();
    match rng.random_range(0..9) {
        6 => ring(),
        7 => ring().into_solid().unwrap(),
        8 => {
            let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE].map(|v| v * size);
            let builder = ComplexShapeBuilder::new(corners.to_vec());
            builder.tetrahedron([0, 1, 2, 3]).triangle([1, 2, 4]).build().unwrap()
        }
        kind => convex_of_kind(rng, kind, sizes, size),
    }
}

/// Turned, and scaled by about as much in all directions.
fn placement(rng: &mut StdRng, scale: f64) -> DAffine3 {
    let turn = DQuat::from_axis_angle(direction(rng), rng.random_range(0.0..6.0));
    let along_z = if rng.random_range(0..3) == 0 { rng.random_range(-1.5..-0.5) } else { 1.0 };
    let scale = DVec3::new(scale, scale, scale * along_z);
    DAffine3::from_scale_rotation_translation(scale, turn, DVec3::ZERO)
}

/// A shape and a placement, and the size of the shape there: small enough to be moved by some of it.
fn placed(rng: &mut StdRng) -> (Shape, DAffine3, f64) {
    loop {
        let (own, scale) = (size(rng), size(rng));
        if own * scale < 1e99 {
            return (shape(rng, own), placement(rng, scale), own * scale);
        }
    }
}

fn is_unit(v: DVec3) -> bool {
    (v.length() - 1.0).abs() < 1e-9
}

#[test]
fn answers_are_whole_at_any_size() {
    let seed = 303;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let mut hits = 0;
    for pair in 0..PAIRS {
        let ((a, at_a, of_a), (b, mut at_b, of_b)) = (placed(&mut rng), placed(&mut rng));
        at_b.translation = direction(&mut rng) * (of_a.max(of_b) * rng.random_range(0.0..2.0));
        let context = format!("pair {pair}: {} of {of_a:e}, {} of {of_b:e}", a.kind(), b.kind());
        let size = 10.0 * of_a.max(of_b);
        // In units of the size, where nothing overflows.
        let off = |from: DVec3, to: DVec3, way: DVec3| ((to - from) / size).distance(way / size);
        let meet = query::intersects(&a, &at_a, &b, &at_b).unwrap();
        hits += usize::from(meet);

        let common = query::common_point(&a, &at_a, &b, &at_b).unwrap();
        assert_eq!(common.is_some(), meet, "{context}");
        for (shape, at) in [(&a, &at_a), (&b, &at_b)] {
            if let Some(point) = common.filter(|point| point.abs().max_element() < 1e100) {
                let away = query::closest_point(shape, at, point).unwrap().distance;
                assert!(away <= ERROR * size, "{context}: {point} is {away:e} off");
            }
        }

        let axis = query::separating_axis(&a, &at_a, &b, &at_b).unwrap();
        assert!(axis.is_none_or(|axis| !meet && is_unit(axis)), "{context}: {axis:?}");

        let found = query::distance(&a, &at_a, &b, &at_b).unwrap();
        assert!(!meet || found.distance == 0.0, "{context}: {found:?}");
        let apart = off(found.point_on_a, found.point_on_b, DVec3::ZERO);
        assert!((apart - found.distance / size).abs() <= ERROR, "{context}: {found:?}");

        let depth = query::penetration(&a, &at_a, &b, &at_b).unwrap();
        assert_eq!(depth.is_some(), meet, "{context}");
        // Round bodies nearly concentric leave a thousandth open, and the points the square root of it.
        let loose = |open: f64| 2.0 * open.sqrt() + ERROR;
        if let Some(found) = depth {
            let open = (found.depth_max - found.depth_min) / size;
            assert!(
                (0.0..=size).contains(&found.depth) && (0.0..=1e-3).contains(&open),
                "{context}: {found:?}"
            );
            assert!(is_unit(found.normal), "{context}: {found:?}");
            let off = off(found.point_on_a, found.point_on_b, found.normal * found.depth);
            assert!(off <= loose(open), "{context}: {found:?} is {off:e} off");
        }

        let contacts = query::contacts(&a, &at_a, &b, &at_b, &ContactOptions::default()).unwrap();
        assert!(contacts.is_empty() || meet, "{context}");
        for found in &contacts {
            assert!(is_unit(found.normal), "{context}: {found:?}");
            for point in &found.points {
                let off = off(point.point_on_a, point.point_on_b, found.normal * point.depth);
                assert!(off <= loose(1e-7), "{context}: {point:?} along {} is {off:e} off", found.normal);
            }
        }
    }
    assert!((PAIRS / 5..PAIRS / 2).contains(&hits), "{hits} of {PAIRS} meet");
}

/// A cast finds what it leads into, no later than it is there and near to it; rays and points see the same shape as other questions.
#[test]
fn casts_and_rays_meet_what_is_in_the_way_at_any_size() {
    let seed = 304;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (mut impacts, mut hits) = (0, 0);
    for pair in 0..PAIRS / 4 {
        let ((a, at_a, of_a), (b, mut at_b, of_b)) = (placed(&mut rng), placed(&mut rng));
        let context = format!("pair {pair}: {} of {of_a:e}, {} of {of_b:e}", a.kind(), b.kind());
        let size = 10.0 * of_a.max(of_b);
        let way = direction(&mut rng) * size * 0.8;
        at_b.translation = way.clamp(DVec3::splat(-9e99), DVec3::splat(9e99));
        let motion = (way + direction(&mut rng) * 0.03 * size) * rng.random_range(0.5..1.2);
        let moved = |t: f64| DAffine3 { translation: motion * t, ..at_a };
        let meet = |t: f64| query::intersects(&a, &moved(t), &b, &at_b).unwrap();
        let cast = query::cast_shape(&a, &at_a, motion, &b, &at_b, DVec3::ZERO).unwrap();
        let clear = cast.map_or(1.0, |impact| impact.time - 1e-9);
        for step in 0..=16 {
            let t = clear * f64::from(step) / 16.0;
            assert!(t < 0.0 || !meet(t), "{context}: they meet at {t} of {cast:?}");
        }
        if let Some(impact) = cast {
            impacts += 1;
            assert!(
                (0.0..=1.0).contains(&impact.time) && impact.normal.is_none_or(is_unit),
                "{context}: {impact:?}"
            );
            let gap = query::distance(&a, &moved(impact.time), &b, &at_b).unwrap().distance;
            assert!(gap <= 1e-8 * size, "{context}: {impact:?} leaves {gap:e} of {size:e}");
        }

        let from = direction(&mut rng) * 3.0 * of_a;
        let ray = Ray::new(from, (direction(&mut rng) * of_a * 0.8 - from) / of_a);
        let hit = query::cast_ray(&a, &at_a, &ray, &RayOptions::default()).unwrap();
        let meets = query::ray_meets(&a, &at_a, &ray, &RayOptions::default()).unwrap();
        assert_eq!(hit.is_some(), meets, "{context}: {hit:?}");
        if let Some(hit) = hit {
            hits += 1;
            let away = query::closest_point(&a, &at_a, hit.point).unwrap().distance;
            let normal = hit.surface.map(|surface| surface.normal);
            assert!(
                away <= 1e-9 * 10.0 * of_a && normal.is_none_or(is_unit),
                "{context}: {hit:?} is {away:e} off"
            );
        }
    }
    println!("{impacts} impacts, {hits} hits");
    assert!(impacts > PAIRS / 16 && hits > PAIRS / 16);
}

/// Law: the normal of a depth is a unit vector where one shape is so small beside the other that squares of lengths vanish.
#[test]
fn normals_are_unit_vectors_beside_what_is_next_to_nothing() {
    let egg = DAffine3::from_scale(DVec3::new(4.0, 8.0, 4.0));
    for big in [Shape::sphere(1.0), Shape::cone(1.0, 1.0), Shape::cylinder(1.0, 1.0), Shape::cuboid([1.0; 3])]
    {
        for exponent in (40..100).step_by(3) {
            let inside = DAffine3 {
                translation: DVec3::new(1e-3, 2e-3, -1e-3),
                ..DAffine3::from_scale(DVec3::splat(10f64.powi(-exponent)))
            };
            for small in [Shape::cuboid([1e-100; 3]), Shape::sphere(1e-50), Shape::cone(1e-100, 1e-100)] {
                let (big, small) = (big.as_ref().unwrap(), small.unwrap());
                let found = query::penetration(big, &egg, &small, &inside).unwrap().unwrap();
                assert!(is_unit(found.normal), "{} at 1e-{exponent}: {found:?}", big.kind());
            }
        }
    }
}

/// Law: so is the normal of a solid mesh at triangles that are so thin that the square of twice their area vanishes.
#[test]
fn normals_of_slivers_are_unit_vectors() {
    let corners = [DVec3::X * 1e100, DVec3::ZERO, DVec3::Z, DVec3::NEG_Y];
    let sliver =
        Shape::mesh(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap().into_solid().unwrap();
    for exponent in 40..80 {
        for digit in [1.0, 1.5, 3.0, 7.0] {
            let at = DAffine3::from_scale(DVec3::new(digit * 10f64.powi(exponent), 1.0, 1.0));
            for p in [DVec3::ZERO, DVec3::Z * 0.25, DVec3::new(-1.0, 1e-8, -2.0), DVec3::NEG_Y] {
                let found = query::signed_distance(&sliver, &at, p).unwrap();
                assert!(is_unit(found.normal), "{digit}e{exponent} wide, at {p}: {found:?}");
            }
        }
    }
}

/// Law: a mesh that is one point, or was deformed to one, has the distances that a point has, whatever it is beside: the space of its tree may be far larger
/// than all else.
#[test]
fn a_mesh_that_is_a_point_is_as_far_away_as_a_point() {
    let here = DAffine3::IDENTITY;
    let mut shrunk = Shape::mesh([DVec3::X * 1e20, DVec3::Y * 1e20, DVec3::Z], [[0, 1, 2]]).unwrap();
    shrunk.deform(&[DVec3::ZERO; 3]).unwrap();
    let flat = Shape::mesh([DVec3::ZERO; 3], [[0, 1, 2]]).unwrap();
    let point = Shape::convex_hull(&[DVec3::ZERO]).unwrap();
    for exponent in (-60..=0).step_by(4) {
        let size = 10f64.powi(exponent);
        let corners = [DVec3::ZERO, DVec3::new(0.5, 1.0, 0.0), DVec3::new(0.5, 0.0, 1.0)];
        let strip: Vec<DVec3> =
            (0..30).map(|i| size * (DVec3::X * f64::from(i / 3) + corners[i as usize % 3])).collect();
        let triangles: Vec<[u32; 3]> = (0..10).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let mesh = Shape::mesh(strip, triangles).unwrap();
        let hull = Shape::convex_hull(&corners.map(|corner| corner * size)).unwrap();
        let at = DAffine3::from_translation(size * DVec3::new(-4.5, 1.0, 2.0));
        for other in [&mesh, &hull] {
            let expected = query::distance(&point, &here, other, &at).unwrap().distance;
            assert!(expected > size && expected < 10.0 * size);
            for it in [&flat, &shrunk] {
                let found = query::distance(it, &here, other, &at).unwrap().distance;
                let within = query::distance_within(it, &here, other, &at, 2.0 * expected).unwrap();
                let off =
                    [found, within.expect("it is near").distance].map(|distance| (distance - expected).abs());
                assert!(off.iter().all(|&off| off <= 1e-10 * size), "{size:e}: {found:e}, not {expected:e}");
            }
        }
    }
}

/// Law: of what is so thin that products of its edges vanish, answers are whole.
#[test]
fn answers_are_whole_where_products_vanish() {
    let f = f64::from_bits;
    let here = DAffine3::IDENTITY;
    let hull = |corners: &[DVec3]| Shape::convex_hull(corners).unwrap();
    let flat =
        hull(&[DVec3::new(-6.3e-176, 0.0, 0.0), DVec3::new(0.0, -0.5, 0.0), DVec3::new(1.0, -1.0, 0.0)]);
    let thin =
        hull(&[DVec3::new(0.0, 8e-174, -0.1), DVec3::new(0.0, 0.0, 1e-172), DVec3::new(0.0, 0.0, -0.01)]);
    let at = DAffine3::from_translation(DVec3::X * 1e-11);
    for (a, b, p, q) in [(&flat, &thin, here, at), (&thin, &flat, at, here)] {
        let distance = query::distance(a, &p, b, &q).unwrap().distance;
        assert!((distance - 1e-11 * 0.5f64.sqrt()).abs() < 1e-20, "{distance:e}");
    }
    let mesh = |corners: [DVec3; 3]| Shape::mesh(corners, [[0, 1, 2]]).unwrap();
    let edge = mesh([DVec3::new(1.0, 0.0, -0.5), DVec3::ZERO, DVec3::ZERO]);
    for tiny in [5e-324, 8e-323, 1e-321, 1e-310, 1e-200] {
        let sheet = mesh([DVec3::X * -tiny, DVec3::ZERO, DVec3::new(4.0, -4.0, 0.0)]);
        let at = DAffine3::from_translation(DVec3::new(-3.0, 4.0, 0.0));
        assert!(!query::intersects(&edge, &here, &sheet, &at).unwrap(), "{tiny:e}");
        assert!(query::distance(&edge, &here, &sheet, &at).unwrap().distance > 0.4, "{tiny:e}");
    }
    let needle = hull(&[
        DVec3::Y * 0.8,
        DVec3::new(f(0xbfe18d2dc7c45b1e), f(0x3fe18d2dc7c45b1f), f(0x3c935c43468e47cd)),
    ]);
    let mote = Shape::cylinder(f(0x3d220489b4eb1bff), f(0x3d6c4f314903bdc8)).unwrap();
    let at = DAffine3::from_translation(DVec3::new(f(0xbfa8893d26276600), f(0x3fe8e593c049c500), 0.0));
    let found = query::distance(&needle, &here, &mote, &at).unwrap();
    assert!(found.point_on_a.is_finite() && found.point_on_a.distance(at.translation) < 1e-11, "{found:?}");
    let depth = query::penetration(&needle, &here, &mote, &at).unwrap().map_or(0.0, |found| found.depth);
    assert!(depth < 1e-12, "{depth:e}");
}

/// Law: a triangle of any size, next to nothing too, is as far from a ball as a point is, and meets it where that is no distance.
#[test]
fn a_triangle_next_to_nothing_is_a_point() {
    let scale = 1.0 / 262_144.0;
    let here = DAffine3 {
        translation: DVec3::new(1.25, -0.5, 2.0),
        ..DAffine3::from_scale(DVec3::new(-scale, scale, scale))
    };
    let there = DAffine3 { translation: here.translation - DVec3::X * 2f64.powi(-24), ..here };
    let away = 2f64.powi(-24) / scale;
    let tiny = [DVec3::new(-1.7, -1.4, 0.5), DVec3::new(-0.3, 0.5, -1.6), DVec3::new(-0.3, 1.4, -0.1)];
    let large = [DVec3::new(0.9, 0.8, 0.5), DVec3::new(0.9, -0.8, 0.5), DVec3::new(0.9, -0.8, -0.5)];
    for exponent in 14..110 {
        let corners: Vec<DVec3> = tiny.iter().map(|v| *v * 10f64.powi(-exponent)).chain(large).collect();
        let mesh = Shape::mesh(corners, [[0, 1, 2], [3, 4, 5]]).unwrap();
        for gap in [-1e-9, 1e-11, 1e-9, 1e-8] {
            let ball = Shape::sphere(away - gap).unwrap();
            let met = query::intersects(&mesh, &here, &ball, &there).unwrap();
            let distance = query::distance(&mesh, &here, &ball, &there).unwrap().distance / scale;
            assert_eq!(met, gap < 0.0, "1e-{exponent}: {gap:e}");
            assert!((distance - gap.max(0.0)).abs() < 2e-13, "1e-{exponent}: {distance:e}, not {gap:e}");
        }
    }
}

/// A coordinate that is nothing beside the others takes no point out of a solid.
#[test]
fn a_point_that_is_nearly_on_a_plane_of_corners_stays_inside() {
    let block = squares_of_a_cube().into_solid().unwrap();
    let here = DAffine3::IDENTITY;
    let ball = Shape::sphere(1e-3).unwrap();
    for tiny in [0.0, 5e-324, 1e-323, 1e-200, 1e-100, 1e-20] {
        for y in [tiny, -tiny] {
            let point = DVec3::new(-0.75, y, 0.5);
            assert!(query::contains_point(&block, &here, point).unwrap(), "{y:e}");
            assert_eq!(query::closest_point(&block, &here, point).unwrap().distance, 0.0, "{y:e}");
            assert_eq!(query::signed_distance(&block, &here, point).unwrap().distance, -0.25, "{y:e}");
            assert!(
                query::intersects(&block, &here, &ball, &DAffine3::from_translation(point)).unwrap(),
                "{y:e}"
            );
        }
    }
}

/// A cube from -1 to 1 whose sides are four squares each, of two triangles.
fn squares_of_a_cube() -> Shape {
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let first = corners.len() as u32;
            for (u, v) in (-1..=1).flat_map(|u| (-1..=1).map(move |v| (f64::from(u), f64::from(v)))) {
                let mut corner = DVec3::ZERO;
                (corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (side, u, v);
                corners.push(corner);
            }
            for at in [0, 1, 3, 4].map(|at| first + at) {
                let (turned, square) = (side < 0.0, [at, at + 3, at + 4, at + 1]);
                let order = if turned { [0, 3, 2, 1] } else { [0, 1, 2, 3] };
                let [p, q, r, s] = order.map(|i: usize| square[i]);
                triangles.extend([[p, q, r], [p, r, s]]);
            }
        }
    }
    Shape::mesh(corners, triangles).unwrap()
}

/// The common point of two shapes that are so many times as large as in a unit, and what else is known of them, in that unit; contacts with a margin.
fn of_pair(
    [a, b]: [&Shape; 2],
    [at_a, at_b]: [&DAffine3; 2],
    margin: f64,
    factor: f64,
) -> (Option<DVec3>, impl Debug + PartialEq + use<>) {
    let point = query::common_point(a, at_a, b, at_b).unwrap();
    let near = query::distance(a, at_a, b, at_b).unwrap();
    let deep = query::penetration(a, at_a, b, at_b).unwrap();
    let options = ContactOptions { margin: margin * factor, ..ContactOptions::default() };
    let contacts = query::contacts(a, at_a, b, at_b, &options).unwrap();
    let told = |point: &query::ContactPoint| {
        let points = [point.point_on_a / factor, point.point_on_b / factor];
        (points, point.depth / factor, point.primitives, point.features)
    };
    let rest = (
        query::separating_axis(a, at_a, b, at_b).unwrap(),
        (near.distance / factor, near.point_on_a / factor, near.point_on_b / factor),
        deep.map(|deep| ([deep.depth, deep.depth_min, deep.depth_max].map(|x| x / factor), deep.normal)),
        contacts.iter().flat_map(|region| region.points.iter().map(told)).collect::<Vec<_>>(),
    );
    (point.map(|point| point / factor), rest)
}

/// The answers at the size itself, which are those at sizes that are powers of two larger.
fn at_any_size<T: Debug + PartialEq>(case: usize, answers: impl Fn(f64) -> T) -> T {
    let reference = answers(1.0);
    for power in [-300, -110, 110, 300] {
        assert_eq!(answers(2f64.powi(power)), reference, "case {case}, 2^{power}");
    }
    reference
}

/// Law: sizes that are a power of two larger, the shapes' own with the way between them, change no bit of an answer.
#[test]
fn a_power_of_two_in_the_shapes_own_sizes_changes_no_bit() {
    let mut rng = seeded(20_281);
    let (mut hits, mut cases) = (0, 0);
    for i in 0..1_200 {
        let sizes = [[0; 3]; 2].map(|sizes| sizes.map(|_| rng.random_range(0.3..=1.5)));
        let points =
            [[0; 9]; 2].map(|points| points.map(|_| rng.random_range(0.3..1.2) * direction(&mut rng)));
        let shape = |kind: usize, k: usize, factor: f64| {
            let [x, y, z] = sizes[k].map(|size| size * factor);
            match kind {
                0 => Shape::sphere(x),
                1 => Shape::cuboid([x, y, z]),
                2 => Shape::cone(x, y),
                3 => Shape::cylinder(x, y),
                4 => Shape::capsule(x, y),
                _ => Shape::convex_hull(&points[k].map(|point| point * factor)),
            }
            .unwrap()
        };
        let at =
            [0; 2].map(|_| DAffine3 { translation: 1.2 * direction(&mut rng), ..placement(&mut rng, 1.0) });
        let answers = |factor: f64| {
            let [a, b] = [shape(i % 6, 0, factor), shape(i / 6 % 6, 1, factor)];
            let [at_a, at_b] = at.map(|at| DAffine3 { translation: at.translation * factor, ..at });
            of_pair([&a, &b], [&at_a, &at_b], 0.0, factor)
        };
        let (common, _) = at_any_size(i, answers);
        hits += usize::from(common.is_some());
        cases += 1;
    }
    assert!((30..=70).contains(&(100 * hits / cases)), "{hits} of {cases} hit");
}

/// Law: the same of meshes and of complex shapes.
#[test]
fn a_power_of_two_in_the_sizes_of_meshes_changes_no_bit() {
    let mut rng = seeded(20_282);
    let (mut hits, mut cases) = (0, 0);
    for i in 0..600 {
        let soup = |rng: &mut StdRng| match rng.random_range(0..7) {
            0 | 1 => torus(9, 7, 0.4),
            2 => sheet(6, 6, [false, false], |u, v| DVec3::new(2.0 * u - 1.0, 0.0, 2.0 * v - 1.0)),
            3 => grid(rng, 5, 5),
            4 => random_mesh(rng, 30),
            5 => random_complex(rng, 12),
            _ => cube(0.7),
        };
        let (ours, theirs, solid) = (soup(&mut rng), soup(&mut rng), i % 2 == 0);
        let sizes = [0; 3].map(|_| rng.random_range(0.3..=1.5));
        let mesh = |soup: &Soup, factor: f64| {
            let shape = soup.clone().scaled(factor).shape();
            if solid { shape.clone().into_solid().unwrap_or(shape) } else { shape }
        };
        let other = |factor: f64| {
            let [x, y, z] = sizes.map(|size| size * factor);
            match i % 6 {
                0 => Shape::sphere(x),
                1 => Shape::cuboid([x, y, z]),
                2 => Shape::cone(x, y),
                3 => Shape::capsule(x, y),
                _ => Ok(mesh(&theirs, factor)),
            }
            .unwrap()
        };
        let turned = i % 3 > 0;
        let at = [0; 2].map(|_| DAffine3 {
            translation: rng.random_range(0.5..1.6) * direction(&mut rng),
            ..if turned { placement(&mut rng, 1.0) } else { DAffine3::IDENTITY }
        });
        let (motion, target) = (2.0 * direction(&mut rng), 0.8 * direction(&mut rng));
        let answers = |factor: f64| {
            let (a, b) = (mesh(&ours, factor), other(factor));
            let [at_a, at_b] = at.map(|at| DAffine3 { translation: at.translation * factor, ..at });
            let ray = Ray::new((at_a.translation - motion * factor) * 2.0, motion * factor);
            let hit = query::cast_ray(&a, &at_a, &ray, &RayOptions::default()).unwrap();
            let side = query::signed_distance(&a, &at_a, target * factor).unwrap();
            let impact = query::cast_shape(&a, &at_a, motion * factor, &b, &at_b, DVec3::ZERO).unwrap();
            (
                of_pair([&a, &b], [&at_a, &at_b], 0.01, factor),
                hit.map(|hit| (hit.t, hit.point / factor, hit.surface)),
                (side.distance / factor, side.point / factor, side.normal),
                impact.map(|impact| (impact.time, impact.normal)),
            )
        };
        let ((common, _), ..) = at_any_size(i, answers);
        hits += usize::from(common.is_some());
        cases += 1;
    }
    assert!((30..=80).contains(&(100 * hits / cases)), "{hits} of {cases} hit");
}
