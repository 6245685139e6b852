//! Simple polygons that are convex: cut into triangles, but one primitive where it is asked how deep they are.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{
    assert_rate, convex_of_kind, direction, in_cube, placement, random_complex, random_mesh, rescaled,
    size_of,
};
use glam::{DAffine3, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::seeded;
use solid3d::{ComplexShapeBuilder, Contact, Response, Shape, World, glam, query};

/// A convex polygon of 3 to 12 corners, or with each edge in two pieces, as they are rounded. About 1 from its origin.
fn convex_polygon(rng: &mut StdRng) -> Vec<DVec3> {
    let (u, v, middle) = (direction(rng), direction(rng), 0.5 * in_cube(rng));
    let count = rng.random_range(3..=12);
    let mut angles: Vec<f64> = (0..count).map(|_| rng.random_range(0.0..std::f64::consts::TAU)).collect();
    angles.sort_by(f64::total_cmp);
    let corners: Vec<DVec3> = angles.iter().map(|angle| middle + angle.cos() * u + angle.sin() * v).collect();
    if rng.random() {
        return corners;
    }
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).flat_map(|(p, q)| [*p, p.lerp(*q, 0.3)]).collect()
}

/// Polygons as simple ones, which are cut, and the same as convex primitives, which are not.
fn cut_and_whole(polygons: &[Vec<DVec3>]) -> [Shape; 2] {
    let start = || ComplexShapeBuilder::new(polygons.concat());
    let (mut cut, mut whole, mut first) = (start(), start(), 0);
    for polygon in polygons {
        let chain: Vec<u32> = (first..first + polygon.len() as u32).collect();
        (cut, whole) = (cut.simple_polygon(&chain), whole.polygon(&chain));
        first += polygon.len() as u32;
    }
    [cut, whole].map(|builder| builder.build().unwrap())
}

/// What polygons may be in: a convex shape of any kind, a tetrahedron, polygons, many primitives; with the same where nothing is cut.
fn obstacle(rng: &mut StdRng, case: u32) -> [Shape; 2] {
    let shape = match case % 11 {
        kind @ 0..=5 => {
            let sizes = [(); 3].map(|()| rng.random_range(0.2..1.0));
            convex_of_kind(rng, kind, sizes, 0.7)
        }
        6 => {
            let corners: Vec<DVec3> = (0..4).map(|_| in_cube(rng)).collect();
            ComplexShapeBuilder::new(corners).tetrahedron([0, 1, 2, 3]).build().unwrap()
        }
        7 => random_complex(rng, 8).shape(),
        8 => random_mesh(rng, 40).shape(),
        9 => return cut_and_whole(&[convex_polygon(rng)]),
        _ => return cut_and_whole(&[(); 6].map(|()| convex_polygon(rng))),
    };
    [shape.clone(), shape]
}

/// Polygons and what they may be in, both also uncut, placed anyhow at any scale, and a length that is nothing to them.
struct Case {
    polygons: [Shape; 2],
    obstacle: [Shape; 2],
    at: [DAffine3; 2],
    is_one: bool,
    little: f64,
}

impl Case {
    fn new(rng: &mut StdRng, case: u32) -> Case {
        let is_one = !case.is_multiple_of(3);
        let polygons = cut_and_whole(
            &vec![(); if is_one { 1 } else { 5 }].iter().map(|()| convex_polygon(rng)).collect::<Vec<_>>(),
        );
        let obstacle = obstacle(rng, case);
        let scale = 10.0_f64.powi(rng.random_range(-6..=6));
        let [at, mut at_obstacle] = [placement(rng, 1.0), placement(rng, 1.0)];
        let from = at.transform_point3(polygons[0].vertices().unwrap()[0]);
        at_obstacle.translation = from + rng.random_range(0.0..1.2) * direction(rng);
        let at = [at, at_obstacle].map(|at| rescaled(&at, scale));
        let little = 1e-6 * size_of(&polygons[0], &at[0], &obstacle[0], &at[1]);
        Case { polygons, obstacle, at, is_one, little }
    }

