//! Vertices against faces and edges against edges over a time step, from simulations and from hand. The exact answer tells
//! whether and when they first meet; so until then, and at both ends of the step where they never do, they are apart.

use std::collections::HashMap;
use std::path::Path;

use glam::{DAffine3, DVec3};
use solid_oracle::{triangle_distance, triangles_intersect};
use solid3d::{Shape, query};

use crate::data::{folder, for_each_row, mesh};
use crate::tally::Tally;

/// The error of a distance relative to the size of the query.
const DISTANCE_ERROR: f64 = 1e-12;

/// The error of interpolated positions relative to the size and the path together: so near, rounding decides.
const IMPACT_ERROR: f64 = 1e-14;

#[derive(Clone, Copy)]
enum Kind {
    VertexFace,
    EdgeEdge,
}

/// Four vertices at the start and at the end of a step.
struct Query {
    kind: Kind,
    start: [DVec3; 4],
    end: [DVec3; 4],
    /// When they first meet, where they do.
    toi: Option<f64>,
}

impl Query {
    fn at(&self, t: f64) -> [DVec3; 4] {
        // Exact at both ends.
        [0, 1, 2, 3]
            .map(|i| if t == 1.0 { self.end[i] } else { self.start[i] + (self.end[i] - self.start[i]) * t })
    }

    /// The two as triangles, degenerate for a vertex and an edge.
    fn triangles(&self, t: f64) -> [[DVec3; 3]; 2] {
        let [p, q, r, s] = self.at(t);
        match self.kind {
            Kind::VertexFace => [[p; 3], [q, r, s]],
            Kind::EdgeEdge => [[p, q, q], [r, s, s]],
        }
    }

    fn size(&self) -> f64 {
        let all = || self.start.iter().chain(&self.end);
        let low = all().copied().reduce(DVec3::min).unwrap();
        let high = all().copied().reduce(DVec3::max).unwrap();
        (high - low).length() + low.abs().max(high.abs()).length()
    }

    fn check(&self, tally: &mut Tally, label: &str) {
        let size = self.size();
        // Times before the impact, and whether the two meet then.
        let apart = match self.toi {
            Some(0.0) => vec![],
            Some(toi) => vec![0.0, 0.5 * toi],
            None => vec![0.0, 1.0],
        };
        let met = self.toi.map(|toi| (toi, true));
        for (t, expected) in apart.into_iter().map(|t| (t, false)).chain(met) {
            let triangles = self.triangles(t);
            let exact = triangles_intersect(&triangles[0], &triangles[1]);
            let gap = triangle_distance(&triangles[0], &triangles[1]);
            let label = || format!("{label}, at {t}");
            // Positions at the start and the end are exact, in between they are rounded.
            let rounded = t != 0.0 && t != 1.0 && gap <= IMPACT_ERROR * size;
            tally.check(exact == expected || rounded, || format!("{}: exactly {exact}, {gap:e}", label()));
            compare(tally, &label(), &triangles, (exact, gap), size);
        }
    }
}

/// Compares our answers, as meshes and as hulls, with exact ones for the same positions.
fn compare(
    tally: &mut Tally,
    label: &str,
    triangles: &[[DVec3; 3]; 2],
    (exact, gap): (bool, f64),
    size: f64,
) {
    let here = DAffine3::IDENTITY;
    let [a, b] = triangles.map(|corners| Shape::mesh(corners, [[0, 1, 2]]).unwrap());
    tally.hit(label, exact, query::intersects(&a, &here, &b, &here).unwrap());
    let distance = query::distance(&a, &here, &b, &here).unwrap().distance;
    tally.error(label, (distance - gap).abs() / size, DISTANCE_ERROR);

    // GJK may take a gap within its error for a touch.
    let [a, b] = triangles.map(|corners| Shape::convex_hull(&corners).unwrap());
    let found = query::intersects(&a, &here, &b, &here).unwrap();
    let close = gap <= DISTANCE_ERROR * size;
    tally.check(found == exact || (found && close), || format!("{label}: hulls {found}, exact gap {gap:e}"));
    let distance = query::distance(&a, &here, &b, &here).unwrap().distance;
    tally.error(label, (distance - gap).abs() / size, DISTANCE_ERROR);
}

#[test]
fn sample_queries() {
    let Some(folder) = folder("ccd/sample-queries") else { return };
    let mut files: HashMap<String, Vec<[f64; 6]>> = HashMap::new();
    let mut tally = Tally::new("ccd sample queries");
    for_each_row(&folder.join("toi.csv"), |row| {
        let (file, number) = (row.text("file"), row.number::<usize>("query").unwrap());
        let lines = files.entry(file.to_owned()).or_insert_with(|| read_queries(&folder.join(file)));
        let vertex = |i: usize| {
            let [x, x_d, y, y_d, z, z_d] = lines[8 * number + i];
            DVec3::new(x / x_d, y / y_d, z / z_d)
        };
        let kind = if file.contains("vertex-face") { Kind::VertexFace } else { Kind::EdgeEdge };
        let [start, end] = [0, 4].map(|first| [0, 1, 2, 3].map(|i| vertex(first + i)));
        let toi = row.number("toi");
        tally.check(toi.is_some() == row.flag("ground_truth"), || format!("{file} {number}: bad data"));
        Query { kind, start, end, toi }.check(&mut tally, &format!("{file} {number}"));
    });
    tally.finish();
}

/// Numerators and denominators of positions; the last column is left out.
fn read_queries(path: &Path) -> Vec<[f64; 6]> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_path(path).unwrap();
    let number = |text: &str| text.parse::<f64>().unwrap();
    reader
        .records()
        .map(|record| {
            let record = record.unwrap();
            [0, 1, 2, 3, 4, 5].map(|i| number(&record[i]))
        })
        .collect()
}

#[test]
fn armadillo_rollers() {
    check_simulation("armadillo-rollers", ["326.ply", "327.ply"]);
}

#[test]
fn cloth_funnel() {
    check_simulation("cloth-funnel", ["227.ply", "228.ply"]);
}

fn check_simulation(scene: &str, frames: [&str; 2]) {
    let Some(folder) = folder("ccd/scalable") else { return };
    let [start, end] = frames.map(|frame| mesh(&folder.join(scene).join(frame)));
    for (file, kind) in [("vf.csv", Kind::VertexFace), ("ee.csv", Kind::EdgeEdge)] {
        let mut tally = Tally::new(format!("{scene} {file}"));
        let mut count = 0;
        for_each_row(&folder.join(scene).join(file), |row| {
            count += 1;
            let indices = ["i0", "i1", "i2", "i3"].map(|column| row.number::<usize>(column).unwrap());
            let [start, end] = [&start, &end].map(|mesh| indices.map(|i| mesh.vertices().unwrap()[i]));
            Query { kind, start, end, toi: row.number("toi") }.check(&mut tally, &format!("{file} {count}"));
        });
        tally.finish();
    }
}
