//! What the readers of text formats share: where a text begins, lines with their numbers, and numbers.

use std::borrow::Cow;

use glam::DVec3;
use solid3d::convex::MAGNITUDE_MAX;

use crate::fault::{Fault, Result};

/// A text without the byte order mark that some editors write before it.
pub(crate) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// The bytes of a text, which may have a byte order mark before it, as characters. What is no UTF-8 is taken for Latin-1, as old programs wrote it, so that
/// different names stay different.
pub(crate) fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    let bytes = without_mark(bytes);
    if let Ok(text) = std::str::from_utf8(bytes) {
        return text.into();
    }
    let mut text = String::with_capacity(bytes.len());
    for chunk in bytes.utf8_chunks() {
        text.push_str(chunk.valid());
        text.extend(chunk.invalid().iter().map(|&byte| char::from(byte)));
    }
    text.into()
}

/// The lines of a text with their numbers, from 1; a line ends with LF, CR or both.
pub(crate) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    // A CR before a LF ends the line, and the LF then ends an empty one, which must not count.
    let mut number = 0;
    let mut rest = Some(text);
    std::iter::from_fn(move || {
        let text = rest?;
        number += 1;
        let end = text.find(['\n', '\r']);
        rest = end.map(|end| text[end..].strip_prefix("\r\n").unwrap_or(&text[end + 1..]));
        Some((number, &text[..end.unwrap_or(text.len())]))
    })
}

/// Three numbers in range: a vertex.
pub(crate) fn vertex<'a>(tokens: &mut impl Iterator<Item = &'a str>, line: usize) -> Result<DVec3> {
    let mut next = |name| number(tokens.next(), line, name);
    Ok(DVec3::new(next("x")?, next("y")?, next("z")?))
}

fn number(token: Option<&str>, line: usize, name: &str) -> Result<f64> {
    let expected = format!("expected a finite number for the vertex's {name}");
    let Some(token) = token else {
        return Err(Fault::at(line, format!("{expected}, but the line ends")));
    };
    match token.parse::<f64>() {
        Ok(value) if value.abs() <= MAGNITUDE_MAX => Ok(value),
        Ok(value) if value.is_finite() => {
            let message = format!("the vertex's {name} is `{}`; it must be at most", quoted(token));
            Err(Fault::at(line, format!("{message} {MAGNITUDE_MAX:e} in magnitude")))
        }
        _ => Err(Fault::at(line, format!("{expected}, but there is `{}`", quoted(token)))),
    }
}

/// A word or name of the file, cut where it is too long for a message.
pub(crate) fn quoted(token: &str) -> String {
    const CHARS_MAX: usize = 80;
    match token.char_indices().nth(CHARS_MAX) {
        Some((end, _)) => format!("{}...", &token[..end]),
        None => token.to_owned(),
    }
}

/// `1 number`, `2 numbers`.
pub(crate) fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// `there is 1`, `there are 2`.
pub(crate) fn there_are(count: usize) -> String {
    format!("there {} {count}", if count == 1 { "is" } else { "are" })
}

/// A message of another program about the file, whose words may be the file's own.
pub(crate) fn with_words_cut(message: &str) -> String {
    message.split(' ').map(quoted).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_three_ways() {
        let found: Vec<_> = lines("a\nb\r\nc\rd\n\ne").collect();
        assert_eq!(found, [(1, "a"), (2, "b"), (3, "c"), (4, "d"), (5, ""), (6, "e")]);
    }

    #[test]
    fn a_text_may_follow_a_byte_order_mark() {
        assert_eq!(without_mark(b"\xef\xbb\xbfv 1 2 3"), b"v 1 2 3");
        assert_eq!(without_mark(b"v 1 2 3"), b"v 1 2 3");
    }

    #[test]
    fn what_is_no_utf_8_is_latin_1() {
        assert_eq!(decoded(b"\xef\xbb\xbfg T\xfcr \xc3\xa9 \xe9\xe8"), "g T\u{fc}r \u{e9} \u{e9}\u{e8}");
    }

    #[test]
    fn nouns_agree_with_their_number() {
        assert_eq!([0, 1, 2].map(|n| counted(n, "key")), ["0 keys", "1 key", "2 keys"]);
        assert_eq!([0, 1, 2].map(there_are), ["there are 0", "there is 1", "there are 2"]);
    }

    #[test]
    fn a_vertex_is_finite() {
        let read = |text: &str| vertex(&mut text.split_whitespace(), 7);
        assert_eq!(read("1 -2e1 .5 9").unwrap(), DVec3::new(1.0, -20.0, 0.5));
        for (text, end) in [
            ("1 2", "the line ends"),
            ("1 nan 2", "`nan`"),
            ("1e999 0 0", "`1e999`"),
            ("0 0 -1e101", "the vertex's z is `-1e101`; it must be at most 1e100 in magnitude"),
        ] {
            let fault = read(text).unwrap_err();
            assert_eq!(fault.line(), Some(7));
            assert!(fault.message().ends_with(end), "{fault:?}");
        }
    }
}
