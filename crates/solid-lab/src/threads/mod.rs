//! One thread against two: the same work on copies of the same data, in one process, in turns. Two are asked by one of them, and from
//! outside of their pool, as most programs do.
//!
//! Each round gives all a turn, and the speed-up is the median of the rounds' ratios: what slows the machine down for a while
//! slows all, and each thread keeps to a core. Times are of the clock on the wall, so a machine that is busy shows less than it could.
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
    /// Microseconds on one thread, on two, and on two asked from outside.
    pub micros: [Spread; 3],
    /// How many times as long one thread takes as two.
    pub speed_up: Spread,
    /// The same, asked from outside.
    pub speed_up_outside: Spread,
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

/// Does work on one thread.
///
/// # Errors
/// When it cannot be had.
pub fn on_one<R: Send>(work: impl FnOnce() -> R + Send) -> Result<R, ThreadPoolBuildError> {
    Ok(ThreadPoolBuilder::new().num_threads(1).build()?.install(work))
}

/// Has two threads in the pool that works are shared on by default.
///
/// # Errors
/// When that pool was there already.
pub fn two_by_default() -> Result<(), ThreadPoolBuildError> {
    pool_of(2).build_global()
}

fn pool_of(threads: usize) -> ThreadPoolBuilder {
    ThreadPoolBuilder::new().num_threads(threads).start_handler(keep_to_a_core)
}

/// Measures everything, from outside on the default pool. `progress` is told the name of each work before its turn.
///
/// # Errors
/// When no threads can be had.
pub fn run(
    effort: Effort,
    seed: u64,
    mut progress: impl FnMut(&str),
) -> Result<Report, ThreadPoolBuildError> {
    let pools = [pool_of(1).build()?, pool_of(2).build()?];
    let bench = Bench::new(effort, seed);
    let mut rows = Vec::new();
    for (name, target, make) in works::all(&bench) {
        progress(&name);
        rows.push(race(effort, &pools, name, target, [make(), make(), make()]));
    }
    Ok(Report { seed, machine: machine(), date: date(), rows })
}

/// Has the calling thread run on a core of its own, where there are enough: else two threads may be left on one core for many frames.
fn keep_to_a_core(thread: usize) {
    if let Some(&core) = core_affinity::get_core_ids().unwrap_or_default().get(thread) {
        core_affinity::set_for_current(core);
    }
}

/// Lets both pools, and this thread, take turns at a work.
fn race(effort: Effort, pools: &[ThreadPool; 2], work: String, target: f64, mut works: [Work; 3]) -> Row {
    let mut turn = |k: usize, passes: usize| -> Duration {
        let work = &mut works[k];
        let mut all = || (0..passes).map(|_| work()).sum();
        match pools.get(k) {
            Some(pool) => pool.install(all),
            None => all(),
        }
    };
    let once = turn(0, 1).max(turn(1, 1)).max(turn(2, 1)).as_secs_f64().max(1e-9);
    let passes = ((TURN_MIN.as_secs_f64() / once).ceil() as usize).clamp(1, PASSES_MAX);
    let passes = if effort == Effort::Smoke { 1 } else { passes };
    let mut micros = [const { Vec::new() }; 3];
    let start = Instant::now();
    while micros[0].len() < effort.rounds_min()
        || (start.elapsed() < 2 * effort.budget() && micros[0].len() < ROUNDS_MAX)
    {
        for (k, micros) in micros.iter_mut().enumerate() {
            micros.push(1e6 * turn(k, passes).as_secs_f64() / passes as f64);
        }
    }
    let [speed_up, speed_up_outside] = [1, 2].map(|k| {
        let ratios = micros[0].iter().zip(&micros[k]).map(|(one, two): (&f64, &f64)| one / two.max(1e-9));
        Spread::of(ratios.collect())
    });
    Row { work, micros: micros.map(Spread::of), speed_up, speed_up_outside, target }
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
