//! Vertices, triangles and edges that move straight, against exact answers.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by panicking, and prints its rates"
)]

mod common;

use std::path::Path;
use std::time::Instant;

use common::{assert_rate, in_cube};
use glam::{DAffine3, DVec3};
use rand::Rng;
use solid_oracle::generate::seeded;
use solid_oracle::known_answers;
use solid3d::ccd::{self, Elements, Impact, Options};
use solid3d::query::{self, ImpactOptions};
use solid3d::{Error, Result, Shape, glam};

type Test = fn(&Elements, &Options) -> Result<Option<Impact>>;

/// The tests, by the names of the folders and files.
const TESTS: [(&str, &str, Test); 2] =
    [("vertex-face", "vf", ccd::vertex_face), ("edge-edge", "ee", ccd::edge_edge)];

/// How many of the queries were answered how.
#[derive(Debug, Default)]
struct Tally {
    positive: usize,
    negative: usize,
    false_positive: usize,
    given_up: usize,
    /// The largest time by which an answer was early.
    early: f64,
}

impl Tally {
    /// Takes an answer; none may be negative, or late, that should not be.
    fn take(&mut self, found: Option<Impact>, truth: bool, time: Option<f64>, context: &str) {
        *if truth { &mut self.positive } else { &mut self.negative } += 1;
        self.given_up += usize::from(found.is_some_and(|impact| !impact.near));
        match found {
            None => assert!(!truth, "{context}: missed"),
            Some(_) if !truth => self.false_positive += 1,
            Some(impact) => {
                let Some(time) = time else { return };
                // The known time is rounded.
                assert!(
                    impact.time <= time * (1.0 + 1e-15),
                    "{context}: {} is later than {time}",
                    impact.time
                );
                self.early = self.early.max(time - impact.time);
            }
        }
    }

    fn print(&self, name: &str, start: Instant) {
        let count = self.positive + self.negative;
        let micros = start.elapsed().as_secs_f64() * 1e6 / count as f64;
        println!("{name}: {self:?}, {micros:.1} us each");
    }
}

/// Rows of comma-separated fields, without a header line.
fn rows(path: &Path, skip: usize) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(path).unwrap();
    text.lines().skip(skip).map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

fn number(field: &str) -> f64 {
    field.parse().unwrap_or_else(|_| panic!("{field:?} is no number"))
}

/// A published benchmark of hard queries (Wang et al. 2021): rational coordinates, which are binary fractions.
#[test]
fn no_sample_query_is_missed() {
    let Some(folder) = known_answers("ccd/sample-queries") else { return };
    let times = rows(&folder.join("toi.csv"), 1);
    for tolerance in [1e-6, 1e-9] {
        let options = Options { tolerance, ..Options::default() };
        let total = sample_queries(&folder, &times, &options);
        println!("tolerance {tolerance:e}: {total:?}");
        assert!(total.positive > 300 && total.negative > 2000, "{total:?}");
        assert!(total.false_positive * 10 < total.negative, "{total:?}");
    }
}

fn sample_queries(folder: &Path, times: &[Vec<String>], options: &Options) -> Tally {
    let mut total = Tally::default();
    for (kind, _, test) in TESTS {
        let mut tally = Tally::default();
        let start = Instant::now();
        for set in
            std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(|p| p.is_dir())
        {
            for part in ["data_0_0.csv", "data_0_1.csv"] {
                let name = format!("{}/{kind}/{part}", set.file_name().unwrap().to_string_lossy());
                let expected: Vec<_> = times.iter().filter(|row| row[0] == name).collect();
                let vertices = rows(&folder.join(&name), 0);
                assert_eq!(vertices.len(), 8 * expected.len());
                for (rows, expected) in vertices.chunks(8).zip(expected) {
                    let position = |row: &Vec<String>| {
                        DVec3::from_array([0, 2, 4].map(|k| number(&row[k]) / number(&row[k + 1])))
                    };
                    let positions: Vec<DVec3> = rows.iter().map(position).collect();
                    let [from, to] = [0, 4].map(|i| positions[i..i + 4].try_into().unwrap());
                    let truth = rows[0][6] == "1";
                    let time = (!expected[3].is_empty()).then(|| number(&expected[3]));
                    let found = test(&Elements { from, to }, options).unwrap();
                    tally.take(found, truth, time, &format!("{name} {}", expected[1]));
                }
            }
        }
        tally.print(kind, start);
        total.false_positive += tally.false_positive;
        total.negative += tally.negative;
        total.positive += tally.positive;
        total.given_up += tally.given_up;
    }
    total
}

