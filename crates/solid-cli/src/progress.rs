//! What is shown of long work with a person watching: a progress bar, or that it goes on.

use std::io::IsTerminal;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Shorter work needs no bar.
const PATIENCE: Duration = Duration::from_millis(500);

/// What the bar shows.
const TEMPLATE: &str = "{wide_bar} {pos}/{len} frames, {eta} left";

/// What is shown of work whose end is not known.
const WAITING_TEMPLATE: &str = "{spinner} {msg}, {elapsed}";

/// How often that is drawn.
const TICK: Duration = Duration::from_millis(100);

/// Does work whose end is not known, and says on standard error what it is when that is a terminal and it takes long.
pub fn while_waiting<T>(what: &'static str, work: impl FnOnce() -> T) -> T {
    if !std::io::stderr().is_terminal() {
        return work();
    }
    thread::scope(|scope| {
        // Dropped when the work ends, however it does.
        let (working, done) = channel::<()>();
        scope.spawn(move || {
            if done.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                let spinner = spinner(what);
                spinner.enable_steady_tick(TICK);
                // Until the other end is dropped.
                let _ = done.recv();
                spinner.finish_and_clear();
            }
        });
        let result = work();
        drop(working);
        result
    })
}

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

fn spinner(what: &'static str) -> ProgressBar {
    let spinner = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template(WAITING_TEMPLATE).expect("the template is well formed");
    spinner.with_style(style).with_message(what)
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
    fn the_templates_are_well_formed() {
        spinner("waiting").set_draw_target(ProgressDrawTarget::hidden());
        let bar = bar(10);
        bar.set_draw_target(ProgressDrawTarget::hidden());
        bar.set_position(3);
        assert_eq!(bar.position(), 3);
    }
}
