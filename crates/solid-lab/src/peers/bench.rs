//! How contestants are measured.

use std::time::{Duration, Instant};

use cpu_time::ThreadTime;
use rand::rngs::StdRng;

use super::spread::Spread;
use super::{Effort, Kind, Peer, Row};
use crate::inputs::seeded;

/// A turn takes at least so long, so that reading the clock is nothing beside it.
const TURN_MIN: Duration = Duration::from_millis(1);

/// Who needs longer for a turn has only one: it is long enough to be a mean of its own.
const TURN_MAX: f64 = 1.0;

/// Up to here the first pass is one that warms up: it also makes what is made when it is first asked for, as a frame of a million boxes does
/// that finds most of them outside of where the first tree expected them.
const WARMING_MAX: f64 = 3.0;

/// No contestant takes more turns than this.
const ROUNDS_MAX: usize = 101;

/// A contestant of a race.
pub struct Entry {
    /// Who.
    pub peer: Peer,
    /// Does every operation of the race once; its result keeps the compiler from leaving them out.
    pub pass: Box<dyn FnMut() -> usize>,
}

impl Entry {
    /// From a function that does everything once.
    pub fn new(peer: Peer, pass: impl FnMut() -> usize + 'static) -> Self {
        Entry { peer, pass: Box::new(pass) }
    }

    /// How long `passes` passes take, of the time that this thread runs.
    fn time(&mut self, passes: usize) -> Duration {
        let start = ThreadTime::now();
        for _ in 0..passes {
            std::hint::black_box((self.pass)());
        }
        start.elapsed()
    }
}

/// Runs the cases, and keeps what they gave.
pub struct Bench {
    /// How much to measure.
    pub effort: Effort,
    seed: u64,
    rows: Vec<Row>,
}

impl Bench {
    /// With nothing measured.
    pub fn new(effort: Effort, seed: u64) -> Self {
        Bench { effort, seed, rows: Vec::new() }
    }

    /// The random numbers of a case: they depend on its name alone, so that what is added elsewhere changes no input.
    pub fn rng(&self, case: &str) -> StdRng {
        // FNV-1a.
        let hash = case.bytes().fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        seeded(self.seed ^ hash)
    }

    /// Lets contestants, ours among them or not, take turns at `operations` operations, and adds a row for each of the others. The
    /// figure of each is the median of its turns, in `unit` an operation.
    pub fn race(&mut self, work: &str, operations: usize, unit: Unit, mut entries: Vec<Entry>) {
        let mut turns: Vec<(usize, Vec<f64>)> = entries
            .iter_mut()
            .map(|entry| {
                let mut once = entry.time(1).as_secs_f64();
                if once < WARMING_MAX {
                    once = entry.time(1).as_secs_f64();
                }
                let passes = (TURN_MIN.as_secs_f64() / once.max(1e-9)).ceil();
                // What fills a turn at once is not warming up any more.
                let first = if passes <= 1.0 { vec![once] } else { Vec::new() };
                (passes as usize, first)
            })
            .collect();
        let done = |(_, times): &(usize, Vec<f64>), rounds: usize| {
            times.len() >= rounds || times.first().is_some_and(|time| *time > TURN_MAX)
        };
        let start = Instant::now();
        while turns.iter().any(|turn| !done(turn, self.effort.rounds_min()))
            || (start.elapsed() < self.effort.budget() && turns.iter().any(|turn| !done(turn, ROUNDS_MAX)))
        {
            for (entry, turn) in entries.iter_mut().zip(&mut turns) {
                if !done(turn, ROUNDS_MAX) {
                    turn.1.push(entry.time(turn.0).as_secs_f64() / turn.0 as f64);
                }
            }
        }
        let spreads: Vec<(Peer, Spread)> = entries
            .iter()
            .zip(turns)
            .map(|(entry, (_, times))| {
                let per_operation = unit.per_second() / operations as f64;
                (entry.peer, Spread::of(times.iter().map(|time| time * per_operation).collect()))
            })
            .collect();
        let ours = spreads.iter().find(|(peer, _)| *peer == Peer::Ours).map(|(_, spread)| *spread);
        for (peer, theirs) in spreads.iter().filter(|(peer, _)| *peer != Peer::Ours) {
            self.rows.push(Row::times(work, unit.name(), *peer, ours, Some(*theirs)));
        }
    }

    /// Adds a row for each of the others beside ours, which is the first. A single figure has nobody beside it.
    pub fn figures(&mut self, work: &str, kind: Kind, unit: &'static str, figures: &[(Peer, f64)]) {
        let (Some(&(_, ours)), others) = (figures.first(), &figures[1..]) else { return };
        for &(peer, theirs) in others {
            self.rows.push(Row::figures(work, kind, unit, peer, Some(ours), Some(theirs)));
        }
        if others.is_empty() {
            self.rows.push(Row::figures(work, kind, unit, Peer::Nobody, Some(ours), None));
        }
    }

    /// What was measured.
    pub fn into_rows(self) -> Vec<Row> {
        self.rows
    }
}

/// The unit of a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Nanoseconds.
    Nano,
    /// Microseconds.
    Micro,
    /// Milliseconds.
    Milli,
}

impl Unit {
    fn name(self) -> &'static str {
        match self {
            Unit::Nano => "ns",
            Unit::Micro => "us",
            Unit::Milli => "ms",
        }
    }

    fn per_second(self) -> f64 {
        match self {
            Unit::Nano => 1e9,
            Unit::Micro => 1e6,
            Unit::Milli => 1e3,
        }
    }
}
