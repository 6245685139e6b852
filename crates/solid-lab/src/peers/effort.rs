use std::time::Duration;

/// How much to measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// Everything, in minutes.
    Full,
    /// Small samples, and without what takes seconds to set up.
    Quick,
    /// Everything once, on inputs so small that a test can do it; rows keep the names of the true sizes.
    Smoke,
}

/// No input of a smoke test has more parts than this.
const SMOKE_SIZE_MAX: usize = 200;

impl Effort {
    /// For how long the contestants of a case take turns.
    pub fn budget(self) -> Duration {
        Duration::from_millis(match self {
            Effort::Full => 700,
            Effort::Quick => 60,
            Effort::Smoke => 0,
        })
    }

    /// So many turns each has at least.
    pub fn rounds_min(self) -> usize {
        if self == Effort::Full { 3 } else { 1 }
    }

    /// How many inputs to draw, of `full`.
    pub fn sample(self, full: usize) -> usize {
        match self {
            Effort::Full => full,
            Effort::Quick => full.div_ceil(5),
            Effort::Smoke => full.min(10),
        }
    }

    /// How large to make an input of so many triangles, objects or vertices.
    pub fn size(self, full: usize) -> usize {
        if self == Effort::Smoke { full.min(SMOKE_SIZE_MAX) } else { full }
    }

    /// Whether to measure inputs that take seconds to set up.
    pub fn large(self) -> bool {
        self != Effort::Quick
    }
}
