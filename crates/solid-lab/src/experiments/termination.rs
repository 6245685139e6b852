//! The experiments of section 4.4.4: does the search end, and how many iterations does an accurate digit take?

use anyhow::Result;
use rand::Rng;
use rand::rngs::StdRng;
use serde::Serialize;
use solid3d::convex::{Cone, Cuboid, Cylinder, Sphere, Support};
use solid3d::glam::DVec3;

use super::chart::{Labels, bars, lines};
use super::output::write_csv;
use super::random::stream;
use super::{Claim, Kind, Report, Settings};
use crate::comparators::convex::{End, Pair, Polytope, Rules, distance};
use crate::inputs::{Pose, direction};

/// Digits asked for.
const DIGITS: [i32; 7] = [2, 4, 6, 8, 10, 12, 14];

/// How many times larger one object is than the other, in the experiment on termination.
const SIZES: [f64; 4] = [1.0, 1e1, 1e2, 1e3];

/// The gap of two objects, in sizes of the smaller.
const GAP: f64 = 0.1;

/// The tolerance of the experiment on termination: as many digits as there are nearly.
const TOLERANCE: f64 = 1e-14;

#[derive(Serialize)]
struct EndRow {
    size_ratio: f64,
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
        ends.iter().filter(|row| row.version == version).map(|row| row.endless).sum::<usize>() as f64
    };
    let pairs = ends.iter().map(|row| row.pairs).sum::<usize>() as f64 / 2.0;
    let claim =
        |what: &str, thesis, ours, unit, kind| Claim { what: what.to_owned(), thesis, ours, unit, kind };
    let at = |shapes: &str, digits| {
        let row = iterations.iter().find(|row| row.shapes == shapes && row.digits == digits);
        row.expect("every kind is measured at every number of digits").iterations
    };
    let growth = |shapes: &str| at(shapes, DIGITS[5]) / at(shapes, DIGITS[2]);
    let claims = vec![
        claim(
            "searches that do not end, with the thesis's measures",
            0.0,
            endless("thesis"),
            "",
            Kind::Count { error: 0.0 },
        ),
        claim(
            "searches of the original that do not end, %: some",
            f64::NAN,
            100.0 * endless("original") / pairs,
            "%",
            Kind::Model,
        ),
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
    let count = settings.sample(20_000, 500);
    let mut rows = Vec::new();
    for ratio in SIZES {
        let versions = [("thesis", Rules::thesis(TOLERANCE)), ("original", Rules::original(TOLERANCE))];
        for (version, rules) in versions {
            // The same pairs for both.
            let mut rng = stream(settings.seed, &format!("termination {ratio}"));
            let mut row = EndRow {
                size_ratio: ratio,
                version,
                pairs: count,
                converged: 0,
                repeated: 0,
                no_subset: 0,
                endless: 0,
                iterations: 0.0,
            };
            for _ in 0..count {
                let found = close_pair(&mut rng, ratio, |pair| distance(pair, &rules));
                match found.end {
                    End::Converged => row.converged += 1,
                    End::Repeated => row.repeated += 1,
                    End::NoSubset => row.no_subset += 1,
                    End::Limit => row.endless += 1,
                }
                row.iterations += f64::from(found.iterations) / count as f64;
            }
            rows.push(row);
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
    let placement_a = Pose::random_at(rng, DVec3::ZERO).affine();
    let turned = Pose::random_at(rng, DVec3::ZERO).affine();
    // As near as their support points along one direction say.
    let touch = Pair { a: &a, placement_a: &placement_a, b: &b, placement_b: &turned }
        .support_against(-toward)
        .w
        .dot(toward);
    let placement_b =
        Pose { rotation: Pose::IDENTITY.rotation, translation: toward * (touch + GAP) }.affine() * turned;
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
                    let [at_a, at_b] = [DVec3::ZERO, far].map(|t| Pose::random_at(&mut rng, t).affine());
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
    let endless: Vec<_> = ["thesis", "original"]
        .map(|version| {
            let of = ends.iter().filter(|row| row.version == version);
            (version.to_owned(), of.map(|row| 100.0 * row.endless as f64 / row.pairs as f64).collect())
        })
        .to_vec();
    let labels =
        Labels { title: "Searches that do not end", x: "size of one object, of the other's", y: "%" };
    bars(settings, "termination.svg", &labels, &groups, &endless)?;
    Ok(vec![
        ("iterations.svg".to_owned(), title.to_owned()),
        ("termination.svg".to_owned(), labels.title.to_owned()),
    ])
}
