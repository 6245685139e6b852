//! Where the time goes.

use std::time::{Duration, Instant};

/// Measures the parts of a work that follow one another.
pub struct Clock {
    last: Instant,
}

impl Clock {
    /// Starts now.
    pub fn start() -> Self {
        Clock { last: Instant::now() }
    }

    /// Adds what has passed since the last lap to a part.
    pub fn lap(&mut self, part: &mut Duration) {
        let now = Instant::now();
        *part += now - self.last;
        self.last = now;
    }
}

/// The time that the parts of a check took.
#[derive(Clone, Copy, Debug, Default)]
pub struct Times {
    pub load: Duration,
    /// Sampling the animation, and placing and deforming the objects.
    pub moving: Duration,
    pub testing: Duration,
    pub writing: Duration,
}

impl Times {
    /// Frames per second, of moving and testing.
    pub fn frames_per_second(&self, frames: u64) -> f64 {
        frames as f64 / (self.moving + self.testing).as_secs_f64().max(f64::MIN_POSITIVE)
    }
}
