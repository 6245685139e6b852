//! Table 5.6: building, refitting and testing trees.

use std::hint::black_box;

use anyhow::Result;
use serde::Serialize;
use solid3d::glam::DVec3;

use super::chart::{Labels, bars};
use super::clock::least_seconds;
use super::models::all;
use super::output::write_csv;
use super::random::stream;
use super::trees::colliding_at_rate;
use super::{Claim, Kind, Report, Settings};
use crate::comparators::tree::{AlignedBox, Fit, OrientedBox, Sat, Traversal, Tree, Triangle};

/// What the thesis found, in milliseconds, for the models in their order.
const THESIS: [(&str, [f64; 3]); 5] = [
    ("build an OBB tree", [350.0, 460.0, 270.0]),
    ("build an AABB tree", [110.0, 180.0, 80.0]),
    ("refit an AABB tree", [15.0, 18.0, 11.0]),
    ("test a pair of OBB trees", [0.5, 2.3, 0.6]),
    ("test a pair of AABB trees", [1.3, 3.3, 0.8]),
];

#[derive(Serialize)]
struct Row {
    model: &'static str,
    operation: &'static str,
    milliseconds: f64,
    thesis_milliseconds: f64,
}

/// Runs it.
pub fn run(settings: &Settings) -> Result<Report> {
    let repeats = settings.sample(9, 3);
    let tests = settings.sample(5_000, 500);
    let mut rows = Vec::new();
    for (k, model) in all().iter().enumerate() {
        let deformed: Vec<Triangle> = model.triangles.iter().map(|t| t.map(wave)).collect();
        let placements = colliding_at_rate(&mut stream(settings.seed, model.name), model, tests);
        let build_obb = least_seconds(repeats, || {
            black_box(Tree::<OrientedBox>::build(model.triangles.clone(), Fit::Surface));
        });
        let build_aabb = least_seconds(repeats, || {
            black_box(Tree::<AlignedBox>::build(model.triangles.clone(), ()));
        });
        let mut tree = Tree::<AlignedBox>::build(model.triangles.clone(), ());
        let refit = least_seconds(repeats, || tree.refit(black_box(&deformed)));
        let obb = Tree::<OrientedBox>::build(model.triangles.clone(), Fit::Surface);
        let aabb = Tree::<AlignedBox>::build(model.triangles.clone(), ());
        // Each with the test that suits it best (Table 5.5).
        let (mut by_obb, mut by_aabb) = (Traversal::new(Sat::Full), Traversal::new(Sat::Lite));
        let test_obb = least_seconds(repeats, || {
            black_box(placements.iter().filter(|p| by_obb.intersects(&obb, &obb, p)).count());
        }) / tests as f64;
        let test_aabb = least_seconds(repeats, || {
            black_box(placements.iter().filter(|p| by_aabb.intersects(&aabb, &aabb, p)).count());
        }) / tests as f64;
        for ((operation, thesis), seconds) in
            THESIS.iter().zip([build_obb, build_aabb, refit, test_obb, test_aabb])
        {
            rows.push(Row {
                model: model.name,
                operation,
                milliseconds: 1e3 * seconds,
                thesis_milliseconds: thesis[k],
            });
        }
    }
    write_csv(settings, "deformable", &rows)?;
    Ok(Report { claims: claims(&rows), charts: vec![chart(settings, &rows)?] })
}

/// A deformation that keeps the mesh whole: a wave as high as a tenth of the distances.
fn wave(p: DVec3) -> DVec3 {
    p + 0.1 * DVec3::new(p.y.sin(), p.z.sin(), p.x.sin())
}

fn claims(rows: &[Row]) -> Vec<Claim> {
    let time = |model: &str, operation: usize| {
        let row = rows.iter().find(|row| row.model == model && row.operation == THESIS[operation].0);
        row.expect("every operation is measured for every model")
    };
    let mut claims: Vec<Claim> = rows
        .iter()
        .map(|row| Claim {
            what: format!("{}: {}", row.model, row.operation),
            thesis: row.thesis_milliseconds,
            ours: row.milliseconds,
            unit: "ms",
            kind: Kind::Time,
        })
        .collect();
    for model in ["Torus", "X-wing", "Teapot"] {
        for (what, over, under) in
            [("building an OBB tree for an AABB tree", 0, 1), ("building for refitting an AABB tree", 1, 2)]
        {
            let (over, under) = (time(model, over), time(model, under));
            claims.push(Claim {
                what: format!("{model}: {what}"),
                thesis: over.thesis_milliseconds / under.thesis_milliseconds,
                ours: over.milliseconds / under.milliseconds,
                unit: "times",
                kind: Kind::Time,
            });
        }
    }
    claims
}

/// In each model's own unit, the refit, since the times differ by a thousand.
fn chart(settings: &Settings, rows: &[Row]) -> Result<(String, String)> {
    let groups: Vec<String> = THESIS.iter().map(|(operation, _)| (*operation).replace(" tree", "")).collect();
    let in_refits = |value: fn(&Row) -> f64| {
        THESIS.iter().map(move |(operation, _)| {
            let of = |name: &str| rows.iter().filter(|r| r.operation == name).map(value).sum::<f64>();
            of(operation) / of(THESIS[2].0)
        })
    };
    let series = [
        ("thesis".to_owned(), in_refits(|r| r.thesis_milliseconds).collect()),
        ("here".to_owned(), in_refits(|r| r.milliseconds).collect()),
    ];
    let labels = Labels { title: "Table 5.6, all models, in times of a refit", x: "", y: "refits" };
    bars(settings, "deformable.svg", &labels, &groups, &series)?;
    Ok(("deformable.svg".to_owned(), labels.title.to_owned()))
}
