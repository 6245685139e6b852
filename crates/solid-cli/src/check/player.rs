//! Playing a scene: every frame is shown, tested and recorded.

use anyhow::Result;
use solid_scene::Scene;

use super::clock::{Clock, Times};
use super::crowd::Crowd;
use super::stage::Stage;
use super::timeline::Timeline;
use crate::progress::Progress;
use crate::rays::NamedRay;
use crate::record::{Frame, NearRecorder, PairRecorder, RayRecorder, Recorder, Summary};

/// What it takes to play a scene.
pub struct Player<'a> {
    pub scene: &'a Scene,
    pub stage: Stage<'a>,
    pub crowd: Crowd,
    /// Whether some pair has a clearance.
    pub has_clearance: bool,
    /// What is cast in every frame.
    pub rays: Vec<NamedRay>,
    /// What else records the frames than the pairs.
    pub recorders: Vec<Box<dyn Recorder>>,
    pub clock: Clock,
    pub times: Times,
}

/// What was found in all frames.
#[derive(Debug, Default)]
pub struct Findings {
    pub pairs: PairRecorder,
    /// What came nearer than its clearance, if there was any clearance.
    pub near: Option<NearRecorder>,
    /// What rays meet, if any is cast.
    pub rays: Option<RayRecorder>,
}

impl Findings {
    /// All of it in numbers.
    pub fn summary(&self) -> Summary {
        let near = self.near.as_ref().map(NearRecorder::summary);
        let rays = self.rays.as_ref().map(RayRecorder::summary);
        Summary { near, rays, ..self.pairs.summary() }
    }
}

impl Player<'_> {
    /// Plays all frames.
    pub fn play(&mut self, timeline: &Timeline) -> Result<Findings> {
        let Player { scene, stage, crowd, has_clearance, rays, recorders, clock, times } = self;
        let near = has_clearance.then(NearRecorder::default);
        let of_rays = (!rays.is_empty()).then(RayRecorder::default);
        let mut findings = Findings { near, rays: of_rays, ..Findings::default() };
        let (mut passes, mut sightings) = (Vec::new(), Vec::new());
        let mut progress = Progress::new(timeline.frames());
        let mut hits = Vec::new();
        for number in 0..timeline.frames() {
            let time = timeline.time(number);
            stage.show(number, time)?;
            clock.lap(&mut times.moving);
            crowd.refuse(stage, time)?;
            if *has_clearance {
                stage.near(&mut passes);
            }
            stage.test(&mut hits);
            stage.cast(rays, &mut sightings);
            clock.lap(&mut times.testing);
            let near = has_clearance.then_some(passes.as_slice());
            let frame = Frame { number, time, hits: &hits, near, rays, sightings: &sightings };
            findings.pairs.frame(scene, &frame)?;
            findings.near.iter_mut().try_for_each(|near| near.frame(scene, &frame))?;
            findings.rays.iter_mut().try_for_each(|rays| rays.frame(scene, &frame))?;
            recorders.iter_mut().try_for_each(|recorder| recorder.frame(scene, &frame))?;
            progress.done(number + 1);
            clock.lap(&mut times.writing);
        }
        let summary = findings.summary();
        recorders.iter_mut().try_for_each(|recorder| recorder.finish(&summary))?;
        clock.lap(&mut times.writing);
        Ok(findings)
    }
}
