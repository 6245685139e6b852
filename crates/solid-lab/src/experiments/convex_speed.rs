//! Figures 4.8, 4.9 and 4.10: convex tests in the multi-body simulation of I-COLLIDE, under variations of density, translational and
//! rotational velocity.

use std::collections::HashMap;
use std::hint::black_box;

use anyhow::Result;
use serde::Serialize;
use solid3d::Aabb;
use solid3d::glam::DAffine3;

use super::chart::{Labels, lines};
use super::clock::seconds;
use super::output::write_csv;
use super::random::stream;
use super::{Claim, Kind, Report, Settings};
use crate::comparators::broad::{BroadTest, LinkedSweep};
use crate::comparators::convex::{
    ChungWang, ConvexTest, EnhancedGjk, IsaGjk, Library, LinCanny, Memory, Pair, Polytope, SignedVolumes,
};
use crate::inputs::{self, ICollide};

/// The frames of the thesis.
const FRAMES: usize = 50_000;

/// Frames that are kept at a time, to measure every test on the same ones.
const BATCH: usize = 500;

/// What is varied in a figure.
struct Figure {
    number: &'static str,
    file: &'static str,
    title: &'static str,
    x: &'static str,
    values: [f64; 6],
    set: fn(&mut inputs::Settings, f64),
}

/// The thesis's defaults are 5 % of the space, 5 % of the radius and 10 degrees; its figures are not in its text, so the ranges are
/// ours.
const FIGURES: [Figure; 3] = [
    Figure {
        number: "4.8",
        file: "convex-density",
        title: "Density",
        x: "% of the space filled",
        values: [1.0, 2.5, 5.0, 7.5, 10.0, 15.0],
        set: |settings, x| settings.density = x / 100.0,
    },
    Figure {
        number: "4.9",
        file: "convex-translation",
        title: "Translational velocity",
        x: "% of the radius a frame",
        values: [1.0, 2.5, 5.0, 10.0, 15.0, 20.0],
        set: |settings, x| settings.translation = x / 100.0,
    },
    Figure {
        number: "4.10",
        file: "convex-rotation",
        title: "Rotational velocity",
        x: "degrees a frame",
        values: [1.0, 5.0, 10.0, 20.0, 30.0, 45.0],
        set: |settings, x| settings.rotation = x,
    },
];

/// The thesis: ISA-GJK takes twice the time of Chung-Wang on average.
const THESIS_OVER_CHUNG_WANG: f64 = 2.0;

/// The thesis: ISA-GJK is roughly five times as fast as Lin-Canny.
const THESIS_LIN_CANNY_OVER: f64 = 5.0;

/// What the tests are called.
const ISA_GJK: &str = "ISA-GJK";
const CHUNG_WANG: &str = "Chung-Wang";
const LIN_CANNY: &str = "Lin-Canny (V-Clip)";

#[derive(Serialize)]
struct Row {
    figure: &'static str,
    value: f64,
    test: &'static str,
    frames: usize,
    tests_a_frame: f64,
    collisions_a_frame: f64,
    nanoseconds_a_frame: f64,
    nanoseconds_a_test: f64,
    /// Empty for a test that does not count them.
    iterations_a_test: Option<f64>,
    gave_up: u64,
    disagreements: u64,
}

/// A test with what it remembers of each pair, and its results.
struct Contender {
    test: Box<dyn ConvexTest>,
    memory: HashMap<(u32, u32), Memory>,
    seconds: f64,
    collisions: u64,
    disagreements: u64,
}

fn contenders() -> Vec<Contender> {
    let tests: [Box<dyn ConvexTest>; 6] = [
        Box::new(IsaGjk::default()),
        Box::new(EnhancedGjk::default()),
        Box::new(SignedVolumes::default()),
        Box::new(ChungWang::default()),
        Box::new(LinCanny::default()),
        Box::new(Library::default()),
    ];
    let contender =
        |test| Contender { test, memory: HashMap::new(), seconds: 0.0, collisions: 0, disagreements: 0 };
    tests.into_iter().map(contender).collect()
}

/// A frame: where the objects are, and which pairs of boxes overlap.
struct Frame {
    placements: Vec<DAffine3>,
    pairs: Vec<(u32, u32)>,
}

