//! Fast objects: what collides on the way from one frame to the next, against slow and exact twins.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by panicking, and prints its seed"
)]

mod common;

use common::{Soup, assert_rate, direction, in_cube, placement, random_complex, random_mesh, shape_of};
use glam::{DAffine3, DMat3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::{random_shape, seeded};
use solid_oracle::hulls_intersect_exact;
use solid3d::{
    Boxes, BroadPhaseKind, Collision, Contact, Motion, ObjectId, Response, Shape, When, World, WorldOptions,
    glam, query,
};

/// A body at both ends of its way.
struct Body {
    was: Soup,
    is: Soup,
    from: DAffine3,
    to: DAffine3,
}

impl Body {
    /// The vertices of each primitive in the world, as they were and as they are.
    fn hulls(&self) -> Vec<[Vec<DVec3>; 2]> {
        self.was.hulls(&self.from).into_iter().zip(self.is.hulls(&self.to)).map(<[_; 2]>::from).collect()
    }

    /// Whether the body is one convex hull rather than a soup.
    fn is_hull(&self) -> bool {
        self.was.primitives.len() == 1 && !self.was.is_mesh
    }

    fn add(&self, world: &mut World) -> ObjectId {
        let shape = match self.is_hull() {
            true => Shape::convex_hull(&self.was.vertices).unwrap(),
            false => self.was.shape(),
        };
        world.add(&shape, self.from).unwrap()
    }

    fn move_in(&self, world: &mut World, id: ObjectId) {
        if self.is.vertices != self.was.vertices {
            world.deform(id, &self.is.vertices).unwrap();
        }
        world.set_placement(id, self.to).unwrap();
    }
}

/// Every pair of worlds that must agree: engines, caching, boxes.
fn worlds(response: Response) -> Vec<World> {
    let options = WorldOptions { default_response: response, motion: Motion::Swept, ..Default::default() };
    vec![
        World::with_options(&options),
        World::with_options(&WorldOptions { broad_phase: BroadPhaseKind::SweepAndPrune, ..options.clone() }),
        World::with_options(&WorldOptions { caching: false, boxes: Boxes::FixedSize, ..options }),
    ]
}

/// Runs one frame in each world; they agree.
fn collision(a: &Body, b: &Body) -> Option<Collision> {
    let mut answers = worlds(Response::Witness).into_iter().map(|mut world| {
        let [i, j] = [a, b].map(|body| body.add(&mut world));
        world.test();
        world.proceed();
        a.move_in(&mut world, i);
        b.move_in(&mut world, j);
        let found = world.test();
        assert_eq!(world.test(), found, "a second test says the same");
        world.proceed();
        assert!(world.test().iter().all(|c| c.when == When::Now), "nothing moves in the next frame");
        found.into_iter().next()
    });
    let first = answers.next().unwrap();
    assert!(answers.all(|answer| answer == first));
    first
}

/// A point of the lattice, so that every placed vertex and every difference is exact.
fn lattice(rng: &mut StdRng, end: i32) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| f64::from(rng.random_range(-end..=end))))
}

fn lattice_placement(rng: &mut StdRng, end: i32) -> DAffine3 {
    loop {
        let matrix3 = match rng.random_range(0..3) {
            0 => DMat3::from_cols(lattice(rng, 1), lattice(rng, 1), lattice(rng, 1)),
            _ => DMat3::IDENTITY,
        };
        if matrix3.determinant() != 0.0 {
            return DAffine3 { matrix3, translation: lattice(rng, end) };
        }
    }
}