    /// The same with polygons that are deformed: so that they stay convex, or so that they do not.
    fn deformed(mut self, rng: &mut StdRng, is_bent: bool) -> Case {
        let map = placement(rng, 0.2);
        let move_one = |p: &DVec3| match is_bent {
            false => map.transform_point3(*p),
            true => *p + 0.3 * in_cube(rng),
        };
        let moved: Vec<DVec3> = self.polygons[0].vertices().unwrap().iter().map(move_one).collect();
        self.polygons.iter_mut().for_each(|shape| shape.deform(&moved).unwrap());
        self
    }
}

/// Law: a convex polygon is as deep in anything as the same polygon that is not cut, and so are several, of which the deepest counts, also
/// deformed. By that depth, one and one convex shape are parted. Bent, it is no deeper than its hull.
#[test]
fn a_convex_polygon_is_as_deep_as_one_that_is_not_cut() {
    let seed = 230;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits, mut parted) = (6000, 0, 0);
    for number in 0..cases {
        let mut case = Case::new(&mut rng, number as u32);
        let is_bent = number % 8 == 0;
        if number % 4 == 0 {
            case = case.deformed(&mut rng, is_bent);
        }
        let Case { polygons: [cut, whole], obstacle: [other, other_whole], at: [at, at_other], .. } = &case;
        let found = query::penetration(cut, at, other, at_other).unwrap();
        assert_eq!(found.is_some(), query::intersects(cut, at, other, at_other).unwrap(), "case {number}");
        let swapped = query::penetration(other, at_other, cut, at).unwrap();
        let Some(found) = found else { continue };
        hits += 1;
        let expected = query::penetration(whole, at, other_whole, at_other).unwrap();
        let expected = expected.map_or(0.0, |expected| expected.depth);
        for depth in [found.depth, swapped.unwrap().depth] {
            let is_as_deep = is_bent || depth >= expected - case.little;
            assert!(is_as_deep && depth <= expected + case.little, "case {number}: {depth}, not {expected}");
        }
        if is_bent || !case.is_one || other.primitive_count() > 1 {
            continue;
        }
        parted += 1;
        let mut away = *at;
        away.translation += (found.depth_max + case.little) * found.normal;
        assert!(!query::intersects(cut, &away, other, at_other).unwrap(), "case {number}");
    }
    println!("{parted} were parted");
    assert!(parted > 500);
    assert_rate("convex polygons in anything", hits, cases);
}

/// Law: so are polygons of so many corners that their pieces are in many leaves, of which triangles pass through the one and reach the other.
#[test]
fn a_polygon_of_many_corners_is_as_deep_as_one_that_is_not_cut() {
    let seed = 250;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits) = (400, 0);
    for case in 0..cases {
        let corners = 96;
        let corner = |i: usize| {
            let angle = std::f64::consts::TAU * i as f64 / corners as f64;
            DVec3::new(angle.cos(), angle.sin(), 0.0)
        };
        let [cut, whole] = cut_and_whole(&[(0..corners).map(corner).collect()]);
        let triangles: Vec<DVec3> = (0..6)
            .flat_map(|_| {
                let place = corner(rng.random_range(0..corners)) * rng.random_range(0.5..1.05);
                let size = rng.random_range(0.1..0.5);
                [(); 3].map(|()| place + size * in_cube(&mut rng))
            })
            .collect();
        let indices: Vec<[u32; 3]> = (0..6).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let other = Shape::mesh(triangles, indices).unwrap();
        let [at, at_other] = [placement(&mut rng, 0.01), placement(&mut rng, 0.01)];
        let depth =
            |shape: &Shape| query::penetration(shape, &at, &other, &at_other).unwrap().map(|it| it.depth);
        let [found, expected] = [depth(&cut), depth(&whole)];
        assert_eq!(found.is_some(), expected.is_some(), "case {case}");
        let (Some(found), Some(expected)) = (found, expected) else { continue };
        hits += 1;
        assert!((found - expected).abs() < 1e-9, "case {case}: {found}, not {expected}");
    }
    assert_rate("polygons of many corners", hits, cases);
}

