//! The experiments of section 4.4.4: does the search end, and how many iterations does an accurate digit take?

use anyhow::Result;
use rand::Rng;
use rand::rngs::StdRng;
use serde::Serialize;
use solid3d::convex::{Cone, Cuboid, Cylinder, Sphere, Support};
use solid3d::glam::{DAffine3, DVec3};

use super::chart::{Labels, bars, lines};
use super::output::write_csv;
use super::random::{stream, turned_at};
use super::{Claim, Kind, Report, Settings};
use crate::comparators::convex::{Pair, Polytope, Rules, distance};
use crate::inputs::direction;

/// Digits asked for.
const DIGITS: [i32; 7] = [2, 4, 6, 8, 10, 12, 14];

/// How many times larger one object is than the other, in the experiment on termination.
const SIZES: [f64; 4] = [1.0, 1e1, 1e2, 1e3];

/// The gap of two objects, in sizes of the smaller.
const GAP: f64 = 0.1;

/// The tolerances of the experiment on termination.
const TOLERANCES: [f64; 3] = [1e-6, 1e-10, 1e-14];

/// Rules but for the tolerance.
type OfTolerance = fn(f64) -> Rules;

/// What each of the thesis's measures is worth: the original, with a relative error, and with all.
const VERSIONS: [(&str, OfTolerance); 3] = [
    ("original", Rules::original),
    ("relative error", |tolerance| Rules { relative: true, ..Rules::original(tolerance) }),
    ("thesis", Rules::thesis),
];

#[derive(Serialize)]
struct EndRow {
    size_ratio: f64,
    tolerance: f64,
    version: &'static str,
    pairs: usize,
    converged: usize,
    repeated: usize,
    no_subset: usize,
    endless: usize,
    iterations: f64,
}

#[derive(Serialize)]
struct IterationRow {
    shapes: &'static str,
    digits: i32,
    iterations: f64,
}

/// Runs it.
pub fn run(settings: &Settings) -> Result<Report> {
    let ends = ends(settings);
    write_csv(settings, "termination", &ends)?;
    let iterations = iterations(settings);
    write_csv(settings, "iterations", &iterations)?;
    let endless = |version: &str| {
        let of = || ends.iter().filter(|row| row.version == version);
        100.0 * of().map(|row| row.endless).sum::<usize>() as f64
            / of().map(|row| row.pairs).sum::<usize>() as f64
    };
    let claim =
        |what: &str, thesis, ours, unit, kind| Claim { what: what.to_owned(), thesis, ours, unit, kind };
    let at = |shapes: &str, digits| {
        let row = iterations.iter().find(|row| row.shapes == shapes && row.digits == digits);
        row.expect("every kind is measured at every number of digits").iterations
    };
    let growth = |shapes: &str| at(shapes, DIGITS[5]) / at(shapes, DIGITS[2]);
    let claims = vec![
        claim(
            "searches without an end: all of the thesis's measures",
            0.0,
            endless("thesis"),
            "%",
            Kind::Count { error: 0.0 },
        ),
        // The thesis: "occasionally".
        claim(
            "searches without an end: a relative error alone",
            f64::NAN,
            endless("relative error"),
            "%",
            Kind::Model,
        ),
        claim("searches without an end: the original", f64::NAN, endless("original"), "%", Kind::Model),
        // The number of iterations is roughly linear in the number of digits, and for polytopes no function of it.
        claim(
            "quadrics: iterations for 12 digits, of those for 6",
            2.0,
            growth("quadrics"),
            "times",
            Kind::Model,
        ),
        claim(
            "polytopes: iterations for 12 digits, of those for 6",
            1.0,
            growth("polytopes"),
            "times",
            Kind::Model,
        ),
    ];
    Ok(Report { claims, charts: charts(settings, &ends, &iterations)? })
}

/// Pairs of polytopes that differ in size, close to each other.
fn ends(settings: &Settings) -> Vec<EndRow> {
    let count = settings.sample(1_000, 100);
    let mut rows = Vec::new();
    for size_ratio in SIZES {
        for tolerance in TOLERANCES {
            for (version, rules) in VERSIONS {
                // The same pairs for all.
                let mut rng = stream(settings.seed, &format!("termination {size_ratio}"));
                let (mut ended, mut iterations) = ([0; 4], 0);
                for _ in 0..count {
                    let found = close_pair(&mut rng, size_ratio, |pair| distance(pair, &rules(tolerance)));
                    ended[found.end as usize] += 1;
                    iterations += found.iterations;
                }
                let [converged, repeated, no_subset, endless] = ended;
                let iterations = f64::from(iterations) / count as f64;
                rows.push(EndRow {
                    size_ratio,
                    tolerance,
                    version,
                    pairs: count,
                    converged,
                    repeated,
                    no_subset,
                    endless,
                    iterations,
                });
            }
        }
    }
    rows
}