fn lattice_body(rng: &mut StdRng) -> Body {
    let (from, to) = (lattice_placement(rng, 3), lattice_placement(rng, 3));
    let count = rng.random_range(1..=7);
    let vertices: Vec<DVec3> = (0..count).map(|_| lattice(rng, 2)).collect();
    let index = |rng: &mut StdRng| rng.random_range(0..count as u32);
    let (primitives, is_mesh) = match rng.random_range(0..3) {
        0 => (vec![(0..count as u32).collect()], false),
        1 => ((0..3).map(|_| vec![index(rng), index(rng), index(rng)]).collect(), true),
        _ => ((0..3).map(|size| (0..=size + 3).map(|_| index(rng)).collect()).collect(), false),
    };
    let was = Soup { vertices, primitives, is_mesh };
    let mut is = was.clone();
    let soup = is.is_mesh || is.primitives.len() > 1;
    if soup && rng.random_range(0..2) == 0 {
        is.vertices.iter_mut().for_each(|v| *v += lattice(rng, 1));
    }
    Body { was, is, from, to }
}

/// Law: two objects collide if and only if they do now, or the hull of the differences of some two primitives, at both ends,
/// contains the origin.
#[test]
fn what_collides_on_the_way_is_what_the_exact_twin_says() {
    let seed = 1000;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits, mut on_the_way) = (1500, 0, 0);
    for case in 0..cases {
        let (a, b) = (lattice_body(&mut rng), lattice_body(&mut rng));
        let (hulls_a, hulls_b) = (a.hulls(), b.hulls());
        let meet = |x: &[Vec<DVec3>; 2], y: &[Vec<DVec3>; 2]| {
            let differences: Vec<DVec3> = [0, 1]
                .iter()
                .flat_map(|&end| x[end].iter().flat_map(move |p| y[end].iter().map(move |q| *p - *q)))
                .collect();
            hulls_intersect_exact(&differences, &[DVec3::ZERO])
        };
        let expected = hulls_a.iter().any(|x| hulls_b.iter().any(|y| meet(x, y)));
        let found = collision(&a, &b);
        assert_eq!(found.is_some(), expected, "case {case}");
        let Some(found) = found else { continue };
        hits += 1;
        let now = hulls_a.iter().any(|x| hulls_b.iter().any(|y| hulls_intersect_exact(&x[1], &y[1])));
        assert_eq!(found.when == When::Now, now, "case {case}");
        on_the_way += usize::from(!now);
        if let (When::OnTheWay, Contact::Witness { point, local_a, local_b }) = (found.when, found.contact) {
            let spot = Shape::convex_hull(&[point]).unwrap();
            for (body, hulls, local) in [(&a, &hulls_a, local_a), (&b, &hulls_b, local_b)] {
                let off = |ends: &[Vec<DVec3>; 2]| {
                    let hull = Shape::convex_hull(&ends.concat()).unwrap();
                    query::distance(&hull, &DAffine3::IDENTITY, &spot, &DAffine3::IDENTITY).unwrap().distance
                };
                let off = hulls.iter().map(off).fold(f64::INFINITY, f64::min);
                assert!(off < 1e-9, "case {case}: {point} is {off} away from what was swept");
                assert!(body.to.transform_point3(local).distance(point) < 1e-9);
            }
        }
    }
    println!("{on_the_way} on the way");
    assert!(on_the_way > cases / 10);
    assert_rate("lattice bodies", hits, cases);
}

/// A shape of any kind; with the vertices of one that deforms.
fn any_shape(rng: &mut StdRng) -> (Shape, Option<Soup>) {
    let soup = match rng.random_range(0..4) {
        0 => random_mesh(rng, 60),
        1 => random_complex(rng, 8),
        _ => return (shape_of(&random_shape(rng, 1.0)), None),
    };
    (soup.shape(), Some(soup))
}

