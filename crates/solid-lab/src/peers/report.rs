use serde::Serialize;

use super::spread::Spread;
use super::targets;

/// Who is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub enum Peer {
    /// The library.
    #[serde(rename = "solid3d")]
    Ours,
    /// What the thesis describes.
    #[serde(rename = "thesis")]
    Thesis,
    /// parry in double precision.
    #[serde(rename = "parry3d-f64")]
    ParryDouble,
    /// parry in single precision.
    #[serde(rename = "parry3d")]
    ParrySingle,
    /// Not a contestant, but a figure not to be exceeded.
    #[serde(rename = "limit")]
    Limit,
    /// Nobody: a figure of ours alone.
    #[serde(rename = "-")]
    Nobody,
}

impl Peer {
    /// As in the table.
    pub fn name(self) -> &'static str {
        match self {
            Peer::Ours => "solid3d",
            Peer::Thesis => "thesis",
            Peer::ParryDouble => "parry3d-f64",
            Peer::ParrySingle => "parry3d",
            Peer::Limit => "limit",
            Peer::Nobody => "-",
        }
    }
}

/// What a row counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// How long something takes: noise of the machine included.
    Time,
    /// Something that repeats exactly.
    Count,
    /// Memory.
    Memory,
    /// Answers that are not the oracle's.
    Wrong,
}

/// A figure of ours beside one of a peer's.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// What was done.
    pub work: String,
    /// Who else did it.
    pub peer: Peer,
    /// What the figures are.
    pub kind: Kind,
    /// Our figure: of times the median. None for what the library does not do yet.
    pub ours: Option<f64>,
    /// The peer's.
    pub theirs: Option<f64>,
    /// The unit of both.
    pub unit: &'static str,
    /// How many times ours goes into theirs.
    pub ratio: Option<f64>,
    /// How many times it is to go.
    pub target: Option<f64>,
    /// Whether it does; for wrong answers, whether there are none of ours.
    pub met: Option<bool>,
    /// The quartiles of times.
    pub ours_quartiles: Option<[f64; 2]>,
    /// The same.
    pub theirs_quartiles: Option<[f64; 2]>,
}

/// Everything that was measured in a run.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Of the inputs.
    pub seed: u64,
    /// On what it was measured.
    pub machine: String,
    /// When, as year-month-day.
    pub date: String,
    /// The figures, in the order in which they were measured.
    pub rows: Vec<Row>,
}

impl Row {
    /// A row of times.
    pub(super) fn times(
        work: &str,
        unit: &'static str,
        peer: Peer,
        ours: Option<Spread>,
        theirs: Option<Spread>,
    ) -> Self {
        let median = |spread: Option<Spread>| spread.map(|spread| spread.median);
        Row {
            ours_quartiles: ours.map(|spread| spread.quartiles),
            theirs_quartiles: theirs.map(|spread| spread.quartiles),
            ..Row::figures(work, Kind::Time, unit, peer, median(ours), median(theirs))
        }
    }

    /// A row of figures that do not spread.
    pub(super) fn figures(
        work: &str,
        kind: Kind,
        unit: &'static str,
        peer: Peer,
        ours: Option<f64>,
        theirs: Option<f64>,
    ) -> Self {
        let comparable = kind != Kind::Wrong;
        let ratio = ours
            .zip(theirs)
            .filter(|&(ours, _)| comparable && ours > 0.0)
            .map(|(ours, theirs)| theirs / ours);
        let target = targets::ratio(work, peer).filter(|_| comparable);
        let met = match kind {
            Kind::Wrong => ours.map(|count| count == 0.0),
            _ => target.map(|target| ratio.is_some_and(|ratio| ratio >= target)),
        };
        let work = work.to_owned();
        Row {
            work,
            peer,
            kind,
            ours,
            theirs,
            unit,
            ratio,
            target,
            met,
            ours_quartiles: None,
            theirs_quartiles: None,
        }
    }
}
