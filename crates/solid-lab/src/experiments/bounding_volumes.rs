//! Tables 5.2 and 5.3: how often bounding volumes of two tori overlap, and what a test costs on average with them in front.

use anyhow::Result;
use serde::Serialize;
use solid3d::glam::{DAffine3, DVec3, dvec3};

use super::chart::{Labels, bars};
use super::models::{MAJOR, MINOR};
use super::output::write_csv;
use super::random::{placement, stream};
use super::report::sampling_error;
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

/// Whether the volumes of a kind overlap.
type Overlap = fn(&Overlaps) -> bool;

/// A sequence of tests, and what the thesis found for it in cubes of two sizes: how often the first volumes overlap, how often all
/// do, in percent, and the average cost.
struct Sequence {
    name: &'static str,
    /// The first volumes, if oriented boxes are not alone.
    first: Option<(Overlap, f64)>,
    /// Whether oriented boxes come at the end.
    oriented: bool,
    thesis: [[f64; 3]; 2],
}

/// The sides of the cubes.
const CUBES: [f64; 2] = [100.0, 20.0];

const SEQUENCES: [Sequence; 5] = [
    Sequence {
        name: "sphere",
        first: Some((|o| o.sphere, SPHERE)),
        oriented: false,
        thesis: [[4.6, 4.6, 471.0], [98.7, 98.7, 9881.0]],
    },
    Sequence {
        name: "OBB",
        first: None,
        oriented: true,
        thesis: [[100.0, 4.1, 610.0], [100.0, 86.9, 8890.0]],
    },
    Sequence {
        name: "dynamic AABB, OBB",
        first: Some((|o| o.dynamic, DYNAMIC_BOX)),
        oriented: true,
        thesis: [[9.1, 4.1, 485.0], [99.0, 86.9, 8945.0]],
    },
    Sequence {
        name: "fixed AABB, OBB",
        first: Some((|o| o.fixed, FIXED_BOX)),
        oriented: true,
        thesis: [[7.8, 3.9, 415.0], [100.0, 86.9, 8899.0]],
    },
    Sequence {
        name: "sphere, OBB",
        first: Some((|o| o.sphere, SPHERE)),
        oriented: true,
        thesis: [[4.6, 3.4, 360.0], [98.7, 86.5, 8858.0]],
    },
];

#[derive(Serialize)]
struct Row {
    volumes: &'static str,
    box_test: &'static str,
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
    /// By the lite test, which takes more boxes to overlap.
    oriented_lite: bool,
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
        let oriented = |sat| AlignedBox::exit_axis(&boxed, &boxed, &shared, &(), sat) == 0;
        let around = |m: &DAffine3| m.matrix3.abs() * half;
        Overlaps {
            sphere: between.length() <= 2.0 * reach,
            oriented: oriented(Sat::Full),
            oriented_lite: oriented(Sat::Lite),
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
            let tests: &[Sat] = if sequence.oriented { &[Sat::Full, Sat::Lite] } else { &[Sat::Full] };
            for &sat in tests {
                let row = measure(sequence, sat, cube, &overlaps, sequence.thesis[k]);
                claims.extend(row.claims(sequence, sequence.thesis[k], count));
                rows.push(row);
            }
        }
        claims.extend(exact_claims(cube, &overlaps));
    }
    write_csv(settings, "bounding-volumes", &rows)?;
    Ok(Report { claims, charts: charts(settings, &rows)? })
}

fn measure(sequence: &Sequence, sat: Sat, cube: f64, overlaps: &[Overlaps], thesis: [f64; 3]) -> Row {
    let first = |o: &Overlaps| sequence.first.is_none_or(|(overlap, _)| overlap(o));
    let last = |o: &Overlaps| match sat {
        _ if !sequence.oriented => true,
        Sat::Full => o.oriented,
        Sat::Lite => o.oriented_lite,
    };
    let percent = |of: &dyn Fn(&Overlaps) -> bool| {
        100.0 * overlaps.iter().filter(|o| of(o)).count() as f64 / overlaps.len() as f64
    };
    let (first_percent, all_percent) = (percent(&first), percent(&|o| first(o) && last(o)));
    let first_cost = sequence.first.map_or(0.0, |(_, cost)| cost);
    let last_cost = if sequence.oriented { ORIENTED_BOX } else { 0.0 };
    Row {
        volumes: sequence.name,
        box_test: if !sequence.oriented {
            ""
        } else if sat == Sat::Full {
            "SAT"
        } else {
            "SAT lite"
        },
        cube,
        first_overlap_percent: first_percent,
        all_overlap_percent: all_percent,
        average_operations: first_cost + first_percent / 100.0 * last_cost + all_percent / 100.0 * TORUS,
        thesis_average_operations: thesis[2],
    }
}

