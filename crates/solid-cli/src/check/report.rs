//! What a check says to a person.

use solid_scene::Scene;
use solid3d::Statistics;

use super::clock::Times;
use crate::record::PairRecorder;
use crate::table::Style;
use crate::{scene, words};

/// A finished check.
pub struct Report<'a> {
    pub scene: &'a Scene,
    pub pairs: &'a PairRecorder,
    pub statistics: Statistics,
    pub times: Times,
}

impl Report<'_> {
    /// The table of pairs, and a summary.
    pub fn text(&self, style: Style) -> String {
        let summary = self.pairs.summary();
        let frames = words::count(summary.frames, "frame");
        let verdict = match summary.pairs {
            0 => "no collisions".to_owned(),
            1 => format!("1 pair collides, in {} of {frames}", summary.colliding_frames),
            pairs => format!("{pairs} pairs collide, in {} of {frames}", summary.colliding_frames),
        };
        let amount = scene::amount(self.scene);
        let tests = words::count(self.statistics.candidates, "test");
        let rate = words::figure(self.times.frames_per_second(summary.frames));
        let table = self.pairs.table(self.scene, style);
        format!("{table}{verdict}\n{amount}, {frames}, {tests}, {rate} frames/s\n")
    }

    /// The work in counts, which repeat exactly, and in time, which does not.
    pub fn statistics(&self) -> String {
        let Statistics { candidates, cache_hits, box_tests, primitive_tests, collisions, .. } =
            self.statistics;
        let counts = [
            ("candidates", candidates),
            ("cache hits", cache_hits),
            ("box tests", box_tests),
            ("primitive tests", primitive_tests),
            ("collisions", collisions),
        ];
        let Times { load, moving, testing, writing } = self.times;
        let times = [("load", load), ("move", moving), ("test", testing), ("write", writing)];
        let counts = counts.iter().map(|(name, count)| format!("{name:<16}{count:>12}\n"));
        let times = times
            .iter()
            .map(|(name, time)| format!("{:<16}{:>12.3} s\n", format!("{name} time"), time.as_secs_f64()));
        counts.chain(times).collect()
    }
}
