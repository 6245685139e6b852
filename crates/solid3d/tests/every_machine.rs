//! Law: the same input gives the same bits on every machine. Every question is asked about shapes of all kinds, the answers are written out to the last
//! digit, and what was written of each question is condensed to a number; `every_machine.txt` has those that every machine must give.
//!
//! After a change that is meant to change answers, `SOLID_ANSWERS=write cargo test -p solid3d --test every_machine` writes it anew, and the diff says
//! which questions that touched. What is asked about is made without sines, powers and random numbers, which differ from machine to machine.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeMap;
use std::fmt::{Debug, Write};

use glam::{DAffine3, DMat3, DQuat, DVec3};
use solid3d::ccd::{self, Elements};
use solid3d::hull::Hull;
use solid3d::polygon::Polygon;
use solid3d::query::{self, ContactOptions, ImpactOptions, PairCache, Path, Ray, RayOptions};
use solid3d::{
    Boxes, BroadPhaseKind, ComplexShapeBuilder, Motion, Response, Shape, World, WorldOptions, glam,
};

const TABLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/every_machine.txt");
/// Where another machine is emulated there may be no files.
const EXPECTED: &str = include_str!("every_machine.txt");
/// Of each pair of shapes.
const PLACEMENTS: u32 = 10;
/// That rays and points come from.
const PLACES: u32 = 100;
const FRAMES: u32 = 4;

/// Text, condensed (FNV-1a).
struct Digest(u64);

impl Write for Digest {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        for byte in text.bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
        Ok(())
    }
}

