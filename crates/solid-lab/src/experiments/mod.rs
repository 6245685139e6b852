//! The experiments of the thesis, each under its name.
//!
//! Each writes its numbers as CSV and its charts as SVG, and compares with the thesis's own figures. Counts that do not depend on the
//! machine are held against them; times only as ratios.

mod bounding_volumes;
mod broad_phase;
mod chart;
mod clock;
mod convex_speed;
mod deformable;
mod models;
mod operations;
mod output;
mod polygons;
mod random;
mod report;
mod solids;
mod summary;
mod termination;
#[cfg(test)]
mod tests;
mod trees;

use std::path::PathBuf;

use anyhow::Result;

#[cfg(test)]
pub(crate) use polygons::star;
pub use report::{Claim, Kind, Report};

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// The samples of the thesis.
    Full,
    /// Small samples: a minute for everything.
    Quick,
    /// A tenth of that, for tests: what is found means nothing, but the same is found each time.
    Least,
}

/// How to run.
#[derive(Clone, Debug)]
pub struct Settings {
    /// How much is measured.
    pub effort: Effort,
    /// Of all random numbers.
    pub seed: u64,
    /// Where files go.
    pub out_dir: PathBuf,
}

impl Settings {
    /// The size of a sample: that of the thesis, or a small one.
    fn sample(&self, full: usize, quick: usize) -> usize {
        match self.effort {
            Effort::Full => full,
            Effort::Quick => quick,
            Effort::Least => quick.div_ceil(10),
        }
    }
}

/// Something that the thesis measured.
#[derive(Clone, Copy, Debug)]
pub struct Experiment {
    /// What it is called on the command line.
    pub name: &'static str,
    /// Where it is in the thesis.
    pub reproduces: &'static str,
    /// Measures.
    pub run: fn(&Settings) -> Result<Report>,
}

/// All, in the order of the thesis.
pub fn all() -> &'static [Experiment] {
    &[
        Experiment { name: "polygons", reproduces: "the two polygon tests of 3.2.2", run: polygons::run },
        Experiment { name: "convex-speed", reproduces: "Figures 4.8, 4.9 and 4.10", run: convex_speed::run },
        Experiment {
            name: "termination",
            reproduces: "the termination experiment of 4.4.4",
            run: termination::run,
        },
        Experiment {
            name: "solids",
            reproduces: "the linear program of 4.1 and the BSP trees of 5.1.3",
            run: solids::run,
        },
        Experiment { name: "operations", reproduces: "Table 5.1", run: operations::run },
        Experiment { name: "bounding-volumes", reproduces: "Tables 5.2 and 5.3", run: bounding_volumes::run },
        Experiment { name: "broad-phase", reproduces: "the sweeps of 5.2.2", run: broad_phase::run },
        Experiment { name: "trees", reproduces: "Tables 5.4 and 5.5, and Figure 5.10", run: trees::run },
        Experiment { name: "deformable", reproduces: "Table 5.6", run: deformable::run },
    ]
}
