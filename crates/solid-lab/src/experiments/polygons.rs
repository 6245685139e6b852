//! The two tests of polygons against each other (thesis, section 3.2.2): is the new one a tenth faster?

use std::f64::consts::TAU;
use std::hint::black_box;

use anyhow::Result;
use rand::Rng;
use rand::rngs::StdRng;
use serde::Serialize;
use solid3d::Aabb;
use solid3d::glam::{DVec3, dvec3};
use solid3d::polygon::{Counters, Polygon, intersect_sorted, intersect_straightforward};

use super::chart::{Labels, lines};
use super::clock::least_seconds;
use super::output::write_csv;
use super::random::stream;
use super::{Claim, Kind, Report, Settings};
use crate::comparators::polygon::{FlatPolygon, Sorted, straightforward};
use crate::inputs::rotation;

/// Numbers of vertices.
const VERTICES: [usize; 6] = [4, 8, 12, 16, 24, 32];

/// The thesis says that the new test is a tenth faster, where boxes intersect.
const THESIS_RATIO: f64 = 0.9;

/// Passes over all pairs; the fastest counts.
const PASSES: usize = 5;

#[derive(Serialize)]
struct Row {
    vertices: usize,
    pairs: usize,
    intersecting_percent: f64,
    straightforward_ns: f64,
    sorted_ns: f64,
    sorted_to_straightforward: f64,
    exact_straightforward_ns: f64,
    exact_sorted_ns: f64,
    exact_ratio: f64,
    point_in_polygon_tests: f64,
}

/// Runs it.
pub fn run(settings: &Settings) -> Result<Report> {
    let count = settings.sample(20_000, 1_000);
    let rows: Vec<Row> = VERTICES.iter().map(|&n| measure(settings, n, count)).collect();
    write_csv(settings, "polygons", &rows)?;
    let ratio = |name: &str, of: fn(&Row) -> f64| {
        (name.to_owned(), rows.iter().map(|row| (row.vertices as f64, of(row))).collect())
    };
    let labels =
        Labels { title: "Sorted segments against the straightforward test", x: "vertices", y: "time, ratio" };
    lines(
        settings,
        "polygons.svg",
        &labels,
        &[
            ratio("as in the thesis", |r| r.sorted_to_straightforward),
            ratio("with exact signs", |r| r.exact_ratio),
        ],
    )?;
    let mut claims: Vec<Claim> = rows
        .iter()
        .map(|row| Claim {
            what: format!("time of the new test, of the straightforward one's, {} vertices", row.vertices),
            thesis: THESIS_RATIO,
            ours: row.sorted_to_straightforward,
            unit: "",
            kind: Kind::Time,
        })
        .collect();
    claims.extend(rows.iter().map(|row| Claim {
        what: format!("the same with the library's exact signs, {} vertices", row.vertices),
        thesis: THESIS_RATIO,
        ours: row.exact_ratio,
        unit: "",
        kind: Kind::Time,
    }));
    let chart =
        ("polygons.svg".to_owned(), "Times of the two polygon tests as a ratio, by vertices".to_owned());
    Ok(Report { claims, charts: vec![chart] })
}

fn measure(settings: &Settings, vertices: usize, count: usize) -> Row {
    let mut rng = stream(settings.seed, &format!("polygons {vertices}"));
    let mut pairs = Vec::with_capacity(count);
    while pairs.len() < count {
        let [a, b] = [0.0, 1.2].map(|reach| star(&mut rng, vertices, reach));
        if Aabb::of_points(a.iter().copied()).overlaps(&Aabb::of_points(b.iter().copied())) {
            pairs.push([a, b]);
        }
    }
    let flat: Vec<_> = pairs.iter().map(|pair| pair.clone().map(FlatPolygon::new)).collect();
    let exact: Vec<_> = pairs
        .into_iter()
        .map(|pair| pair.map(|chain| Polygon::new(chain).expect("stars are flat")))
        .collect();
    let mut counters = Counters::default();
    let hits = exact.iter().filter(|[a, b]| intersect_straightforward(a, b, &mut counters)).count();
    let each = |seconds: f64| seconds * 1e9 / count as f64;
    let straightforward_ns = each(least_seconds(PASSES, || {
        flat.iter().for_each(|[a, b]| _ = black_box(straightforward(a, b)));
    }));
    let mut by_sorting = Sorted::default();
    let sorted_ns = each(least_seconds(PASSES, || {
        flat.iter().for_each(|[a, b]| _ = black_box(by_sorting.intersect(a, b)));
    }));
    let time_exact = |test: fn(&Polygon, &Polygon, &mut Counters) -> bool| {
        let mut counters = Counters::default();
        each(least_seconds(PASSES, || {
            exact.iter().for_each(|[a, b]| _ = black_box(test(a, b, &mut counters)))
        }))
    };
    let exact_straightforward_ns = time_exact(intersect_straightforward);
    let exact_sorted_ns = time_exact(intersect_sorted);
    Row {
        vertices,
        pairs: count,
        intersecting_percent: 100.0 * hits as f64 / count as f64,
        straightforward_ns,
        sorted_ns,
        sorted_to_straightforward: sorted_ns / straightforward_ns,
        exact_straightforward_ns,
        exact_sorted_ns,
        exact_ratio: exact_sorted_ns / exact_straightforward_ns,
        point_in_polygon_tests: counters.point_in_polygon_tests as f64 / count as f64,
    }
}

/// A star-shaped polygon, not convex as a rule, in a random plane, its centre within `reach` of the origin.
pub(crate) fn star(rng: &mut StdRng, vertices: usize, reach: f64) -> Vec<DVec3> {
    let turn = rotation(rng);
    let center = DVec3::from_array([0; 3].map(|_| rng.random_range(-1.0..=1.0))) * reach;
    (0..vertices)
        .map(|i| {
            let angle = TAU * (i as f64 + rng.random_range(0.1..0.9)) / vertices as f64;
            let radius = rng.random_range(0.3..=1.0);
            turn * (radius * dvec3(angle.cos(), angle.sin(), 0.0)) + center
        })
        .collect()
}
