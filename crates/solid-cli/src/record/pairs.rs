//! Which pairs collide, from when to when, and where.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use anyhow::Result;
use solid_scene::Scene;
use solid3d::glam::DVec3;

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
    /// The greatest depth.
    depth: Option<f64>,
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
        let with_depth = self.pairs.iter().any(|pair| pair.depth.is_some());
        let depth = with_depth.then_some(DEPTH);
        let columns: Vec<Column> = COLUMNS.into_iter().chain(depth).chain([PLACE]).collect();
        table::draw(style, &columns, self.pairs.iter().map(|pair| pair.row(scene, with_depth))) + "\n"
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

    fn finish(&mut self, _summary: &Summary) -> Result<()> {
        Ok(())
    }
}

impl Pair {
    fn new(hit: &Hit, time: f64) -> Self {
        let first = hit.contact_time.unwrap_or(time);
        let depth = hit.depth.map(|depth| depth.depth);
        Pair { a: hit.a, b: hit.b, first, last: time, frames: 1, point: hit.point, depth }
    }

    fn extend(&mut self, hit: &Hit, time: f64) {
        self.last = time;
        self.frames += 1;
        self.depth = self.depth.into_iter().chain(hit.depth.map(|depth| depth.depth)).reduce(f64::max);
    }

    fn row(&self, scene: &Scene, with_depth: bool) -> Vec<String> {
        let [a, b] = [self.a, self.b].map(|object| words::printable(scene.objects()[object].name()));
        let place = self.point.map_or("-".to_owned(), words::point);
        let depth = with_depth.then(|| self.depth.map_or("-".to_owned(), words::figure));
        let known = [a, b, words::seconds(self.first), words::seconds(self.last), self.frames.to_string()];
        known.into_iter().chain(depth).chain([place]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hit(a: usize, b: usize) -> Hit {
        Hit { a, b, point: Some(DVec3::X), normal: None, curve: None, depth: None, contact_time: None }
    }

    #[test]
    fn a_pair_lasts_from_its_first_frame_to_its_last() {
        let mut recorder = PairRecorder::default();
        let frames: [&[Hit]; 4] = [&[], &[hit(0, 1), hit(1, 2)], &[], &[hit(0, 1), hit(0, 2)]];
        for (number, hits) in (0..).zip(frames) {
            recorder.count(&Frame { number, time: number as f64, hits, near: None });
        }
        let expected = Summary { frames: 4, colliding_frames: 2, collisions: 4, pairs: 3, near: None };
        assert_eq!(recorder.summary(), expected);
        let pairs: Vec<_> = recorder.pairs.iter().map(|p| (p.a, p.b, p.first, p.last, p.frames)).collect();
        assert_eq!(pairs, [(0, 1, 1.0, 3.0, 2), (1, 2, 1.0, 1.0, 1), (0, 2, 3.0, 3.0, 1)]);
    }
}
