//! Reading the file.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow};
use csv::{ReaderBuilder, StringRecord};

use super::fields;
use super::row::Row;
use crate::words::{self, quoted};
use crate::{suggest, text};

/// The most bytes of a file of placements: the rows take some 15 times as many.
const BYTES_MAX: u64 = 1 << 30;

/// The columns; the last three may be missing.
const COLUMNS: [&str; 12] = ["frame", "object", "tx", "ty", "tz", "qx", "qy", "qz", "qw", "sx", "sy", "sz"];

/// How many columns there are at least.
const COLUMNS_MIN: usize = 9;

/// The placements of a scene's objects, frame by frame.
#[derive(Debug)]
pub struct Placements {
    path: PathBuf,
    /// By frame, then by object; those of one object and frame in the order of the file.
    rows: Vec<Row>,
}

impl Placements {
    /// Reads a file of placements of objects with these names.
    pub fn read(path: &Path, names: &[&str]) -> Result<Placements> {
        let text = text::read(path, BYTES_MAX)?;
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

    /// That objects are placed twice in a frame, in words, if any is; `names` are those of the objects.
    pub fn repetition(&self, names: &[&str]) -> Option<String> {
        let twice = |pair: &&[Row]| (pair[0].frame, pair[0].object) == (pair[1].frame, pair[1].object);
        let mut pairs = self.rows.windows(2).filter(twice);
        let [before, row] = pairs.next()?.first_chunk()?;
        let more = match pairs.count() {
            0 => String::new(),
            1 => "; there is 1 more such row".to_owned(),
            count => format!("; there are {count} more such rows"),
        };
        let (place, name, frame, line) =
            (self.place(row.line), quoted(names[row.object]), row.frame, before.line);
        Some(format!(
            "{place}: object {name} is placed in frame {frame} again, after line {line}; the later row holds{more}"
        ))
    }

    /// Where a line is.
    pub fn place(&self, line: u64) -> String {
        format!("{}:{line}", self.path.display())
    }
}

/// A mistake and its line.
type Mistake = (u64, String);

fn rows(text: &str, names: &[&str]) -> std::result::Result<Vec<Row>, Mistake> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = Lines { text, at: 0, line: 1 };
    let mut csv = ReaderBuilder::new().has_headers(false).flexible(true).from_reader(text.as_bytes());
    let mut records = csv.records().map(|record| match record {
        Ok(record) => Ok((lines.of(&record), record)),
        Err(error) => Err((lines.line, error.to_string())),
    });
    let Some((line, record)) = records.next().transpose()? else {
        return Err((1, format!("the file is empty; expected {}", expected_header())));
    };
    let columns = header(&record).map_err(|message| (line, message))?;
    let reader = RowReader::new(columns, names);
    let read = |(line, record)| reader.row(line, &record).map_err(|message| (line, message));
    let mut rows = records.map(|record| record.and_then(read)).collect::<std::result::Result<Vec<_>, _>>()?;
    rows.sort_by_key(|row| (row.frame, row.object));
    Ok(rows)
}

/// The number of columns.
fn header(record: &StringRecord) -> fields::Result<usize> {
    let count = record.len();
    let found: Vec<&str> = record.iter().map(str::trim).collect();
    if (count == COLUMNS_MIN || count == COLUMNS.len()) && found == COLUMNS[..count] {
        return Ok(count);
    }
    let found = found.join(",");
    Err(format!("the header is {}; expected {}", quoted(&found), expected_header()))
}

fn expected_header() -> String {
    let (needed, optional) = COLUMNS.split_at(COLUMNS_MIN);
    format!("the header {}, optionally followed by {}", needed.join(","), optional.join(","))
}

/// Reads the rows below the header.
struct RowReader<'a> {
    columns: usize,
    names: &'a [&'a str],
    places: HashMap<&'a str, usize>,
}

impl<'a> RowReader<'a> {
    fn new(columns: usize, names: &'a [&'a str]) -> Self {
        let places = names.iter().enumerate().map(|(place, &name)| (name, place)).collect();
        RowReader { columns, names, places }
    }

    fn row(&self, line: u64, record: &StringRecord) -> fields::Result<Row> {
        let (found, expected) = (record.len(), self.columns);
        if found != expected {
            let found = words::size(found);
            let (fields, are) = (words::count(found, "field"), words::are(found));
            return Err(format!("there {are} {fields}; expected {expected}, as in the header"));
        }
        let texts: Vec<&str> = record.iter().map(str::trim).collect();
        let frame = fields::frame(texts[0])?;
        let object = self.object(&record[1])?;
        let placement = fields::placement(&texts[2..], &COLUMNS[2..expected])?;
        Ok(Row { frame, object, placement, line })
    }

    /// The object of a name as it is written, or else without the space around it.
    fn object(&self, written: &str) -> fields::Result<usize> {
        if let Some(&place) = self.places.get(written) {
            return Ok(place);
        }
        let name = written.trim();
        let hint = || suggest::hint(name, self.names.iter().copied());
        let unknown = || format!("there is no object {}{}", quoted(name), hint());
        self.places.get(name).copied().ok_or_else(unknown)
    }
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
        let ends_line =
            |&i: &usize| bytes[i] == b'\n' || bytes[i] == b'\r' && bytes.get(i + 1) != Some(&b'\n');
        self.line += (self.at..end).filter(ends_line).count() as u64;
        self.at = end;
        self.line
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

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
    fn a_name_may_begin_and_end_with_space() {
        let text = format!("{HEADER}0, arm ,1,0,0,0,0,0,1\n0,arm,2,0,0,0,0,0,1\n0,  arm,3,0,0,0,0,0,1\n");
        let place = |names: &[&str]| -> Vec<usize> {
            rows(&text, names).expect("the rows are well formed").iter().map(|row| row.object).collect()
        };
        assert_eq!(place(&["arm"]), [0, 0, 0]);
        assert_eq!(place(&["arm", " arm "]), [0, 0, 1]);
    }

    #[test]
    fn mistakes_name_line_value_and_expectation() {
        let (line, message) = mistake("\n\n0,shpi,1,0,0,0,0,0,1\n");
        assert_eq!((line, message.as_str()), (4, "there is no object \"shpi\"; did you mean \"ship\"?"));
        let (line, message) = mistake("0,ship,1,0,0,0,0,0,1\n1,ship,1,0,0,0,0,0\n");
        assert_eq!((line, message.as_str()), (3, "there are 8 fields; expected 9, as in the header"));
        let (line, message) = mistake("0\n");
        assert_eq!((line, message.as_str()), (2, "there is 1 field; expected 9, as in the header"));
        let (line, _) = mistake("0,ship,1,0,0,0,0,0,1\r\r\n1,ship,1,0,0,0,0,0,1\r2,ship,1,0\r");
        assert_eq!(line, 5);
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

    proptest! {
        #[test]
        fn no_text_panics(body in "[0-9a-z,.\"\r\n -]{0,60}", any in ".{0,60}") {
            let _ = read(&any);
            if let Err((line, _)) = read(&format!("{HEADER}{body}")) {
                prop_assert!(line >= 1 && line as usize <= 2 + body.matches(['\n', '\r']).count());
            }
        }
    }
}
