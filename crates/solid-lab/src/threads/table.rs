use std::fmt::Write;

use super::Report;
use crate::peers::Spread;

/// The report as a table in Markdown.
pub fn table(report: &Report) -> String {
    let mut text = String::from(
        "| work | one thread | two threads | speed-up | target | met | from outside |\n|---|---|---|---|---|---|---|\n",
    );
    for row in &report.rows {
        let [one, two, _] = row.micros.map(|spread| spread.median);
        let told = |Spread { median, quartiles: [low, high], .. }: Spread| {
            format!("{median:.2} ({low:.2} to {high:.2})")
        };
        let _ = writeln!(
            text,
            "| {} | {one:.4} us | {two:.4} us | {} | {} | {} | {} |",
            row.work,
            told(row.speed_up),
            row.target,
            if row.met() { "yes" } else { "no" },
            told(row.speed_up_outside),
        );
    }
    let met = report.rows.iter().filter(|row| row.met()).count();
    let _ = write!(
        text,
        "\n{met} of {} targets met; {}, {}, seed {}",
        report.rows.len(),
        report.machine,
        report.date,
        report.seed
    );
    text
}
