//! Non-convex polygons as primitives of complex shapes: in every query, in worlds, and deformed.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{Soup, assert_rate, direction, in_cube, placement, random_complex, random_mesh, shape_of};
use glam::{DAffine3, DMat3, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::{random_shape, seeded};
use solid3d::polygon::{Polygon, join_holes};
use solid3d::query::{ImpactOptions, Ray, RayOptions};
use solid3d::{
    Boxes, ComplexShapeBuilder, Error, Motion, Shape, ShapeKind, World, WorldOptions, glam, query,
};

/// A star-shaped polygon with a hole of the same form, in the plane x, y; about 1 from its origin.
fn star(rng: &mut StdRng) -> (Vec<DVec3>, Vec<u32>) {
    let n = rng.random_range(3..=9);
    let radii: Vec<f64> = (0..n).map(|_| rng.random_range(0.3..=1.0)).collect();
    let at = |i: usize, size: f64| {
        let angle = std::f64::consts::TAU * i as f64 / n as f64;
        size * radii[i] * DVec3::new(angle.cos(), angle.sin(), 0.0)
    };
    let mut vertices: Vec<DVec3> = (0..n).map(|i| at(i, 1.0)).collect();
    let outer: Vec<u32> = (0..n as u32).collect();
    if rng.random() {
        return (vertices, outer);
    }
    vertices.extend((0..n).map(|i| at(i, 0.6)));
    let chain = join_holes(&vertices, &outer, &[(n as u32..2 * n as u32).collect()]).unwrap();
    (vertices, chain)
}

/// Several stars in space: as polygons, and as the triangles that they should be.
fn stars(rng: &mut StdRng) -> (Shape, Soup, usize) {
    let count = rng.random_range(1..=5);
    let (mut vertices, mut chains, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..count {
        let (flat, chain) = star(rng);
        let at = DAffine3 {
            matrix3: DMat3::from_quat(glam::DQuat::from_rotation_arc(DVec3::Z, direction(rng)))
                * rng.random_range(0.2..0.7),
            translation: 0.5 * in_cube(rng),
        };
        let first = vertices.len() as u32;
        vertices.extend(flat.iter().map(|&p| at.transform_point3(p)));
        let chain: Vec<u32> = chain.iter().map(|i| first + i).collect();
        let polygon = Polygon::new(chain.iter().map(|&i| vertices[i as usize]).collect::<Vec<_>>()).unwrap();
        triangles.extend(polygon.triangles().into_iter().map(|t| t.map(|i| chain[i as usize])));
        chains.push(chain);
    }
    let builder = ComplexShapeBuilder::new(vertices.clone());
    let shape = chains.iter().fold(builder, |builder, chain| builder.simple_polygon(chain)).build().unwrap();
    (shape, Soup::mesh(vertices, triangles), count)
}

/// A shape of any kind, about 1 from its origin.
fn any_shape(rng: &mut StdRng) -> Shape {
    match rng.random_range(0..4) {
        0 => random_mesh(rng, 40).shape(),
        1 => random_complex(rng, 8).shape(),
        2 => stars(rng).0,
        _ => shape_of(&random_shape(rng, 0.7)),
    }
}

/// Law: the pairs of primitives that meet have the numbers that the user gave, on either side, whatever pieces polygons are cut into.
#[test]
fn pairs_of_polygons_have_the_numbers_of_the_user() {
    // Combs of five teeth, side by side.
    let comb = |k: u32| {
        let teeth = (0..5).flat_map(|i| [[f64::from(2 * i), 3.0], [f64::from(2 * i + 1), 1.0]]);
        let outline = teeth.chain([[9.0, 0.0], [0.0, 0.0]]);
        outline.map(move |[x, y]| DVec3::new(x + 10.0 * f64::from(k), y, 0.0))
    };
    let combs = |count: u32| {
        let builder = ComplexShapeBuilder::new((0..count).flat_map(comb).collect::<Vec<_>>());
        let polygon = |k: u32| (12 * k..12 * (k + 1)).collect::<Vec<_>>();
        (0..count).fold(builder, |builder, k| builder.simple_polygon(&polygon(k))).build().unwrap()
    };
    let (long, short) = (combs(4), combs(2));
    // Across the second comb of the long one, and along it.
    let at = DAffine3::from_translation(DVec3::new(14.5, 0.5, 0.5))
        * DAffine3::from_rotation_y(std::f64::consts::FRAC_PI_2);
    let along = DAffine3::from_translation(DVec3::new(14.5, 0.2, -0.1)) * DAffine3::from_rotation_x(0.1);
    for (placement, expected) in [(at, vec![[1, 0]]), (along, vec![[1, 0], [2, 0], [2, 1], [3, 1]])] {
        for mirrored in [false, true] {
            let mut found = Vec::new();
            let mut take = |i, j| {
                found.push(if mirrored { [j, i] } else { [i, j] });
                std::ops::ControlFlow::Continue(())
            };
            let (here, there) = ((&long, &DAffine3::IDENTITY), (&short, &placement));
            let (a, b) = if mirrored { (there, here) } else { (here, there) };
            query::intersecting_primitives(a.0, a.1, b.0, b.1, &mut take).unwrap();
            found.sort_unstable();
            found.dedup();
            assert_eq!(found, expected, "mirrored: {mirrored}");
        }
    }
}

/// Law: a polygon in a complex shape is its triangles, in every query and against every kind.
#[test]
fn polygons_are_their_triangles_in_every_query() {
    let seed = 60;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits) = (3000, 0);
    for case in 0..cases {
        let (shape, soup, count) = stars(&mut rng);
        let mesh = soup.shape();
        // Of nothing but triangles it is a mesh.
        let kind = if count == mesh.primitive_count() { ShapeKind::Mesh } else { ShapeKind::Complex };
        assert_eq!((shape.kind(), shape.primitive_count()), (kind, count));
        let other = any_shape(&mut rng);
        let (at, mut at_other) = (placement(&mut rng, 1.0), placement(&mut rng, 0.2));
        let near = at.transform_point3(soup.vertices[0]);
        at_other.translation = near + rng.random_range(0.0..1.4) * direction(&mut rng);
        let meet = query::intersects(&mesh, &at, &other, &at_other).unwrap();
        hits += usize::from(meet);
        assert_eq!(query::intersects(&shape, &at, &other, &at_other).unwrap(), meet, "case {case}");
        assert_eq!(query::intersects(&other, &at_other, &shape, &at).unwrap(), meet, "case {case}, swapped");
        assert_eq!(query::common_point(&shape, &at, &other, &at_other).unwrap().is_some(), meet);
        let of_mesh = query::distance(&mesh, &at, &other, &at_other).unwrap().distance;
        let of_shape = query::distance(&shape, &at, &other, &at_other).unwrap().distance;
        assert!((of_mesh - of_shape).abs() <= 1e-9 * (1.0 + of_mesh), "case {case}: {of_mesh} {of_shape}");
        let axes = [&mesh, &shape].map(|x| query::separating_axis(x, &at, &other, &at_other).unwrap());
        assert_eq!(axes[0], axes[1]);

        let mut world = World::new();
        let id = world.add(&shape, at).unwrap();
        world.add(&other, at_other).unwrap();
        assert_eq!(!world.test().is_empty(), meet, "case {case}, in a world");
        world.remove(id).unwrap();
    }
    assert_rate("polygons against anything", hits, cases);
}

/// Law: deformed within its plane, a polygon stays covered by its triangles; also where collinear vertices open.
#[test]
fn deformed_polygons_are_what_would_be_built_anew() {
    let seed = 61;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (mut cases, mut hits) = (0, 0);
    for case in 0..4000 {
        // A comb whose back has collinear vertices in it.
        let comb = [
            (0.0, 0.0),
            (1.0, 0.0),
            (2.0, 0.0),
            (3.0, 0.0),
            (4.0, 0.0),
            (5.0, 0.0),
            (5.0, 3.0),
            (4.0, 3.0),
            (4.0, 1.0),
            (3.0, 1.0),
            (3.0, 3.0),
            (2.0, 3.0),
            (2.0, 1.0),
            (1.0, 1.0),
            (1.0, 3.0),
            (0.0, 3.0),
        ];
        let lift = |(x, y): (f64, f64)| DVec3::new(x, y, x + 2.0 * y);
        let rest: Vec<DVec3> = comb.map(lift).to_vec();
        let chain: Vec<u32> = (0..16).collect();
        let shape = ComplexShapeBuilder::new(rest.clone()).point(0).simple_polygon(&chain).build().unwrap();
        assert_eq!(shape.primitive_count(), 2);
        let moved: Vec<DVec3> = comb
            .map(|(x, y)| lift((x + rng.random_range(-0.2..0.2), y + rng.random_range(-0.2..0.2))))
            .to_vec();
        let mut world = World::new();
        let id = world.add(&shape, DAffine3::IDENTITY).unwrap();
        let through = DVec3::new(rng.random_range(-0.5..5.5), rng.random_range(-0.5..3.5), 0.0);
        let needle =
            ComplexShapeBuilder::new([DVec3::Z * -30.0, DVec3::Z * 30.0]).segment([0, 1]).build().unwrap();
        let at = DAffine3::from_translation(through);
        world.add(&needle, at).unwrap();
        world.test();
        world.deform(id, &moved).unwrap();
        let Ok(anew) = ComplexShapeBuilder::new(moved.clone()).simple_polygon(&chain).build() else {
            continue;
        };
        let expected = query::intersects(&anew, &DAffine3::IDENTITY, &needle, &at).unwrap();
        assert_eq!(!world.test().is_empty(), expected, "case {case}: {through}");
        let mut deformed = shape.clone();
        deformed.deform(&moved).unwrap();
        assert_eq!(query::intersects(&deformed, &DAffine3::IDENTITY, &needle, &at).unwrap(), expected);
        cases += 1;
        hits += usize::from(expected);
    }
    assert!(cases > 3000);
    assert_rate("deformed combs", hits, cases);
}

/// A strip along x, 10 long: one polygon of many corners.
fn strip() -> (Shape, Vec<DVec3>) {
    let there = (0..=10).map(|x| DVec3::new(f64::from(x), 0.0, 0.0));
    let vertices: Vec<DVec3> = there.clone().chain(there.rev().map(|p| p + DVec3::Y)).collect();
    let chain: Vec<u32> = (0..vertices.len() as u32).collect();
    (ComplexShapeBuilder::new(vertices.clone()).simple_polygon(&chain).build().unwrap(), vertices)
}

/// Where a surface goes through polygons that are cut, they are named, not their pieces.
#[test]
fn a_curve_names_polygons() {
    let [first, second]: [Vec<u32>; 2] = [(0..22).collect(), (22..44).collect()];
    let vertices = strip().1;
    let both = [vertices.clone(), vertices.iter().map(|p| p + DVec3::Z).collect()].concat();
    let strips =
        ComplexShapeBuilder::new(both).simple_polygon(&first).simple_polygon(&second).build().unwrap();
    let pillar = Shape::cuboid([0.3, 0.3, 4.0]).unwrap();
    for x in 1..10 {
        let at = DAffine3::from_translation(DVec3::new(f64::from(x), 0.5, 0.0));
        let curve = query::intersection_curve(&strips, &DAffine3::IDENTITY, &pillar, &at).unwrap();
        let named = |z: f64| curve.segments().filter(move |segment| segment.ends[0].z == z);
        for (z, primitive) in [(0.0, 0), (1.0, 1)] {
            assert!(
                named(z).count() >= 4 && named(z).all(|segment| segment.primitives.a == primitive),
                "{curve:?}"
            );
        }
        let back = query::intersection_curve(&pillar, &at, &strips, &DAffine3::IDENTITY).unwrap();
        assert!(back.segments().all(|segment| segment.primitives.b == segment.ends[0].z as u32), "{back:?}");
    }
}

/// Every corner counts for a box that fits the shape however it turns.
#[test]
fn boxes_of_a_fixed_size_lose_nothing_of_a_polygon() {
    let (strip, ball) = (strip().0, Shape::sphere(0.2).unwrap());
    for x in 0..=10 {
        let mut world =
            World::with_options(&WorldOptions { boxes: Boxes::FixedSize, ..WorldOptions::default() });
        world.add(&strip, DAffine3::IDENTITY).unwrap();
        world.add(&ball, DAffine3::from_translation(DVec3::new(f64::from(x), 0.2, 0.1))).unwrap();
        assert_eq!(world.test().len(), 1, "{x}");
    }
}

/// Every corner counts for the way that a deformation takes.
#[test]
fn the_way_of_a_deformation_is_that_of_all_corners() {
    let (was, vertices) = strip();
    let moved: Vec<DVec3> =
        vertices.iter().map(|p| p + if p.x >= 5.0 { DVec3::Z * 8.0 } else { DVec3::ZERO }).collect();
    let mut is = was.clone();
    is.deform(&moved).unwrap();
    let here = DAffine3::IDENTITY;
    let small = Shape::mesh([DVec3::ZERO, DVec3::X, DVec3::Y].map(|p| p * 0.1), [[0, 1, 2]]).unwrap();
    for (obstacle, reach) in [(Shape::sphere(0.1).unwrap(), 0.1), (small, 0.0)] {
        let at = DAffine3::from_translation(DVec3::new(9.0, 0.5, 4.0));
        let ways = [[(&was, &here), (&is, &here)], [(&obstacle, &at); 2]];
        let impact = query::time_of_impact_deforming(ways[0], ways[1], &ImpactOptions::default()).unwrap();
        let time = impact.unwrap().time;
        assert!((time - (4.0 - reach) / 8.0).abs() < 1e-5, "{time}");
        let mut world =
            World::with_options(&WorldOptions { motion: Motion::Swept, ..WorldOptions::default() });
        let id = world.add(&was, here).unwrap();
        world.add(&obstacle, at).unwrap();
        world.proceed();
        world.set_shape(id, &is).unwrap();
        assert_eq!(world.test().len(), 1);
    }
}

/// Law: a ray meets a polygon in one place, wherever it was cut, at corners and on edges too; weights of corners are told of triangles alone, in the
/// order that was given.
#[test]
fn a_ray_meets_a_polygon_once() {
    let options = RayOptions::default();
    let all =
        |shape: &Shape, ray: &Ray| query::cast_ray_all(shape, &DAffine3::IDENTITY, ray, &options).unwrap();
    let strip = strip().0;
    for (x, y) in (0..=40).flat_map(|x| (0..=4).map(move |y| (0.25 * f64::from(x), 0.25 * f64::from(y)))) {
        for way in [DVec3::NEG_Z, DVec3::new(0.1, 0.3, -0.7), DVec3::new(-7.0, 0.2, 0.3)] {
            let target = DVec3::new(x, y, 0.0);
            let hits = all(&strip, &Ray::new(target - way, way));
            // At the border rounding may take it past the edge.
            let is_inside = x > 0.0 && x < 10.0 && y > 0.0 && y < 1.0;
            assert!(hits.len() <= 1 && (hits.len() == 1 || !is_inside), "{target}: {hits:?}");
            assert!(hits.iter().all(|hit| hit.surface.unwrap().barycentric.is_none()));
        }
    }
    // Seen edge on, and of one that is a segment.
    let along = all(&strip, &Ray::new(DVec3::new(-1.0, 0.5, 0.0), DVec3::X));
    assert_eq!(along.iter().map(|hit| hit.t).collect::<Vec<_>>(), [1.0]);
    let line = [0.0, 1.0, 3.0, 2.0].map(|x| DVec3::X * x);
    let line = ComplexShapeBuilder::new(line).simple_polygon(&[0, 1, 2, 3]).build().unwrap();
    assert_eq!(all(&line, &Ray::new(DVec3::new(0.5, 1.0, 0.0), DVec3::NEG_Y)).len(), 1);
    let corners = [DVec3::X * 8.0, DVec3::Y * 8.0, DVec3::ZERO, DVec3::Z];
    for chain in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        let shape = ComplexShapeBuilder::new(corners).point(3).simple_polygon(&chain).build().unwrap();
        let hits = all(&shape, &Ray::new(DVec3::new(4.0, 1.0, 2.0), DVec3::NEG_Z));
        let weights = hits[0].surface.unwrap().barycentric;
        assert_eq!((hits.len(), weights), (1, Some(chain.map(|i| [0.5, 0.125, 0.375][i as usize]))));
    }
}

