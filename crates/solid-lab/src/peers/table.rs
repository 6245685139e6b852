use std::fmt::Write;

use comfy_table::presets::ASCII_MARKDOWN;
use comfy_table::{CellAlignment, Table};

use super::{Report, Row};

/// The report as a table to read.
pub fn table(report: &Report) -> String {
    let mut table = Table::new();
    table.load_style(ASCII_MARKDOWN);
    table.set_header(["work", "peer", "ours", "theirs", "unit", "ratio", "target", "met"]);
    let mut before = "";
    for row in &report.rows {
        let work = if row.work == before { "" } else { &row.work };
        before = &row.work;
        table.add_row([
            work.to_owned(),
            row.peer.name().to_owned(),
            with_spread(row.ours, row.ours_quartiles),
            with_spread(row.theirs, row.theirs_quartiles),
            row.unit.to_owned(),
            row.ratio.map_or(String::new(), figure),
            row.target.map_or(String::new(), figure),
            row.met.map_or("", |met| if met { "yes" } else { "no" }).to_owned(),
        ]);
    }
    for column in 2..7 {
        if let Some(column) = table.column_mut(column) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    let asked: Vec<&Row> = report.rows.iter().filter(|row| row.target.is_some()).collect();
    let met = asked.iter().filter(|row| row.met == Some(true)).count();
    format!(
        "{table}\n{met} of {} targets met; {}, {}, seed {}",
        asked.len(),
        report.machine,
        report.date,
        report.seed
    )
}

/// The works for which a target is missed, with the ratios and those asked for: a table in Markdown.
pub fn shortfalls(report: &Report) -> String {
    let mut text = String::from("| work | peer | ratio | target |\n|---|---|---|---|");
    for row in report.rows.iter().filter(|row| row.target.is_some() && row.met == Some(false)) {
        let [ratio, target] = [row.ratio, row.target].map(|x| x.map_or("-".to_owned(), figure));
        let _ = write!(text, "\n| {} | {} | {ratio} | {target} |", row.work, row.peer.name());
    }
    text
}

/// The median, and half of the distance of the quartiles in percent of it.
fn with_spread(median: Option<f64>, quartiles: Option<[f64; 2]>) -> String {
    match (median, quartiles) {
        (None, _) => "-".to_owned(),
        (Some(median), None) => figure(median),
        (Some(median), Some([low, high])) => {
            format!("{} ±{:.0}%", figure(median), 50.0 * (high - low) / median)
        }
    }
}

/// Three digits, or all that are before the point.
fn figure(x: f64) -> String {
    let decimals = if x == 0.0 || x.abs() >= 100.0 { 0 } else { (2 - x.abs().log10().floor() as i32).max(0) };
    let text = format!("{x:.*}", decimals as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
