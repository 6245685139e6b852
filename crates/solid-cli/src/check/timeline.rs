//! The times of the frames.

use anyhow::{Result, bail};

/// How many frames a check may have: hours of work even for a small scene, and a bound on what a slip of the pen costs.
pub const FRAMES_MAX: u64 = 10_000_000;

/// By what part of a frame the end may come after a frame and still be that: durations are often written in few decimals, so
/// that a third of 20 s may come out as 200.001 frames of 1/30 s.
const FRAME_TOLERANCE: f64 = 1e-3;

/// The same, by what part of the time of the end: durations are often products of an `f32` and a step in `f32`, of a relative
/// error of 2^-24 each and as much for the product; and twice that.
const TIME_TOLERANCE: f64 = 1.0 / (1 << 22) as f64;

/// The most that both make: beyond a million frames an `f32` hardly tells frames apart.
const TOLERANCE_MAX: f64 = 0.25;

/// Frames at regular times, but for the last, which is at the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timeline {
    from: f64,
    to: f64,
    fps: f64,
    frames: u64,
}

impl Timeline {
    /// The frames from one time to another, both in seconds and a frame each; `fps` is above 0. Where the end is between two
    /// regular times, the last step is shorter.
    pub fn between(from: f64, to: f64, fps: f64) -> Result<Timeline> {
        if from > to {
            bail!("--from is {from:?}, after the end at {to:?}; expected at most that");
        }
        let tolerance = (FRAME_TOLERANCE + TIME_TOLERANCE * to * fps).min(TOLERANCE_MAX);
        let steps_min = if from < to { 1.0 } else { 0.0 };
        let last = ((to - from) * fps - tolerance).ceil().max(steps_min);
        if last >= FRAMES_MAX as f64 {
            let seconds = to - from;
            bail!(
                "{seconds:?} seconds at {fps:?} frames per second make more than {FRAMES_MAX} frames, the limit; \
                 an earlier end (--to) or a lower rate (--fps) makes fewer"
            );
        }
        Ok(Timeline { from, to, fps, frames: last as u64 + 1 })
    }

    /// The frames from 0 to a last one.
    pub fn until(last: u64, fps: f64) -> Result<Timeline> {
        if last >= FRAMES_MAX {
            bail!("frame {last} is beyond the limit of {FRAMES_MAX} frames");
        }
        Ok(Timeline { from: 0.0, to: last as f64 / fps, fps, frames: last + 1 })
    }

    /// How many frames there are.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// The time of a frame, in seconds; not after the end, where an animation may begin anew: all but the last are before it by more
    /// than rounding, as the tolerances are.
    pub fn time(&self, frame: u64) -> f64 {
        if frame + 1 == self.frames {
            return self.to;
        }
        self.from + frame as f64 / self.fps
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn between(from: f64, to: f64, fps: f64) -> Timeline {
        Timeline::between(from, to, fps).expect("the frames are few")
    }

    #[test]
    fn both_ends_are_frames() {
        for (from, to, fps, frames) in [
            (0.0, 0.0, 30.0, 1),
            (1e300, 1e300, 30.0, 1),
            (0.0, 1.0, 30.0, 31),
            (0.5, 1.0, 10.0, 6),
            (0.0, 0.99, 10.0, 11),
            (0.0, 1.0625, 10.0, 12),
            (0.25, 1.0, 10.0, 9),
            (0.0, 1e-9, 30.0, 2),
            (1e9, 1e9 + 0.05, 30.0, 3),
        ] {
            let timeline = between(from, to, fps);
            assert_eq!(timeline.frames(), frames, "{from} {to} {fps}");
            assert_eq!((timeline.time(0), timeline.time(frames - 1)), (from, to), "{from} {to} {fps}");
        }
    }

    #[test]
    fn the_last_step_is_shorter() {
        let timeline = between(0.0, 1.0625, 4.0);
        let times: Vec<f64> = (0..timeline.frames()).map(|frame| timeline.time(frame)).collect();
        assert_eq!(times, [0.0, 0.25, 0.5, 0.75, 1.0, 1.0625]);
    }

    /// Law: an end that is a frame but for rounding makes no other.
    #[test]
    fn rounding_neither_loses_nor_gains_a_frame() {
        for fps in [24.0, 25.0, 29.97, 30_000.0 / 1001.0, 30.0, 50.0, 60.0, 120.0, 1000.0] {
            for last in (0..3000).chain((3000..1_000_000).step_by(997)) {
                let end = f64::from(last) / fps;
                let step = (1.0 / fps) as f32;
                for end in
                    [end, f64::from(end as f32), f64::from(last as f32 * step), (end * 1e6).round() / 1e6]
                {
                    let timeline = between(0.0, end, fps);
                    assert_eq!(
                        timeline.frames(),
                        u64::from(last as u32) + 1,
                        "{last} frames of 1/{fps} s: {end}"
                    );
                    let times = [last - 1, last].map(|frame| timeline.time(frame.max(0) as u64));
                    assert!(times[0] < end || last == 0, "{times:?}, {end}");
                    assert_eq!(times[1], end);
                }
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