/// The vertices and triangles of a PLY file of the benchmark.
fn ply(path: &Path) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let bytes = std::fs::read(path).unwrap();
    let end = b"end_header\n";
    let body = bytes.windows(end.len()).position(|window| window == end).unwrap() + end.len();
    let header = std::str::from_utf8(&bytes[..body]).unwrap();
    let big = header.contains("binary_big_endian");
    let count = |element: &str| {
        let line = header.lines().find_map(|line| line.strip_prefix(element)).unwrap();
        line.trim().parse::<usize>().unwrap()
    };
    let properties = || header.lines().skip_while(|line| !line.starts_with("element vertex")).skip(1);
    let sizes: Vec<usize> = properties()
        .take_while(|line| !line.starts_with("element"))
        .map(|line| match line.split_whitespace().nth(1).unwrap() {
            "double" => 8,
            "float" | "int" | "uint" => 4,
            "uchar" => 1,
            other => panic!("{other}"),
        })
        .collect();
    let mut rest = &bytes[body..];
    let mut take = |size: usize| -> u64 {
        let (first, after) = rest.split_at(size);
        rest = after;
        let little: Vec<u8> = if big { first.iter().rev().copied().collect() } else { first.to_vec() };
        little.iter().rev().fold(0, |value, &byte| value << 8 | u64::from(byte))
    };
    let vertices = (0..count("element vertex")).map(|_| {
        let values: Vec<f64> = sizes
            .iter()
            .map(|&size| match size {
                8 => f64::from_bits(take(8)),
                4 => f64::from(f32::from_bits(take(4) as u32)),
                size => take(size) as f64,
            })
            .collect();
        DVec3::new(values[0], values[1], values[2])
    });
    let vertices: Vec<DVec3> = vertices.collect();
    let triangle = |_| {
        assert_eq!(take(1), 3);
        std::array::from_fn(|_| take(4) as u32)
    };
    (vertices, (0..count("element face")).map(triangle).collect())
}

/// Steps of two simulations, with exact answers for pairs whose boxes meet on the way.
const STEPS: [(&str, &str, &str); 2] =
    [("cloth-funnel", "227.ply", "228.ply"), ("armadillo-rollers", "326.ply", "327.ply")];

#[test]
fn no_query_of_a_simulation_is_missed() {
    let Some(folder) = known_answers("ccd/scalable") else { return };
    for (scene, from, to) in STEPS {
        let [from, to] = [from, to].map(|file| ply(&folder.join(scene).join(file)).0);
        for (_, name, test) in TESTS {
            let start = Instant::now();
            let mut tally = Tally::default();
            for row in rows(&folder.join(scene).join(format!("{name}.csv")), 1) {
                let index = [2, 3, 4, 5].map(|k| row[k].parse::<usize>().unwrap());
                let elements = Elements { from: index.map(|i| from[i]), to: index.map(|i| to[i]) };
                let time = (!row[7].is_empty()).then(|| number(&row[7]));
                let found = test(&elements, &Options::default()).unwrap();
                tally.take(found, row[6] == "1", time, &format!("{scene} {name} {row:?}"));
            }
            tally.print(&format!("{scene} {name}"), start);
            assert!(tally.positive > 20 && tally.false_positive * 100 < tally.negative, "{scene} {tally:?}");
        }
    }
}

