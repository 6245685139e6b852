//! Statements of an OBJ file: lines without comments, joined where a backslash says so.

use std::borrow::Cow;

use crate::text;

/// The statements of a text, each with the number of the line on which it starts.
pub(super) fn statements(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let mut lines = text::lines(text).map(|(number, line)| (number, without_comment(line)));
    std::iter::from_fn(move || {
        let (number, line) = lines.next()?;
        let Some(start) = continued(line) else {
            return Some((number, Cow::Borrowed(line)));
        };
        let mut statement = start.to_owned();
        for (_, line) in lines.by_ref() {
            statement.push(' ');
            statement.push_str(continued(line).unwrap_or(line));
            if continued(line).is_none() {
                break;
            }
        }
        Some((number, Cow::Owned(statement)))
    })
}

/// The line before the backslash that joins it with the next.
fn continued(line: &str) -> Option<&str> {
    line.trim_end().strip_suffix('\\')
}

/// A comment goes to the end of its line, even if that is a backslash (`# C:\models\`). Within the name of a group or object it
/// begins after white space only: exporters number them `part#1`.
fn without_comment(line: &str) -> &str {
    let is_name = matches!(line.split_whitespace().next(), Some("g" | "o"));
    let begins = |&(at, _): &(usize, &str)| !is_name || line[..at].ends_with(char::is_whitespace);
    line.match_indices('#').find(begins).map_or(line, |(at, _)| &line[..at])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn backslashes_join_lines() {
        let found: Vec<_> = statements("a # b\nc \\\n d\\\r\ne#\\\nf\ng\\").collect();
        let found: Vec<_> = found.iter().map(|(number, text)| (*number, text.as_ref())).collect();
        assert_eq!(found, [(1, "a "), (2, "c   d e"), (5, "f"), (6, "g")]);
    }
}
