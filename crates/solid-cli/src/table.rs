//! Tables: with rules for a person at a terminal, plain for `grep`, `awk` and `diff`.

use comfy_table::presets::NOTHING;
use comfy_table::{CellAlignment, LineStyle, Table, TableStyle};

/// Rules around the table and under its headings.
const RULED: TableStyle = TableStyle::new().top_border(RULE).header_separator(RULE).bottom_border(RULE);
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

/// Draws a table, with a line break at the end.
pub fn draw(style: Style, columns: &[Column], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let mut table = Table::new();
    table.load_style(match style {
        Style::Ruled => RULED,
        Style::Plain => NOTHING,
    });
    table.set_header(columns.iter().map(|column| match *column {
        Column::Left(heading) | Column::Right(heading) => heading,
    }));
    for row in rows {
        table.add_row(row);
    }
    for (cells, column) in table.column_iter_mut().zip(columns) {
        if style == Style::Plain {
            cells.set_padding((0, 2));
        }
        if let Column::Right(_) = column {
            cells.set_cell_alignment(CellAlignment::Right);
        }
    }
    table.lines().map(|line| format!("{}\n", line.trim_end())).collect()
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

    #[test]
    fn ruled_tables_have_rules() {
        let text = draw(Style::Ruled, &COLUMNS, rows());
        assert!(text.contains('─') && text.contains("sweeper"), "{text}");
    }
}
