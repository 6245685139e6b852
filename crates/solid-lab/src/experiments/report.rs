/// What an experiment found.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Beside what the thesis found.
    pub claims: Vec<Claim>,
    /// The charts it wrote, by file name and what is in them.
    pub charts: Vec<(String, String)>,
}

/// A figure of the thesis and ours.
#[derive(Clone, Debug)]
pub struct Claim {
    /// What was measured.
    pub what: String,
    /// The thesis's figure.
    pub thesis: f64,
    /// Ours.
    pub ours: f64,
    /// Of both.
    pub unit: &'static str,
    /// Whether it depends on the machine.
    pub kind: Kind,
}

/// Whether a figure must agree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// It must, up to sampling: three standard errors, and what the thesis rounded off.
    Count {
        /// By how much it may differ.
        error: f64,
    },
    /// It depends on a model that the thesis does not define, or on how it was told apart: compared, not held.
    Model,
    /// It depends on the machine.
    Time,
}

impl Claim {
    /// Ours for each of the thesis's.
    pub fn ratio(&self) -> f64 {
        self.ours / self.thesis
    }

    /// `None` where it need not agree.
    pub fn agrees(&self) -> Option<bool> {
        match self.kind {
            Kind::Count { error } => Some((self.ours - self.thesis).abs() <= error),
            Kind::Model | Kind::Time => None,
        }
    }
}

/// The share of hits as a percentage, and three standard errors of the difference of two such samples.
pub fn percentage(hits: u64, count: usize, thesis_count: usize) -> (f64, f64) {
    let p = hits as f64 / count as f64;
    // One hit more keeps the error from vanishing at 0 and 1.
    let q = ((hits.min(count as u64 - hits) + 1) as f64 / count as f64).min(0.5);
    let variance = q * (1.0 - q) * (1.0 / count as f64 + 1.0 / thesis_count as f64);
    (100.0 * p, 300.0 * variance.sqrt())
}
