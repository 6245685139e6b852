//! The simulation of I-COLLIDE, whole frames: boxes, broad phase and narrow phase.

use solid_oracle::{Convex, verdict};

use super::with_commas;
use crate::inputs::{ICollide, Pose, Settings};
use crate::peers::bench::{Entry, Unit};
use crate::peers::contestants::parry::{double, single};
use crate::peers::contestants::{Ours, Simulator, Thesis, each};
use crate::peers::{Bench, Kind, Peer};

/// Objects of a simulation, and how many of its frames are recorded; they are played there and back.
const SIZES: [(usize, usize); 3] = [(20, 200), (1_000, 20), (10_000, 6)];

/// The oracle, which tests all with all, judges so many objects at most, in so many frames.
const JUDGED_MAX: usize = 20;
const JUDGED_FRAMES: usize = 20;

/// What everyone plays: the collisions are those that the library found, so that nobody's answer changes the motion.
struct Recording {
    start: ICollide,
    frames: Vec<Vec<Pose>>,
}

/// Races, judges, and counts.
pub fn measure(bench: &mut Bench) {
    for (objects, frames) in SIZES {
        let name = format!("I-COLLIDE, {} polyhedra", with_commas(objects));
        let settings = Settings { objects: bench.effort.size(objects), ..Settings::default() };
        let start = ICollide::new(&mut bench.rng(&name), &settings);
        let recording = record(bench, &name, start, bench.effort.sample(frames));
        let entries = each!(entry: Ours, Thesis, double::Parry, single::Parry; (&recording));
        bench.race(&format!("{name}, a frame"), 2 * recording.frames.len(), Unit::Micro, entries);
        if objects <= JUDGED_MAX {
            judge(bench, &name, &recording);
        }
    }
}

/// Plays it once with the library, and counts its work.
fn record(bench: &mut Bench, name: &str, start: ICollide, count: usize) -> Recording {
    let mut simulation = start.clone();
    let mut world = Ours::world(&simulation);
    let mut frames = Vec::new();
    for _ in 0..count {
        let poses = simulation.poses();
        let found = Ours::frame(&mut world, &poses.iter().map(Pose::affine).collect::<Vec<_>>());
        simulation.step(found.iter().map(|(a, b)| (*a as usize, *b as usize)));
        frames.push(poses);
    }
    let done = world.world().statistics();
    let counts = [
        ("candidates", done.candidates),
        ("cache hits", done.cache_hits),
        ("tests of two shapes", done.primitive_tests),
        ("collisions", done.collisions),
    ];
    for (what, total) in counts {
        let per_frame = total as f64 / count as f64;
        bench.figures(&format!("{name}: {what} a frame"), Kind::Count, "pairs", &[(Peer::Ours, per_frame)]);
    }
    Recording { start, frames }
}

fn entry<S: Simulator>(recording: &Recording) -> Entry {
    let mut world = S::world(&recording.start);
    let frames: Vec<Vec<S::Pose>> =
        recording.frames.iter().map(|poses| poses.iter().map(S::pose).collect()).collect();
    Entry::new(S::PEER, move || {
        frames.iter().chain(frames.iter().rev()).map(|poses| S::frame(&mut world, poses).len()).sum()
    })
}

/// Compares the pairs that collide with the oracle's.
fn judge(bench: &mut Bench, name: &str, recording: &Recording) {
    let frames: Vec<&Vec<Pose>> = recording.frames.iter().take(JUDGED_FRAMES).collect();
    let truths: Vec<Vec<(u32, u32)>> =
        frames.iter().map(|poses| colliding(&recording.start, poses)).collect();
    let wrong = each!(wrong: Ours, Thesis, double::Parry, single::Parry; (recording, &truths));
    let total: usize = truths.iter().map(Vec::len).sum();
    bench.figures(&format!("{name}, collisions lost or invented of {total}"), Kind::Wrong, "wrong", &wrong);
}

/// All pairs that the oracle says have a point in common.
fn colliding(simulation: &ICollide, poses: &[Pose]) -> Vec<(u32, u32)> {
    let hull = |i: usize| Convex::Hull { points: simulation.shape_of(i).vertices.clone() };
    let meet = |i: usize, j: usize| {
        let near = poses[i].translation.distance(poses[j].translation) <= 2.0;
        near && verdict(&hull(i), &poses[i].affine(), &hull(j), &poses[j].affine()).shares_point()
            != Some(false)
    };
    let pairs = (0..poses.len()).flat_map(|i| (i + 1..poses.len()).map(move |j| (i, j)));
    pairs.filter(|&(i, j)| meet(i, j)).map(|(i, j)| (i as u32, j as u32)).collect()
}

fn wrong<S: Simulator>(recording: &Recording, truths: &[Vec<(u32, u32)>]) -> (Peer, f64) {
    let mut world = S::world(&recording.start);
    let mut wrong = 0;
    for (poses, truth) in recording.frames.iter().zip(truths) {
        let found = S::frame(&mut world, &poses.iter().map(S::pose).collect::<Vec<_>>());
        wrong += truth.iter().filter(|pair| !found.contains(pair)).count();
        wrong += found.iter().filter(|pair| !truth.contains(pair)).count();
    }
    (S::PEER, wrong as f64)
}
