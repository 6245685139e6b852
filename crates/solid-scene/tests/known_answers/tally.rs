//! What a test found.

use std::ops::RangeInclusive;

/// Rows, hits, the worst error and every mismatch of a comparison. Mismatches are collected, so that all are seen at once.
pub(crate) struct Tally {
    name: String,
    rows: usize,
    hits: usize,
    worst: f64,
    mismatches: Vec<String>,
}

/// A test is representative when between 30 and 70 percent of its rows hit.
const REPRESENTATIVE: RangeInclusive<f64> = 0.3..=0.7;

impl Tally {
    pub fn new(name: impl Into<String>) -> Self {
        Tally { name: name.into(), rows: 0, hits: 0, worst: 0.0, mismatches: Vec::new() }
    }

    /// Notes a row that should hit or not, and whether it does.
    pub fn hit(&mut self, row: &str, expected: bool, found: bool) {
        self.rows += 1;
        self.hits += usize::from(expected);
        self.check(expected == found, || format!("{row}: expected {expected}, found {found}"));
    }

    /// Notes an error, in units of the size of the data, and its limit.
    pub fn error(&mut self, row: &str, error: f64, limit: f64) {
        if error > self.worst || error.is_nan() {
            self.worst = error;
        }
        self.check(error <= limit, || format!("{row}: off by {error:e}, more than {limit:e}"));
    }

    /// Notes a mismatch unless the condition holds.
    pub fn check(&mut self, holds: bool, mismatch: impl FnOnce() -> String) {
        if !holds {
            self.mismatches.push(mismatch());
        }
    }

    /// Prints the summary and fails when anything did not match.
    pub fn finish(self) {
        let Tally { name, rows, hits, worst, mismatches } = self;
        let rate = 100.0 * hits as f64 / rows.max(1) as f64;
        println!("{name}: {rows} rows, {hits} hits ({rate:.0} %), worst error {worst:e}");
        assert!(rows > 0, "{name} has no rows");
        assert!(mismatches.is_empty(), "{name}: {} mismatches:\n{}", mismatches.len(), mismatches.join("\n"));
    }

    /// Like [`finish`](Tally::finish), and fails when the rows are not representative.
    pub fn finish_representative(self) {
        let (rate, name) = (self.hits as f64 / self.rows.max(1) as f64, self.name.clone());
        self.finish();
        assert!(REPRESENTATIVE.contains(&rate), "{name}: hit rate {rate}");
    }
}