/// The part of a mesh that each vertex belongs to, by its least vertex.
fn parts(count: usize, triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut part: Vec<u32> = (0..count as u32).collect();
    loop {
        let mut changed = false;
        for triangle in triangles {
            let least = triangle.iter().map(|&i| part[i as usize]).min().unwrap();
            for &i in triangle {
                changed |= std::mem::replace(&mut part[i as usize], least) != least;
            }
        }
        if !changed {
            return part;
        }
    }
}

/// Two of the bodies of a simulation as meshes with moving vertices: the time is that of their earliest elements.
#[test]
fn meshes_meet_when_their_first_elements_do() {
    let Some(folder) = known_answers("ccd/scalable") else { return };
    let (scene, from, to) = STEPS[1];
    let folder = folder.join(scene);
    let (from, triangles) = ply(&folder.join(from));
    let (to, _) = ply(&folder.join(to));
    let part = parts(from.len(), &triangles);
    let mut names: Vec<u32> = triangles.iter().map(|t| part[t[0] as usize]).collect();
    names.sort_unstable();
    names.dedup();
    let meshes: Vec<[Shape; 2]> = names
        .iter()
        .map(|&name| {
            let own: Vec<[u32; 3]> =
                triangles.iter().copied().filter(|t| part[t[0] as usize] == name).collect();
            let was = Shape::mesh(from.clone(), own).unwrap();
            let mut is = was.clone();
            is.deform(&to).unwrap();
            [was, is]
        })
        .collect();
    println!("{} bodies", meshes.len());
    let mut first = std::collections::BTreeMap::new();
    for (_, name, _) in TESTS {
        for row in rows(&folder.join(format!("{name}.csv")), 1).iter().filter(|row| row[6] == "1") {
            let last = if name == "vf" { 3 } else { 4 };
            let mut pair = [2, last].map(|k| part[row[k].parse::<usize>().unwrap()]);
            pair.sort_unstable();
            let time: f64 = first.get(&pair).copied().unwrap_or(2.0);
            first.insert(pair, time.min(number(&row[7])));
        }
    }
    let here = DAffine3::IDENTITY;
    let mut hits = 0;
    for (i, a) in meshes.iter().enumerate() {
        for (j, b) in meshes.iter().enumerate().skip(i + 1) {
            let start = Instant::now();
            let [ends_a, ends_b] = [a, b].map(|ends| ends.each_ref().map(|shape| (shape, &here)));
            let found = query::time_of_impact_deforming(ends_a, ends_b, &ImpactOptions::default()).unwrap();
            let expected = first.get(&[names[i], names[j]]);
            println!("{i} {j}: {found:?}, {expected:?}, {:?}", start.elapsed());
            match (found, expected) {
                // Not all queries of the step are in the data.
                (_, None) => {}
                (None, Some(time)) => panic!("the contact at {time} was missed"),
                (Some(found), Some(&time)) => {
                    assert!(found.time <= time, "{} {time}", found.time);
                    hits += 1;
                }
            }
        }
    }
    assert!(hits > 0, "{first:?}");
}

fn random_elements(rng: &mut rand::rngs::StdRng) -> Elements {
    let size = 10f64.powi(rng.random_range(-3..3));
    let still = rng.random_range(0..4) == 0;
    let from: [DVec3; 4] = std::array::from_fn(|_| in_cube(rng) * size);
    let drift = in_cube(rng) * size;
    let to = from.map(|p| if still { p + drift } else { p + drift + in_cube(rng) * size * 1.2 });
    Elements { from, to }
}

/// The distance of the elements at a time.
fn distance(kind: &str, elements: &Elements, t: f64) -> f64 {
    let at: [DVec3; 4] = std::array::from_fn(|i| elements.from[i].lerp(elements.to[i], t));
    let first = if kind == "vertex-face" { 1 } else { 2 };
    let [a, b] = [&at[..first], &at[first..]].map(|points| Shape::convex_hull(points).unwrap());
    query::distance(&a, &DAffine3::IDENTITY, &b, &DAffine3::IDENTITY).unwrap().distance
}

