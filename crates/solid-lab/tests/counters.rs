//! The work that a fixed set of scenes takes, in counts that repeat exactly: a change that makes the library visit more fails here,
//! with the figures, and without timing anything.
//!
//! The counts expected are in `counters.json`. After a change that is meant, `SOLID_LAB_COUNTERS=write cargo test -p solid-lab
//! --test counters` writes them anew, and the diff shows what it does.
#![allow(clippy::print_stdout, reason = "a seed is printed")]

use std::collections::BTreeMap;
use std::path::Path;

use solid_lab::inputs::{
    ICollide, Mesh, PairPose, Polyhedron, Pose, SEED, Settings, Swarm, direction, pairs_at_overlap, seeded,
};
use solid_lab::peers::{Ours, Simulator};
use solid3d::broad::{BroadPhase, DynamicTree, SweepAndPrune};
use solid3d::{Response, Shape, World, WorldOptions, query};

/// The counts of a scene by name.
type Counts = BTreeMap<String, BTreeMap<&'static str, u64>>;

const EXPECTED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/counters.json");

fn statistics(world: &World) -> BTreeMap<&'static str, u64> {
    let done = world.statistics();
    [
        ("candidates", done.candidates),
        ("cache hits", done.cache_hits),
        ("box tests", done.box_tests),
        ("primitive tests", done.primitive_tests),
        ("collisions", done.collisions),
    ]
    .into()
}

/// Two shapes in a world without caching, at each of the poses.
fn pairs(a: &Shape, b: &Shape, poses: &[PairPose]) -> BTreeMap<&'static str, u64> {
    let options =
        WorldOptions { default_response: Response::Simple, caching: false, ..WorldOptions::default() };
    let mut world = World::with_options(&options);
    let ids = [a, b].map(|shape| world.add(shape, Pose::IDENTITY.affine()).expect("the pose is valid"));
    for pair in poses {
        for (id, pose) in ids.iter().zip(pair) {
            world.set_placement(*id, pose.affine()).expect("the pose is valid");
        }
        world.test();
    }
    statistics(&world)
}

fn at_overlap(seed: u64, count: usize, a: &Shape, b: &Shape) -> Vec<PairPose> {
    pairs_at_overlap(&mut seeded(seed), count, 0.5, 20.0, |_, pair| {
        query::intersects(a, &pair[0].affine(), b, &pair[1].affine()).expect("the poses are valid")
    })
}

fn meshes(counts: &mut Counts) {
    let torus = Mesh::torus(5_000).shape();
    let poses = at_overlap(SEED, 100, &torus, &torus);
    counts.insert("two tori, first hit".into(), pairs(&torus, &torus, &poses));
    let apart: Vec<f64> = poses
        .iter()
        .map(|pair| {
            query::distance(&torus, &pair[0].affine(), &torus, &pair[1].affine())
                .expect("the poses are valid")
                .distance
        })
        .collect();
    assert!(
        (30..=70).contains(&apart.iter().filter(|distance| **distance > 0.0).count()),
        "not representative"
    );

    let mut rng = seeded(SEED);
    let terrain = Mesh::terrain(&mut rng, 20_000);
    let hull = Polyhedron::random(&mut rng, 40).scaled(0.05).shape();
    let poses: Vec<PairPose> = (0..100)
        .map(|i| {
            let vertex = terrain.vertices[(i * 7919) % terrain.vertices.len()];
            [Pose::IDENTITY, Pose { translation: vertex + direction(&mut rng) * 0.1, ..Pose::IDENTITY }]
        })
        .collect();
    counts.insert("terrain and hull".into(), pairs(&terrain.shape(), &hull, &poses));
}

fn simulations(counts: &mut Counts) {
    for objects in [20, 500] {
        let settings = Settings { objects, ..Settings::default() };
        let mut simulation = ICollide::new(&mut seeded(SEED), &settings);
        let mut world = Ours::world(&simulation);
        for _ in 0..4_000 / objects {
            let poses: Vec<_> = simulation.poses().iter().map(Pose::affine).collect();
            let found = Ours::frame(&mut world, &poses);
            simulation.step(found.iter().map(|(a, b)| (*a as usize, *b as usize)));
        }
        counts.insert(format!("I-COLLIDE, {objects} polyhedra"), statistics(world.world()));
    }
}

fn swarms(counts: &mut Counts) {
    for (name, movers) in [("1 %", 50), ("100 %", 5_000)] {
        let engines: [Box<dyn BroadPhase>; 2] =
            [Box::<DynamicTree>::default(), Box::<SweepAndPrune>::default()];
        for (engine, mut broad) in ["dynamic tree", "sweep and prune"].into_iter().zip(engines) {
            let mut swarm = Swarm::random(&mut seeded(SEED), 5_000);
            (0..swarm.count()).for_each(|i| broad.insert(i as u32, swarm.bounds(i)));
            broad.flush();
            for _ in 0..20 {
                swarm.step(movers);
                (0..movers).for_each(|i| broad.update(i as u32, swarm.bounds(i)));
                broad.flush();
            }
            let done = broad.counters();
            let figures = [
                ("swaps", done.swaps),
                ("sweeps", done.sweeps),
                ("reinsertions", done.reinsertions),
                ("node visits", done.node_visits),
                ("rebuilds", done.rebuilds),
                ("pairs", broad.sorted_pairs().len() as u64),
            ];
            counts.insert(format!("{engine}, {name} moving"), figures.into());
        }
    }
}

#[test]
fn the_work_of_fixed_scenes_is_as_expected() {
    println!("seed {SEED}");
    let mut counts = Counts::new();
    meshes(&mut counts);
    simulations(&mut counts);
    swarms(&mut counts);

    let found = serde_json::to_string_pretty(&counts).expect("counts have a form in JSON") + "\n";
    if std::env::var_os("SOLID_LAB_COUNTERS").is_some_and(|value| value == "write") {
        std::fs::write(EXPECTED, &found).expect("the file can be written");
    }
    let expected = std::fs::read_to_string(Path::new(EXPECTED)).expect("the file can be read");
    let expected: BTreeMap<String, BTreeMap<String, u64>> =
        serde_json::from_str(&expected).expect("the file is well formed");
    let mut differences = String::new();
    for (scene, figures) in &counts {
        for (what, &figure) in figures {
            let before = expected.get(scene).and_then(|figures| figures.get(*what)).copied();
            if before != Some(figure) {
                let before = before.map_or("nothing".to_owned(), |figure| figure.to_string());
                differences += &format!("\n{scene}: {what}: {figure}, expected {before}");
            }
        }
    }
    assert!(expected.keys().all(|scene| counts.contains_key(scene)), "a scene expected is no longer there");
    assert!(
        differences.is_empty(),
        "the work has changed; if that is meant, SOLID_LAB_COUNTERS=write makes it what is expected:{differences}"
    );
}
