//! Of meshes and complex shapes: which normals their surfaces have.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

use glam::{DAffine3, DVec3};
use rand::Rng;
use solid_oracle::generate::{Pair, Regime, direction, in_cube, log_uniform, random_pair, seeded};
use solid3d::query::{self, Manifold};
use solid3d::{Shape, glam};

use super::{SEED, assert_flat, assert_laws, contacts, cube, cube_mesh, deepest, floor, only, within};
use crate::common::{
    self, at, convex_of_kind, globe, placement, random_complex, random_mesh, sheet, size_of, torus,
};

/// The ridge of a roof of small triangles has the normals that the edge of a wedge has, and faces their own.
#[test]
fn a_ridge_of_small_triangles_is_an_edge() {
    let mut rng = seeded(SEED);
    let corner = |x: f64, y: f64| DVec3::new(x, -y.abs(), y);
    let wedge =
        Shape::convex_hull(&[-5.0, 5.0].map(|x| [-2.0, 0.0, 2.0].map(|y| corner(x, y))).concat()).unwrap();
    let roof = sheet(41, 101, [false, false], |u, v| corner(10.0 * v - 5.0, 4.0 * u - 2.0)).shape();
    let slope = DVec3::new(0.0, 1.0, 1.0).normalize();
    let mut at_the_ridge = 0;
    for case in 0..6_000 {
        let shape = match case % 4 {
            0 => Shape::cone(0.3, 0.6).unwrap(),
            1 => Shape::cylinder(0.2, 0.5).unwrap(),
            2 => Shape::cuboid([0.3, 0.4, 0.5]).unwrap(),
            _ => Shape::convex_hull(&[(); 12].map(|()| in_cube(&mut rng) * 0.3)).unwrap(),
        };
        let turned = DAffine3::from_axis_angle(direction(&mut rng), rng.random_range(0.0..TAU));
        let (above, aside) = (DAffine3::from_translation(DVec3::Y), rng.random_range(-0.05..0.05));
        let high = above * turned;
        let hit =
            query::cast_shape(&shape, &high, DVec3::NEG_Y * 2.0, &wedge, &at(0.03, 0.0, aside), DVec3::ZERO);
        let depth = 10f64.powf(rng.random_range(-4.0..-1.5));
        let lower = DVec3::NEG_Y * (2.0 * hit.unwrap().unwrap().time + depth);
        let placed = DAffine3::from_translation(lower - DVec3::new(0.03, 0.0, aside)) * high;
        let expected = only(&shape, &placed, &wedge, &DAffine3::IDENTITY);
        if expected.normal.dot(slope).max(expected.normal.dot(slope * DVec3::new(1.0, 1.0, -1.0))) > 0.999_999
        {
            continue;
        }
        let found = contacts(&shape, &placed, &roof, &DAffine3::IDENTITY);
        let near = query::contacts(&shape, &placed, &roof, &DAffine3::IDENTITY, &within(0.02)).unwrap();
        assert!(deepest(&near) > deepest(&found) - 1e-6, "case {case}: {near:#?}, not {found:#?}");
        for region in found {
            let is_of_a_face = (region.normal.abs() - slope).length() < 1e-6;
            let off = deepest(std::slice::from_ref(&region)) - deepest(std::slice::from_ref(&expected));
            assert!(
                is_of_a_face || region.normal.distance(expected.normal) < 1e-4 && off.abs() < 1e-6,
                "case {case}: {region:#?}, not {expected:#?}"
            );
            at_the_ridge += usize::from(!is_of_a_face);
        }
    }
    assert!(at_the_ridge > 1_500, "{at_the_ridge}");
}

/// Two unit cubes of triangles, 0.30 in each other: that deep, everywhere.
#[test]
fn cubes_of_triangles_are_as_deep_as_cubes() {
    let mesh = cube_mesh();
    let solid = mesh.clone().into_solid().unwrap();
    for (a, b) in [(&mesh, &mesh), (&mesh, &solid), (&solid, &solid), (&mesh, &cube()), (&solid, &cube())] {
        for place in [at(0.7, 0.0, 0.0), at(0.7, 0.1, 0.2)] {
            assert_flat(&only(a, &place, b, &DAffine3::IDENTITY), DVec3::X, 0.3, 4);
        }
    }
    // A surface has no inside.
    let small = Shape::cuboid([0.1; 3]).unwrap();
    assert!(contacts(&small, &at(0.1, 0.0, 0.0), &mesh, &DAffine3::IDENTITY).is_empty());
    assert_eq!(contacts(&small, &at(0.1, 0.0, 0.0), &solid, &DAffine3::IDENTITY).len(), 1);
}

