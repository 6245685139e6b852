//! Tables: with rules for a person at a terminal, plain for `grep`, `awk` and `diff`.

use comfy_table::presets::NOTHING;
use comfy_table::{CellAlignment, ColumnConstraint, LineStyle, Table, TableStyle, Width};

/// Rows that are laid out at a time: each takes more than a kilobyte meanwhile, and there may be millions.
const BATCH: usize = 1 << 12;

/// Between columns without rules.
const GAP: u16 = 2;

const RULE: LineStyle = LineStyle::new('─', '─', '─', '─');

/// How a table is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// With rules, for a terminal.
    Ruled,
    /// Rows and nothing else, for a file or pipe.
    Plain,
}

impl Style {
    /// The style for an output that is a terminal or not.
    pub fn on(terminal: bool) -> Style {
        if terminal { Style::Ruled } else { Style::Plain }
    }
}

/// A column: its heading, and the side its cells keep to.
#[derive(Clone, Copy, Debug)]
pub enum Column {
    /// Words.
    Left(&'static str),
    /// Numbers.
    Right(&'static str),
}

/// Some of the rows of a table.
#[derive(Clone, Copy)]
struct Batch {
    is_first: bool,
    is_last: bool,
}

/// Draws a table, with a line break at the end. The rows are gone through twice.
pub fn draw(
    style: Style,
    columns: &[Column],
    rows: impl IntoIterator<Item = Vec<String>, IntoIter: Clone>,
) -> String {
    draw_by(BATCH, style, columns, rows.into_iter())
}

fn draw_by(
    count: usize,
    style: Style,
    columns: &[Column],
    rows: impl Iterator<Item = Vec<String>> + Clone,
) -> String {
    let mut widths = vec![0; columns.len()];
    for_each_batch(count, rows.clone(), |batch, rows| {
        let of_batch = filled(columns, batch, rows).column_max_content_widths();
        widths.iter_mut().zip(of_batch).for_each(|(width, of_batch)| *width = of_batch.max(*width));
    });
    let mut text = String::new();
    for_each_batch(count, rows, |batch, rows| {
        let mut table = filled(columns, batch, rows);
        table.load_style(match style {
            Style::Ruled => batch.ruled(),
            Style::Plain => NOTHING,
        });
        for ((cells, column), &width) in table.column_iter_mut().zip(columns).zip(&widths) {
            if style == Style::Plain {
                cells.set_padding((0, GAP));
            }
            if let Column::Right(_) = column {
                cells.set_cell_alignment(CellAlignment::Right);
            }
            let padded = width.saturating_add(cells.padding_width());
            cells.set_constraint(ColumnConstraint::LowerBoundary(Width::Fixed(padded)));
        }
        for line in table.lines() {
            text += line.trim_end();
            text.push('\n');
        }
    });
    text
}

/// Calls `draw` with so many rows at a time, once without any if there are none.
fn for_each_batch(
    count: usize,
    rows: impl Iterator<Item = Vec<String>>,
    mut draw: impl FnMut(Batch, Vec<Vec<String>>),
) {
    let (mut rows, mut is_first) = (rows.peekable(), true);
    // Ends, because each batch takes rows.
    while is_first || rows.peek().is_some() {
        let batch = rows.by_ref().take(count).collect();
        draw(Batch { is_first, is_last: rows.peek().is_none() }, batch);
        is_first = false;
    }
}

/// A table of a batch; the first has the headings.
fn filled(columns: &[Column], batch: Batch, rows: Vec<Vec<String>>) -> Table {
    let mut table = Table::new();
    if batch.is_first {
        table.set_header(columns.iter().map(|column| match *column {
            Column::Left(heading) | Column::Right(heading) => heading,
        }));
    }
    table.add_rows(rows);
    table
}

impl Batch {
    /// Rules around the whole and under its headings.
    fn ruled(self) -> TableStyle {
        let style = TableStyle::new().header_separator(RULE);
        let style = if self.is_first { style.top_border(RULE) } else { style };
        if self.is_last { style.bottom_border(RULE) } else { style }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COLUMNS: [Column; 2] = [Column::Left("name"), Column::Right("frames")];

    fn rows() -> Vec<Vec<String>> {
        vec![vec!["ship".to_owned(), "7".to_owned()], vec!["sweeper".to_owned(), "12".to_owned()]]
    }

    #[test]
    fn plain_tables_are_rows_and_nothing_else() {
        let expected = "name     frames\nship          7\nsweeper      12\n";
        assert_eq!(draw(Style::Plain, &COLUMNS, rows()), expected);
    }

    /// Law: a table is the same however many of its rows are laid out at a time.
    #[test]
    fn batches_make_the_same_table() {
        let name = |i: usize| "x".repeat(1 + 7 * i % 23);
        for count in [0, 1, 2, 9, 10] {
            let rows = (0..count).map(|i| vec![name(i), (i * i).to_string()]);
            for style in [Style::Plain, Style::Ruled] {
                let whole = draw_by(100, style, &COLUMNS, rows.clone());
                for batch in [1, 2, 3, 9, 10] {
                    assert_eq!(draw_by(batch, style, &COLUMNS, rows.clone()), whole, "{count} by {batch}");
                }
            }
        }
    }

    #[test]
    fn ruled_tables_have_rules() {
        let text = draw(Style::Ruled, &COLUMNS, rows());
        assert!(text.contains('─') && text.contains("sweeper"), "{text}");
    }
}
