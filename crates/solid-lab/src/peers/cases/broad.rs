//! Many boxes, of which some move.

use solid3d::Aabb;
use solid3d::broad::DynamicTree;

use super::with_commas;
use crate::comparators::broad::LinkedSweep;
use crate::inputs::Swarm;
use crate::peers::bench::{Entry, Unit};
use crate::peers::contestants::parry::{double, single};
use crate::peers::contestants::{Boxes, each};
use crate::peers::{Bench, Kind, Peer};

/// Frames there, of a full and of a quick run; then they are played backwards, so that the motion has no jump.
const FRAMES: [usize; 2] = [4, 2];

/// More boxes times movers than this take the sweep and prune of the thesis minutes.
const SWEPT_MAX: f64 = 1e10;

/// The oracle, which tests all with all, judges so many boxes at most.
const JUDGED_MAX: usize = 10_000;

/// Boxes that move, and the boxes of the movers in each frame.
struct Scene {
    start: Vec<Aabb>,
    frames: Vec<Vec<(u32, Aabb)>>,
}

/// Races, then judges what pairs are found after the last frame.
pub fn measure(bench: &mut Bench) {
    for count in [1_000, 10_000, 100_000, 1_000_000] {
        if count == 1_000_000 && !bench.effort.large() {
            continue;
        }
        for percent in [1, 10, 100] {
            let work = format!("broad phase of {} boxes, {percent} % moving", with_commas(count));
            let scene = scene(bench, &work, bench.effort.size(count), percent);
            let mut entries = each!(entry: DynamicTree, double::Swarm, single::Swarm; (&scene));
            if (count * count * percent / 100) as f64 <= SWEPT_MAX {
                entries.insert(1, entry::<LinkedSweep>(&scene));
            }
            bench.race(&format!("{work}, a frame"), scene.frames.len(), Unit::Micro, entries);
            if count <= JUDGED_MAX && percent == 100 {
                judge(bench, &work, &scene);
            }
        }
    }
}

fn scene(bench: &Bench, name: &str, count: usize, percent: usize) -> Scene {
    let mut swarm = Swarm::random(&mut bench.rng(name), count);
    let movers = (count * percent / 100).max(1);
    let start = (0..count).map(|i| swarm.bounds(i)).collect();
    let mut frames: Vec<Vec<(u32, Aabb)>> = Vec::new();
    let there = FRAMES[usize::from(!bench.effort.large())];
    for _ in 0..there {
        swarm.step(movers);
        frames.push((0..movers).map(|i| (i as u32, swarm.bounds(i))).collect());
    }
    frames.extend_from_within(..there - 1);
    frames[there..].reverse();
    Scene { start, frames }
}

/// The boxes of the movers in each frame, in a library's own types.
type Frames<B> = Vec<Vec<(u32, <B as Boxes>::Bounds)>>;

fn converted<B: Boxes>(scene: &Scene) -> (B, Frames<B>) {
    let start: Vec<B::Bounds> = scene.start.iter().map(B::bounds).collect();
    let frame = |frame: &Vec<(u32, Aabb)>| frame.iter().map(|(i, bounds)| (*i, B::bounds(bounds))).collect();
    (B::new(&start), scene.frames.iter().map(frame).collect())
}

fn entry<B: Boxes>(scene: &Scene) -> Entry {
    let (mut boxes, frames) = converted::<B>(scene);
    Entry::new(B::PEER, move || {
        frames.iter().for_each(|moved| boxes.frame(moved));
        frames.len()
    })
}

/// A count that is not that of all overlapping boxes is wrong by the difference.
fn judge(bench: &mut Bench, work: &str, scene: &Scene) {
    let mut boxes = scene.start.clone();
    for (i, bounds) in scene.frames.last().into_iter().flatten() {
        boxes[*i as usize] = *bounds;
    }
    let overlaps = |i: usize| boxes[..i].iter().filter(|other| boxes[i].overlaps(other)).count();
    let truth: usize = (0..boxes.len()).map(overlaps).sum();
    let wrong = each!(wrong: DynamicTree, LinkedSweep, double::Swarm, single::Swarm; (scene, truth));
    bench.figures(
        &format!("{work}, pairs lost or invented of {}", with_commas(truth)),
        Kind::Wrong,
        "wrong",
        &wrong,
    );
}

fn wrong<B: Boxes>(scene: &Scene, truth: usize) -> (Peer, f64) {
    let (mut boxes, frames) = converted::<B>(scene);
    frames.iter().for_each(|moved| boxes.frame(moved));
    (B::PEER, boxes.pair_count().abs_diff(truth) as f64)
}
