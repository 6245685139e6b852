//! One thread against two: the same work on copies of the same data, in one process, in turns.
//!
//! Each round gives both a turn, and the speed-up is the median of the rounds' ratios: what slows the machine down for a while
//! slows both, and each thread keeps to a core. Times are of the clock on the wall, so a machine that is busy shows less than it could.
//!
//! | file | holds |
//! |---|---|
//! | `works` | what is measured |
//! | `table` | what comes out |

mod table;
mod works;

use std::time::{Duration, Instant};

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

use crate::peers::{Bench, Effort, Spread, date, machine};
pub use table::table;
pub use works::Work;

/// Where there is much to do, two threads are to be so many times as fast as one.
pub const SPEED_UP: f64 = 1.8;

/// Where there is little, they are not to be slower: by more than this, which is what equal work differs by.
pub const NO_SLOWER: f64 = 0.97;

/// A turn takes at least so long.
const TURN_MIN: Duration = Duration::from_millis(5);

/// No work takes more rounds than this.
const ROUNDS_MAX: usize = 101;

/// No turn has more passes than this.
const PASSES_MAX: usize = 10_000;

/// What one thread and two took for a work.
#[derive(Clone, Debug)]
pub struct Row {
    /// Which.
    pub work: String,
    /// Microseconds on one thread and on two.
    pub micros: [Spread; 2],
    /// How many times as long one thread takes.
    pub speed_up: Spread,
    /// What it is to be at least.
    pub target: f64,
}

impl Row {
    /// Whether it is.
    pub fn met(&self) -> bool {
        self.speed_up.median >= self.target
    }
}

/// What was measured, on what.
#[derive(Clone, Debug)]
pub struct Report {
    /// Of all random numbers.
    pub seed: u64,
    /// The processor.
    pub machine: String,
    /// Year-month-day.
    pub date: String,
    /// In the order in which they were measured.
    pub rows: Vec<Row>,
}

/// Makes the calling thread the only one of the pool that everything runs on by default: for what is measured on one thread.
///
/// # Errors
/// When that pool was there already.
pub fn stay_on_one() -> Result<(), ThreadPoolBuildError> {
    ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global()
}

/// Measures everything. `progress` is told the name of each work before its turn.
///
/// # Errors
/// When no threads can be had.
pub fn run(
    effort: Effort,
    seed: u64,
    mut progress: impl FnMut(&str),
) -> Result<Report, ThreadPoolBuildError> {
    let pool = |threads| ThreadPoolBuilder::new().num_threads(threads).start_handler(keep_to_a_core).build();
    let pools = [pool(1)?, pool(2)?];
    let bench = Bench::new(effort, seed);
    let mut rows = Vec::new();
    for (name, target, make) in works::all(&bench) {
        progress(&name);
        rows.push(race(effort, &pools, name, target, [make(), make()]));
    }
    Ok(Report { seed, machine: machine(), date: date(), rows })
}

/// Has the calling thread run on a core of its own, where there are enough: else two threads may be left on one core for many frames.
fn keep_to_a_core(thread: usize) {
    if let Some(&core) = core_affinity::get_core_ids().unwrap_or_default().get(thread) {
        core_affinity::set_for_current(core);
    }
}

/// Lets both pools take turns at a work.
fn race(effort: Effort, pools: &[ThreadPool; 2], work: String, target: f64, mut works: [Work; 2]) -> Row {
    let mut turn = |k: usize, passes: usize| -> Duration {
        let work = &mut works[k];
        pools[k].install(|| (0..passes).map(|_| work()).sum::<Duration>())
    };
    let once = turn(0, 1).max(turn(1, 1)).as_secs_f64().max(1e-9);
    let passes = ((TURN_MIN.as_secs_f64() / once).ceil() as usize).clamp(1, PASSES_MAX);
    let passes = if effort == Effort::Smoke { 1 } else { passes };
    let mut micros = [Vec::new(), Vec::new()];
    let start = Instant::now();
    while micros[0].len() < effort.rounds_min()
        || (start.elapsed() < 2 * effort.budget() && micros[0].len() < ROUNDS_MAX)
    {
        for (k, micros) in micros.iter_mut().enumerate() {
            micros.push(1e6 * turn(k, passes).as_secs_f64() / passes as f64);
        }
    }
    let ratios = micros[0].iter().zip(&micros[1]).map(|(one, two)| one / two.max(1e-9)).collect();
    Row { work, micros: micros.map(Spread::of), speed_up: Spread::of(ratios), target }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_work_runs_and_has_a_target() {
        let report = run(Effort::Smoke, 1999, |_| {}).expect("there are threads");
        let targets: Vec<f64> = report.rows.iter().map(|row| row.target).collect();
        assert!(targets.contains(&SPEED_UP) && targets.contains(&NO_SLOWER));
        for row in &report.rows {
            assert!(row.micros.iter().all(|spread| spread.median > 0.0), "{row:?}");
            assert!(table(&report).contains(&row.work), "{row:?}");
        }
    }
}