/// The answers to each question.
#[derive(Default)]
struct Answers(BTreeMap<&'static str, Digest>);

impl Answers {
    /// A number is written with as many digits as tell it from all others.
    fn add(&mut self, question: &'static str, answer: impl Debug) {
        let digest = self.0.entry(question).or_insert(Digest(0xcbf2_9ce4_8422_2325));
        write!(digest, "{answer:?}").unwrap();
    }
}

/// Numbers from 0 to 1 that are spread evenly: the fractions of multiples of a root of two.
struct Spread(u32);

impl Spread {
    fn part(&mut self) -> f64 {
        self.0 += 1;
        (f64::from(self.0) * std::f64::consts::SQRT_2).fract()
    }

    /// In the cube from -1 to 1.
    fn vector(&mut self) -> DVec3 {
        // One after the other these would be in few planes.
        DVec3::from_array([7, 11, 13].map(|skip| {
            self.0 += skip;
            2.0 * self.part() - 1.0
        }))
    }

    /// Half of the time a rotation, else any map.
    fn placement(&mut self, far: f64) -> DAffine3 {
        let turn = DQuat::from_vec4(self.vector().extend(self.part() + 0.1)).normalize();
        let moved = DAffine3::from_rotation_translation(turn, far * self.vector());
        match self.0 % 2 {
            0 => moved,
            _ => moved * DAffine3::from_mat3(DMat3::IDENTITY + 0.2 * DMat3::from_diagonal(self.vector())),
        }
    }
}

/// A point of the unit circle, counted in halves of right angles and their parts.
fn on_circle(i: u32, sides: u32) -> (f64, f64) {
    let quarter = sides / 4;
    let t = f64::from(i % quarter) / f64::from(quarter);
    let (x, y) = ((1.0 - t * t) / (1.0 + t * t), 2.0 * t / (1.0 + t * t));
    [(x, y), (-y, x), (-x, -y), (y, -x)][(i / quarter) as usize % 4]
}

fn torus(sides: [u32; 2]) -> Shape {
    let around = |i| on_circle(i, sides[0]);
    let across = |j| on_circle(j, sides[1]);
    let vertex = |i, j| {
        let ((x, z), (r, y)) = (around(i), across(j));
        DVec3::new(x * (0.7 + 0.3 * r), 0.3 * y, z * (0.7 + 0.3 * r))
    };
    let places = || (0..sides[0]).flat_map(|i| (0..sides[1]).map(move |j| (i, j)));
    let number = |i, j| i % sides[0] * sides[1] + j % sides[1];
    let triangles = places().flat_map(|(i, j)| {
        let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
        [[a, c, b], [a, d, c]]
    });
    let vertices: Vec<DVec3> = places().map(|(i, j)| vertex(i, j)).collect();
    Shape::mesh(vertices, triangles.collect::<Vec<_>>()).unwrap()
}

/// One of every kind, all about 2 in size.
fn shapes() -> Vec<Shape> {
    let mut spread = Spread(0);
    let mut points = |count| -> Vec<DVec3> { (0..count).map(|_| spread.vector()).collect() };
    let soup = ComplexShapeBuilder::new(points(12));
    let torus = torus([16, 8]);
    vec![
        Shape::sphere(0.9).unwrap(),
        Shape::cuboid([1.0, 1.5, 2.0]).unwrap(),
        Shape::cone(0.8, 1.7).unwrap(),
        Shape::cylinder(0.7, 1.6).unwrap(),
        Shape::capsule(0.5, 1.2).unwrap(),
        Shape::convex_hull(&points(20)).unwrap(),
        Shape::convex_hull(&points(300)).unwrap(),
        soup.tetrahedron([0, 1, 2, 3])
            .polyhedron(&[4, 5, 6, 7, 8])
            .triangle([8, 9, 10])
            .segment([9, 11])
            .build()
            .unwrap(),
        torus.clone(),
        torus.into_solid().unwrap(),
    ]
}

fn ask_about_two(answers: &mut Answers, a: &Shape, b: &Shape, spread: &mut Spread) {
    let mut cache = PairCache::new(a, b);
    let contacts = ContactOptions { margin: 0.05, ..ContactOptions::default() };
    for i in 0..PLACEMENTS {
        let [p, q, next] = [0.7, 0.7, 1.2].map(|far| spread.placement(far));
        answers.add("intersects", query::intersects(a, &p, b, &q));
        answers.add("common_point", query::common_point(a, &p, b, &q));
        answers.add("separating_axis", query::separating_axis(a, &p, b, &q));
        answers.add("distance", query::distance(a, &p, b, &q));
        answers.add("penetration", query::penetration(a, &p, b, &q));
        answers.add("contacts", query::contacts(a, &p, b, &q, &contacts));
        answers.add("intersection_curve", query::intersection_curve(a, &p, b, &q));
        answers.add("cast_shape", query::cast_shape(a, &p, 2.0 * spread.vector(), b, &next, DVec3::ZERO));
        let path = if i % 2 == 0 { Path::Straight } else { Path::Turning };
        let options = ImpactOptions { path, tolerance: 1e-4 };
        answers.add("time_of_impact", query::time_of_impact(a, &next, &p, b, &q, &q, &options));
        for step in 0..3 {
            let p = DAffine3::from_translation(DVec3::splat(0.02 * f64::from(step))) * p;
            answers.add("PairCache::intersects", cache.intersects(&p, &q));
            answers.add("PairCache::distance", cache.distance(&p, &q));
        }
    }
}

fn ask_about_one(answers: &mut Answers, shape: &Shape, spread: &mut Spread) {
    for _ in 0..PLACES {
        let (at, point) = (spread.placement(0.3), 1.5 * spread.vector());
        let ray = Ray::new(point, spread.vector() - point);
        answers.add("bounds", query::bounds(shape, &at));
        answers.add("contains_point", query::contains_point(shape, &at, point));
        answers.add("closest_point", query::closest_point(shape, &at, point));
        answers.add("signed_distance", query::signed_distance(shape, &at, point));
        answers.add("winding_number", query::winding_number(shape, &at, point));
        answers.add("cast_ray_all", query::cast_ray_all(shape, &at, &ray, &RayOptions::default()));
    }
}

/// A crowd of all kinds that moves, and a mesh in it that deforms.
fn play(answers: &mut Answers, options: &WorldOptions, shapes: &[Shape], spread: &mut Spread) {
    let mut world = World::with_options(options);
    let ids: Vec<_> =
        (0..2).flat_map(|_| shapes).map(|shape| world.add(shape, spread.placement(3.0)).unwrap()).collect();
    world.set_clearance(0.1).unwrap();
    let deforming = world.add(&torus([12, 8]), DAffine3::IDENTITY).unwrap();
    for frame in 0..FRAMES {
        for &id in ids.iter().skip(frame as usize % 3).step_by(2) {
            let moved = DAffine3::from_translation(0.2 * spread.vector()) * world.placement(id).unwrap();
            world.set_placement(id, moved).unwrap();
        }
        let vertices = world.shape(deforming).unwrap().vertices().unwrap();
        let bent: Vec<DVec3> = vertices.iter().map(|&v| v + 0.05 * spread.vector()).collect();
        world.deform(deforming, &bent).unwrap();
        answers.add("World::test", world.test());
        answers.add("World::near", world.near());
        world.proceed();
    }
    answers.add("World::statistics", world.statistics());
}

fn ask_about_points(answers: &mut Answers, spread: &mut Spread) {
    for _ in 0..PLACES {
        let [from, to] = [(); 2].map(|()| [(); 4].map(|()| spread.vector()));
        let elements = Elements { from, to };
        answers.add("ccd::vertex_face", ccd::vertex_face(&elements, &ccd::Options::default()));
        answers.add("ccd::edge_edge", ccd::edge_edge(&elements, &ccd::Options::default()));
        answers.add("Hull::of", Hull::of(&[from, to].concat()));
        let across = spread.placement(0.5);
        let rim = |i| on_circle(i, 12);
        let star =
            (0..12).map(|i| DVec3::new(rim(i).0, 0.0, rim(i).1) * (1.0 - f64::from(i % 2) * spread.part()));
        let star = Polygon::new(star.collect::<Vec<_>>()).unwrap();
        answers.add("Polygon::triangles", star.triangles());
        answers.add("Polygon::intersection", star.intersection(&star.transformed(&across).unwrap()));
    }
}

fn answers() -> Answers {
    let (mut answers, mut spread) = (Answers::default(), Spread(1000));
    let shapes = shapes();
    for (i, a) in shapes.iter().enumerate() {
        ask_about_one(&mut answers, a, &mut spread);
        for b in &shapes[i..] {
            ask_about_two(&mut answers, a, b, &mut spread);
        }
    }
    let [tree, sweep] = [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune];
    for (default_response, broad_phase, boxes, motion) in [
        (Response::Smart, tree, Boxes::Dynamic, Motion::Sampled),
        (Response::Depth, sweep, Boxes::FixedSize, Motion::Sampled),
        (Response::Contacts, tree, Boxes::Dynamic, Motion::Swept),
    ] {
        let options = WorldOptions { default_response, broad_phase, boxes, motion, caching: true };
        play(&mut answers, &options, &shapes, &mut spread);
    }
    ask_about_points(&mut answers, &mut spread);
    answers
}

#[test]
fn every_machine_gives_the_same_bits() {
    let answers = answers();
    let told: String =
        answers.0.iter().map(|(question, digest)| format!("{:016x} {question}\n", digest.0)).collect();
    if std::env::var_os("SOLID_ANSWERS").is_some_and(|wish| wish == "write") {
        std::fs::write(TABLE, &told).unwrap();
        return;
    }
    let differ: Vec<_> = told.lines().filter(|line| !EXPECTED.lines().any(|known| known == *line)).collect();
    assert!(
        differ.is_empty() && told.lines().count() == EXPECTED.lines().count(),
        "not what {TABLE} has: {differ:#?}"
    );
}
