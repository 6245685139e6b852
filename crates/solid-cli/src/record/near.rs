//! Which pairs come nearer than their clearance.

use anyhow::Result;
use solid_scene::Scene;

use super::encounters::{Encounters, Sight};
use super::{Frame, NearSummary, Pass, Recorder};
use crate::table::Style;
use crate::words;

/// Keeps one entry per pair that is near at some time, and counts.
#[derive(Debug, Default)]
pub struct NearRecorder(Encounters<Pass>);

impl Sight for Pass {
    fn pair(&self) -> (usize, usize) {
        (self.a, self.b)
    }

    fn distance(&self) -> f64 {
        self.distance
    }
}

impl NearRecorder {
    /// The numbers so far.
    pub fn summary(&self) -> NearSummary {
        let pairs = self.0.entries();
        NearSummary {
            near_frames: self.0.frames(),
            near_pairs: words::size(pairs.len()),
            least_distance: pairs.iter().map(|pair| pair.nearest.distance).reduce(f64::min),
        }
    }

    /// The pairs as a table, ended by an empty line; empty without any.
    pub fn table(&self, scene: &Scene, style: Style) -> String {
        self.0.table(style, ["a", "b", "on a", "on b"], |&Pass { a, b, points, .. }| {
            let [a, b] = [a, b].map(|object| words::printable(scene.objects()[object].name()));
            let [on_a, on_b] = points.map(words::point);
            [a, b, on_a, on_b]
        })
    }
}

impl Recorder for NearRecorder {
    fn frame(&mut self, _scene: &Scene, frame: &Frame) -> Result<()> {
        self.0.count(frame.near.unwrap_or_default(), frame.time);
        Ok(())
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
            recorder.0.count(near, time);
        }
        let expected = NearSummary { near_frames: 3, near_pairs: 2, least_distance: Some(-0.1) };
        assert_eq!(recorder.summary(), expected);
        let first = recorder.0.entries()[0];
        assert_eq!((first.first, first.last, first.frames, first.time), (0.0, 3.0, 3, 2.0));
    }
}
