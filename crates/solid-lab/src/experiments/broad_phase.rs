//! Section 5.2.2: sweeping by inserting each end that moved, against sorting all ends in each frame, and against cells of space
//! (section 5.1), for boxes of one size and of many.

use anyhow::Result;
use serde::Serialize;
use solid3d::Aabb;

use super::chart::{Labels, Series, lines};
use super::clock::seconds;
use super::output::write_csv;
use super::random::stream;
use super::{Claim, Kind, Report, Settings};
use crate::comparators::broad::{Baraff, BroadTest, Cut, FieldTree, LinkedSweep, SpaceTree, VoxelGrid};
use crate::inputs::Swarm;

/// Shares of the boxes that move in a frame, in percent.
const MOVING: [f64; 5] = [1.0, 10.0, 25.0, 50.0, 100.0];

/// The sides of the boxes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
enum Sizes {
    /// All 1.
    #[serde(rename = "one size")]
    One,
    /// One in [`LARGE_EVERY`] is [`LARGE`], the others [`SMALL`].
    #[serde(rename = "two sizes")]
    Two,
}

/// One box in so many is large, where there are two sizes.
const LARGE_EVERY: usize = 50;

/// The side of a large box.
const LARGE: f64 = 4.0;

/// The side of a small one.
const SMALL: f64 = 0.125;

impl Sizes {
    fn of(self, box_number: usize) -> f64 {
        match self {
            Sizes::One => 1.0,
            Sizes::Two if box_number.is_multiple_of(LARGE_EVERY) => LARGE,
            Sizes::Two => SMALL,
        }
    }
}

#[derive(Serialize)]
struct Row {
    engine: &'static str,
    sizes: Sizes,
    boxes: usize,
    moving_percent: f64,
    frames: usize,
    pairs_a_frame: f64,
    steps_a_frame: f64,
    /// Of engines that look for pairs anew in each frame.
    box_tests_a_frame: f64,
    microseconds_a_frame: f64,
}

/// Runs it.
pub fn run(settings: &Settings) -> Result<Report> {
    let (count, frames) = (settings.sample(2_000, 500), settings.sample(60, 20));
    let mut rows = Vec::new();
    for sizes in [Sizes::One, Sizes::Two] {
        for moving in MOVING {
            rows.extend(measure(settings, sizes, count, frames, moving));
        }
    }
    write_csv(settings, "broad-phase", &rows)?;
    let mut names: Vec<&str> = Vec::new();
    for row in &rows {
        if !names.contains(&row.engine) {
            names.push(row.engine);
        }
    }
    let mut charts = Vec::new();
    for (sizes, file, of_what) in [
        (Sizes::One, "broad-phase.svg", "boxes"),
        (Sizes::Two, "broad-phase-sizes.svg", "boxes of two sizes"),
    ] {
        let of = |name: &&str| -> Series {
            let points = rows.iter().filter(|row| row.engine == *name && row.sizes == sizes);
            let points = points.map(|row| (row.moving_percent, row.microseconds_a_frame));
            ((*name).to_owned(), points.collect())
        };
        let series: Vec<Series> = names.iter().map(of).collect();
        let title = format!("Keeping the pairs of {count} {of_what}");
        lines(settings, file, &Labels { title: &title, x: "% moving", y: "microseconds a frame" }, &series)?;
        charts.push((file.to_owned(), title));
    }
    let row = |engine: &str, sizes: Sizes, moving: f64| {
        let same = |row: &&Row| (row.engine, row.sizes, row.moving_percent) == (engine, sizes, moving);
        rows.iter().find(same).expect("every engine is measured at every share")
    };
    let sweep = LinkedSweep::new(&[]).name();
    // The thesis: time linear in the number of moving boxes.
    let mut claims = vec![Claim {
        what: "swaps of the incremental sweep with all boxes moving, of those with a tenth".to_owned(),
        thesis: 10.0,
        ours: row(sweep, Sizes::One, 100.0).steps_a_frame / row(sweep, Sizes::One, 10.0).steps_a_frame,
        unit: "times",
        kind: Kind::Model,
    }];
    // The thesis, without figures: the grid lists boxes in many cells, the trees keep small boxes near the root, the fieldtree does neither.
    let fieldtree = FieldTree::new(&[]).name();
    for sizes in [Sizes::One, Sizes::Two] {
        for engine in names.iter().filter(|name| **name != fieldtree) {
            let [tests, of] = [engine, fieldtree].map(|name| row(name, sizes, 100.0).box_tests_a_frame);
            if tests > 0.0 {
                let said = if sizes == Sizes::One { "one size" } else { "two sizes" };
                claims.push(Claim {
                    what: format!("{said}: box tests of the {engine}, of those of the {fieldtree}"),
                    thesis: f64::NAN,
                    ours: tests / of,
                    unit: "times",
                    kind: Kind::Model,
                });
            }
        }
    }
    Ok(Report { claims, charts })
}

fn measure(settings: &Settings, sizes: Sizes, count: usize, frames: usize, moving: f64) -> Vec<Row> {
    let mut swarm = Swarm::random(&mut stream(settings.seed, "broad phase"), count);
    let sized = |i: usize, unit: Aabb| {
        let half = 0.5 * sizes.of(i);
        Aabb::new(unit.center() - half, unit.center() + half)
    };
    let bounds = |swarm: &Swarm| -> Vec<Aabb> { (0..count).map(|i| sized(i, swarm.bounds(i))).collect() };
    let mut current = bounds(&swarm);
    let mut engines: [(Box<dyn BroadTest>, f64, u64); 6] = [
        (Box::new(LinkedSweep::new(&current)), 0.0, 0),
        (Box::new(Baraff::new(&current)), 0.0, 0),
        (Box::new(VoxelGrid::new(&current)), 0.0, 0),
        (Box::new(SpaceTree::new(&current, Cut::Octree)), 0.0, 0),
        (Box::new(SpaceTree::new(&current, Cut::KdTree)), 0.0, 0),
        (Box::new(FieldTree::new(&current)), 0.0, 0),
    ];
    let before: Vec<[u64; 2]> =
        engines.iter().map(|(engine, ..)| [engine.steps(), engine.box_tests()]).collect();
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
            sizes,
            boxes: count,
            moving_percent: moving,
            frames,
            pairs_a_frame: a_frame(*pairs as f64),
            steps_a_frame: a_frame((engine.steps() - before[0]) as f64),
            box_tests_a_frame: a_frame((engine.box_tests() - before[1]) as f64),
            microseconds_a_frame: a_frame(time * 1e6),
        })
        .collect()
}