/// Laws: at the time given elements are near; in a larger unit it is the same; and the other way round they meet, too.
#[test]
fn elements_are_near_when_they_meet() {
    let mut rng = seeded(2200);
    let mut hits = [0; 2];
    let cases = 1500;
    for case in 0..cases {
        let elements = random_elements(&mut rng);
        let size =
            elements.from.iter().chain(&elements.to).map(|p| p.abs().max_element()).fold(0.0, f64::max);
        for (k, (kind, _, test)) in TESTS.into_iter().enumerate() {
            let found = test(&elements, &Options::default()).unwrap();
            let unit = 2f64.powi(rng.random_range(-90..90));
            let scaled =
                Elements { from: elements.from.map(|p| p * unit), to: elements.to.map(|p| p * unit) };
            assert_eq!(test(&scaled, &Options::default()).unwrap(), found);
            let reversed = Elements { from: elements.to, to: elements.from };
            let reversed = test(&reversed, &Options::default()).unwrap();
            let sliding = found.is_some_and(|impact| !impact.near);
            assert!(reversed.is_some() == found.is_some() || sliding, "case {case}: {found:?} {reversed:?}");
            let Some(found) = found else { continue };
            hits[k] += 1;
            let left = distance(kind, &elements, found.time);
            assert!(!found.near || left < 1e-5 * size, "case {case}: {left} {size}");
        }
    }
    // A vertex seldom meets a triangle.
    println!("vertex-face {} and edge-edge {} of {cases} hit", hits[0], hits[1]);
    assert!(hits.iter().all(|&hits| hits > cases / 50), "{hits:?}");
}

/// Elements that are aimed at each other, at a known time.
#[test]
fn elements_aimed_at_each_other_meet_in_time() {
    let mut rng = seeded(2201);
    let (mut hits, cases) = (0, 4000);
    for case in 0..cases {
        let (kind, _, test) = TESTS[case % 2];
        let mut elements = random_elements(&mut rng);
        let time: f64 = rng.random_range(0.0..2.0);
        let (u, v): (f64, f64) = (rng.random_range(0.0..0.5), rng.random_range(0.0..0.5));
        // Shift the first vertices so that a point of each coincides at the time, which may be after the end.
        let at: [DVec3; 4] = std::array::from_fn(|i| elements.from[i].lerp(elements.to[i], time));
        let off = match kind {
            "vertex-face" => at[1] + (at[2] - at[1]) * u + (at[3] - at[1]) * v - at[0],
            _ => at[2].lerp(at[3], v) - at[0].lerp(at[1], u),
        };
        let moved = if kind == "vertex-face" { 1 } else { 2 };
        for i in 0..moved {
            elements.from[i] += off;
            elements.to[i] += off;
        }
        let found = test(&elements, &Options::default()).unwrap();
        hits += usize::from(found.is_some());
        if time <= 1.0 {
            assert!(found.is_some_and(|impact| impact.time <= time + 1e-14), "case {case}: {found:?} {time}");
        }
    }
    println!("{hits} of {cases}");
    assert_rate("aimed elements", hits, cases);
}

