//! Solid meshes: what they contain, judged by brute force; what is refused.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{
    Soup, assert_rate, at, cube, direction, globe, in_cube, joined, log_uniform, placement, random_complex,
    rescaled, stretch, torus, voxels,
};
use glam::{DAffine3, DVec3, dvec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::seeded;
use solid_oracle::{hulls_intersect_exact, mesh_distance, winding_number};
use solid3d::{
    ComplexShapeBuilder, Contact, Error, OpenEdge, Response, Shape, ShapeKind, World, glam, query,
};

const HERE: DAffine3 = DAffine3::IDENTITY;

fn solid(soup: &Soup) -> Shape {
    soup.shape().into_solid().unwrap()
}

fn point_shape(point: DVec3) -> Shape {
    ComplexShapeBuilder::new([point]).point(0).build().unwrap()
}

/// The answer for a pair, which must be the same from the other side and in any unit of length.
fn meet(a: &Shape, at_a: &DAffine3, b: &Shape, at_b: &DAffine3) -> bool {
    let answer = query::intersects(a, at_a, b, at_b).unwrap();
    assert_eq!(query::intersects(b, at_b, a, at_a).unwrap(), answer, "swapped");
    for factor in [2f64.powi(-250), 2f64.powi(300)] {
        let (in_a, in_b) = (rescaled(at_a, factor), rescaled(at_b, factor));
        assert_eq!(query::intersects(a, &in_a, b, &in_b).unwrap(), answer, "times {factor}");
    }
    let distance = query::distance(a, at_a, b, at_b).unwrap().distance;
    assert_eq!(distance == 0.0, answer, "a distance of {distance}");
    answer
}

fn turned_inside_out(soup: &Soup) -> Soup {
    Soup::mesh(soup.vertices.clone(), soup.triangles().iter().map(|&[a, b, c]| [a, c, b]).collect())
}

fn moved(mut soup: Soup, by: DVec3) -> Soup {
    soup.vertices.iter_mut().for_each(|v| *v += by);
    soup
}

fn on_lattice(rng: &mut StdRng, end: i32) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| f64::from(rng.random_range(0..=end))))
}

/// A closed mesh of one part, at most about 1 from its origin.
fn closed_part(rng: &mut StdRng) -> Soup {
    let (rows, columns) = (rng.random_range(2..9), rng.random_range(3..12));
    let part = match rng.random_range(0..4) {
        0 => {
            let tube = rng.random_range(0.2..0.8);
            torus(rows + 1, columns, tube)
        }
        1 => globe(rows, columns, |v| rng.random_range(0.7..=1.0) * v),
        // It passes through itself everywhere.
        2 => globe(rows, columns, |_| in_cube(rng)),
        // The same with degenerate triangles, and rays through edges and vertices.
        _ => globe(rows, columns, |_| on_lattice(rng, 4) / 2.0 - 1.0),
    };
    if rng.random() { turned_inside_out(&part) } else { part }
}

/// A closed mesh of some parts, which may lie in each other or overlap.
fn closed_mesh(rng: &mut StdRng) -> Soup {
    let count = rng.random_range(1..4);
    joined((0..count).map(|_| {
        let part = closed_part(rng).scaled(rng.random_range(0.5..=1.0));
        moved(part, 0.3 * in_cube(rng))
    }))
}

/// A point near a mesh: anywhere, on a vertex, an edge or a triangle, or where an axis-parallel ray hits a vertex.
fn point_near(rng: &mut StdRng, soup: &Soup) -> DVec3 {
    let triangles = soup.triangles();
    let corners = triangles[rng.random_range(0..triangles.len())].map(|i| soup.vertices[i as usize]);
    match rng.random_range(0..10) {
        0 => corners[0],
        1 => 0.5 * corners[0] + 0.5 * corners[1],
        2 => corners[0].lerp(corners[1], rng.random()).lerp(corners[2], rng.random()),
        3 | 4 => corners[0].with_x(rng.random_range(-1.0..=1.0)),
        5 => corners[0].with_y(rng.random_range(-1.0..=1.0)),
        6 => on_lattice(rng, 8) / 4.0 - 1.0,
        _ => 0.7 * in_cube(rng),
    }
}

