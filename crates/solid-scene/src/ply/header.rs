//! The header of a PLY file: what elements follow, and how they are encoded.

use super::payload::{Encoding, Payload};
use crate::fault::{Fault, Result};
use crate::text::{quoted, without_mark};

/// The elements of a file, in order.
#[derive(Debug, Default)]
pub(super) struct Header {
    pub elements: Vec<Element>,
}

#[derive(Debug)]
pub(super) struct Element {
    pub name: String,
    /// Where the header tells it.
    pub line: usize,
    pub count: u64,
    pub properties: Vec<Property>,
}

#[derive(Debug)]
pub(super) struct Property {
    pub name: String,
    /// The type of the length, for a list.
    pub length: Option<Scalar>,
    /// The type of the value, or of the values of a list.
    pub scalar: Scalar,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &str) -> Option<Scalar> {
        Some(match name {
            "char" | "int8" => Scalar::I8,
            "uchar" | "uint8" => Scalar::U8,
            "short" | "int16" => Scalar::I16,
            "ushort" | "uint16" => Scalar::U16,
            "int" | "int32" => Scalar::I32,
            "uint" | "uint32" => Scalar::U32,
            "float" | "float32" => Scalar::F32,
            "double" | "float64" => Scalar::F64,
            _ => return None,
        })
    }

    /// In bytes.
    pub fn size(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::F64 => 8,
        }
    }
}

impl Property {
    /// The type of the first value that stands in the file.
    fn first(&self) -> Scalar {
        self.length.unwrap_or(self.scalar)
    }
}

/// The header, and the payload after it. Elements that can't all be in the file are refused here.
pub(super) fn read(bytes: &[u8]) -> Result<(Header, Payload<'_>)> {
    let mut header = Header::default();
    let mut encoding = None;
    let mut rest = without_mark(bytes);
    let line_end = line_end(rest);
    let mut line = 0;
    loop {
        line += 1;
        let Some(content) = next_line(&mut rest, line_end) else {
            return Err(Fault::at((line - 1).max(1), "the file ends in its header; expected `end_header`"));
        };
        let content = String::from_utf8_lossy(content);
        let words: Vec<&str> = content.split_whitespace().collect();
        if line == 1 && words != ["ply"] {
            return Err(Fault::at(line, "expected `ply`"));
        }
        match words.as_slice() {
            ["end_header"] => {
                let encoding = encoding.ok_or_else(|| Fault::at(line, "the header has no `format`"))?;
                header.check_counts(encoding, rest.len())?;
                return Ok((header, Payload::new(rest, encoding, line + 1, line_end)));
            }
            ["format", ..] => encoding = Some(format(&words, line)?),
            _ => header.line(&words, line)?,
        }
    }
}

/// With what all lines end, as the first does: CR alone, or LF, before which a CR is white space. What follows the header may begin with
/// any byte, so that it can't be told line by line.
fn line_end(bytes: &[u8]) -> u8 {
    match bytes.iter().position(|byte| matches!(byte, b'\r' | b'\n')) {
        Some(end) if bytes[end] == b'\r' && bytes.get(end + 1) != Some(&b'\n') => b'\r',
        _ => b'\n',
    }
}

/// Takes a line off the text, without its end.
fn next_line<'a>(rest: &mut &'a [u8], line_end: u8) -> Option<&'a [u8]> {
    let end = rest.iter().position(|&byte| byte == line_end)?;
    let line = &rest[..end];
    *rest = &rest[end + 1..];
    Some(line)
}

fn format(words: &[&str], line: usize) -> Result<Encoding> {
    match words {
        ["format", "ascii", "1.0"] => Ok(Encoding::Ascii),
        ["format", "binary_little_endian", "1.0"] => Ok(Encoding::LittleEndian),
        ["format", "binary_big_endian", "1.0"] => Ok(Encoding::BigEndian),
        _ => Err(Fault::at(line, "expected `format`, an encoding and the version 1.0")),
    }
}

impl Header {
    fn line(&mut self, words: &[&str], line: usize) -> Result<()> {
        match words {
            [] | ["ply"] | ["comment" | "obj_info", ..] => {}
            ["element", rest @ ..] => self.elements.push(element(rest, line)?),
            ["property", rest @ ..] => {
                let Some(element) = self.elements.last_mut() else {
                    return Err(Fault::at(line, "a property stands before the first element"));
                };
                element.properties.push(property(rest, line)?);
            }
            [other, ..] => {
                let expected = "expected `element`, `property` or `end_header`";
                return Err(Fault::at(line, format!("{expected}, but there is `{}`", quoted(other))));
            }
        }
        Ok(())
    }

    /// Refuses what can't be in a payload of so many bytes, lists being empty at least.
    fn check_counts(&self, encoding: Encoding, mut bytes: usize) -> Result<()> {
        for Element { name, line, count, properties } in &self.elements {
            if properties.is_empty() && *count > 0 {
                let message =
                    format!("the header tells {count} of `{}`, which has no property", quoted(name));
                return Err(Fault::at(*line, message));
            }
            let each: usize = properties.iter().map(|property| encoding.least_size(property.first())).sum();
            let needed = u128::from(*count) * each as u128;
            // The last number of a text needs no space after it.
            if needed > bytes as u128 + 1 {
                let message =
                    format!("the header tells {count} of `{}`, of {needed} bytes in all", quoted(name));
                return Err(Fault::at(*line, format!("{message}; the file has {bytes} for them")));
            }
            bytes = bytes.saturating_sub(needed as usize);
        }
        Ok(())
    }
}

fn element(words: &[&str], line: usize) -> Result<Element> {
    let expected = || Fault::at(line, "expected `element`, a name and a count");
    let [name, count] = words else { return Err(expected()) };
    let count = count.parse().map_err(|_| expected())?;
    Ok(Element { name: (*name).to_owned(), line, count, properties: Vec::new() })
}

fn property(words: &[&str], line: usize) -> Result<Property> {
    let scalar = |word: &str| {
        let expected = || Fault::at(line, format!("expected a type, but there is `{}`", quoted(word)));
        Scalar::named(word).ok_or_else(expected)
    };
    match words {
        ["list", length, of, name] => {
            Ok(Property { name: (*name).to_owned(), length: Some(scalar(length)?), scalar: scalar(of)? })
        }
        [of, name] => Ok(Property { name: (*name).to_owned(), length: None, scalar: scalar(of)? }),
        _ => Err(Fault::at(line, "expected `property`, a type and a name")),
    }
}