/// Law: whatever collides at some time of the straight motion of every point is found.
#[test]
fn no_collision_of_a_sampled_motion_is_missed() {
    const SAMPLES: u32 = 16;
    let seed = 1001;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits, mut between) = (1200, 0, 0);
    for case in 0..cases {
        let bodies: [_; 2] = std::array::from_fn(|_| {
            let (shape, soup) = any_shape(&mut rng);
            let size = rng.random_range(0.3..=2.0);
            let [from, to] = std::array::from_fn(|_| {
                let mut at = placement(&mut rng, 1.0);
                at.matrix3 *= size;
                at.translation = 1.5 * in_cube(&mut rng);
                at
            });
            let positions = soup.filter(|_| rng.random_range(0..2) == 0).map(|soup| {
                let moved = soup.vertices.iter().map(|&v| v + 0.3 * in_cube(&mut rng));
                (soup.vertices.clone(), moved.collect::<Vec<DVec3>>())
            });
            (shape, positions, from, to)
        });
        // Both ends and what lies between, by interpolation.
        let mut met = [false; 2];
        for sample in 0..=SAMPLES {
            let t = f64::from(sample) / f64::from(SAMPLES);
            let placed = bodies.each_ref().map(|(shape, positions, from, to)| {
                let mut shape = shape.clone();
                if let Some((was, is)) = positions {
                    // Each point goes straight in the world, which a deformation in a space that moves would not.
                    let ends =
                        |was: &DVec3, is: &DVec3| [from.transform_point3(*was), to.transform_point3(*is)];
                    let at =
                        was.iter().zip(is).map(|(was, is)| ends(was, is)).map(|[was, is]| was.lerp(is, t));
                    shape.deform(&at.collect::<Vec<DVec3>>()).unwrap();
                    return (shape, DAffine3::IDENTITY);
                }
                let matrix3 = from.matrix3 * (1.0 - t) + to.matrix3 * t;
                (shape, DAffine3 { matrix3, translation: from.translation.lerp(to.translation, t) })
            });
            let [(a, at_a), (b, at_b)] = &placed;
            // Half a turn is flat in its middle: no placement.
            let meet = query::intersects(a, at_a, b, at_b).unwrap_or(false);
            met[usize::from(sample == SAMPLES)] |= meet;
        }
        for mut world in worlds(Response::Smart) {
            let ids = bodies.each_ref().map(|(shape, _, from, _)| world.add(shape, *from).unwrap());
            for ((_, positions, _, to), id) in bodies.iter().zip(ids) {
                if let Some((_, moved)) = positions {
                    world.deform(id, moved).unwrap();
                }
                world.set_placement(id, *to).unwrap();
            }
            let found = world.test();
            assert!(!found.is_empty() || met == [false; 2], "case {case}: a collision is missed");
            assert_eq!(found.iter().any(|c| c.when == When::Now), met[1], "case {case}");
        }
        hits += usize::from(met != [false; 2]);
        between += usize::from(met == [true, false]);
    }
    println!("{between} between the frames");
    assert!(between > cases / 20);
    assert_rate("sampled motions", hits, cases);
}

/// Law: no speed is too high for a bullet, of any kind, to be stopped by a wall, of any kind; and one that flies by does not
/// hit it.
#[test]
fn a_bullet_passes_no_wall_at_any_speed() {
    let mut rng = seeded(1002);
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[y, z]| DVec3::new(0.0, y, z));
    let walls = [
        Shape::cuboid([1e-3, 2.0, 2.0]).unwrap(),
        Shape::convex_hull(&corners).unwrap(),
        Shape::mesh(corners, [[0, 1, 2], [0, 2, 3]]).unwrap(),
    ];
    let mut bullets: Vec<Shape> = (0..12).map(|_| shape_of(&random_shape(&mut rng, 0.01))).collect();
    bullets.extend((0..4).map(|_| random_mesh(&mut rng, 20).scaled(0.01).shape()));
    for (wall, bullet) in walls.iter().flat_map(|wall| bullets.iter().map(move |bullet| (wall, bullet))) {
        for speed in [1.0, 10.0, 1e3, 1e5, 1e7] {
            // Somewhere into the middle of the wall, far from its rim; or well beside.
            for (beside, hit) in [(0.0, true), (3.0, false)] {
                let target = 0.5 * DVec3::new(0.0, rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0));
                let target = target + DVec3::Y * beside;
                let way = DVec3::new(1.0, rng.random_range(-0.1..0.1), rng.random_range(-0.1..0.1)) * speed;
                let turn = DQuat::from_axis_angle(direction(&mut rng), 1.0);
                let at = |t: f64| DAffine3::from_rotation_translation(turn, target + way * t);
                let part = rng.random_range(0.2..0.8);
                for mut world in worlds(Response::Smart) {
                    world.add(wall, DAffine3::IDENTITY).unwrap();
                    let id = world.add(bullet, at(-part)).unwrap();
                    assert!(world.test().is_empty());
                    world.set_placement(id, at(1.0 - part)).unwrap();
                    let found = world.test();
                    assert_eq!(found.len(), usize::from(hit), "speed {speed}");
                    if let Some(found) = found.first() {
                        assert_eq!(found.when, When::OnTheWay);
                        // From the wall to where the bullet came from.
                        assert!(found.normal().unwrap().x > 0.0);
                    }
                    world.proceed();
                    assert!(world.test().is_empty());
                    world.set_motion(id, Motion::Sampled).unwrap();
                    world.set_placement(id, at(-part)).unwrap();
                    assert!(world.test().is_empty(), "where it is sampled it passes");
                }
            }
        }
    }
}

