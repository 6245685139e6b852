//! Tables 5.4 and 5.5 and Figure 5.10: AABB trees against OBB trees, with all axes and with six, and on which axis the
//! separating-axes test exits.

use anyhow::Result;
use rand::rngs::StdRng;
use serde::Serialize;
use solid3d::glam::DAffine3;

use super::chart::{Labels, bars};
use super::clock::seconds;
use super::models::{Model, all};
use super::output::write_csv;
use super::random::{placement, stream};
use super::{Claim, Kind, Report, Settings};
use crate::comparators::tree::{AlignedBox, Ball, Dop, Fit, OrientedBox, Sat, Traversal, Tree, Volume};

/// Placements of the thesis.
const RUNS: usize = 100_000;

/// The share of placements that collide.
const RATE: f64 = 0.6;

/// The size of the cube is found by halving an interval so often, on so many placements.
const HALVINGS: usize = 12;
const CALIBRATION: usize = 2_000;

/// What the thesis found for a model and a tree: `N_b`, `N_p` and the total time in seconds, for the whole test and for the lite one.
struct Thesis {
    model: &'static str,
    tree: &'static str,
    full: [f64; 3],
    lite: [f64; 3],
}

const THESIS: [Thesis; 6] = [
    Thesis {
        model: "Torus",
        tree: "OBB",
        full: [10_178_961.0, 197_314.0, 52.6],
        lite: [13_116_295.0, 371_345.0, 52.3],
    },
    Thesis {
        model: "X-wing",
        tree: "OBB",
        full: [48_890_612.0, 975_217.0, 234.0],
        lite: [65_041_340.0, 2_451_543.0, 244.3],
    },
    Thesis {
        model: "Teapot",
        tree: "OBB",
        full: [12_025_710.0, 186_329.0, 60.3],
        lite: [14_404_588.0, 279_987.0, 54.3],
    },
    Thesis {
        model: "Torus",
        tree: "AABB",
        full: [32_913_297.0, 3_996_806.0, 151.0],
        lite: [40_238_149.0, 5_222_836.0, 134.5],
    },
    Thesis {
        model: "X-wing",
        tree: "AABB",
        full: [92_376_250.0, 8_601_433.0, 350.1],
        lite: [121_462_120.0, 13_066_095.0, 328.0],
    },
    Thesis {
        model: "Teapot",
        tree: "AABB",
        full: [25_810_569.0, 1_874_830.0, 98.7],
        lite: [30_127_623.0, 2_214_671.0, 78.1],
    },
];

/// The thesis: of boxes that are apart, so many percent are separated by the product of two edges only.
const THESIS_EDGE_EXITS: f64 = 15.0;

/// The thesis: so many percent of the tests of boxes find them to overlap.
const THESIS_OVERLAPS: f64 = 60.0;

#[derive(Serialize)]
struct Row {
    model: &'static str,
    tree: &'static str,
    test: &'static str,
    colliding_percent: f64,
    box_tests: f64,
    triangle_tests: f64,
    seconds: f64,
    microseconds_a_placement: f64,
    overlapping_percent: f64,
    edge_exits_percent: f64,
}

#[derive(Serialize)]
struct ExitRow {
    axis: usize,
    aabb_percent: f64,
    obb_percent: f64,
}

/// A measurement of one model, one tree and one test.
struct Run {
    row: Row,
    exits: [u64; 16],
}

/// Runs it.
pub fn run(settings: &Settings) -> Result<Report> {
    let count = settings.sample(RUNS, 4_000);
    let (mut runs, mut others) = (Vec::new(), Vec::new());
    for model in all() {
        let placements = colliding_at_rate(&mut stream(settings.seed, model.name), &model, count);
        runs.extend(measure::<OrientedBox>(&model, "OBB", Fit::Surface, &placements));
        runs.extend(measure::<AlignedBox>(&model, "AABB", (), &placements));
        // Not in the thesis's tables: they have one test each.
        let alone = |[mut run, _]: [Run; 2]| {
            run.row.test = "";
            run
        };
        others.push(alone(measure::<OrientedBox>(&model, "OBB of hulls", Fit::Hull, &placements)));
        others.push(alone(measure::<Dop>(&model, "k-DOP", (), &placements)));
        others.push(alone(measure::<Ball>(&model, "sphere", (), &placements)));
    }
    let rows: Vec<&Row> = runs.iter().chain(&others).map(|run| &run.row).collect();
    write_csv(settings, "trees", &rows)?;
    let exits = exit_rows(&runs);
    write_csv(settings, "sat-exits", &exits)?;
    Ok(Report { claims: claims(&runs), charts: charts(settings, &rows, &exits)? })
}

/// Placements of B in the space of A of which about the rate collide.
pub(super) fn colliding_at_rate(rng: &mut StdRng, model: &Model, count: usize) -> Vec<DAffine3> {
    let tree = Tree::<AlignedBox>::build(model.triangles.clone(), ());
    let drawn: Vec<[DAffine3; 2]> = (0..count).map(|_| [(); 2].map(|()| placement(rng, 1.0))).collect();
    let relative = |pair: &[DAffine3; 2], side: f64| {
        let [a, b] = pair.map(|p| DAffine3 { translation: p.translation * side, ..p });
        a.inverse() * b
    };
    let mut traversal = Traversal::new(Sat::Lite);
    let sample = &drawn[..count.min(CALIBRATION)];
    let reach = model.triangles.iter().flatten().map(|p| p.length()).fold(0.0, f64::max);
    let (mut near, mut far) = (0.0, 16.0 * reach);
    for _ in 0..HALVINGS {
        let side = 0.5 * (near + far);
        let hits =
            sample.iter().filter(|pair| traversal.intersects(&tree, &tree, &relative(pair, side))).count();
        if hits as f64 > RATE * sample.len() as f64 { near = side } else { far = side }
    }
    drawn.iter().map(|pair| relative(pair, far)).collect()
}

