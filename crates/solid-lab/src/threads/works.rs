//! What is measured: worlds, broad phases and meshes, of sizes below and above what is worth another thread.

use std::time::{Duration, Instant};

use solid3d::broad::{BroadPhase, DynamicTree, Proxy};
use solid3d::glam::{DAffine3, DVec3};
use solid3d::{Aabb, Response, Shape, World, WorldOptions};

use super::{NO_SLOWER, SPEED_UP};
use crate::inputs::{ICollide, Mesh, Pose, Settings, Swarm};
use crate::peers::{Bench, with_commas};

/// Does a work once, and says how long the part of it took that counts.
pub type Work = Box<dyn FnMut() -> Duration + Send>;

/// The name of a work, the speed-up asked for, and how to make it.
pub type Case<'b> = (String, f64, Box<dyn Fn() -> Work + 'b>);

/// Objects or boxes from which on two threads are to be faster.
const OBJECTS_MANY: usize = 10_000;

/// Triangles from which on they are.
const TRIANGLES_MANY: usize = 100_000;

/// Frames of what moves; they are played there and back, so that the motion has no jump.
const FRAMES: usize = 4;

/// All works.
pub fn all(bench: &Bench) -> Vec<Case<'_>> {
    let target = |size: usize, many: usize| if size < many { NO_SLOWER } else { SPEED_UP };
    let scaled = |size: usize| bench.effort.size(size);
    let mut cases: Vec<Case> = Vec::new();
    for objects in [1_000, 2_000, 10_000, 100_000] {
        let target = target(objects, OBJECTS_MANY);
        let name = format!("test of a world, {} polyhedra that all move", with_commas(objects));
        cases.push((name.clone(), target, Box::new(move || world(bench, &name, scaled(objects)))));
    }
    for boxes in [1_000, 10_000, 100_000, 1_000_000] {
        let target = target(boxes, OBJECTS_MANY);
        let name = format!("broad phase, {} boxes that all move", with_commas(boxes));
        cases.push((name.clone(), target, Box::new(move || frames(bench, &name, scaled(boxes)))));
        let name = format!("broad phase, {} boxes for the first time", with_commas(boxes));
        cases.push((name.clone(), target, Box::new(move || fresh(bench, &name, scaled(boxes)))));
    }
    for triangles in [5_000, 100_000, 1_000_000] {
        let target = target(triangles, TRIANGLES_MANY);
        let name = format!("build of {} triangles", with_commas(triangles));
        cases.push((name, target, Box::new(move || build(scaled(triangles)))));
        let name = format!("refit of {} triangles", with_commas(triangles));
        cases.push((name, target, Box::new(move || refit(scaled(triangles)))));
    }
    cases
}

/// The numbers of frames there and back, for ever.
fn there_and_back(frames: usize) -> impl Iterator<Item = usize> {
    (0..frames).chain((1..frames.max(2) - 1).rev()).cycle()
}

/// The time of `work`.
fn time(work: impl FnOnce()) -> Duration {
    let start = Instant::now();
    work();
    start.elapsed()
}

/// Placements are set before the clock starts.
fn world(bench: &Bench, name: &str, objects: usize) -> Work {
    let settings = Settings { objects, ..Settings::default() };
    let mut simulation = ICollide::new(&mut bench.rng(name), &settings);
    let options = WorldOptions { default_response: Response::Simple, ..WorldOptions::default() };
    let mut world = World::with_options(&options);
    let shapes: Vec<Shape> = simulation.shapes.iter().map(|polyhedron| polyhedron.shape()).collect();
    let ids: Vec<_> = (shapes.iter().cycle().zip(simulation.poses()))
        .map(|(shape, pose)| world.add(shape, pose.affine()))
        .collect::<Result<_, _>>()
        .expect("the poses are valid");
    let frames: Vec<Vec<DAffine3>> = (0..FRAMES)
        .map(|_| {
            simulation.step(std::iter::empty());
            simulation.poses().iter().map(Pose::affine).collect()
        })
        .collect();
    let mut order = there_and_back(FRAMES);
    let mut collisions = Vec::new();
    Box::new(move || {
        for (id, pose) in ids.iter().zip(&frames[order.next().unwrap_or(0)]) {
            world.set_placement(*id, *pose).expect("the poses are valid");
        }
        let time = time(|| world.test_into(&mut collisions));
        world.proceed();
        time
    })
}

fn frames(bench: &Bench, name: &str, count: usize) -> Work {
    let mut swarm = Swarm::random(&mut bench.rng(name), count);
    let mut boxes = |_| -> Vec<(Proxy, Aabb)> {
        swarm.step(count);
        bounds_of(&swarm)
    };
    let mut broad = DynamicTree::default();
    // They come from somewhere, so that they are known to move.
    broad.insert_many(&boxes(0));
    let frames: Vec<Vec<(Proxy, Aabb)>> = (0..FRAMES).map(&mut boxes).collect();
    broad.flush();
    let mut order = there_and_back(FRAMES);
    Box::new(move || {
        let boxes = &frames[order.next().unwrap_or(0)];
        time(|| {
            broad.update_many(boxes);
            broad.flush();
        })
    })
}

/// All boxes, by proxy.
fn bounds_of(swarm: &Swarm) -> Vec<(Proxy, Aabb)> {
    (0..).zip((0..swarm.count()).map(|i| swarm.bounds(i))).collect()
}

/// The tree and all pairs from nothing.
fn fresh(bench: &Bench, name: &str, count: usize) -> Work {
    let swarm = Swarm::random(&mut bench.rng(name), count);
    let boxes = bounds_of(&swarm);
    Box::new(move || {
        let mut broad = DynamicTree::default();
        time(|| {
            broad.insert_many(&boxes);
            broad.flush();
        })
    })
}

/// The buffers are copied before the clock starts.
fn build(triangles: usize) -> Work {
    let torus = Mesh::torus(triangles);
    Box::new(move || {
        let Mesh { vertices, triangles } = torus.clone();
        let mut shape = None;
        let time = time(|| shape = Shape::mesh(vertices, triangles).ok());
        assert!(shape.is_some(), "the mesh is well formed");
        time
    })
}

fn refit(triangles: usize) -> Work {
    let torus = Mesh::torus(triangles);
    let mut shape = torus.shape();
    let positions: [Vec<DVec3>; 2] = [0.0, 0.5].map(|t| torus.deformed(t));
    let mut order = there_and_back(positions.len());
    Box::new(move || {
        let positions = &positions[order.next().unwrap_or(0)];
        time(|| shape.deform(positions).expect("the positions are finite"))
    })
}
