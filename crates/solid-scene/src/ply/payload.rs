//! The numbers after the header of a PLY file.

use super::header::Scalar;
use crate::fault::{Fault, Result};
use crate::text::quoted;

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

impl Encoding {
    /// The least number of bytes that a value takes: in ASCII a digit and a space.
    pub fn least_size(self, scalar: Scalar) -> usize {
        if self == Encoding::Ascii { 2 } else { scalar.size() }
    }
}

/// Takes numbers off a file, one by one. Double precision holds every type's values exactly.
pub(super) struct Payload<'a> {
    rest: &'a [u8],
    encoding: Encoding,
    line: usize,
    /// With what a line ends.
    line_end: u8,
}

impl<'a> Payload<'a> {
    /// The numbers that begin at a line.
    pub fn new(rest: &'a [u8], encoding: Encoding, line: usize, line_end: u8) -> Self {
        Payload { rest, encoding, line, line_end }
    }

    /// A mistake at the last number that was taken.
    pub fn fault(&self, message: impl Into<String>) -> Fault {
        Fault::new(self.line(), message)
    }

    /// The line of the last number that was taken, in a text.
    pub fn line(&self) -> Option<usize> {
        (self.encoding == Encoding::Ascii).then_some(self.line)
    }

    /// How many numbers of a type may be left, at most.
    pub fn left(&self, scalar: Scalar) -> usize {
        self.rest.len().div_ceil(self.encoding.least_size(scalar))
    }

    /// The next number; `None` at the end of the file.
    pub fn next(&mut self, scalar: Scalar) -> Result<Option<f64>> {
        match self.encoding {
            Encoding::Ascii => self.next_in_text(),
            encoding => {
                let Some((bytes, rest)) = self.rest.split_at_checked(scalar.size()) else { return Ok(None) };
                self.rest = rest;
                let mut little = [0; 8];
                little[..bytes.len()].copy_from_slice(bytes);
                if encoding == Encoding::BigEndian {
                    little[..bytes.len()].reverse();
                }
                Ok(Some(value(little, scalar)))
            }
        }
    }

    fn next_in_text(&mut self) -> Result<Option<f64>> {
        let start = self.rest.iter().position(|byte| !byte.is_ascii_whitespace()).unwrap_or(self.rest.len());
        let (space, rest) = self.rest.split_at(start);
        self.line += space.iter().filter(|&&byte| byte == self.line_end).count();
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        let (word, rest) = rest.split_at(end);
        self.rest = rest;
        if word.is_empty() {
            return Ok(None);
        }
        let word = String::from_utf8_lossy(word);
        match word.parse() {
            Ok(value) => Ok(Some(value)),
            Err(_) => {
                Err(Fault::at(self.line, format!("expected a number, but there is `{}`", quoted(&word))))
            }
        }
    }
}

/// A number in little-endian bytes, of which there are as many as the type has.
fn value(b: [u8; 8], scalar: Scalar) -> f64 {
    match scalar {
        Scalar::I8 => f64::from(b[0].cast_signed()),
        Scalar::U8 => f64::from(b[0]),
        Scalar::I16 => f64::from(i16::from_le_bytes([b[0], b[1]])),
        Scalar::U16 => f64::from(u16::from_le_bytes([b[0], b[1]])),
        Scalar::I32 => f64::from(i32::from_le_bytes([b[0], b[1], b[2], b[3]])),
        Scalar::U32 => f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])),
        Scalar::F32 => f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])),
        Scalar::F64 => f64::from_le_bytes(b),
    }
}