/// Law: whether the way counts is as it was set last, before or after what moved.
#[test]
fn a_way_counts_once_it_is_to() {
    let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
    let corners = [DVec3::ZERO, DVec3::Y * 0.1, DVec3::Z * 0.1];
    let dart = Shape::mesh(corners, [[0, 1, 2]]).unwrap();
    for deforms in [false, true] {
        let mut world = World::new();
        let wall = world.add(&Shape::cuboid([0.5, 4.0, 4.0]).unwrap(), DAffine3::IDENTITY).unwrap();
        let id = world.add(&dart, at(-5.0)).unwrap();
        if deforms {
            world.deform(id, &corners.map(|v| v + DVec3::X * 10.0)).unwrap();
        } else {
            world.set_placement(id, at(5.0)).unwrap();
        }
        let time = |world: &World| {
            let impact = world.time_of_impact(wall, id, &query::ImpactOptions::default()).unwrap();
            impact.map(|impact| impact.time)
        };
        for _ in 0..2 {
            assert_eq!((world.test().len(), time(&world)), (0, None), "deforms: {deforms}");
            world.set_motion(id, Motion::Swept).unwrap();
            assert!(matches!(&world.test()[..], [found] if found.when == When::OnTheWay));
            assert!(time(&world).is_some_and(|time| (time - 0.475).abs() < 1e-6), "deforms: {deforms}");
            world.set_motion(id, Motion::Sampled).unwrap();
        }
    }
}

/// Law: what told two apart tells nothing of a way that comes from elsewhere, as where frames ended that nobody tested.
#[test]
fn a_way_from_a_frame_that_was_not_tested_is_tested() {
    // Beside the top of a cone, where the boxes overlap.
    let at = |x: f64| DAffine3::from_translation(DVec3::new(x, 0.45, 0.0));
    for mut world in worlds(Response::Witness) {
        world.add(&Shape::cone(0.5, 1.0).unwrap(), DAffine3::IDENTITY).unwrap();
        let bullet = world.add(&Shape::cylinder(0.1, 0.2).unwrap(), at(-0.45)).unwrap();
        world.set_placement(bullet, at(-0.4)).unwrap();
        assert!(world.test().is_empty());
        for x in [0.4, -0.4] {
            world.proceed();
            world.set_placement(bullet, at(x)).unwrap();
        }
        assert!(matches!(&world.test()[..], [found] if found.when == When::OnTheWay));
    }
}

