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

/// Three standard errors of the difference of a share in percent, sampled so often, and the same of another sample.
pub fn sampling_error(percent: f64, count: usize, other_count: usize) -> f64 {
    let p = percent / 100.0;
    // One hit more keeps the error from vanishing at 0 and 1.
    let q = (p.min(1.0 - p) + 1.0 / count as f64).min(0.5);
    300.0 * (q * (1.0 - q) * (1.0 / count as f64 + 1.0 / other_count as f64)).sqrt()
}