/// A large polytope and a small one above it, at about [`GAP`].
fn close_pair<T>(rng: &mut StdRng, ratio: f64, ask: impl FnOnce(&Pair) -> T) -> T {
    let mut polytope = |size: f64| {
        let points: Vec<DVec3> = (0..20).map(|_| direction(rng) * size).collect();
        Polytope::hull_of(&points).expect("there are points")
    };
    let (a, b) = (polytope(ratio), polytope(1.0));
    let toward = direction(rng);
    let placement_a = turned_at(rng, DVec3::ZERO);
    let turned = turned_at(rng, DVec3::ZERO);
    // As near as their support points along one direction say.
    let touch = Pair { a: &a, placement_a: &placement_a, b: &b, placement_b: &turned }
        .support_against(-toward)
        .w
        .dot(toward);
    let placement_b = DAffine3::from_translation(toward * (touch + GAP)) * turned;
    ask(&Pair { a: &a, placement_a: &placement_a, b: &b, placement_b: &placement_b })
}

/// Mean iterations until so many digits are right.
fn iterations(settings: &Settings) -> Vec<IterationRow> {
    let count = settings.sample(4_000, 200);
    let mut rows = Vec::new();
    for digits in DIGITS {
        let rules = Rules::thesis(10.0f64.powi(-digits));
        for shapes in ["quadrics", "boxes", "polytopes"] {
            let mut rng = stream(settings.seed, shapes);
            let total: u32 = (0..count)
                .map(|_| {
                    let [a, b] = [(); 2].map(|()| shape(&mut rng, shapes));
                    // Apart: the centres of two objects of radius at most 1.5.
                    let far = direction(&mut rng) * rng.random_range(3.2..6.0);
                    let [at_a, at_b] = [DVec3::ZERO, far].map(|t| turned_at(&mut rng, t));
                    let pair = Pair { a: a.as_ref(), placement_a: &at_a, b: b.as_ref(), placement_b: &at_b };
                    distance(&pair, &rules).iterations
                })
                .sum();
            rows.push(IterationRow { shapes, digits, iterations: f64::from(total) / count as f64 });
        }
    }
    rows
}

fn shape(rng: &mut StdRng, shapes: &str) -> Box<dyn Support> {
    let mut size = || rng.random_range(0.5..1.5);
    let fits = "sizes are positive";
    match shapes {
        "boxes" => Box::new(Cuboid::new(DVec3::new(size(), size(), size())).expect(fits)),
        "polytopes" => {
            let points: Vec<DVec3> = (0..20).map(|_| direction(rng)).collect();
            Box::new(Polytope::hull_of(&points).expect("there are points"))
        }
        _ => {
            let (radius, height) = (0.6 * size(), size());
            match rng.random_range(0..3) {
                0 => Box::new(Sphere::new(radius).expect(fits)),
                1 => Box::new(Cone::new(radius, height).expect(fits)),
                _ => Box::new(Cylinder::new(radius, height).expect(fits)),
            }
        }
    }
}

fn charts(
    settings: &Settings,
    ends: &[EndRow],
    iterations: &[IterationRow],
) -> Result<Vec<(String, String)>> {
    let series: Vec<_> = ["quadrics", "boxes", "polytopes"]
        .map(|shapes| {
            let of = iterations.iter().filter(|row| row.shapes == shapes);
            (shapes.to_owned(), of.map(|row| (f64::from(row.digits), row.iterations)).collect())
        })
        .to_vec();
    let title = "Iterations of the GJK distance algorithm";
    lines(settings, "iterations.svg", &Labels { title, x: "digits asked for", y: "iterations" }, &series)?;
    let groups: Vec<String> = SIZES.iter().map(|ratio| format!("{ratio}")).collect();
    let endless: Vec<_> = VERSIONS
        .map(|(version, _)| {
            // In the middle tolerance.
            let of = ends.iter().filter(|row| row.version == version && row.tolerance == TOLERANCES[1]);
            (version.to_owned(), of.map(|row| 100.0 * row.endless as f64 / row.pairs as f64).collect())
        })
        .to_vec();
    let labels = Labels {
        title: "Searches that do not end, tolerance 1e-10",
        x: "size of one object, of the other's",
        y: "%",
    };
    bars(settings, "termination.svg", &labels, &groups, &endless)?;
    Ok(vec![
        ("iterations.svg".to_owned(), title.to_owned()),
        ("termination.svg".to_owned(), labels.title.to_owned()),
    ])
}
