use std::fmt::Write;

use super::Report;

/// The report as a table in Markdown.
pub fn table(report: &Report) -> String {
    let mut text = String::from(
        "| work | one thread | two threads | speed-up | target | met |\n|---|---|---|---|---|---|\n",
    );
    for row in &report.rows {
        let [one, two] = row.micros.map(|spread| spread.median);
        let [low, high] = row.speed_up.quartiles;
        let _ = writeln!(
            text,
            "| {} | {one:.4} us | {two:.4} us | {:.2} ({low:.2} to {high:.2}) | {} | {} |",
            row.work,
            row.speed_up.median,
            row.target,
            if row.met() { "yes" } else { "no" },
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
