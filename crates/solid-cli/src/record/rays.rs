//! What rays meet.

use anyhow::Result;
use solid_scene::Scene;

use super::encounters::{Encounters, Sight};
use super::{Frame, RaySummary, Recorder, Sighting};
use crate::rays::NamedRay;
use crate::table::Style;
use crate::words;

/// Keeps one entry for each ray and object that it meets at some time, and counts.
#[derive(Debug, Default)]
pub struct RayRecorder(Encounters<Sighting>);

impl Sight for Sighting {
    fn pair(&self) -> (usize, usize) {
        (self.ray, self.object)
    }

    fn distance(&self) -> f64 {
        self.distance
    }
}

impl RayRecorder {
    /// The numbers so far.
    pub fn summary(&self) -> RaySummary {
        RaySummary { ray_frames: self.0.frames(), ray_meetings: words::size(self.0.entries().len()) }
    }

    /// The rays and what they meet as a table, ended by an empty line; empty when they meet nothing.
    pub fn table(&self, scene: &Scene, rays: &[NamedRay], style: Style) -> String {
        self.0.table(style, ["ray", "object", "where", "normal"], |sighting| {
            let &Sighting { ray, object, point, normal, .. } = sighting;
            let [ray, object] =
                [rays[ray].name.as_str(), scene.objects()[object].name()].map(words::printable);
            [ray, object, words::point(point), normal.map_or("-".to_owned(), words::point)]
        })
    }
}

impl Recorder for RayRecorder {
    fn frame(&mut self, _scene: &Scene, frame: &Frame) -> Result<()> {
        self.0.count(frame.sightings, frame.time);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use solid3d::glam::DVec3;

    use super::*;

    #[test]
    fn a_meeting_is_kept_where_it_is_nearest() {
        let sighting = |ray, object, distance| Sighting {
            ray,
            object,
            primitive: Some(0),
            distance,
            point: DVec3::X,
            normal: None,
        };
        let mut recorder = RayRecorder::default();
        let frames: [&[Sighting]; 3] =
            [&[sighting(0, 1, 3.0), sighting(0, 2, 4.0)], &[], &[sighting(0, 1, 2.0)]];
        for (time, sightings) in [0.0, 1.0, 2.0].into_iter().zip(frames) {
            recorder.0.count(sightings, time);
        }
        assert_eq!(recorder.summary(), RaySummary { ray_frames: 2, ray_meetings: 2 });
        let first = recorder.0.entries()[0];
        assert_eq!((first.first, first.last, first.frames, first.time), (0.0, 2.0, 2, 2.0));
        assert_eq!(first.nearest, sighting(0, 1, 2.0));
    }
}
