//! Reading the file.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow};
use csv::{ReaderBuilder, StringRecord, Trim};

use super::fields;
use super::row::Row;
use crate::suggest;

/// The columns; the last three may be missing.
const COLUMNS: [&str; 12] = ["frame", "object", "tx", "ty", "tz", "qx", "qy", "qz", "qw", "sx", "sy", "sz"];

/// How many columns there are at least.
const COLUMNS_MIN: usize = 9;

/// The placements of a scene's objects, frame by frame.
#[derive(Debug)]
pub struct Placements {
    path: PathBuf,
    /// By frame; those of one frame in the order of the file.
    rows: Vec<Row>,
}

impl Placements {
    /// Reads a file of placements of objects with these names.
    pub fn read(path: &Path, names: &[&str]) -> Result<Placements> {
        let text = std::fs::read_to_string(path).with_context(|| format!("{}", path.display()))?;
        let rows =
            rows(&text, names).map_err(|(line, message)| anyhow!("{}:{line}: {message}", path.display()))?;
        Ok(Placements { path: path.to_owned(), rows })
    }

    /// The rows, by frame.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// The last frame that is spoken of; 0 for none.
    pub fn last_frame(&self) -> u64 {
        self.rows.last().map_or(0, |row| row.frame)
    }

    /// Where a line is.
    pub fn place(&self, line: u64) -> String {
        format!("{}:{line}", self.path.display())
    }
}

/// A mistake and its line.
type Mistake = (u64, String);

fn rows(text: &str, names: &[&str]) -> std::result::Result<Vec<Row>, Mistake> {
    let places: HashMap<&str, usize> = names.iter().enumerate().map(|(place, &name)| (name, place)).collect();
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = Lines { text, at: 0, line: 1 };
    let mut reader =
        ReaderBuilder::new().has_headers(false).flexible(true).trim(Trim::All).from_reader(text.as_bytes());
    let mut columns = None;
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| (lines.line, error.to_string()))?;
        let line = lines.of(&record);
        match columns {
            None => columns = Some(header(&record).map_err(|message| (line, message))?),
            Some(columns) => {
                rows.push(row(&record, columns, line, names, &places).map_err(|message| (line, message))?);
            }
        }
    }
    if columns.is_none() {
        return Err((1, format!("the file is empty; expected {}", expected_header())));
    }
    rows.sort_by_key(|row| row.frame);
    Ok(rows)
}

/// The number of columns.
fn header(record: &StringRecord) -> fields::Result<usize> {
    let count = record.len();
    if (count == COLUMNS_MIN || count == COLUMNS.len()) && record.iter().eq(COLUMNS[..count].iter().copied())
    {
        return Ok(count);
    }
    let found = record.iter().collect::<Vec<_>>().join(",");
    Err(format!("the header is {found:?}; expected {}", expected_header()))
}

fn expected_header() -> String {
    let (needed, optional) = COLUMNS.split_at(COLUMNS_MIN);
    format!("the header {}, optionally followed by {}", needed.join(","), optional.join(","))
}

fn row(
    record: &StringRecord,
    columns: usize,
    line: u64,
    names: &[&str],
    places: &HashMap<&str, usize>,
) -> fields::Result<Row> {
    if record.len() != columns {
        return Err(format!("there are {} fields; expected {columns}, as in the header", record.len()));
    }
    let texts: Vec<&str> = record.iter().collect();
    let frame = fields::frame(texts[0])?;
    let object = *places.get(texts[1]).ok_or_else(|| {
        format!("there is no object {:?}{}", texts[1], suggest::hint(texts[1], names.iter().copied()))
    })?;
    let placement = fields::placement(&texts[2..], &COLUMNS[2..columns])?;
    Ok(Row { frame, object, placement, line })
}

/// Counts lines along with the records. (A record's own line number counts from before the empty lines ahead of it.)
struct Lines<'a> {
    text: &'a str,
    at: usize,
    line: u64,
}

impl Lines<'_> {
    /// The line on which a record begins; records in their order.
    fn of(&mut self, record: &StringRecord) -> u64 {
        let start = record.position().map_or(self.at, |position| position.byte() as usize);
        let bytes = self.text.as_bytes();
        let mut end = start.clamp(self.at, bytes.len());
        while end < bytes.len() && matches!(bytes[end], b'\n' | b'\r') {
            end += 1;
        }
        self.line += bytes[self.at..end].iter().filter(|&&byte| byte == b'\n').count() as u64;
        self.at = end;
        self.line
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "frame,object,tx,ty,tz,qx,qy,qz,qw\n";

    fn read(text: &str) -> std::result::Result<Vec<Row>, Mistake> {
        rows(text, &["ship", "mine, big"])
    }

    fn mistake(body: &str) -> Mistake {
        read(&format!("{HEADER}{body}")).expect_err(body)
    }

    #[test]
    fn rows_come_by_frame() {
        let text =
            format!("{HEADER}7,ship,1,0,0,0,0,0,1\n2,\"mine, big\",2,0,0,0,0,0,1\n7,ship,3,0,0,0,0,0,1\n");
        let rows = read(&text).expect("the rows are well formed");
        let seen: Vec<_> =
            rows.iter().map(|r| (r.frame, r.object, r.line, r.placement.translation.x)).collect();
        assert_eq!(seen, [(2, 1, 3, 2.0), (7, 0, 2, 1.0), (7, 0, 4, 3.0)]);
    }

    #[test]
    fn spaces_line_ends_and_a_byte_order_mark_do_no_harm() {
        let text = "\u{feff}frame, object, tx, ty, tz, qx, qy, qz, qw, sx, sy, sz\r\n\r\n0, ship, 1, 0, 0, 0, 0, 0, 1, 2, 2, 2\r\n";
        let rows = read(text).expect("the rows are well formed");
        assert_eq!((rows[0].line, rows[0].placement.matrix3.x_axis.x), (3, 2.0));
    }

    #[test]
    fn mistakes_name_line_value_and_expectation() {
        let (line, message) = mistake("\n\n0,shpi,1,0,0,0,0,0,1\n");
        assert_eq!((line, message.as_str()), (4, "there is no object \"shpi\"; did you mean \"ship\"?"));
        let (line, message) = mistake("0,ship,1,0,0,0,0,0,1\n1,ship,1,0,0,0,0,0\n");
        assert_eq!((line, message.as_str()), (3, "there are 8 fields; expected 9, as in the header"));
        let (line, message) = mistake("0,\"ship\nwreck\",1,0,0,0,0,0,1");
        assert!(line == 2 && message.starts_with("there is no object \"ship\\nwreck\""), "{message}");
        assert_eq!(mistake("0,ship,1,0,0,0,0,0,0").0, 2);
    }

    #[test]
    fn a_bad_header_says_what_was_expected() {
        for text in [
            "",
            "\n",
            "frame,object\n",
            "0,ship,1,0,0,0,0,0,1\n",
            "frame,object,tx,ty,tz,qw,qx,qy,qz\n",
            "\"\n\n",
        ] {
            let (line, message) = read(text).expect_err(text);
            let expected =
                "expected the header frame,object,tx,ty,tz,qx,qy,qz,qw, optionally followed by sx,sy,sz";
            assert!(line == 1 && message.ends_with(expected), "{text:?}: {line} {message}");
        }
    }
}