#[test]
fn mistakes_name_the_primitive_as_the_user_counts() {
    let flat = |points: &[(f64, f64)]| points.iter().map(|&(x, y)| DVec3::new(x, y, 0.0)).collect::<Vec<_>>();
    let mut vertices = flat(&[(0.0, 0.0), (2.0, 1.0), (0.0, 2.0), (1.0, 1.0), (1.0, 2.0)]);
    vertices.push(DVec3::Z);
    let builder = || ComplexShapeBuilder::new(vertices.clone()).simple_polygon(&[0, 1, 2, 3]);
    assert_eq!(builder().point(0).build().unwrap().primitive_count(), 2);
    let bow = builder().simple_polygon(&[0, 1, 2]).simple_polygon(&[0, 4, 1, 2]).build().unwrap_err();
    assert_eq!(
        bow.to_string(),
        "primitive 2: edges 0 and 2 of the polygon cross; a simple polygon's edges may touch but not cross"
    );
    let tent = builder().simple_polygon(&[0, 1, 5, 2]).build().unwrap_err().to_string();
    assert!(tent.starts_with("primitive 1: vertex ") && tent.contains("off the plane"), "{tent}");
    let short = builder().simple_polygon(&[0, 1]).build().unwrap_err();
    assert_eq!(short, Error::PrimitiveSize { primitive: 1, count: 2, least: 3 });
    let lost = builder().triangle([0, 1, 9]).build().unwrap_err();
    assert_eq!(lost, Error::VertexIndex { primitive: 1, index: 9, vertices: 6 });
}