#[test]
fn points_agree_with_the_exact_winding_number() {
    let seed = 310;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (mut cases, mut hits, mut on_surface, mut more_than_once) = (0, 0, 0, 0);
    for _ in 0..400 {
        let soup = closed_mesh(&mut rng);
        let (shape, triangles) = (solid(&soup), soup.triangles());
        for _ in 0..50 {
            let point = point_near(&mut rng, &soup);
            let winding = winding_number(&soup.vertices, &triangles, point);
            let found = query::intersects(&shape, &HERE, &point_shape(point), &HERE).unwrap();
            assert_eq!(found, winding != Some(0), "{point:?} has the winding number {winding:?}");
            cases += 1;
            hits += usize::from(found);
            on_surface += usize::from(winding.is_none());
            more_than_once += usize::from(winding.is_some_and(|w| w.abs() > 1));
        }
    }
    println!("{on_surface} on a surface, {more_than_once} inside more than once");
    assert!(on_surface > cases / 20 && more_than_once > cases / 50);
    assert_rate("points", hits, cases);
}

/// Every ray hits vertices and edges, and the truth is known without any ray.
#[test]
fn points_of_the_half_lattice_are_in_filled_cells() {
    let seed = 311;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (mut cases, mut hits) = (0, 0);
    for _ in 0..40 {
        let side = rng.random_range(1..6);
        let (filled, soup) = voxels(&mut rng, side);
        if filled.is_empty() {
            continue;
        }
        let shape = solid(&soup);
        for _ in 0..400 {
            let twice = on_lattice(&mut rng, 2 * side);
            // A point on the border of cells is in the solid when any of them is filled.
            let cells_along = |axis: usize| {
                let x = twice[axis] as i32;
                if x % 2 == 0 { vec![x / 2 - 1, x / 2] } else { vec![x / 2] }
            };
            let [xs, ys, zs] = [0, 1, 2].map(cells_along);
            let expected =
                xs.iter().any(|&x| ys.iter().any(|&y| zs.iter().any(|&z| filled.contains(&[x, y, z]))));
            let found = meet(&shape, &HERE, &point_shape(twice / 2.0), &HERE);
            assert_eq!(found, expected, "{:?}", twice / 2.0);
            cases += 1;
            hits += usize::from(found);
        }
    }
    println!("{hits} of {cases} hit");
    assert!(hits > cases / 4 && hits < 9 * cases / 10);
}

/// A placed solid and something else near it.
struct Case {
    a: Soup,
    at_a: DAffine3,
    b: Soup,
    b_is_solid: bool,
    at_b: DAffine3,
}

impl Case {
    fn new(rng: &mut StdRng) -> Case {
        let (size, ratio) = (log_uniform(rng, 1e-6, 1e6), log_uniform(rng, 0.01, 0.5));
        let b_is_solid = rng.random();
        let b = if b_is_solid { closed_mesh(rng) } else { random_complex(rng, 5) };
        let (a, b) = (closed_mesh(rng).scaled(size), b.scaled(0.5 * ratio * size));
        let (at_a, mut at_b) = (placement(rng, 3.0 * size), placement(rng, size));
        at_b.translation = at_a.transform_point3(size * rng.random_range(0.0..=0.9) * direction(rng));
        Case { a, at_a, b, b_is_solid, at_b }
    }

    /// Whether the surfaces meet, and whether a vertex of one is inside the other.
    fn expected(&self) -> (bool, bool) {
        let (in_a, in_b) = (self.a.placed(&self.at_a), self.b.placed(&self.at_b));
        let (hulls_a, hulls_b) = (self.a.hulls(&self.at_a), self.b.hulls(&self.at_b));
        let bounds = |hull: &[DVec3]| solid3d::Aabb::of_points(hull.iter().copied());
        let surfaces_meet = hulls_a.iter().any(|a| {
            let box_a = bounds(a);
            hulls_b.iter().any(|b| box_a.overlaps(&bounds(b)) && hulls_intersect_exact(a, b))
        });
        let named = |soup: &Soup| soup.primitives.concat();
        let any_inside = |vertices: &[DVec3], indices: Vec<u32>, solid: &[DVec3], soup: &Soup| {
            let triangles = soup.triangles();
            let inside = |v: DVec3| winding_number(solid, &triangles, v) != Some(0);
            indices.iter().any(|&i| inside(vertices[i as usize]))
        };
        let contained = any_inside(&in_b, named(&self.b), &in_a, &self.a)
            || self.b_is_solid && any_inside(&in_a, named(&self.a), &in_b, &self.b);
        (surfaces_meet, contained)
    }
}