/// A star goes around its middle twice and bends outward at each edge, but its tips stand apart: what is between them touches what it meets there.
#[test]
fn between_the_tips_of_a_star_is_nothing() {
    let star = globe(2, 5, |p| DVec3::new(p.x * p.x - p.z * p.z, p.y, 2.0 * p.x * p.z)).shape();
    let solid = star.clone().into_solid().unwrap();
    let ball = Shape::sphere(0.1).unwrap();
    for (distance, depth) in [(0.6, None), (0.52, None), (0.5, Some(0.01)), (0.45, Some(0.06))] {
        let place = DAffine3::from_rotation_y(0.1 * TAU) * at(distance, 0.0, 0.0);
        for star in [&star, &solid] {
            let found = contacts(&ball, &place, star, &DAffine3::IDENTITY);
            let met = query::intersects(&ball, &place, star, &DAffine3::IDENTITY).unwrap();
            assert_eq!((met, found.is_empty()), (depth.is_some(), depth.is_none()), "{distance}: {found:?}");
            assert!(deepest(&found) < depth.unwrap_or(0.0), "{distance}: {found:?}");
        }
    }
}

/// Sliding over a floor of triangles gives what one big box would: its normal, and the corners of what slides.
#[test]
fn internal_edges_have_no_normals() {
    let mut rng = seeded(SEED);
    let block = Shape::cuboid([1.0, 1.0, 1.5]).unwrap();
    let cylinder = Shape::cylinder(0.5, 1.0).unwrap();
    let sphere = Shape::sphere(0.5).unwrap();
    for squares in [3, 10, 40] {
        let floor = floor(squares);
        for step in 0..60 {
            let slide = DVec3::new(rng.random_range(-2.0..2.0), 0.0, rng.random_range(-2.0..2.0));
            let depth = if step % 3 == 0 { 0.2 } else { 0.001 };
            let turn =
                DAffine3::from_rotation_y(if step % 2 == 0 { 0.0 } else { rng.random_range(0.0..TAU) });
            for (shape, half, count) in
                [(&block, 0.5, 4), (&cube_mesh(), 0.5, 4), (&cylinder, 0.5, 16), (&sphere, 0.5, 1)]
            {
                let place = DAffine3::from_translation(slide + DVec3::Y * (half - depth)) * turn;
                let found = only(shape, &place, &floor, &DAffine3::IDENTITY);
                assert_eq!(found.normal, DVec3::Y, "{squares}, step {step}: {found:?}");
                // Where only the arc beyond a corner of a circle reaches a triangle, that adds a point.
                let more = if count == 16 { found.points.len().clamp(16, 24) } else { count };
                assert_flat(&found, DVec3::Y, depth, more);
            }
        }
    }
}

/// Triangles of which two corners are one change no contact: they are but edges and corners of others.
#[test]
fn collapsed_triangles_have_no_normals() {
    let mut rng = seeded(SEED);
    let collapsed = |mesh: &Shape| {
        let triangles = mesh.triangles().unwrap();
        let more = triangles.iter().flat_map(|&[i, j, k]| [[i, i, j], [j, k, j], [k; 3]]);
        let all: Vec<_> = triangles.iter().copied().chain(more).collect();
        Shape::mesh(mesh.vertices().unwrap(), all).unwrap()
    };
    let (floor, mesh) = (collapsed(&floor(10)), collapsed(&cube_mesh()));
    let sphere = Shape::sphere(0.5).unwrap();
    for step in 0..60 {
        let depth = if step % 3 == 0 { 0.2 } else { 0.001 };
        let place = at(rng.random_range(-2.0..2.0), 0.5 - depth, rng.random_range(-2.0..2.0))
            * DAffine3::from_rotation_y(rng.random_range(0.0..TAU));
        for (shape, count) in [(&cube(), 4), (&mesh, 4), (&sphere, 1)] {
            assert_flat(&only(shape, &place, &floor, &DAffine3::IDENTITY), DVec3::Y, depth, count);
        }
        let above = at(0.0, 1.0 - depth, 0.0) * place;
        assert_flat(&only(&cube(), &above, &mesh, &place), DVec3::Y, depth, 4);
    }
}

