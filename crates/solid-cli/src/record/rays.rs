//! What rays meet, from when to when, and where it is nearest.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use anyhow::Result;
use solid_scene::Scene;

use super::{Frame, RaySummary, Recorder, Sighting, Summary};
use crate::rays::NamedRay;
use crate::table::{self, Column, Style};
use crate::words;

const COLUMNS: [Column; 9] = [
    Column::Left("ray"),
    Column::Left("object"),
    Column::Right("first [s]"),
    Column::Right("last [s]"),
    Column::Right("frames"),
    Column::Right("nearest"),
    Column::Right("at [s]"),
    Column::Left("where"),
    Column::Left("normal"),
];

/// Keeps one entry for each ray and object that it meets at some time, and counts.
#[derive(Debug, Default)]
pub struct RayRecorder {
    /// In the order in which they first meet.
    meetings: Vec<Meeting>,
    places: HashMap<(usize, usize), usize>,
    frames: u64,
}

/// A ray and an object that it meets.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Meeting {
    /// The times of the first and last frame, in seconds.
    first: f64,
    last: f64,
    frames: u64,
    /// Where it is nearest, for the first time.
    nearest: Sighting,
    /// When, in seconds.
    time: f64,
}

impl RayRecorder {
    /// The numbers so far.
    pub fn summary(&self) -> RaySummary {
        RaySummary { ray_frames: self.frames, ray_meetings: words::size(self.meetings.len()) }
    }

    /// The rays and what they meet as a table, ended by an empty line; empty when they meet nothing.
    pub fn table(&self, scene: &Scene, rays: &[NamedRay], style: Style) -> String {
        if self.meetings.is_empty() {
            return String::new();
        }
        table::draw(style, &COLUMNS, self.meetings.iter().map(|meeting| meeting.row(scene, rays))) + "\n"
    }

    fn count(&mut self, sightings: &[Sighting], time: f64) {
        self.frames += u64::from(!sightings.is_empty());
        for &sighting in sightings {
            match self.places.entry((sighting.ray, sighting.object)) {
                Entry::Occupied(place) => self.meetings[*place.get()].extend(sighting, time),
                Entry::Vacant(place) => {
                    place.insert(self.meetings.len());
                    self.meetings.push(Meeting {
                        first: time,
                        last: time,
                        frames: 1,
                        nearest: sighting,
                        time,
                    });
                }
            }
        }
    }
}

impl Recorder for RayRecorder {
    fn frame(&mut self, _scene: &Scene, frame: &Frame) -> Result<()> {
        self.count(frame.sightings, frame.time);
        Ok(())
    }

    fn finish(&mut self, _summary: &Summary) -> Result<()> {
        Ok(())
    }
}

impl Meeting {
    fn extend(&mut self, sighting: Sighting, time: f64) {
        self.last = time;
        self.frames += 1;
        if sighting.distance < self.nearest.distance {
            (self.nearest, self.time) = (sighting, time);
        }
    }

    fn row(&self, scene: &Scene, rays: &[NamedRay]) -> Vec<String> {
        let Sighting { ray, object, distance, point, normal, .. } = self.nearest;
        let [ray, object] = [rays[ray].name.as_str(), scene.objects()[object].name()].map(words::printable);
        let [first, last, time] = [self.first, self.last, self.time].map(words::seconds);
        let normal = normal.map_or("-".to_owned(), words::point);
        let (frames, distance) = (self.frames.to_string(), words::figure(distance));
        vec![ray, object, first, last, frames, distance, time, words::point(point), normal]
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
            primitive: 0,
            distance,
            point: DVec3::X,
            normal: None,
        };
        let mut recorder = RayRecorder::default();
        let frames: [&[Sighting]; 3] =
            [&[sighting(0, 1, 3.0), sighting(0, 2, 4.0)], &[], &[sighting(0, 1, 2.0)]];
        for (time, sightings) in [0.0, 1.0, 2.0].into_iter().zip(frames) {
            recorder.count(sightings, time);
        }
        assert_eq!(recorder.summary(), RaySummary { ray_frames: 2, ray_meetings: 2 });
        let first = recorder.meetings[0];
        assert_eq!((first.first, first.last, first.frames, first.time), (0.0, 2.0, 2, 2.0));
        assert_eq!(first.nearest, sighting(0, 1, 2.0));
    }
}