fn measure<V: Volume>(
    model: &Model,
    name: &'static str,
    options: V::Options,
    placements: &[DAffine3],
) -> [Run; 2] {
    let tree = Tree::<V>::build(model.triangles.clone(), options);
    [("SAT", Sat::Full), ("SAT lite", Sat::Lite)].map(|(test, sat)| {
        let mut traversal = Traversal::new(sat);
        let (seconds, hits) =
            seconds(|| placements.iter().filter(|b_to_a| traversal.intersects(&tree, &tree, b_to_a)).count());
        let counters = traversal.counters;
        let share = |part: u64, whole: u64| 100.0 * part as f64 / whole as f64;
        let apart: u64 = counters.exits[1..].iter().sum();
        // As for the number of placements of the thesis.
        let scale = RUNS as f64 / placements.len() as f64;
        let row = Row {
            model: model.name,
            tree: name,
            test,
            colliding_percent: share(hits as u64, placements.len() as u64),
            box_tests: counters.box_tests as f64 * scale,
            triangle_tests: counters.triangle_tests as f64 * scale,
            seconds: seconds * scale,
            microseconds_a_placement: seconds * 1e6 / placements.len() as f64,
            overlapping_percent: share(counters.exits[0], counters.box_tests),
            edge_exits_percent: share(counters.exits[7..].iter().sum(), apart),
        };
        Run { row, exits: counters.exits }
    })
}

fn claims(runs: &[Run]) -> Vec<Claim> {
    let mut claims = Vec::new();
    for thesis in &THESIS {
        for (test, figures) in [("SAT", thesis.full), ("SAT lite", thesis.lite)] {
            let run = runs
                .iter()
                .find(|run| (run.row.model, run.row.tree, run.row.test) == (thesis.model, thesis.tree, test));
            let row = &run.expect("every model is measured with both trees and both tests").row;
            let claim = |what: &str, thesis_figure, ours, unit, kind| Claim {
                what: format!("{}, {} tree, {test}: {what}", thesis.model, thesis.tree),
                thesis: thesis_figure,
                ours,
                unit,
                kind,
            };
            claims.push(claim("N_b", figures[0], row.box_tests, "", Kind::Model));
            claims.push(claim("N_p", figures[1], row.triangle_tests, "", Kind::Model));
            claims.push(claim("total", figures[2], row.seconds, "s", Kind::Time));
        }
    }
    for run in runs.iter().filter(|run| run.row.test == "SAT") {
        let of = format!("{}, {} tree", run.row.model, run.row.tree);
        let claim = |what: &str, thesis, ours| Claim {
            what: format!("{of}: {what}"),
            thesis,
            ours,
            unit: "%",
            kind: Kind::Model,
        };
        claims.push(claim(
            "boxes apart that only edges separate",
            THESIS_EDGE_EXITS,
            run.row.edge_exits_percent,
        ));
        claims.push(claim("box tests that find an overlap", THESIS_OVERLAPS, run.row.overlapping_percent));
    }
    claims
}

fn exit_rows(runs: &[Run]) -> Vec<ExitRow> {
    let distribution = |tree: &str| {
        let mut sums = [0; 16];
        for run in runs.iter().filter(|run| run.row.test == "SAT" && run.row.tree == tree) {
            for (sum, exits) in sums.iter_mut().zip(run.exits) {
                *sum += exits;
            }
        }
        let apart: u64 = sums[1..].iter().sum();
        sums.map(|exits| 100.0 * exits as f64 / apart as f64)
    };
    let (aabb, obb) = (distribution("AABB"), distribution("OBB"));
    (1..16).map(|axis| ExitRow { axis, aabb_percent: aabb[axis], obb_percent: obb[axis] }).collect()
}

fn charts(settings: &Settings, rows: &[&Row], exits: &[ExitRow]) -> Result<Vec<(String, String)>> {
    let axes: Vec<String> = exits.iter().map(|row| row.axis.to_string()).collect();
    let series = [
        ("AABB trees".to_owned(), exits.iter().map(|row| row.aabb_percent).collect()),
        ("OBB trees".to_owned(), exits.iter().map(|row| row.obb_percent).collect()),
    ];
    let title = "Figure 5.10: the axis on which the SAT exits";
    bars(settings, "sat-exits.svg", &Labels { title, x: "axis", y: "% of boxes apart" }, &axes, &series)?;
    let mut charts = vec![("sat-exits.svg".to_owned(), title.to_owned())];
    let models: Vec<String> = all().iter().map(|model| model.name.to_owned()).collect();
    let ways = [
        ("OBB", "SAT"),
        ("OBB", "SAT lite"),
        ("AABB", "SAT"),
        ("AABB", "SAT lite"),
        ("k-DOP", ""),
        ("sphere", ""),
    ];
    let of = |value: fn(&Row) -> f64| -> Vec<(String, Vec<f64>)> {
        let column = |(tree, test)| {
            rows.iter().filter(|r| (r.tree, r.test) == (tree, test)).map(|r| value(r)).collect()
        };
        ways.map(|way| (format!("{} {}", way.0, way.1), column(way))).to_vec()
    };
    for (file, title, y, series) in [
        ("trees-tests.svg", "Box tests for 100,000 placements", "tests", of(|r| r.box_tests)),
        ("trees-times.svg", "Time of one placement", "microseconds", of(|r| r.microseconds_a_placement)),
    ] {
        bars(settings, file, &Labels { title, x: "", y }, &models, &series)?;
        charts.push((file.to_owned(), title.to_owned()));
    }
    Ok(charts)
}
