//! The library beside the thesis's design and parry: the same inputs, one process, one run.
//!
//! | file | holds |
//! |---|---|
//! | `contestants` | the contestants, behind the traits of what they can do |
//! | `cases` | what is measured, a function each |
//! | `bench` | how: contestants take turns, and each is judged by the median of its turns |
//! | `targets` | the ratios that are asked for |
//! | `report`, `table`, `chart` | what comes out |

mod bench;
mod cases;
mod chart;
pub(crate) mod contestants;
mod effort;
mod machine;
mod report;
mod spread;
mod table;
mod targets;

pub use bench::Bench;
pub(crate) use cases::with_commas;
pub use chart::draw;
pub use contestants::{Library, Ours, Simulator};
pub use effort::Effort;
pub(crate) use machine::{date, name as machine};
pub use report::{Kind, Peer, Report, Row};
pub use spread::Spread;
pub use table::{shortfalls, table};
pub use targets::{TARGETS, Target};

/// The names of the groups of cases.
pub fn groups() -> impl Iterator<Item = &'static str> {
    cases::ALL.iter().map(|&(name, _)| name)
}

/// Measures the cases of some [`groups`], of all if none is named. `progress` is told the name of each group before its turn.
pub fn run(effort: Effort, seed: u64, only: &[String], mut progress: impl FnMut(&str)) -> Report {
    let mut bench = Bench::new(effort, seed);
    for (name, case) in
        cases::ALL.iter().filter(|(name, _)| only.is_empty() || only.iter().any(|o| o == name))
    {
        progress(name);
        case(&mut bench);
    }
    Report {
        seed,
        machine: format!("{}, one thread used", machine::name()),
        date: machine::date(),
        rows: bench.into_rows(),
    }
}
