//! A progress bar, for long work with a person watching.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Shorter work needs no bar.
const PATIENCE: Duration = Duration::from_millis(500);

/// What the bar shows.
const TEMPLATE: &str = "{wide_bar} {pos}/{len} frames, {eta} left";

/// Counts frames on standard error when that is a terminal and the work takes long.
pub struct Progress {
    total: u64,
    started: Instant,
    watched: bool,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// Nothing done yet, of so many frames.
    pub fn new(total: u64) -> Self {
        Progress { total, started: Instant::now(), watched: std::io::stderr().is_terminal(), bar: None }
    }

    /// So many frames are done.
    pub fn done(&mut self, frames: u64) {
        if !self.watched {
            return;
        }
        if self.bar.is_none() && self.started.elapsed() > PATIENCE {
            self.bar = Some(bar(self.total));
        }
        if let Some(bar) = &self.bar {
            bar.set_position(frames);
        }
    }
}

impl Drop for Progress {
    /// The bar gives way to what is said next, be it the result or an error.
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

fn bar(total: u64) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template(TEMPLATE).expect("the template is well formed");
    bar.with_style(style)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_template_is_well_formed() {
        let bar = bar(10);
        bar.set_draw_target(ProgressDrawTarget::hidden());
        bar.set_position(3);
        assert_eq!(bar.position(), 3);
    }
}