/// A convex edge of a mesh is no internal one.
#[test]
fn ridges_have_normals() {
    let ridge = Shape::mesh(
        [
            [-1.0, 0.0, -3.0],
            [-1.0, 0.0, 3.0],
            [0.0, 1.0, -3.0],
            [0.0, 1.0, 3.0],
            [1.0, 0.0, -3.0],
            [1.0, 0.0, 3.0],
        ]
        .map(DVec3::from),
        [[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]],
    )
    .unwrap();
    let found = only(&cube(), &at(0.0, 1.49, 0.0), &ridge, &DAffine3::IDENTITY);
    assert_flat(&found, DVec3::Y, 0.01, 2);
    // In the valley below it, a ball touches both sides.
    let flipped = DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0));
    let ball = Shape::sphere(0.5).unwrap();
    let found = contacts(&ball, &at(0.0, -1.0 + 0.5f64.sqrt() - 0.01, 0.1), &ridge, &flipped);
    let mut normals: Vec<f64> = found.iter().map(|manifold| manifold.normal.x).collect();
    normals.sort_by(f64::total_cmp);
    assert_eq!(found.len(), 2, "{found:#?}");
    assert!((normals[0] + 0.5f64.sqrt()).abs() < 1e-9 && (normals[1] - 0.5f64.sqrt()).abs() < 1e-9);
}

/// Law: a region has one normal also where a surface turns by so little from facet to facet that all of them are of one normal with
/// the next: that of the surface at each of its points.
#[test]
fn a_smooth_surface_has_many_normals() {
    // A quarter of a pipe along z, in facets of 4e-4 radians, and a rod that nearly fills it.
    let facets = 4000;
    let angle = |i: u32| PI + FRAC_PI_4 + FRAC_PI_2 * f64::from(i) / f64::from(facets);
    let edge = |i: u32| [-1.0, 1.0].map(|z| DVec3::new(angle(i).cos(), angle(i).sin(), z));
    let vertices: Vec<DVec3> = (0..=facets).flat_map(edge).collect();
    let strip = |i: u32| [[2 * i, 2 * i + 1, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 2]];
    let pipe = Shape::mesh(vertices, (0..facets).flat_map(strip).collect::<Vec<_>>()).unwrap();
    let rod = Shape::cylinder(0.999, 1.0).unwrap();
    let along_z = DAffine3::from_rotation_x(FRAC_PI_2);
    let found = query::contacts(&rod, &along_z, &pipe, &DAffine3::IDENTITY, &within(0.01)).unwrap();
    let mut points = 0;
    for region in &found {
        for point in &region.points {
            let inward = -DVec3::new(point.point_on_b.x, point.point_on_b.y, 0.0);
            let off = region.normal.angle_between(inward);
            assert!(off < 2e-3, "{off} radians at {point:?}");
            points += 1;
        }
    }
    println!("{} regions of {points} points", found.len());
    assert!((700..2000).contains(&found.len()), "{} regions", found.len());
}