/// Law: of what collided on the way and is apart now the depth is 0, with the closest points.
#[test]
fn what_collided_on_the_way_has_no_depth() {
    let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
    for mut world in worlds(Response::Depth) {
        world.add(&Shape::cuboid([2.0, 4.0, 4.0]).unwrap(), DAffine3::IDENTITY).unwrap();
        let bullet = world.add(&Shape::sphere(0.5).unwrap(), at(-5.0)).unwrap();
        world.set_placement(bullet, at(5.0)).unwrap();
        let Contact::Depth { depth, normal, point_on_a, point_on_b } = world.test()[0].contact else {
            panic!("a depth was asked for")
        };
        assert_eq!((depth, normal), (0.0, DVec3::NEG_X));
        assert_eq!((point_on_a, point_on_b), (DVec3::X, DVec3::X * 4.5));
    }
}

/// The relative motion counts: what flies side by side, or one behind the other, does not collide.
#[test]
fn a_convoy_does_not_collide_with_itself() {
    let mut rng = seeded(1003);
    for shape in [Shape::cuboid([1.0; 3]).unwrap(), random_mesh(&mut rng, 100).shape()] {
        for mut world in worlds(Response::Simple) {
            let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
            let cars: Vec<ObjectId> =
                (0..10).map(|i| world.add(&shape, at(2.5 * f64::from(i))).unwrap()).collect();
            for frame in 1..5 {
                for (x, &car) in (0..).map(|i| 2.5 * f64::from(i)).zip(&cars) {
                    world.set_placement(car, at(x + 8.0 * f64::from(frame))).unwrap();
                }
                assert!(world.test().is_empty());
                world.proceed();
            }
            assert!(world.statistics().sweeps > 0);
            // The last overtakes all others.
            world.set_placement(cars[0], at(100.0)).unwrap();
            assert_eq!(world.test().len(), cars.len() - 1);
        }
    }
}

/// A shape that was set has come all the way, unless it is a deformation of the one before.
#[test]
fn a_shape_set_within_the_frame_comes_along() {
    let small = Shape::sphere(0.1).unwrap();
    let triangle = [DVec3::ZERO, DVec3::Y, DVec3::Z];
    let mesh = Shape::mesh(triangle, [[0, 1, 2]]).unwrap();
    let mut deformed = mesh.clone();
    deformed.deform(&triangle.map(|v| v + DVec3::X * 10.0)).unwrap();
    let at = |x: f64, y: f64| DAffine3::from_translation(DVec3::new(x, y, 0.1));
    // The obstacle is beside the way of the small ball, and in that of the large one and of the deformation.
    for (before, after, to, obstacle, hit) in [
        (&small, small.clone(), 10.0, at(5.0, 1.0), false),
        (&small, Shape::sphere(1.0).unwrap(), 10.0, at(5.0, 1.0), true),
        (&small, mesh.clone(), 10.0, at(5.0, 0.5), true),
        (&mesh, deformed, 0.0, at(5.0, 0.3), true),
        (&mesh, mesh.clone(), 0.0, at(5.0, 0.3), false),
    ] {
        let mut world = World::new();
        let obstacle = world.add(&small, obstacle).unwrap();
        let id = world.add(before, DAffine3::IDENTITY).unwrap();
        world.set_motion(id, Motion::Swept).unwrap();
        world.set_shape(id, &after).unwrap();
        world.set_placement(id, DAffine3::from_translation(DVec3::X * to)).unwrap();
        assert_eq!(world.test().len(), usize::from(hit), "{} to {}", before.kind(), after.kind());
        let impact = world.time_of_impact(obstacle, id, &query::ImpactOptions::default()).unwrap();
        assert_eq!(impact.is_some(), hit, "{} to {}: {impact:?}", before.kind(), after.kind());
    }
}