#[test]
fn pairs_agree_with_brute_force() {
    let seed = 312;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits, mut contained) = (600, 0, 0);
    for i in 0..cases {
        let case = Case::new(&mut rng);
        let (surfaces_meet, inside) = case.expected();
        let (a, b) = (solid(&case.a), if case.b_is_solid { solid(&case.b) } else { case.b.shape() });
        assert_eq!(meet(&a, &case.at_a, &b, &case.at_b), surfaces_meet || inside, "case {i}");
        hits += usize::from(surfaces_meet || inside);
        if inside && !surfaces_meet {
            contained += 1;
            assert!(!query::intersects(&case.a.shape(), &case.at_a, &case.b.shape(), &case.at_b).unwrap());
            let point = query::common_point(&a, &case.at_a, &b, &case.at_b).unwrap().unwrap();
            // It is a point of one of the two, inside the other.
            let error = 1e-9 * (stretch(&case.at_a) + stretch(&case.at_b));
            let ball = Shape::sphere(error).unwrap();
            for (shape, place) in [(&a, &case.at_a), (&b, &case.at_b)] {
                assert!(query::intersects(shape, place, &ball, &DAffine3::from_translation(point)).unwrap());
            }
        }
    }
    println!("{contained} contained");
    assert!(contained > cases / 8);
    assert_rate("pairs", hits, cases);
}

#[test]
fn balls_agree_with_brute_force() {
    let seed = 313;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits) = (2000, 0);
    for _ in 0..cases {
        let soup = closed_mesh(&mut rng);
        let (at_solid, radius) = (placement(&mut rng, 1.0), log_uniform(&mut rng, 1e-4, 0.3));
        let center = at_solid.transform_point3(0.6 * in_cube(&mut rng));
        let placed = soup.placed(&at_solid);
        let inside = winding_number(&placed, &soup.triangles(), center) != Some(0);
        let near = || mesh_distance(&placed, &soup.triangles(), &[center], &[[0, 0, 0]]) <= radius;
        let expected = inside || near();
        let ball = Shape::sphere(radius).unwrap();
        assert_eq!(meet(&solid(&soup), &at_solid, &ball, &DAffine3::from_translation(center)), expected);
        hits += usize::from(expected);
    }
    assert_rate("balls", hits, cases);
}

/// The hole of a ring is no part of it; the tube is.
#[test]
fn a_ball_in_the_hole_of_a_torus_is_free_and_one_in_the_tube_is_not() {
    // The ring's radius is 1 / 1.3, the tube's 0.3 / 1.3.
    let (ring, ball) = (torus(40, 20, 0.3), Shape::sphere(0.1).unwrap());
    let tube = at(1.0 / 1.3, 0.0, 0.0);
    for soup in [&ring, &turned_inside_out(&ring)] {
        let shape = solid(soup);
        assert!(!meet(&shape, &HERE, &ball, &HERE));
        assert!(meet(&shape, &HERE, &ball, &tube));
        assert!(!query::intersects(&soup.shape(), &HERE, &ball, &tube).unwrap());
        for mirror in [dvec3(-1.0, 1.0, 1.0), dvec3(1.0, -2.0, 1.0)] {
            let mirrored = DAffine3::from_scale(mirror);
            assert!(!meet(&shape, &mirrored, &ball, &HERE));
            assert!(meet(&shape, &mirrored, &ball, &at(mirror.x / 1.3, 0.0, 0.0)));
        }
        let far = query::distance(&shape, &HERE, &ball, &HERE).unwrap();
        assert!((far.distance - (0.7 / 1.3 - 0.1)).abs() < 0.01);
        let within = query::distance(&shape, &HERE, &ball, &tube).unwrap();
        assert_eq!(within.distance, 0.0);
        assert!(within.point_on_a.abs_diff_eq(tube.translation, 1e-12));
        assert!(within.point_on_b.abs_diff_eq(tube.translation, 1e-12));
    }
}