/// Law: where they meet is told by a point of each, of slivers, of triangles that are segments or points, and of what is long along one axis too:
/// these are near at the time told.
#[test]
fn the_parameters_are_those_of_points_that_meet() {
    let mut rng = seeded(2202);
    let (cases, mut hits, mut outer) = (3000, [0; 2], 0);
    for case in 0..cases {
        let k = case % 2;
        let (_, _, test) = TESTS[k];
        let mut elements = random_elements(&mut rng);
        let long = [1.0, 1e4][case / 16 % 2];
        for points in [&mut elements.from, &mut elements.to] {
            points.iter_mut().for_each(|point| point[case % 3] *= long);
        }
        // The triangle has a short side, or one of the edges is short.
        let short = [1.0, 1e-3, 1e-6, 0.0][case / 4 % 4];
        let [base, end] = [[[1, 2], [1, 3]], [[0, 1], [2, 3]]][k][case / 2 % 2];
        for points in [&mut elements.from, &mut elements.to] {
            points[end] = points[base] + (points[end] - points[base]) * short;
        }
        let part = rng.random_range(0.0..=1.0);
        let off = elements.to[2].lerp(elements.to[3], part) - elements.to[0];
        for points in [&mut elements.from, &mut elements.to] {
            points[..=k].iter_mut().for_each(|point| *point += off);
        }
        let Some(found) = test(&elements, &Options::default()).unwrap() else { continue };
        let [u, v] = found.parameters;
        assert!(u >= 0.0 && v >= 0.0 && u <= 1.0 && v <= 1.0, "case {case}: {found:?}");
        let at: [DVec3; 4] = std::array::from_fn(|i| elements.from[i].lerp(elements.to[i], found.time));
        let between = if k == 0 {
            assert!(u + v <= 1.0, "case {case}: {found:?}");
            outer += usize::from(u + v == 1.0);
            at[1] + (at[2] - at[1]) * u + (at[3] - at[1]) * v - at[0]
        } else {
            at[2].lerp(at[3], v) - at[0].lerp(at[1], u)
        };
        hits[k] += 1;
        let size =
            elements.from.iter().chain(&elements.to).map(|p| p.abs().max_element()).fold(0.0, f64::max);
        assert!(!found.near || between.length() < 1e-5 * size, "case {case}: {found:?} {between} {size}");
    }
    println!("vertex-face {} and edge-edge {} of {cases} hit, {outer} at the outer edge", hits[0], hits[1]);
    assert!(hits.iter().all(|&hits| hits > cases / 4) && outer > cases / 20);
}

#[test]
fn bad_input_is_refused_by_name() {
    let good = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    for (_, _, test) in TESTS {
        for bad in [f64::NAN, f64::INFINITY, 1.1e100] {
            let mut wild = good;
            wild[2].y = bad;
            let errors = [
                (test(&Elements { from: wild, to: good }, &Options::default()), "from"),
                (test(&Elements { from: good, to: wild }, &Options::default()), "to"),
            ];
            for (error, name) in errors {
                let Err(error @ Error::Coordinates { .. }) = error else { panic!("{error:?}") };
                assert!(error.to_string().starts_with(&format!("{name} is")), "{error}");
            }
        }
        for tolerance in [f64::NAN, 0.0, 9e-13, 1.1] {
            let options = Options { tolerance, ..Options::default() };
            let error = test(&Elements { from: good, to: good }, &options).unwrap_err();
            assert!(error.to_string().starts_with("tolerance is"), "{error}");
        }
    }
}

/// What slides in its own plane touches from the start, and no limit of boxes is too small.
#[test]
fn the_search_gives_up_on_the_safe_side() {
    let [p, q, r] = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let near = DVec3::new(-1.0, 0.3, 0.0);
    let elements = Elements { from: [near, p, q, r], to: [near + DVec3::X * 1.5, p, q, r] };
    for boxes_max in [0, 1, 10, 100, 100_000] {
        let found =
            ccd::vertex_face(&elements, &Options { boxes_max, ..Options::default() }).unwrap().unwrap();
        assert!(found.time <= 2.0 / 3.0, "{found:?}");
        assert_eq!(found.near, boxes_max > 10, "{found:?}");
    }
    for wild in [[5e-324; 3], [1e100, -1e100, 1e-100], [1e-300, 1.0, 1e16]] {
        let far = DVec3::from_array(wild);
        let elements = Elements { from: [far, p, q, r], to: [p, far, r, q] };
        for (_, _, test) in TESTS {
            let found = test(&elements, &Options::default()).unwrap();
            assert!(found.is_none_or(|impact| (0.0..=1.0).contains(&impact.time)));
        }
    }
}
