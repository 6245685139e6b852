//! Integers that 32 bits do not hold.
//!
//! The scan gives them a point, at which the parser stops where it wants an integer. It tells the line, but not at which of the
//! numbers there it stopped: this asks it once more, with a line for each of them.

use super::scan::{Scanned, as_written, is_word};
use crate::text::quoted;

/// What to say of the integer at which the parser stopped in a line of a text, counted from 1; `None` where it stopped at something
/// else. `stops_at` parses a text and tells the line in which that ends. Cost: that of parsing, where the line has such integers.
pub(super) fn message(
    scanned: &Scanned,
    line: usize,
    stops_at: impl FnOnce(&str) -> Option<usize>,
) -> Option<String> {
    let text = scanned.text.as_str();
    let wide = in_line(scanned, line)?;
    let (first, _) = wide.split_first()?;
    let mut apart = text[..*first].to_owned();
    for (i, &begin) in wide.iter().enumerate() {
        let word = text[begin..].bytes().take_while(|&byte| is_word(byte) || byte == b'.').count();
        let next = wide.get(i + 1).copied().unwrap_or(text.len());
        let end = next.min(begin + word);
        apart.extend(["\n", &text[begin..end], "\n", &text[end..next]]);
    }
    // Each has the first of two new lines.
    let new = stops_at(&apart)?.checked_sub(line + 1)?;
    let begin = *wide.get(new / 2).filter(|_| new % 2 == 0)?;
    Some(says(text, begin))
}

/// Where the integers of a line begin.
fn in_line(scanned: &Scanned, line: usize) -> Option<&[usize]> {
    let Scanned { text, wide, .. } = scanned;
    let start = match line.checked_sub(2) {
        Some(breaks) => text.match_indices('\n').nth(breaks)?.0 + 1,
        None => 0,
    };
    let end = text[start..].find('\n').map_or(text.len(), |length| start + length);
    let before = |place| wide.partition_point(|&begin| begin < place);
    Some(&wide[before(start)..before(end)])
}

fn says(text: &str, begin: usize) -> String {
    let (before, number) = text.split_at(begin);
    let number = number.split_once('.').map_or(number, |(number, _)| number);
    let names = before.rsplit(|c: char| c.is_ascii() && !is_word(c as u8));
    let is_name = |word: &&str| word.starts_with(|c: char| !(c.is_ascii_digit() || c == '+' || c == '-'));
    let field = names.into_iter().find(is_name).unwrap_or_default();
    let limit = match number.starts_with('-') {
        true => format!("at least {}", i32::MIN),
        false => format!("at most {}", i32::MAX),
    };
    format!("{} holds {}; expected an integer of {limit}", quoted(&as_written(field)), quoted(number))
}