/// Meshes and complex shapes, also degenerate ones, in any place: the laws hold, and there are contacts if and only if they intersect.
#[test]
fn soups_obey_the_laws() {
    let mut rng = seeded(SEED);
    let (mut hits, cases) = (0, 400);
    for case in 0..cases {
        let soup = |rng: &mut _| {
            let soup: common::Soup =
                if case % 3 == 0 { random_complex(rng, 6) } else { random_mesh(rng, 30) };
            soup.shape()
        };
        let (a, other) = (soup(&mut rng), soup(&mut rng));
        let Pair { b, .. } = random_pair(&mut rng, Regime::Random);
        let b = if case % 2 == 0 { other } else { common::try_shape_of(&b).unwrap_or(other) };
        let places = [0, 1].map(|_| placement(&mut rng, 0.8));
        let context = format!("case {case}: {} {:?} {} {:?}", a.kind(), places[0], b.kind(), places[1]);
        let size = size_of(&a, &places[0], &b, &places[1]);
        let found = contacts(&a, &places[0], &b, &places[1]);
        assert_eq!(
            !found.is_empty(),
            query::intersects(&a, &places[0], &b, &places[1]).unwrap(),
            "{context}"
        );
        assert_laws(&found, 0.0, size, &context);
        hits += usize::from(!found.is_empty());
        let wide = query::contacts(&a, &places[0], &b, &places[1], &within(0.1 * size)).unwrap();
        assert_laws(&wide, 0.1 * size, size, &context);
    }
    common::assert_rate("soups", hits, cases);
}

#[test]
fn degenerate_input_has_answers() {
    let here = DAffine3::IDENTITY;
    let points = [vec![DVec3::ZERO], vec![DVec3::ZERO, DVec3::X], vec![DVec3::ZERO, DVec3::X, DVec3::Z]];
    let mut shapes: Vec<Shape> = points.iter().map(|points| Shape::convex_hull(points).unwrap()).collect();
    shapes.push(Shape::mesh([DVec3::ZERO, DVec3::X], [[0, 1, 1], [0, 0, 0], [0, 0, 1]]).unwrap());
    shapes.push(Shape::mesh([DVec3::ZERO, DVec3::X, DVec3::Z], [[0, 1, 2], [0, 2, 1], [0, 1, 2]]).unwrap());
    shapes.extend([
        cube(),
        cube_mesh(),
        floor(2),
        Shape::cone(1.0, 1.0).unwrap(),
        Shape::sphere(1e-6).unwrap(),
    ]);
    for a in &shapes {
        for b in &shapes {
            for place in [here, at(0.5, 0.0, 0.0), at(0.0, -0.5, 0.0), at(0.5, 0.5, 0.5)] {
                for size in [1e-90, 1e-6, 1.0, 1e6, 1e90] {
                    let scaled = |at: DAffine3| DAffine3::from_scale(DVec3::splat(size)) * at;
                    let found = contacts(a, &scaled(place), b, &scaled(here));
                    let meet = query::intersects(a, &scaled(place), b, &scaled(here)).unwrap();
                    assert_eq!(!found.is_empty(), meet, "{} {} {place:?} {size}", a.kind(), b.kind());
                    assert_laws(&found, 0.0, 4.0 * size, "degenerate");
                }
            }
        }
    }
}

/// A roof of many triangles around one vertex, which each have all others next to them. Were each held against each, this would take
/// minutes.
#[test]
fn a_fan_of_many_triangles() {
    const COUNT: u32 = 20_000;
    let rim = |i: u32| {
        let (sin, cos) = (TAU * f64::from(i) / f64::from(COUNT)).sin_cos();
        DVec3::new(cos, -0.2, sin)
    };
    let points: Vec<DVec3> = std::iter::once(DVec3::ZERO).chain((0..COUNT).map(rim)).collect();
    let roof = Shape::mesh(points, (0..COUNT).map(|i| [0, 1 + i, 1 + (i + 1) % COUNT]).collect::<Vec<_>>());
    let (roof, here) = (roof.unwrap(), DAffine3::IDENTITY);
    let box_on_top = only(&roof, &here, &cube(), &at(0.1, 0.49, 0.2));
    assert!(box_on_top.normal.abs_diff_eq(-DVec3::Y, 1e-9), "{box_on_top:#?}");
    assert!(box_on_top.points.iter().any(|p| (p.depth - 0.01).abs() < 1e-9), "{box_on_top:#?}");
    let ball = Shape::sphere(0.5).unwrap();
    for region in contacts(&roof, &here, &ball, &at(0.0, 0.49, 0.0)) {
        assert!(region.normal.y < -0.9 && region.points.iter().all(|p| p.depth < 0.05), "{region:#?}");
    }
}

