use std::fmt::Write;

use super::{Asked, Cell, Report};

/// The report as tables in Markdown: microseconds that ours takes, and how many times as long parry takes.
pub fn table(report: &Report) -> String {
    let mut text = of_asked("two shapes", &report.pairs);
    text.push('\n');
    text.push_str(&of_asked("one shape", &report.alone));
    text.push('\n');
    text.push_str(&of_asked("a frame of 1,000", &report.crowds));
    text.push('\n');
    text.push_str(&of_asked("objects at rest", &report.fields));
    let rows = || report.asked().into_iter().flat_map(|asked| &asked.rows);
    let ratios = || rows().flat_map(|(_, cells)| cells).filter_map(|cell| cell.ratio);
    let faster = ratios().filter(|&ratio| ratio >= 1.0).count();
    let _ = write!(
        text,
        "\nParry takes longer in {faster} of {}; {}, {}, seed {}",
        ratios().count(),
        report.machine,
        report.date,
        report.seed
    );
    text
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
