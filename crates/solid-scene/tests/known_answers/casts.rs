//! A mesh that moves in a straight line until it hits another: by a cast, and by stepping forward by the distance, which never
//! passes the first contact either.

use glam::{DAffine3, DVec3};
use solid3d::{Shape, query};

use crate::data::{Row, folder, for_each_row, json, model};
use crate::tally::Tally;

/// Contact is reached when the distance is less than this, relative to the size.
const CONTACT: f64 = 1e-10;

/// How far our time of impact may be off, as a path relative to the size. Along a flat approach a distance of [`CONTACT`]
/// is reached a good deal before the impact.
const PATH_ERROR: f64 = 1e-6;

/// How far the time of a cast may be off, as such a path.
const CAST_ERROR: f64 = 1e-9;

/// A flat approach takes many steps; none in the data took half as many.
const STEPS_MAX: usize = 4000;

#[test]
fn bunny_torus() {
    check("bunny_torus");
}

#[test]
fn fcl_env_rob() {
    check("fcl_env_rob");
}

#[test]
fn teapot_teapot() {
    check("teapot_teapot");
}

struct Cast {
    a: Shape,
    b: Shape,
    size: f64,
}

fn check(name: &str) {
    let Some(folder) = folder("casts") else { return };
    let facts = json(&folder.join(format!("{name}.json")));
    let shape = |name: &str| model(facts[name].as_str().unwrap()).unwrap();
    let cast = Cast { a: shape("A"), b: shape("B"), size: facts["size"].as_f64().unwrap() };
    let mut tally = Tally::new(format!("{name} casts"));
    let (mut steps_most, mut grazing) = (0, 0);
    for_each_row(&folder.join(format!("{name}.csv")), |row| {
        let (label, toi) = (format!("row {}", row.text("id")), row.number::<f64>("toi"));
        let length = row.vector("v", "").length();
        let path = PATH_ERROR * cast.size / length;
        let (found, steps) = cast.time_of_impact(&row);
        steps_most = steps_most.max(steps);
        tally.hit(&label, toi.is_some(), found.is_some_and(|t| t <= 1.0));
        if let (Some(toi), Some(found)) = (toi, found) {
            tally.error(&label, (toi - found).abs() * length / cast.size, PATH_ERROR);
            tally.check(found <= toi + 1e-12 * cast.size / length, || format!("{label}: {found} past {toi}"));
            tally.check(toi <= path || !cast.intersects(&row, toi - path), || {
                format!("{label}: hit too early")
            });
            grazing += usize::from(!cast.intersects(&row, toi + path));
        }
        let swept = cast.sweep(&row);
        tally.hit(&label, toi.is_some(), swept.is_some());
        if let (Some(toi), Some(swept)) = (toi, swept) {
            let off = (toi - swept) * length / cast.size;
            tally.error(&label, off.abs(), CAST_ERROR);
            tally.check(off > -1e-12, || format!("{label}: cast to {swept}, past {toi}"));
        }
        for quarter in 0..4 {
            let t = 0.25 * f64::from(quarter);
            tally.check(toi.is_some_and(|toi| toi <= t) || !cast.intersects(&row, t), || {
                format!("{label}: hit at {t}")
            });
        }
    });
    println!("{name}: {steps_most} steps at most, {grazing} rows without an overlap just after the impact");
    tally.finish();
}

impl Cast {
    fn at(&self, row: &Row, t: f64) -> DAffine3 {
        let start = row.placement("");
        DAffine3 { translation: start.translation + row.vector("v", "") * t, ..start }
    }

    fn intersects(&self, row: &Row, t: f64) -> bool {
        query::intersects(&self.a, &DAffine3::IDENTITY, &self.b, &self.at(row, t)).unwrap()
    }

    /// The time by a cast.
    fn sweep(&self, row: &Row) -> Option<f64> {
        let here = DAffine3::IDENTITY;
        let (at, motion) = (self.at(row, 0.0), row.vector("v", ""));
        let cast = query::cast_shape(&self.a, &here, DVec3::ZERO, &self.b, &at, motion).unwrap();
        cast.map(|cast| cast.time)
    }

    /// Conservative advancement; the time, at most 1 or `None`, and the number of steps.
    fn time_of_impact(&self, row: &Row) -> (Option<f64>, usize) {
        let speed = row.vector("v", "").length();
        let mut t = 0.0;
        for step in 0..STEPS_MAX {
            let at = self.at(row, t);
            let distance = query::distance(&self.a, &DAffine3::IDENTITY, &self.b, &at).unwrap().distance;
            if distance <= CONTACT * self.size {
                return (Some(t), step);
            }
            t += distance / speed;
            if t > 1.0 {
                return (None, step);
            }
        }
        panic!("row {}: no end at {t}", row.text("id"));
    }
}