/// Law: so says smart response, of polygons that met in the previous frame and of those that did not.
#[test]
fn smart_response_takes_a_convex_polygon_whole() {
    let seed = 231;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (mut were_apart, mut met) = (0, 0);
    for number in 0..3000 {
        let Case { polygons, obstacle, at: [at, at_other], little, .. } = Case::new(&mut rng, number);
        let mut before = at;
        before.translation += rng.random_range(0.0..1e6) * little * direction(&mut rng);
        let [found, expected] = [0, 1].map(|i| {
            let mut world = World::new();
            world.set_default_response(Response::Smart);
            let id = world.add(&polygons[i], before).unwrap();
            world.add(&obstacle[i], at_other).unwrap();
            world.proceed();
            world.set_placement(id, at).unwrap();
            world.test().first().map(|collision| match collision.contact {
                Contact::Smart { distance, .. } => distance,
                _ => panic!("another response"),
            })
        });
        let (Some(found), Some(expected)) = (found, expected) else { continue };
        assert!((found - expected).abs() <= little, "case {number}: {found}, not {expected}");
        *(if found > 0.0 { &mut were_apart } else { &mut met }) += 1;
    }
    println!("{were_apart} were apart, {met} met");
    assert!(were_apart > 300 && met > 300);
}

/// Across a square the way is long, off it too; across its triangles it is short.
#[test]
fn a_post_through_a_square_is_as_deep_as_the_way_off_it() {
    let square = [(2.0, 2.0), (-2.0, 2.0), (-2.0, -2.0), (2.0, -2.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
    let square = ComplexShapeBuilder::new(square).simple_polygon(&[0, 1, 2, 3]).build().unwrap();
    let (post, here) = (Shape::cuboid([1.0, 1.0, 20.0]).unwrap(), DAffine3::IDENTITY);
    let found = query::penetration(&square, &here, &post, &here).unwrap().unwrap();
    assert!((found.depth - 2.5).abs() < 1e-12, "{found:?}");
}

/// A polygon that is not convex is as deep as the deepest of its triangles, so that nothing is pushed out of a window that is in none of them.
#[test]
fn a_polygon_that_is_not_convex_is_as_deep_as_its_triangles() {
    let square = |half: f64| [(half, half), (-half, half), (-half, -half), (half, -half)];
    let vertices: Vec<DVec3> =
        [square(4.0), square(2.0)].concat().into_iter().map(|(x, y)| DVec3::new(x, y, 0.0)).collect();
    let chain = solid3d::polygon::join_holes(&vertices, &[0, 1, 2, 3], &[vec![4, 5, 6, 7]]).unwrap();
    let wall = ComplexShapeBuilder::new(vertices).simple_polygon(&chain).build().unwrap();
    let (ball, here) = (Shape::sphere(1.0).unwrap(), DAffine3::IDENTITY);
    for gap in [0.25, 0.5] {
        let at = DAffine3::from_translation(DVec3::new(1.0 + gap, 0.0, 0.0));
        let found = query::penetration(&ball, &at, &wall, &here).unwrap().unwrap();
        assert!((found.depth - gap).abs() < 1e-12 && (found.normal + DVec3::X).length() < 1e-9, "{found:?}");
    }
}

/// Of a square that is bent, what is between its triangles and its hull does not count.
#[test]
fn a_bent_square_is_as_deep_as_its_triangles() {
    let corners =
        |z: f64| [(2.0, 2.0, z), (-2.0, 2.0, 0.0), (-2.0, -2.0, z), (2.0, -2.0, 0.0)].map(DVec3::from);
    let mut square = ComplexShapeBuilder::new(corners(0.0)).simple_polygon(&[0, 1, 2, 3]).build().unwrap();
    let (post, here) = (Shape::cuboid([1.0, 1.0, 20.0]).unwrap(), DAffine3::IDENTITY);
    let depth = |shape: &Shape| query::penetration(shape, &here, &post, &here).unwrap().unwrap().depth;
    square.deform(&corners(1.0)).unwrap();
    let meshes =
        [[[0, 1, 2], [0, 2, 3]], [[0, 1, 3], [1, 2, 3]]].map(|cut| Shape::mesh(corners(1.0), cut).unwrap());
    assert!(meshes.iter().any(|mesh| (depth(&square) - depth(mesh)).abs() < 1e-12), "{}", depth(&square));
    square.deform(&corners(0.0)).unwrap();
    assert!((depth(&square) - 2.5).abs() < 1e-12);
}