/// Of a shape in several parts, each counts: also when the others are outside.
#[test]
fn one_part_inside_is_enough() {
    let shell = solid(&cube(1.0));
    let far = dvec3(10.0, 0.0, 0.0);
    for reversed in [false, true] {
        let mut parts = vec![moved(cube(0.1), far), cube(0.1), moved(cube(0.1), -far)];
        if reversed {
            parts.reverse();
        }
        let surface = joined(parts.clone()).shape();
        assert!(meet(&shell, &HERE, &surface, &HERE));
        assert!(!meet(&shell, &at(3.0, 0.0, 0.0), &surface, &HERE));
        assert!(meet(&solid(&joined(parts)), &HERE, &shell, &HERE));
    }
    // A part that is made of unconnected primitives.
    let loose =
        ComplexShapeBuilder::new([far, DVec3::ZERO, -far]).point(0).point(1).point(2).build().unwrap();
    assert!(meet(&shell, &HERE, &loose, &HERE));
    // Each is inside a part of the other.
    let two = |half_left: f64, half_right: f64| {
        solid(&joined([moved(cube(half_left), -far), moved(cube(half_right), far)]))
    };
    assert!(meet(&two(1.0, 0.1), &HERE, &two(0.1, 1.0), &HERE));
}

#[test]
fn cavities_overlaps_and_copies() {
    let (outer, inner, ball) = (cube(2.0), cube(1.0), Shape::sphere(0.2).unwrap());
    let hollow = solid(&joined([outer.clone(), turned_inside_out(&inner)]));
    let massive = solid(&joined([outer.clone(), inner]));
    assert!(!meet(&hollow, &HERE, &ball, &HERE) && meet(&massive, &HERE, &ball, &HERE));
    assert!(meet(&hollow, &HERE, &ball, &at(1.5, 0.0, 0.0)));
    // Two blocks that overlap, turned the same way, are joined.
    let cross = solid(&joined([cube(1.0), moved(cube(1.0), DVec3::splat(0.5))]));
    assert!(meet(&cross, &HERE, &ball, &at(0.25, 0.25, 0.25)));
    // Equal solids, and a solid around itself.
    assert!(meet(&solid(&outer), &HERE, &solid(&outer), &HERE));
    assert!(meet(&solid(&outer), &HERE, &solid(&outer), &DAffine3::from_scale(DVec3::splat(0.1))));
}

/// A convex shape that contains a solid collides with it as it did with its surface.
#[test]
fn convex_shapes_contain_solids_and_surfaces_do_not() {
    let (small, ball) = (cube(0.1), Shape::sphere(1.0).unwrap());
    assert!(meet(&ball, &HERE, &small.shape(), &HERE) && meet(&ball, &HERE, &solid(&small), &HERE));
    let surface = cube(1.0).shape();
    assert!(!meet(&surface, &HERE, &solid(&small), &HERE));
}

#[test]
fn every_convex_kind_inside_collides() {
    let shell = solid(&globe(12, 24, |v| 3.0 * v));
    let shapes = [
        Shape::sphere(0.5),
        Shape::cuboid([0.5, 1.0, 0.2]),
        Shape::cone(0.5, 1.0),
        Shape::cylinder(0.5, 1.0),
        Shape::capsule(0.3, 1.0),
        Shape::convex_hull(&[DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]),
    ];
    for shape in shapes.map(Result::unwrap) {
        assert!(shape.is_solid());
        assert!(meet(&shell, &HERE, &shape, &at(0.3, -0.5, 0.2)), "{}", shape.kind());
        assert!(!meet(&shell, &HERE, &shape, &at(9.0, 0.0, 0.0)), "{}", shape.kind());
    }
}

#[test]
fn a_deformation_of_a_solid_is_solid() {
    let mut shape = solid(&globe(6, 12, |v| v));
    let before = shape.clone();
    let grown: Vec<DVec3> = shape.vertices().unwrap().iter().map(|&v| v * 10.0).collect();
    shape.deform(&grown).unwrap();
    let (ball, away) = (Shape::sphere(0.5).unwrap(), at(5.0, 0.0, 0.0));
    assert!(shape.is_solid() && shape.kind() == ShapeKind::Mesh);
    assert!(meet(&shape, &HERE, &ball, &away) && !meet(&before, &HERE, &ball, &away));
}

