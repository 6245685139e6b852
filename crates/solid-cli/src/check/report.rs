//! What a check says to a person.

use solid_scene::Scene;
use solid3d::Statistics;

use super::clock::Times;
use super::player::Findings;
use crate::rays::NamedRay;
use crate::record::{NearSummary, RaySummary};
use crate::table::Style;
use crate::{scene, words};

/// A finished check.
pub struct Report<'a> {
    pub scene: &'a Scene,
    pub findings: &'a Findings,
    pub rays: &'a [NamedRay],
    pub statistics: Statistics,
    pub times: Times,
}

impl Report<'_> {
    /// The table of pairs, and a summary.
    pub fn text(&self, style: Style) -> String {
        let summary = self.findings.summary();
        let frames = words::count(summary.frames, "frame");
        let verdict = match summary.pairs {
            0 => "no collisions".to_owned(),
            1 => format!("1 pair collides, in {} of {frames}", summary.colliding_frames),
            pairs => format!("{pairs} pairs collide, in {} of {frames}", summary.colliding_frames),
        };
        let amount = scene::amount(self.scene);
        let tests = words::count(self.statistics.candidates, "test");
        let rate = words::figure(self.times.frames_per_second(summary.frames));
        let mut tables = self.findings.pairs.table(self.scene, style);
        let mut verdicts = verdict;
        if let Some(near) = &self.findings.near {
            tables += &near.table(self.scene, style);
            verdicts = format!("{verdicts}\n{}", nearness(&near.summary(), &frames));
        }
        if let Some(rays) = &self.findings.rays {
            tables += &rays.table(self.scene, self.rays, style);
            verdicts = format!("{verdicts}\n{}", view(&rays.summary(), self.rays.len(), &frames));
        }
        format!("{tables}{verdicts}\n{amount}, {frames}, {tests}, {rate} frames/s\n")
    }

    /// The work in counts, which repeat exactly, and in time, which does not.
    pub fn statistics(&self) -> String {
        let Statistics { candidates, examined, cache_hits, box_tests, primitive_tests, collisions, .. } =
            self.statistics;
        let counts = [
            ("candidates", candidates),
            ("examined", examined),
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

/// What is nearer than its clearance, in words.
fn nearness(summary: &NearSummary, frames: &str) -> String {
    let NearSummary { near_frames, near_pairs, least_distance } = summary;
    let Some(least) = least_distance else {
        return "in no frame is anything nearer than its clearance".to_owned();
    };
    let (pairs, are) = (words::count(*near_pairs, "pair"), words::are(*near_pairs));
    let least = words::figure(*least);
    format!(
        "{pairs} {are} nearer than the clearance, in {near_frames} of {frames}; the least distance is {least}"
    )
}

/// What rays meet, in words.
fn view(summary: &RaySummary, rays: usize, frames: &str) -> String {
    let RaySummary { ray_frames, ray_meetings } = summary;
    let meet = if rays == 1 { "meets" } else { "meet" };
    let rays = words::count(words::size(rays), "ray");
    match ray_meetings {
        0 => format!("{rays} {meet} nothing"),
        _ => format!("{rays} {meet} something, in {ray_frames} of {frames}"),
    }
}
