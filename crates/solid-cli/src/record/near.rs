//! Which pairs come nearer than their clearance, from when to when, and how near.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use anyhow::Result;
use solid_scene::Scene;

use super::{Frame, NearSummary, Pass, Recorder, Summary};
use crate::table::{self, Column, Style};
use crate::words;

const COLUMNS: [Column; 9] = [
    Column::Left("a"),
    Column::Left("b"),
    Column::Right("first [s]"),
    Column::Right("last [s]"),
    Column::Right("frames"),
    Column::Right("nearest"),
    Column::Right("at [s]"),
    Column::Left("on a"),
    Column::Left("on b"),
];

/// Keeps one entry per pair that is near at some time, and counts.
#[derive(Debug, Default)]
pub struct NearRecorder {
    /// In the order in which they are first near.
    pairs: Vec<Pair>,
    places: HashMap<(usize, usize), usize>,
    frames: u64,
}

/// A pair that is near.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pair {
    /// The times of the first and last frame, in seconds.
    first: f64,
    last: f64,
    frames: u64,
    /// Where it is nearest, for the first time.
    nearest: Pass,
    /// When, in seconds.
    time: f64,
}

impl NearRecorder {
    /// The numbers so far.
    pub fn summary(&self) -> NearSummary {
        NearSummary {
            near_frames: self.frames,
            near_pairs: words::size(self.pairs.len()),
            least_distance: self.pairs.iter().map(|pair| pair.nearest.distance).reduce(f64::min),
        }
    }

    /// The pairs as a table, ended by an empty line; empty without any.
    pub fn table(&self, scene: &Scene, style: Style) -> String {
        if self.pairs.is_empty() {
            return String::new();
        }
        table::draw(style, &COLUMNS, self.pairs.iter().map(|pair| pair.row(scene))) + "\n"
    }

    fn count(&mut self, near: &[Pass], time: f64) {
        self.frames += u64::from(!near.is_empty());
        for &pass in near {
            match self.places.entry((pass.a, pass.b)) {
                Entry::Occupied(place) => self.pairs[*place.get()].extend(pass, time),
                Entry::Vacant(place) => {
                    place.insert(self.pairs.len());
                    self.pairs.push(Pair { first: time, last: time, frames: 1, nearest: pass, time });
                }
            }
        }
    }
}

impl Recorder for NearRecorder {
    fn frame(&mut self, _scene: &Scene, frame: &Frame) -> Result<()> {
        self.count(frame.near.unwrap_or_default(), frame.time);
        Ok(())
    }

    fn finish(&mut self, _summary: &Summary) -> Result<()> {
        Ok(())
    }
}

impl Pair {
    fn extend(&mut self, pass: Pass, time: f64) {
        self.last = time;
        self.frames += 1;
        if pass.distance < self.nearest.distance {
            (self.nearest, self.time) = (pass, time);
        }
    }

    fn row(&self, scene: &Scene) -> Vec<String> {
        let Pass { a, b, distance, points, .. } = self.nearest;
        let [a, b] = [a, b].map(|object| words::printable(scene.objects()[object].name()));
        let [on_a, on_b] = points.map(words::point);
        let [first, last, time] = [self.first, self.last, self.time].map(words::seconds);
        vec![a, b, first, last, self.frames.to_string(), words::figure(distance), time, on_a, on_b]
    }
}

#[cfg(test)]
mod tests {
    use solid3d::glam::DVec3;

    use super::*;

    #[test]
    fn a_pair_is_kept_where_it_is_nearest() {
        let pass = |a, b, distance| Pass { a, b, distance, points: [DVec3::X; 2], normal: DVec3::Y };
        let mut recorder = NearRecorder::default();
        assert_eq!(recorder.summary(), NearSummary::default());
        let frames: [&[Pass]; 4] =
            [&[pass(0, 1, 0.3)], &[], &[pass(0, 1, -0.1), pass(1, 2, 0.2)], &[pass(0, 1, -0.1)]];
        for (time, near) in [0.0, 1.0, 2.0, 3.0].into_iter().zip(frames) {
            recorder.count(near, time);
        }
        let expected = NearSummary { near_frames: 3, near_pairs: 2, least_distance: Some(-0.1) };
        assert_eq!(recorder.summary(), expected);
        let first = recorder.pairs[0];
        assert_eq!((first.first, first.last, first.frames, first.time), (0.0, 3.0, 3, 2.0));
    }
}
