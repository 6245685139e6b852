use std::fmt::Write;

use super::{Asked, Cell, Report};

/// The report as tables in Markdown, but for what stands on a ground: microseconds that ours takes, and how many times as long parry takes.
pub fn table(report: &Report) -> String {
    let [pairs, alone, crowds, fields] = report.asked();
    let tables = [
        of_asked("two shapes", pairs),
        of_asked("one shape", alone),
        of_asked("a frame of 1,000", crowds),
        of_asked("objects at rest", fields),
    ];
    tables.join("\n") + &footer(report, &report.asked())
}

/// The same of what stands on a ground.
pub fn table_of_grounds(report: &Report) -> String {
    of_asked("contacts of what stands", &report.grounds) + &footer(report, &[&report.grounds])
}

fn footer(report: &Report, asked: &[&Asked]) -> String {
    let cells = || asked.iter().flat_map(|asked| &asked.rows).flat_map(|(_, cells)| cells);
    let ratios = || cells().filter_map(|cell| cell.ratio);
    let faster = ratios().filter(|&ratio| ratio >= 1.0).count();
    let Report { machine, date, seed, .. } = report;
    format!("\nParry takes longer in {faster} of {}; {machine}, {date}, seed {seed}", ratios().count())
}

fn of_asked(of: &str, asked: &Asked) -> String {
    let mut text = format!("| {of} | {} |\n|---|", asked.questions.join(" | "));
    text.push_str(&"---|".repeat(asked.questions.len()));
    text.push('\n');
    for (name, cells) in &asked.rows {
        let cells: Vec<String> = cells.iter().map(of_cell).collect();
        let _ = writeln!(text, "| {name} | {} |", cells.join(" | "));
    }
    text
}

fn of_cell(cell: &Cell) -> String {
    let micros = two_digits(cell.micros);
    match cell.ratio {
        Some(ratio) => format!("{micros} us, {}", two_digits(ratio)),
        None => format!("{micros} us"),
    }
}

fn two_digits(figure: f64) -> String {
    let digits = (1.0 - figure.abs().max(1e-3).log10().floor()).clamp(0.0, 3.0) as usize;
    format!("{figure:.digits$}")
}
