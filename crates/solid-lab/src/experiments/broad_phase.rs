//! Section 5.2.2: sweeping by inserting each end that moved, against sorting all ends in each frame, and against cells of space.

use anyhow::Result;
use serde::Serialize;
use solid3d::Aabb;

use super::chart::{Labels, lines};
use super::clock::seconds;
use super::output::write_csv;
use super::random::stream;
use super::{Claim, Kind, Report, Settings};
use crate::comparators::broad::{Baraff, BroadTest, Cut, LinkedSweep, SpaceTree, VoxelGrid};
use crate::inputs::Swarm;

/// Shares of the boxes that move in a frame, in percent.
const MOVING: [f64; 5] = [1.0, 10.0, 25.0, 50.0, 100.0];

#[derive(Serialize)]
struct Row {
    engine: &'static str,
    boxes: usize,
    moving_percent: f64,
    frames: usize,
    pairs_a_frame: f64,
    steps_a_frame: f64,
    microseconds_a_frame: f64,
}

/// Runs it.
pub fn run(settings: &Settings) -> Result<Report> {
    let (count, frames) = (settings.sample(2_000, 500), settings.sample(60, 20));
    let mut rows = Vec::new();
    for moving in MOVING {
        rows.extend(measure(settings, count, frames, moving));
    }
    write_csv(settings, "broad-phase", &rows)?;
    let mut names: Vec<&str> = Vec::new();
    for row in &rows {
        if !names.contains(&row.engine) {
            names.push(row.engine);
        }
    }
    let of = |name: &str| {
        let points = rows.iter().filter(|row| row.engine == name);
        (name.to_owned(), points.map(|row| (row.moving_percent, row.microseconds_a_frame)).collect())
    };
    let series: Vec<_> = names.iter().map(|name| of(name)).collect();
    let title = format!("Keeping the pairs of {count} boxes");
    lines(
        settings,
        "broad-phase.svg",
        &Labels { title: &title, x: "% moving", y: "microseconds a frame" },
        &series,
    )?;
    let swaps = |engine: &str, moving: f64| {
        let row = rows.iter().find(|row| row.engine == engine && row.moving_percent == moving);
        row.expect("every engine is measured at every share").steps_a_frame
    };
    let sweep = LinkedSweep::new(&[]).name();
    // The thesis: time linear in the number of moving boxes.
    let claims = vec![Claim {
        what: "swaps of the incremental sweep with all boxes moving, of those with a tenth".to_owned(),
        thesis: 10.0,
        ours: swaps(sweep, 100.0) / swaps(sweep, 10.0),
        unit: "times",
        kind: Kind::Model,
    }];
    Ok(Report { claims, charts: vec![("broad-phase.svg".to_owned(), title)] })
}

fn measure(settings: &Settings, count: usize, frames: usize, moving: f64) -> Vec<Row> {
    let mut swarm = Swarm::random(&mut stream(settings.seed, "broad phase"), count);
    let bounds = |swarm: &Swarm| -> Vec<Aabb> { (0..count).map(|i| swarm.bounds(i)).collect() };
    let mut current = bounds(&swarm);
    let mut engines: [(Box<dyn BroadTest>, f64, u64); 5] = [
        (Box::new(LinkedSweep::new(&current)), 0.0, 0),
        (Box::new(Baraff::new(&current)), 0.0, 0),
        (Box::new(VoxelGrid::new(&current)), 0.0, 0),
        (Box::new(SpaceTree::new(&current, Cut::Octree)), 0.0, 0),
        (Box::new(SpaceTree::new(&current, Cut::KdTree)), 0.0, 0),
    ];
    let before: Vec<u64> = engines.iter().map(|(engine, ..)| engine.steps()).collect();
    let movers = (count as f64 * moving / 100.0) as usize;
    for _ in 0..frames {
        swarm.step(movers);
        let next = bounds(&swarm);
        let changed = (0..count).filter(|&i| next[i] != current[i]);
        let moved: Vec<(u32, Aabb)> = changed.map(|i| (i as u32, next[i])).collect();
        for (engine, time, pairs) in &mut engines {
            let (taken, found) = seconds(|| {
                engine.update(&moved);
                engine.pairs().len() as u64
            });
            *time += taken;
            *pairs += found;
        }
        current = next;
    }
    let a_frame = |x: f64| x / frames as f64;
    engines
        .iter()
        .zip(before)
        .map(|((engine, time, pairs), before)| Row {
            engine: engine.name(),
            boxes: count,
            moving_percent: moving,
            frames,
            pairs_a_frame: a_frame(*pairs as f64),
            steps_a_frame: a_frame((engine.steps() - before) as f64),
            microseconds_a_frame: a_frame(time * 1e6),
        })
        .collect()
}