#[test]
fn a_deformation_may_not_open_a_solid() {
    let (_, soup) = voxels(&mut seeded(314), 2);
    let mut shape = solid(&soup);
    let mut surface = soup.shape();
    // All corners of a place may move together.
    let shear = |v: &DVec3| dvec3(v.x + 0.3 * v.y, v.y, v.z);
    let sheared: Vec<DVec3> = soup.vertices.iter().map(shear).collect();
    shape.deform(&sheared).unwrap();
    let mut torn = sheared.clone();
    torn[0].x += 1e-300 + f64::EPSILON * 16.0;
    let error = shape.deform(&torn).unwrap_err();
    let Error::TornSolid { vertices: [0, twin], positions } = error else { panic!("{error:?}") };
    assert_eq!(positions, [torn[0], torn[twin as usize]]);
    assert_eq!(soup.vertices[0], soup.vertices[twin as usize]);
    assert_eq!(shape.vertices().unwrap(), sheared);
    surface.deform(&torn).unwrap();
}

#[test]
fn what_is_not_closed_is_refused_with_its_open_edges() {
    let open = |vertices: &[[u32; 2]], forward, backward| -> Vec<OpenEdge> {
        vertices.iter().map(|&vertices| OpenEdge { vertices, forward, backward }).collect()
    };
    let refused = |soup: &Soup| match soup.shape().into_solid() {
        Err(Error::OpenMesh { edges }) => edges,
        other => panic!("{other:?}"),
    };
    let mut one_gone = cube(1.0);
    let gone: Vec<u32> = one_gone.primitives.remove(0);
    assert_eq!(gone, [0, 2, 3]);
    let edges = refused(&one_gone);
    assert_eq!(*edges, [open(&[[0, 2]], 0, 1), open(&[[0, 3]], 1, 0), open(&[[2, 3]], 0, 1)].concat());
    assert_eq!(
        Error::OpenMesh { edges }.to_string(),
        "mesh is not closed: of its edges, 3 must be run through by as many triangles one way as the other: \
         0-2 (0 and 1), 0-3 (1 and 0), 2-3 (0 and 1)"
    );

    let mut one_flipped = cube(1.0);
    one_flipped.primitives[0].reverse();
    let edges = refused(&one_flipped);
    assert_eq!(*edges, [open(&[[0, 2]], 0, 2), open(&[[0, 3]], 2, 0), open(&[[2, 3]], 0, 2)].concat());

    // Messages stay short, that of a program that unwraps it too.
    let sheet = common::grid(&mut seeded(315), 20, 20);
    let edges = refused(&sheet);
    assert_eq!(edges.len(), 4 * 19);
    let error = Error::OpenMesh { edges };
    assert!(error.to_string().ends_with(", and 68 more") && format!("{error:?}").len() < 300);

    let doubled = joined([cube(1.0), cube(1.0)]);
    assert!(doubled.shape().into_solid().is_ok());
}

#[test]
fn other_shapes_are_solid_already_or_never() {
    let ball = Shape::sphere(1.0).unwrap();
    assert_eq!(ball.clone().into_solid().unwrap().kind(), ShapeKind::Sphere);
    let error = point_shape(DVec3::ZERO).into_solid().unwrap_err();
    assert_eq!(error.to_string(), "shape is a complex shape; it must be a mesh");
    assert!(!point_shape(DVec3::ZERO).is_solid());
    let once = solid(&cube(1.0));
    let twice = once.clone().into_solid().unwrap();
    assert_eq!(twice.vertices().unwrap().as_ptr(), once.vertices().unwrap().as_ptr(), "it stays shared");
    assert!(twice.is_solid() && !cube(1.0).shape().is_solid());
}

/// Signs of zeros, triangles without area and edges of four triangles do no harm.
#[test]
fn harmless_meshes_are_closed() {
    let mut signed = cube(1.0);
    // The same corner under two indices, with zeros of different signs.
    signed.vertices.iter_mut().for_each(|v| *v += 1.0);
    signed.vertices.push(dvec3(-0.0, 0.0, -0.0));
    signed.primitives[0][0] = 8;
    assert_eq!(signed.primitives[0], [8, 2, 3]);
    let shape = solid(&signed);
    assert!(meet(&shape, &HERE, &point_shape(DVec3::splat(0.5)), &HERE));

    let mut degenerate = cube(1.0);
    degenerate.primitives.extend([vec![0, 0, 0], vec![1, 1, 7], vec![0, 7, 0]]);
    assert!(meet(&solid(&degenerate), &HERE, &point_shape(DVec3::splat(0.5)), &HERE));

    let touching = joined([cube(1.0), moved(cube(1.0), dvec3(2.0, 2.0, 0.0))]);
    assert!(meet(&solid(&touching), &HERE, &point_shape(dvec3(2.0, 2.0, 0.5)), &HERE));
    assert!(!meet(&solid(&touching), &HERE, &point_shape(dvec3(2.0, 0.0, 0.5)), &HERE));
}

