//! Which pairs collide, from when to when, and where.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use anyhow::Result;
use solid_scene::Scene;
use solid3d::glam::DVec3;
use solid3d::query::Manifold;

use super::{Frame, Hit, Recorder, Summary};
use crate::table::{self, Column, Style};
use crate::words;

const COLUMNS: [Column; 5] = [
    Column::Left("a"),
    Column::Left("b"),
    Column::Right("first [s]"),
    Column::Right("last [s]"),
    Column::Right("frames"),
];
/// When some response tells it.
const CONTACTS: Column = Column::Right("contacts");
/// When some response tells it.
const DEPTH: Column = Column::Right("deepest");
const PLACE: Column = Column::Left("where");

/// Keeps one entry per colliding pair, and counts.
#[derive(Debug, Default)]
pub struct PairRecorder {
    /// In the order in which they first collide.
    pairs: Vec<Pair>,
    places: HashMap<(usize, usize), usize>,
    summary: Summary,
}

/// The collisions of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pair {
    a: usize,
    b: usize,
    /// The time of the first frame, or of the first contact before it if that is known, and of the last frame, in seconds.
    first: f64,
    last: f64,
    frames: u64,
    /// The point at the first time.
    point: Option<DVec3>,
    /// The greatest number of points of contact in a frame.
    contacts: Option<u64>,
    /// The greatest depth.
    depth: Option<f64>,
}

/// The columns that some tables have.
#[derive(Clone, Copy)]
struct Told {
    contacts: bool,
    depth: bool,
}

impl PairRecorder {
    /// The numbers so far.
    pub fn summary(&self) -> Summary {
        Summary { pairs: words::size(self.pairs.len()), ..self.summary }
    }

    /// The pairs as a table, ended by an empty line; empty without collisions.
    pub fn table(&self, scene: &Scene, style: Style) -> String {
        if self.pairs.is_empty() {
            return String::new();
        }
        let told = Told {
            contacts: self.pairs.iter().any(|pair| pair.contacts.is_some()),
            depth: self.pairs.iter().any(|pair| pair.depth.is_some()),
        };
        let some = [told.contacts.then_some(CONTACTS), told.depth.then_some(DEPTH)];
        let columns: Vec<Column> =
            COLUMNS.into_iter().chain(some.into_iter().flatten()).chain([PLACE]).collect();
        table::draw(style, &columns, self.pairs.iter().map(|pair| pair.row(scene, told))) + "\n"
    }

    fn count(&mut self, frame: &Frame) {
        self.summary.frames += 1;
        self.summary.colliding_frames += u64::from(!frame.hits.is_empty());
        self.summary.collisions += words::size(frame.hits.len());
        for hit in frame.hits {
            match self.places.entry((hit.a, hit.b)) {
                Entry::Occupied(place) => self.pairs[*place.get()].extend(hit, frame.time),
                Entry::Vacant(place) => {
                    place.insert(self.pairs.len());
                    self.pairs.push(Pair::new(hit, frame.time));
                }
            }
        }
    }
}

impl Recorder for PairRecorder {
    fn frame(&mut self, _scene: &Scene, frame: &Frame) -> Result<()> {
        self.count(frame);
        Ok(())
    }
}

impl Pair {
    fn new(hit: &Hit, time: f64) -> Self {
        let first = hit.contact_time.unwrap_or(time);
        let depth = hit.depth.map(|depth| depth.depth);
        let contacts = contact_count(hit);
        Pair { a: hit.a, b: hit.b, first, last: time, frames: 1, point: hit.point, contacts, depth }
    }

    fn extend(&mut self, hit: &Hit, time: f64) {
        self.last = time;
        self.frames += 1;
        self.contacts = self.contacts.max(contact_count(hit));
        self.depth = self.depth.into_iter().chain(hit.depth.map(|depth| depth.depth)).reduce(f64::max);
    }

    fn row(&self, scene: &Scene, told: Told) -> Vec<String> {
        let [a, b] = [self.a, self.b].map(|object| words::printable(scene.objects()[object].name()));
        let place = self.point.map_or("-".to_owned(), words::point);
        let contacts = told.contacts.then(|| self.contacts.map_or("-".to_owned(), |count| count.to_string()));
        let depth = told.depth.then(|| self.depth.map_or("-".to_owned(), words::figure));
        let known = [a, b, words::seconds(self.first), words::seconds(self.last), self.frames.to_string()];
        known.into_iter().chain(contacts).chain(depth).chain([place]).collect()
    }
}

fn contact_count(hit: &Hit) -> Option<u64> {
    let count = |manifolds: &[Manifold]| manifolds.iter().map(|manifold| manifold.points.len()).sum();
    hit.contacts.as_deref().map(count).map(words::size)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hit(a: usize, b: usize) -> Hit {
        let (point, normal, curve) = (Some(DVec3::X), None, None);
        Hit { a, b, point, normal, curve, depth: None, contacts: None, contact_time: None }
    }

    #[test]
    fn a_pair_lasts_from_its_first_frame_to_its_last() {
        let mut recorder = PairRecorder::default();
        let frames: [&[Hit]; 4] = [&[], &[hit(0, 1), hit(1, 2)], &[], &[hit(0, 1), hit(0, 2)]];
        for (number, hits) in (0..).zip(frames) {
            let (time, rays, sightings) = (number as f64, &[], &[]);
            recorder.count(&Frame { number, time, hits, near: None, rays, sightings });
        }
        let expected =
            Summary { frames: 4, colliding_frames: 2, collisions: 4, pairs: 3, ..Summary::default() };
        assert_eq!(recorder.summary(), expected);
        let pairs: Vec<_> = recorder.pairs.iter().map(|p| (p.a, p.b, p.first, p.last, p.frames)).collect();
        assert_eq!(pairs, [(0, 1, 1.0, 3.0, 2), (1, 2, 1.0, 1.0, 1), (0, 2, 3.0, 3.0, 1)]);
    }
}
