//! Playing a scene: every frame is shown, tested and recorded.

use anyhow::Result;
use solid_scene::Scene;

use super::clock::{Clock, Times};
use super::stage::Stage;
use super::timeline::Timeline;
use crate::progress::Progress;
use crate::record::{Frame, PairRecorder, Recorder};

/// What it takes to play a scene.
pub struct Player<'a> {
    pub scene: &'a Scene,
    pub stage: Stage<'a>,
    /// What else records the frames than the pairs.
    pub recorders: Vec<Box<dyn Recorder>>,
    pub clock: Clock,
    pub times: Times,
}

impl Player<'_> {
    /// Plays all frames. Returns the pairs that collide.
    pub fn play(&mut self, timeline: &Timeline) -> Result<PairRecorder> {
        let Player { scene, stage, recorders, clock, times } = self;
        let mut pairs = PairRecorder::default();
        let mut progress = Progress::new(timeline.frames());
        let mut hits = Vec::new();
        for number in 0..timeline.frames() {
            let time = timeline.time(number);
            stage.show(number, time)?;
            clock.lap(&mut times.moving);
            stage.test(&mut hits);
            clock.lap(&mut times.testing);
            let frame = Frame { number, time, hits: &hits };
            pairs.frame(scene, &frame)?;
            recorders.iter_mut().try_for_each(|recorder| recorder.frame(scene, &frame))?;
            progress.done(number + 1);
            clock.lap(&mut times.writing);
        }
        let summary = pairs.summary();
        recorders.iter_mut().try_for_each(|recorder| recorder.finish(&summary))?;
        clock.lap(&mut times.writing);
        Ok(pairs)
    }
}