/// Scaling a scene by a power of two scales the answer, to the bit.
#[test]
fn powers_of_two_change_nothing() {
    let mut rng = seeded(SEED);
    for i in 0..200 {
        let Pair { a, pa, b, pb, .. } = random_pair(&mut rng, Regime::Random);
        let (Ok(mut a), Ok(b)) = (common::try_shape_of(&a), common::try_shape_of(&b)) else { continue };
        if i % 4 == 0 {
            a = random_mesh(&mut rng, 30).shape();
        }
        let answer = |power: i32| {
            let factor = 2f64.powi(power);
            let (pa, pb) = (common::rescaled(&pa, factor), common::rescaled(&pb, factor));
            let mut found = contacts(&a, &pa, &b, &pb);
            for point in found.iter_mut().flat_map(|manifold| &mut manifold.points) {
                point.depth /= factor;
                point.point_on_a /= factor;
                point.point_on_b /= factor;
            }
            found
        };
        let reference = answer(0);
        for power in [-200, -1, 7, 200] {
            assert_eq!(answer(power), reference, "pair {i}, 2^{power}");
        }
    }
}

/// Of more pairs of triangles than are told the deepest point is, or the closest ones.
#[test]
fn of_a_million_pairs_one_contact_is_told() {
    let copies = |corners: [DVec3; 3]| Shape::mesh(corners, vec![[0, 1, 2]; 1_100]).unwrap();
    let wall = copies([DVec3::ZERO, DVec3::X, DVec3::Y]);
    let fin = copies([DVec3::new(0.2, 0.2, -0.1), DVec3::new(0.3, 0.2, 1.0), DVec3::new(0.2, 0.3, 1.0)]);
    let [here, away] = [0.0, 0.5].map(|z| DAffine3::from_translation(DVec3::Z * z));
    let found = only(&fin, &here, &wall, &here);
    let [deepest] = found.points[..] else { panic!("{found:?}") };
    let penetration = query::penetration(&fin, &here, &wall, &here).unwrap().unwrap();
    assert_eq!((deepest.depth, found.normal), (penetration.depth, penetration.normal));
    assert!(contacts(&fin, &away, &wall, &here).is_empty());
    let near = query::contacts(&fin, &away, &wall, &here, &within(0.5)).unwrap();
    assert!((near[0].points[0].depth + 0.4).abs() < 1e-12 && (near[0].normal - DVec3::Z).length() < 1e-9);
    assert_eq!((near.len(), near[0].points.len()), (1, 1));
}

/// Law: normals lead out of a solid that is not convex, or all lead into it, as where something is in its wall alone.
#[test]
fn normals_lead_out_of_a_solid() {
    let mut rng = seeded(SEED + 9);
    let ring = torus(12, 8, 0.4);
    let (solid, here, mut told) = (ring.shape().into_solid().unwrap(), DAffine3::IDENTITY, [0; 2]);
    // The tube is around a circle.
    let outward: Vec<DVec3> = ring
        .triangles()
        .into_iter()
        .map(|triangle| {
            let [p, q, r] = triangle.map(|i| ring.vertices[i as usize]);
            let middle = (p + q + r) / 3.0;
            let normal = (q - p).cross(r - p).normalize();
            normal * normal.dot(middle - middle.with_y(0.0).normalize() / 1.4).signum()
        })
        .collect();
    for case in 0..3_000 {
        let sizes = [(); 3].map(|()| log_uniform(&mut rng, 0.01, 1.5));
        let other = match case % 7 {
            6 => ring.shape(),
            kind => convex_of_kind(&mut rng, kind, sizes, sizes[0]),
        };
        let turned = DAffine3::from_axis_angle(direction(&mut rng), rng.random_range(0.0..6.0));
        let placed = DAffine3::from_translation(in_cube(&mut rng)) * turned;
        let found = contacts(&solid, &here, &other, &placed);
        let leads_in = |region: &Manifold| {
            region
                .points
                .iter()
                .any(|point| -region.normal.dot(outward[point.primitives[0] as usize]) < -0.01)
        };
        let inward = found.iter().filter(|region| leads_in(region)).count();
        assert!(inward == 0 || inward == found.len(), "case {case}: {inward} of {found:#?}");
        told[usize::from(inward > 0)] += usize::from(!found.is_empty());
    }
    assert!(told[0] > 1_000, "{told:?}");
}