/// The laws of the world hold for solids: it reports what the query says, with and without caching; smart response has points that were
/// apart when the ball came, then those that are deepest.
#[test]
fn a_world_reports_what_is_inside() {
    let mut world = World::new();
    world.set_default_response(Response::Smart);
    let shell = world.add(&solid(&cube(1.0)), HERE).unwrap();
    let ball = world.add(&Shape::sphere(0.1).unwrap(), at(3.0, 0.0, 0.0)).unwrap();
    let (mut frames_in, mut comings) = (0, 0);
    for i in 0..40 {
        let place = at(3.0 - 0.15 * f64::from(i), 0.1, 0.2);
        world.set_placement(ball, place).unwrap();
        if i == 20 {
            world.disable_caching();
        }
        let collisions = world.test();
        let [in_shell, in_ball] = [shell, ball].map(|id| world.shape(id).unwrap());
        assert_eq!(collisions.len() == 1, query::intersects(in_shell, &HERE, in_ball, &place).unwrap());
        frames_in += collisions.len();
        for collision in &collisions {
            let Contact::Smart { distance, normal, .. } = collision.contact else { panic!("{collision:?}") };
            comings += usize::from(distance > 0.0);
            // It leaves the way it came until another side is nearer.
            let side = -normal.x.signum() * (place.translation.x + 0.15);
            assert!(normal.x.abs() < 0.5 || distance > 0.0 || side > 0.0, "{collision:?}");
        }
        world.proceed();
    }
    assert_eq!((frames_in, comings), (15, 1));
    // A surface that becomes a solid, and is deformed afterwards, is a solid.
    let surface = cube(1.0).shape();
    world.set_shape(shell, &surface).unwrap();
    world.set_placement(ball, HERE).unwrap();
    assert!(world.test().is_empty());
    world.proceed();
    world.set_shape(shell, &surface.clone().into_solid().unwrap()).unwrap();
    assert_eq!(world.test().len(), 1);
    world.proceed();
    world.deform(shell, &cube(2.0).vertices).unwrap();
    assert_eq!(world.test().len(), 1);
}

/// Local sizes and placements may be anything that is in range.
#[test]
fn local_sizes_of_any_magnitude_are_placed() {
    let ball = Shape::sphere(0.1).unwrap();
    for size in [1e-90, 1e-30, 1e30, 1e90] {
        let shell = solid(&torus(20, 10, 0.3).scaled(size));
        let place = DAffine3::from_scale(DVec3::splat(1.0 / size));
        for (x, expected) in [(0.0, false), (1.0 / 1.3, true), (-1.0 / 1.3, true), (2.0, false)] {
            let found = query::intersects(&shell, &place, &ball, &at(x, 0.0, 0.0)).unwrap();
            assert_eq!(found, expected, "{size} {x}");
            let found = query::intersects(&point_shape(dvec3(x, 0.0, 0.0)), &HERE, &shell, &place).unwrap();
            assert_eq!(found, expected, "{size} {x}");
        }
    }
}

/// What is inside is found along one ray, not by looking at the whole surface.
#[test]
fn a_ray_visits_few_triangles() {
    let mut world = World::new();
    let ring = torus(400, 100, 0.3);
    world.add(&solid(&ring), HERE).unwrap();
    world.add(&Shape::sphere(0.01).unwrap(), at(0.0, 0.01, -1.0 / 1.3)).unwrap();
    assert_eq!(world.test().len(), 1);
    let work = world.statistics();
    println!(
        "{} triangles: {} box tests, {} tests",
        ring.primitives.len(),
        work.box_tests,
        work.primitive_tests
    );
    assert!(work.box_tests < 100 && work.primitive_tests < 100);
}
