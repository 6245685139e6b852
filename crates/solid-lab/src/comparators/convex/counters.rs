/// Work done by a convex test: counts that repeat exactly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Pairs examined.
    pub tests: u64,
    /// Support points of A-B, or steps from feature to feature.
    pub iterations: u64,
    /// Pairs given up on because of rounding, or at the limit of iterations.
    pub gave_up: u64,
}

impl Counters {
    /// Iterations for each test.
    pub fn iterations_per_test(&self) -> f64 {
        self.iterations as f64 / self.tests as f64
    }
}