impl Row {
    fn claims(&self, sequence: &Sequence, thesis: [f64; 3], count: usize) -> Vec<Claim> {
        // The thesis rounds percentages to tenths, and costs to ones.
        let [first_error, all_error] =
            [self.first_overlap_percent, self.all_overlap_percent].map(|p| sampling_error(p, count, RUNS));
        let average_error = (first_error * ORIENTED_BOX + all_error * TORUS) / 100.0;
        let claim = |what: &str, thesis, ours, unit, error| Claim {
            what: format!("{} {}, cube of {}: {what}", self.volumes, self.box_test, self.cube),
            thesis,
            ours,
            unit,
            kind: Kind::Count { error },
        };
        let mut claims = Vec::new();
        if sequence.first.is_some() && self.box_test != "SAT lite" {
            claims.push(claim(
                "first overlap",
                thesis[0],
                self.first_overlap_percent,
                "%",
                first_error + 0.05,
            ));
        }
        if sequence.oriented {
            claims.push(claim("all overlap", thesis[1], self.all_overlap_percent, "%", all_error + 0.05));
        }
        claims.push(claim("average cost", thesis[2], self.average_operations, "", average_error + 0.5));
        claims
    }
}

/// What can be integrated: how often two balls overlap, and two cubes.
fn exact_claims(cube: f64, overlaps: &[Overlaps]) -> [Claim; 2] {
    let reach = (2.0 * (MAJOR + MINOR) / cube).min(1.0);
    let cubes = 100.0 * (1.0 - (1.0 - reach) * (1.0 - reach)).powi(3);
    let claim = |what: &str, exact: f64, of: fn(&Overlaps) -> bool| {
        let ours = 100.0 * overlaps.iter().filter(|o| of(o)).count() as f64 / overlaps.len() as f64;
        Claim {
            what: format!("{what}, cube of {cube}: the exact probability, for the thesis's figure"),
            thesis: exact,
            ours,
            unit: "%",
            kind: Kind::Count { error: sampling_error(ours, overlaps.len(), usize::MAX) },
        }
    };
    let balls = 100.0 * within(2.0 * (MAJOR + MINOR) / cube);
    [claim("sphere", balls, |o| o.sphere), claim("fixed AABB", cubes, |o| o.fixed)]
}

/// The probability that two random points of a unit cube are within `s` of each other, by integrating over the differences of
/// their coordinates, which have the density 1 - |x|.
fn within(s: f64) -> f64 {
    /// Cells on a side: the error is below 1e-5.
    const CELLS: usize = 400;
    let cell = |i: usize| (i as f64 + 0.5) / CELLS as f64;
    let density = |i: usize| 2.0 * (1.0 - cell(i)) / CELLS as f64;
    let mut sum = 0.0;
    for i in 0..CELLS {
        for j in 0..CELLS {
            let rest = s * s - cell(i) * cell(i) - cell(j) * cell(j);
            if rest > 0.0 {
                // The third difference is below z: integrated by hand.
                let z = rest.sqrt().min(1.0);
                sum += density(i) * density(j) * (2.0 * z - z * z);
            }
        }
    }
    sum
}

fn charts(settings: &Settings, rows: &[Row]) -> Result<Vec<(String, String)>> {
    let groups: Vec<String> = SEQUENCES.iter().map(|s| s.name.to_owned()).collect();
    let mut charts = Vec::new();
    for cube in CUBES {
        let file = format!("bounding-volumes-{cube}.svg");
        let of = |value: fn(&Row) -> f64| {
            rows.iter().filter(|row| row.cube == cube && row.box_test != "SAT lite").map(value).collect()
        };
        let series = [
            ("thesis".to_owned(), of(|r| r.thesis_average_operations)),
            ("here".to_owned(), of(|r| r.average_operations)),
        ];
        let title = format!("Average cost of testing two tori, centres in a cube of {cube}");
        bars(settings, &file, &Labels { title: &title, x: "", y: "operations" }, &groups, &series)?;
        charts.push((file, title));
    }
    Ok(charts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_of_random_points_is_integrated_rightly() {
        // Closed form for s up to 1.
        let s: f64 = 0.24;
        let exact = std::f64::consts::PI * (4.0 / 3.0 * s.powi(3) - 1.5 * s.powi(4)) + 1.6 * s.powi(5)
            - s.powi(6) / 6.0;
        assert!((within(s) - exact).abs() < 1e-5, "{}, not {exact}", within(s));
        assert!((within(2.0) - 1.0).abs() < 1e-9);
    }
}