/// Law: boxes of a fixed size are around all forms on the way, also where another shape was set in between.
#[test]
fn boxes_of_a_fixed_size_hold_what_was_larger_on_the_way() {
    let small = Shape::mesh([DVec3::ZERO, DVec3::X, DVec3::Y], [[0, 1, 2]]).unwrap();
    let mut large = small.clone();
    large.deform(&[DVec3::ZERO, DVec3::X * 100.0, DVec3::Y * 100.0]).unwrap();
    let ball = Shape::sphere(1.0).unwrap();
    for boxes in [Boxes::Dynamic, Boxes::FixedSize] {
        let options = WorldOptions { boxes, motion: Motion::Swept, ..WorldOptions::default() };
        let mut world = World::with_options(&options);
        let sheet = world.add(&large, DAffine3::IDENTITY).unwrap();
        world.add(&ball, DAffine3::from_translation(DVec3::new(30.0, 30.0, 0.0))).unwrap();
        world.set_shape(sheet, &ball).unwrap();
        world.set_shape(sheet, &small).unwrap();
        assert!(matches!(&world.test()[..], [found] if found.when == When::OnTheWay), "{boxes:?}");
        world.proceed();
        assert!(world.test().is_empty());
    }
}

/// Law: a box of a fixed size gives way to what deforms beyond it.
#[test]
fn boxes_of_a_fixed_size_hold_what_deforms() {
    let sheet = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let small = Shape::mesh(sheet, [[0, 1, 2]]).unwrap();
    let large = sheet.map(|v| v * 100.0);
    let mut deformed = small.clone();
    deformed.deform(&large).unwrap();
    for boxes in [Boxes::Dynamic, Boxes::FixedSize] {
        for is_set in [false, true] {
            let mut world = World::with_options(&WorldOptions { boxes, ..WorldOptions::default() });
            let id = world.add(&small, DAffine3::IDENTITY).unwrap();
            let place = DAffine3::from_translation(DVec3::new(30.0, 30.0, 0.0));
            world.add(&Shape::sphere(1.0).unwrap(), place).unwrap();
            assert!(world.test().is_empty());
            if is_set { world.set_shape(id, &deformed) } else { world.deform(id, &large) }.unwrap();
            assert_eq!(world.test().len(), 1, "{boxes:?}");
        }
    }
}

/// The tree leaves out what a bullet does not come near, also when the bullet is a mesh.
#[test]
fn a_bullet_in_a_valley_costs_little() {
    let mut rng = seeded(1004);
    let valley = common::sheet(101, 101, [false, false], |u, v| {
        DVec3::new(100.0 * u - 50.0, 10.0 * (2.0 * v - 1.0).powi(2), 100.0 * v - 50.0)
    });
    let triangles = valley.primitives.len() as u64;
    let pebble = random_mesh(&mut rng, 20).scaled(0.1).shape();
    for bullet in [Shape::sphere(0.1).unwrap(), pebble] {
        for mut world in worlds(Response::Simple) {
            world.add(&valley.shape(), DAffine3::IDENTITY).unwrap();
            let at = |x: f64| DAffine3::from_translation(DVec3::new(x, 0.15, 0.3));
            let id = world.add(&bullet, at(-40.0)).unwrap();
            world.set_placement(id, at(40.0)).unwrap();
            assert!(world.test().is_empty());
            let work = world.statistics();
            println!("{work:?}");
            assert_eq!((work.candidates, work.sweeps), (1, 1));
            assert!(
                work.box_tests > 0
                    && 20 * work.box_tests < triangles
                    && 20 * work.primitive_tests < triangles,
                "{work:?}"
            );
        }
    }
}

/// The way of a box along a diagonal is much less than the box around its way.
#[test]
fn meshes_that_pass_each_other_by_cost_little() {
    let ring = common::torus(60, 60, 0.3);
    let triangles = ring.primitives.len() as u64;
    for length in [0.1, 1.0, 10.0, 1000.0] {
        for mut world in worlds(Response::Simple) {
            let way = DVec3::new(1.0, 0.1, 1.0).normalize() * length;
            let beside = DVec3::new(1.0, 0.0, -1.0).normalize() * 2.05;
            world.add(&ring.shape(), DAffine3::IDENTITY).unwrap();
            let id = world.add(&ring.shape(), DAffine3::from_translation(beside - 0.5 * way)).unwrap();
            world.set_placement(id, DAffine3::from_translation(beside + 0.5 * way)).unwrap();
            assert!(world.test().is_empty());
            let work = world.statistics();
            println!("{length}: {work:?}");
            assert_eq!(work.sweeps, 1);
            assert!(work.box_tests.max(work.primitive_tests) < 2 * triangles, "{work:?}");
        }
    }
}