/// Runs it.
pub fn run(settings: &Settings) -> Result<Report> {
    let frames = settings.sample(FRAMES, 2_000);
    let (mut rows, mut claims, mut charts) = (Vec::new(), Vec::new(), Vec::new());
    for figure in &FIGURES {
        let mut of_figure = Vec::new();
        for value in figure.values {
            of_figure.extend(simulate(settings, figure, value, frames));
        }
        let file = format!("{}.svg", figure.file);
        let title = format!("Figure {}: {}", figure.number, figure.title.to_lowercase());
        let mut names: Vec<&str> = Vec::new();
        for row in &of_figure {
            if !names.contains(&row.test) {
                names.push(row.test);
            }
        }
        let series: Vec<_> = names
            .iter()
            .map(|name| {
                let of = of_figure.iter().filter(|row| row.test == *name);
                ((*name).to_owned(), of.map(|row| (row.value, row.nanoseconds_a_frame)).collect())
            })
            .collect();
        lines(
            settings,
            &file,
            &Labels { title: &title, x: figure.x, y: "ns a frame, narrow phase" },
            &series,
        )?;
        let total = |name: &str, of: fn(&Row) -> f64| {
            of_figure.iter().filter(|row| row.test == name).map(of).sum::<f64>()
        };
        for (over, under, thesis) in
            [(ISA_GJK, CHUNG_WANG, THESIS_OVER_CHUNG_WANG), (LIN_CANNY, ISA_GJK, THESIS_LIN_CANNY_OVER)]
        {
            claims.push(Claim {
                what: format!("Figure {}: time of {over}, of that of {under}", figure.number),
                thesis,
                ours: total(over, |r| r.nanoseconds_a_frame) / total(under, |r| r.nanoseconds_a_frame),
                unit: "",
                kind: Kind::Time,
            });
        }
        // The thesis: ISA-GJK and Chung-Wang consistently return the same collisions, Lin-Canny occasionally misses one.
        for (name, kind) in [(CHUNG_WANG, Kind::Count { error: 0.0 }), (LIN_CANNY, Kind::Model)] {
            claims.push(Claim {
                what: format!(
                    "Figure {}: answers of {name} that differ from those of {ISA_GJK}",
                    figure.number
                ),
                thesis: if name == CHUNG_WANG { 0.0 } else { f64::NAN },
                ours: total(name, |r| r.disagreements as f64),
                unit: "",
                kind,
            });
        }
        charts.push((file, title));
        rows.extend(of_figure);
    }
    write_csv(settings, "convex-speed", &rows)?;
    Ok(Report { claims, charts })
}

fn simulate(settings: &Settings, figure: &Figure, value: f64, frames: usize) -> Vec<Row> {
    let mut rng = stream(settings.seed, &format!("figure {} at {value}", figure.number));
    let mut of_simulation = inputs::Settings::default();
    (figure.set)(&mut of_simulation, value);
    let mut simulation = ICollide::new(&mut rng, &of_simulation);
    let shape = |i: usize| Polytope::hull_of(&simulation.shape_of(i).vertices).expect("there are vertices");
    let shapes: Vec<Polytope> = (0..of_simulation.objects).map(shape).collect();
    let mut contenders = contenders();
    // The motion is led by ISA-GJK, as its answers are right: see its test.
    let (mut leader, mut memory) = (IsaGjk::default(), HashMap::new());
    let mut sweep: Option<LinkedSweep> = None;
    let mut done = 0;
    while done < frames {
        let batch = BATCH.min(frames - done);
        let frames: Vec<Frame> = (0..batch)
            .map(|_| {
                let frame = frame(&simulation, &shapes, &mut sweep);
                let colliding: Vec<(usize, usize)> = frame
                    .pairs
                    .iter()
                    .filter(|&&(i, j)| {
                        leader.intersects(&frame.pair(&shapes, (i, j)), memory.entry((i, j)).or_default())
                    })
                    .map(|&(i, j)| (i as usize, j as usize))
                    .collect();
                simulation.step(colliding);
                frame
            })
            .collect();
        let mut expected: Option<Vec<bool>> = None;
        for contender in &mut contenders {
            let (seconds, found) = seconds(|| contender.examine(&frames, &shapes));
            contender.seconds += seconds;
            contender.collisions += found.iter().filter(|&&hit| hit).count() as u64;
            let expected = expected.get_or_insert_with(|| found.clone());
            contender.disagreements += expected.iter().zip(&found).filter(|(x, y)| x != y).count() as u64;
        }
        done += batch;
    }
    contenders
        .iter()
        .map(|Contender { test, seconds, collisions, disagreements, .. }| {
            let counters = test.counters();
            let a_frame = |x: f64| x / frames as f64;
            Row {
                figure: figure.number,
                value,
                test: test.name(),
                frames,
                tests_a_frame: a_frame(counters.tests as f64),
                collisions_a_frame: a_frame(*collisions as f64),
                nanoseconds_a_frame: a_frame(seconds * 1e9),
                nanoseconds_a_test: seconds * 1e9 / counters.tests as f64,
                iterations_a_test: (counters.iterations > 0).then(|| counters.iterations_per_test()),
                gave_up: counters.gave_up,
                disagreements: *disagreements,
            }
        })
        .collect()
}

impl Contender {
    fn examine(&mut self, frames: &[Frame], shapes: &[Polytope]) -> Vec<bool> {
        let mut found = Vec::new();
        for frame in frames {
            for &pair in &frame.pairs {
                let memory = self.memory.entry(pair).or_default();
                found.push(black_box(self.test.intersects(&frame.pair(shapes, pair), memory)));
            }
        }
        found
    }
}

impl Frame {
    fn pair<'a>(&'a self, shapes: &'a [Polytope], (i, j): (u32, u32)) -> Pair<'a> {
        let (i, j) = (i as usize, j as usize);
        Pair {
            a: &shapes[i],
            placement_a: &self.placements[i],
            b: &shapes[j],
            placement_b: &self.placements[j],
        }
    }
}

fn frame(simulation: &ICollide, shapes: &[Polytope], sweep: &mut Option<LinkedSweep>) -> Frame {
    let placements: Vec<DAffine3> = simulation.poses().iter().map(inputs::Pose::affine).collect();
    let bounds: Vec<Aabb> = shapes
        .iter()
        .zip(&placements)
        .map(|(shape, placement)| {
            Aabb::of_points(shape.vertices().iter().map(|p| placement.transform_point3(*p)))
        })
        .collect();
    let sweep = sweep.get_or_insert_with(|| LinkedSweep::new(&bounds));
    let moved: Vec<(u32, Aabb)> = (0..).zip(bounds).collect();
    sweep.update(&moved);
    Frame { placements, pairs: sweep.pairs() }
}
