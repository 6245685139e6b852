//! Table 5.1: what an overlap test of two bounding volumes costs, and what a volume takes to store. Counted, by running the tests on
//! numbers that count.

use std::cell::Cell;
use std::cmp::Ordering;
use std::ops::{Add, Mul, Sub};

use anyhow::Result;
use serde::Serialize;

use super::chart::{Labels, bars};
use super::output::write_csv;
use super::{Claim, Kind, Report, Settings};
use crate::comparators::tree::{Sat, Scalar, exit_axis};

/// The thesis gives k-DOPs in k.
const K: usize = 9;

#[derive(Serialize)]
struct Row {
    volume: String,
    operations: u64,
    scalars: usize,
    thesis_operations: f64,
    thesis_scalars: f64,
}

/// Runs it.
pub fn run(settings: &Settings) -> Result<Report> {
    let rows = rows();
    write_csv(settings, "operations", &rows)?;
    let groups: Vec<String> = rows.iter().map(|row| row.volume.clone()).collect();
    let series = [
        ("thesis".to_owned(), rows.iter().map(|row| row.thesis_operations).collect()),
        ("counted here".to_owned(), rows.iter().map(|row| row.operations as f64).collect()),
    ];
    let labels = Labels { title: "Cost of an overlap test, Table 5.1", x: "", y: "arithmetic operations" };
    bars(settings, "operations.svg", &labels, &groups, &series)?;
    let claims = rows.iter().flat_map(|row| {
        // "200 operations" for oriented boxes is a round number, from another paper.
        let cost = if row.scalars == 15 { Kind::Model } else { Kind::Count { error: 0.0 } };
        let claim = |what: &str, thesis, ours, kind| Claim {
            what: format!("{}: {what}", row.volume),
            thesis,
            ours,
            unit: "",
            kind,
        };
        [
            claim("operations", row.thesis_operations, row.operations as f64, cost),
            claim("scalars", row.thesis_scalars, row.scalars as f64, Kind::Count { error: 0.0 }),
        ]
    });
    let chart = ("operations.svg".to_owned(), "Operations of the overlap tests".to_owned());
    Ok(Report { claims: claims.collect(), charts: vec![chart] })
}

fn rows() -> Vec<Row> {
    let row = |volume: &str, operations, scalars, thesis: [f64; 2]| Row {
        volume: volume.to_owned(),
        operations,
        scalars,
        thesis_operations: thesis[0],
        thesis_scalars: thesis[1],
    };
    let k = K as f64;
    let (sphere, aabb, dop) = ([0.0; 4], ([0.0; 3], [1.0; 3]), ([0.0; K], [1.0; K]));
    let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    vec![
        row(
            "Sphere",
            cost(|n| {
                spheres_overlap(sphere.map(n), sphere.map(n));
            }),
            sphere.len(),
            [11.0, 4.0],
        ),
        row("AABB", slabs_cost(aabb), aabb.0.len() + aabb.1.len(), [9.0, 6.0]),
        row(&format!("{K}-DOP"), slabs_cost(dop), dop.0.len() + dop.1.len(), [3.0 * k, 2.0 * k]),
        row(
            "OBB",
            cost(|n| {
                let (center, half) = ([0.0; 3].map(n), [1.0; 3].map(n));
                let rotation = || identity.map(|axis| axis.map(n));
                oriented_boxes_overlap((rotation(), center, half), (rotation(), center, half));
            }),
            identity.as_flattened().len() + 3 + 3,
            [200.0, 15.0],
        ),
    ]
}

fn spheres_overlap<T: Scalar>([x, y, z, r]: [T; 4], [u, v, w, s]: [T; 4]) -> bool {
    let (x, y, z, reach) = (x - u, y - v, z - w, r + s);
    x * x + y * y + z * z <= reach * reach
}

/// Boxes and k-DOPs: the projections onto each axis, by centre and half size.
fn slabs_overlap<T: Scalar, const K: usize>((c, h): ([T; K], [T; K]), (d, g): ([T; K], [T; K])) -> bool {
    (0..K).all(|i| (c[i] - d[i]).abs() <= h[i] + g[i])
}

type Box3<T> = ([[T; 3]; 3], [T; 3], [T; 3]);

/// With the relative orientation, which other than in an AABB tree is another for each pair. Axes are rows.
fn oriented_boxes_overlap<T: Scalar>((a, c, h): Box3<T>, (b, d, g): Box3<T>) -> bool {
    let dot = |p: [T; 3], q: [T; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let between = [d[0] - c[0], d[1] - c[1], d[2] - c[2]];
    let r = a.map(|x| b.map(|y| dot(x, y)));
    let t = a.map(|x| dot(x, between));
    exit_axis(&r, &r.map(|row| row.map(Scalar::abs)), h, g, t, Sat::Full) == 0
}

fn slabs_cost<const K: usize>((center, half): ([f64; K], [f64; K])) -> u64 {
    cost(|n| {
        slabs_overlap((center.map(n), half.map(n)), (center.map(n), half.map(n)));
    })
}

/// How many operations a test of two volumes at the same place takes: all of them, since it finds nothing that separates.
fn cost(test: impl FnOnce(&dyn Fn(f64) -> Counted<'static>)) -> u64 {
    thread_local!(static COUNT: &'static Cell<u64> = Box::leak(Box::new(Cell::new(0))));
    COUNT.with(|count| {
        count.set(0);
        let count: &'static Cell<u64> = count;
        test(&move |value| Counted { value, count });
        count.get()
    })
}

/// A number that counts additions, subtractions, multiplications and comparisons; a magnitude costs nothing.
#[derive(Clone, Copy)]
struct Counted<'c> {
    value: f64,
    count: &'c Cell<u64>,
}

impl Counted<'_> {
    fn after(self, value: f64) -> Self {
        self.count.set(self.count.get() + 1);
        Counted { value, ..self }
    }
}

impl Add for Counted<'_> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.after(self.value + other.value)
    }
}

impl Sub for Counted<'_> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.after(self.value - other.value)
    }
}

impl Mul for Counted<'_> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.after(self.value * other.value)
    }
}

impl PartialEq for Counted<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl PartialOrd for Counted<'_> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.after(self.value).value.partial_cmp(&other.value)
    }
}

impl Scalar for Counted<'_> {
    fn abs(self) -> Self {
        Counted { value: self.value.abs(), ..self }
    }
}
