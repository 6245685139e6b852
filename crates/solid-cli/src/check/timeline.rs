//! The times of the frames.

use anyhow::{Result, bail};

/// How many frames a check may have: hours of work even for a small scene, and a bound on what a slip of the pen costs.
pub const FRAMES_MAX: u64 = 10_000_000;

/// By what part of a frame the last one may come after the end, to be counted nevertheless: durations are often written in
/// decimals or computed in `f32` (relative error 6e-8), so that 2.3 s may come out as 68.99999 frames of 1/30 s.
const FRAME_TOLERANCE: f64 = 1e-3;

/// Frames at regular times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timeline {
    from: f64,
    to: f64,
    fps: f64,
    frames: u64,
}

impl Timeline {
    /// The frames from one time to another, both in seconds and included; `fps` is above 0.
    pub fn between(from: f64, to: f64, fps: f64) -> Result<Timeline> {
        if from > to {
            bail!("--from is {from:?}, after the end at {to:?}; expected at most that");
        }
        let last = (to - from) * fps + FRAME_TOLERANCE;
        if last >= FRAMES_MAX as f64 {
            let seconds = to - from;
            bail!(
                "{seconds:?} seconds at {fps:?} frames per second make more than {FRAMES_MAX} frames, the limit"
            );
        }
        Ok(Timeline { from, to, fps, frames: last as u64 + 1 })
    }

    /// The frames from 0 to a last one.
    pub fn until(last: u64, fps: f64) -> Result<Timeline> {
        if last >= FRAMES_MAX {
            bail!("frame {last} is beyond the limit of {FRAMES_MAX} frames");
        }
        Ok(Timeline { from: 0.0, to: f64::INFINITY, fps, frames: last + 1 })
    }

    /// How many frames there are.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// The time of a frame, in seconds; not after the end, where an animation may begin anew.
    pub fn time(&self, frame: u64) -> f64 {
        (self.from + frame as f64 / self.fps).min(self.to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn between(from: f64, to: f64, fps: f64) -> Timeline {
        Timeline::between(from, to, fps).expect("the frames are few")
    }

    #[test]
    fn both_ends_are_included() {
        for (from, to, fps, frames) in
            [(0.0, 0.0, 30.0, 1), (0.0, 1.0, 30.0, 31), (0.5, 1.0, 10.0, 6), (0.0, 0.99, 10.0, 10)]
        {
            assert_eq!(between(from, to, fps).frames(), frames, "{from} {to} {fps}");
        }
    }

    #[test]
    fn rounding_loses_no_frame_and_passes_no_end() {
        for tenths in 0..1000 {
            for end in [f64::from(tenths) / 10.0, f64::from(tenths as f32 / 10.0)] {
                let timeline = between(0.0, end, 30.0);
                assert_eq!(timeline.frames(), u64::from(tenths as u32) * 3 + 1, "{end}");
                assert!(timeline.time(timeline.frames() - 1) <= end);
            }
        }
    }

    #[test]
    fn times_are_regular() {
        assert_eq!(between(1.0, 2.0, 4.0).time(3), 1.75);
        assert_eq!(Timeline::until(7, 2.0).expect("few").time(7), 3.5);
    }

    #[test]
    fn endless_timelines_are_refused() {
        assert!(Timeline::between(2.0, 1.0, 30.0).is_err());
        assert!(Timeline::between(0.0, 1e300, 1e300).is_err());
        assert!(Timeline::until(u64::MAX, 1.0).is_err());
        assert_eq!(Timeline::until(FRAMES_MAX - 1, 1.0).expect("at the limit").frames(), FRAMES_MAX);
    }
}