/// At the limit of precision the boxes of the ways must not decide otherwise than the narrow phase: what touches is found
/// with any boxes, and scaling all by a power of two changes nothing.
#[test]
fn boxes_lose_no_touch_on_the_way() {
    let mut rng = seeded(1005);
    let (cases, mut hits) = (600, 0);
    for case in 0..cases {
        let block = Shape::cuboid(0.5 + in_cube(&mut rng).abs()).unwrap();
        let ball = shape_of(&random_shape(&mut rng, 1.0));
        let length = 10f64.powi(rng.random_range(0..6));
        let way = DVec3::new(length, 0.0, 0.0);
        let turn =
            DAffine3::from_quat(DQuat::from_axis_angle(direction(&mut rng), rng.random_range(0.0..3.0)));
        // Beside the block by the sum of both half sizes, and some gap near the rounding error.
        let gap = [0.0, 1e-13, -1e-13, -3e-12, -1e-12, 1e-11, -1e-11, -1e-3][case % 8] * length;
        let (low, high) =
            (query::bounds(&ball, &turn).unwrap(), query::bounds(&block, &DAffine3::IDENTITY).unwrap());
        let y = high.max.y - low.min.y + gap;
        let at = |t: f64| {
            let mut at = turn;
            at.translation = DVec3::new(0.0, y, 0.0) + way * t;
            at
        };
        let mut answers = Vec::new();
        for factor in [1.0, 2f64.powi(100), 2f64.powi(-100)] {
            for mut world in worlds(Response::Simple) {
                world.add(&block, common::rescaled(&DAffine3::IDENTITY, factor)).unwrap();
                let id = world.add(&ball, common::rescaled(&at(-0.5), factor)).unwrap();
                world.set_placement(id, common::rescaled(&at(0.5), factor)).unwrap();
                answers.push(!world.test().is_empty());
            }
        }
        assert!(answers.iter().all(|answer| *answer == answers[0]), "case {case}: {answers:?}");
        hits += usize::from(answers[0]);
    }
    assert_rate("touching on the way", hits, cases);
}

/// Law: boxes lose nothing of what grows or deforms by much, for which the narrow phase errs by a part of the size that it then has.
#[test]
fn boxes_have_room_for_the_error_at_the_larger_end() {
    let triangle = [DVec3::ZERO, DVec3::new(0.0, 1e-3, 0.0), DVec3::new(0.0, 0.0, 1e-3)];
    let (dart, pole) = (Shape::mesh(triangle, [[0, 1, 2]]).unwrap(), Shape::cuboid([0.1, 4.0, 0.1]).unwrap());
    let mut away = dart.clone();
    away.deform(&triangle.map(|v| v + DVec3::X * 1e15)).unwrap();
    let grown = DAffine3::from_scale(DVec3::new(1e15, 1e15, -1e15));
    let triangle = triangle.map(|v| v + DVec3::X);
    let blade = Shape::mesh(triangle, [[0, 1, 2]]).unwrap();
    for (shape, after, to) in [(&dart, &away, DAffine3::IDENTITY), (&blade, &blade, grown)] {
        let met = worlds(Response::Simple).into_iter().map(|mut world| {
            // The box of a pole that may turn reaches as far as its end, that of one that may not ends just beside the dart.
            world.add(&pole, DAffine3::from_translation(DVec3::X * -0.06)).unwrap();
            let id = world.add(shape, DAffine3::IDENTITY).unwrap();
            assert!(world.test().is_empty());
            world.set_shape(id, after).unwrap();
            world.set_placement(id, to).unwrap();
            world.test().len()
        });
        let met: Vec<usize> = met.collect();
        assert!(met.iter().all(|&count| count == met[0]), "{met:?}");
    }
}
