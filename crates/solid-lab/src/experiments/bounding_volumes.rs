//! Tables 5.2 and 5.3: how often bounding volumes of two tori overlap, and what a test costs on average with them in front.

use anyhow::Result;
use serde::Serialize;
use solid3d::glam::{DAffine3, DVec3, dvec3};

use super::chart::{Labels, bars};
use super::models::{MAJOR, MINOR};
use super::output::write_csv;
use super::random::{placement, stream};
use super::report::percentage;
use super::{Claim, Kind, Report, Settings};
use crate::comparators::tree::{AlignedBox, Sat, Volume};

/// Runs of the thesis.
const RUNS: usize = 100_000;

/// Operations of the overlap tests (Table 5.1), and of one with the boxes to compute (section 5.2.1).
const SPHERE: f64 = 11.0;
const FIXED_BOX: f64 = 9.0;
const DYNAMIC_BOX: f64 = 57.0;
const ORIENTED_BOX: f64 = 200.0;

/// Operations of the test of the tori themselves, which the thesis assumes.
const TORUS: f64 = 10_000.0;

/// A sequence of tests, and what the thesis found for it in cubes of two sizes: how often the first volumes overlap, how often all
/// do, in percent, and the average cost.
struct Sequence {
    name: &'static str,
    first: fn(&Overlaps) -> bool,
    first_cost: f64,
    /// Whether oriented boxes come second.
    then_oriented: bool,
    thesis: [[f64; 3]; 2],
}

/// The sides of the cubes.
const CUBES: [f64; 2] = [100.0, 20.0];

const SEQUENCES: [Sequence; 5] = [
    Sequence {
        name: "sphere",
        first: |o| o.sphere,
        first_cost: SPHERE,
        then_oriented: false,
        thesis: [[4.6, 4.6, 471.0], [98.7, 98.7, 9881.0]],
    },
    Sequence {
        name: "OBB",
        first: |o| o.oriented,
        first_cost: ORIENTED_BOX,
        then_oriented: false,
        thesis: [[4.1, 4.1, 610.0], [86.9, 86.9, 8890.0]],
    },
    Sequence {
        name: "dynamic AABB, OBB",
        first: |o| o.dynamic,
        first_cost: DYNAMIC_BOX,
        then_oriented: true,
        thesis: [[9.1, 4.1, 485.0], [99.0, 86.9, 8945.0]],
    },
    Sequence {
        name: "fixed AABB, OBB",
        first: |o| o.fixed,
        first_cost: FIXED_BOX,
        then_oriented: true,
        thesis: [[7.8, 3.9, 415.0], [100.0, 86.9, 8899.0]],
    },
    Sequence {
        name: "sphere, OBB",
        first: |o| o.sphere,
        first_cost: SPHERE,
        then_oriented: true,
        thesis: [[4.6, 3.4, 360.0], [98.7, 86.5, 8858.0]],
    },
];

#[derive(Serialize)]
struct Row {
    volumes: &'static str,
    cube: f64,
    first_overlap_percent: f64,
    all_overlap_percent: f64,
    average_operations: f64,
    thesis_average_operations: f64,
}

/// Which volumes of a pair overlap.
struct Overlaps {
    sphere: bool,
    oriented: bool,
    dynamic: bool,
    fixed: bool,
}

impl Overlaps {
    fn of(a: &DAffine3, b: &DAffine3) -> Self {
        let reach = MAJOR + MINOR;
        let half = dvec3(reach, reach, MINOR);
        let between = b.translation - a.translation;
        let boxed = AlignedBox { center: DVec3::ZERO, half };
        let shared = AlignedBox::shared(&(a.inverse() * *b));
        let around = |m: &DAffine3| m.matrix3.abs() * half;
        Overlaps {
            sphere: between.length() <= 2.0 * reach,
            oriented: AlignedBox::exit_axis(&boxed, &boxed, &shared, &(), Sat::Full) == 0,
            dynamic: between.abs().cmple(around(a) + around(b)).all(),
            fixed: between.abs().max_element() <= 2.0 * reach,
        }
    }
}

/// Runs it.
pub fn run(settings: &Settings) -> Result<Report> {
    let count = settings.sample(RUNS, 10_000);
    let (mut rows, mut claims) = (Vec::new(), Vec::new());
    for (k, cube) in CUBES.into_iter().enumerate() {
        let mut rng = stream(settings.seed, &format!("bounding volumes {cube}"));
        let overlaps: Vec<Overlaps> = (0..count)
            .map(|_| Overlaps::of(&placement(&mut rng, cube), &placement(&mut rng, cube)))
            .collect();
        for sequence in &SEQUENCES {
            let first = overlaps.iter().filter(|o| (sequence.first)(o)).count() as u64;
            let both = overlaps
                .iter()
                .filter(|o| (sequence.first)(o) && (!sequence.then_oriented || o.oriented))
                .count();
            let (first_percent, first_error) = percentage(first, count, RUNS);
            let (all_percent, all_error) = percentage(both as u64, count, RUNS);
            let second_cost = if sequence.then_oriented { ORIENTED_BOX } else { 0.0 };
            let average =
                sequence.first_cost + first_percent / 100.0 * second_cost + all_percent / 100.0 * TORUS;
            let average_error = (first_error * second_cost + all_error * TORUS) / 100.0;
            let [thesis_first, thesis_all, thesis_average] = sequence.thesis[k];
            // The thesis rounds percentages to tenths, and costs to ones.
            let claim = |what: &str, thesis, ours, unit, error| Claim {
                what: format!("{} in a cube of {cube}: {what}", sequence.name),
                thesis,
                ours,
                unit,
                kind: Kind::Count { error },
            };
            claims.push(claim("first overlap", thesis_first, first_percent, "%", first_error + 0.05));
            if sequence.then_oriented {
                claims.push(claim("both overlap", thesis_all, all_percent, "%", all_error + 0.05));
            }
            claims.push(claim("average cost", thesis_average, average, "", average_error + 0.5));
            rows.push(Row {
                volumes: sequence.name,
                cube,
                first_overlap_percent: first_percent,
                all_overlap_percent: all_percent,
                average_operations: average,
                thesis_average_operations: thesis_average,
            });
        }
    }
    write_csv(settings, "bounding-volumes", &rows)?;
    let groups: Vec<String> = SEQUENCES.iter().map(|s| s.name.to_owned()).collect();
    let mut charts = Vec::new();
    for cube in CUBES {
        let file = format!("bounding-volumes-{cube}.svg");
        let of = |value: fn(&Row) -> f64| rows.iter().filter(|row| row.cube == cube).map(value).collect();
        let series = [
            ("thesis".to_owned(), of(|r| r.thesis_average_operations)),
            ("here".to_owned(), of(|r| r.average_operations)),
        ];
        let title = format!("Average cost of testing two tori, centres in a cube of {cube}");
        bars(settings, &file, &Labels { title: &title, x: "", y: "operations" }, &groups, &series)?;
        charts.push((file, title));
    }
    Ok(Report { claims, charts })
}
