//! Lists of vectors in which numbers are missing.
//!
//! The parser leaves an incomplete last vector out without a word, though any number may be the missing one: what follows that is shifted.

use super::scan::{is_word, string, word};
use crate::text::counted;

/// Warns of lists of coordinates whose numbers do not come out even, in a text as the scan hands it on. Cost: O(n).
pub(super) fn uneven(text: &str, mut warn: impl FnMut(String)) {
    let (mut nodes, mut name) = (Vec::<&str>::new(), "");
    let header = text.find(['\r', '\n']).unwrap_or(text.len());
    let (mut at, mut line, mut counted_to) = (header, 1, 0);
    while let Some(&byte) = text.as_bytes().get(at) {
        let rest = &text[at..];
        at += match byte {
            b'"' => string(rest).unwrap_or(rest).len(),
            b'[' => {
                let each = nodes.last().and_then(|node| numbers_each(node, name));
                if let Some(warning) = each.and_then(|each| missing(&rest[1..], each)) {
                    line += text[counted_to..at].matches('\n').count();
                    counted_to = at;
                    warn(format!("line {line}: {name} has {warning}"));
                }
                1
            }
            b'{' => {
                nodes.push(name);
                1
            }
            b'}' => {
                nodes.pop();
                1
            }
            _ if is_word(byte) => {
                name = word(rest);
                name.len()
            }
            _ => 1,
        };
    }
}

/// How many numbers each value takes, of the fields of a node that say where things are.
fn numbers_each(node: &str, field: &str) -> Option<usize> {
    match (node, field) {
        ("Extrusion", "crossSection" | "scale") => Some(2),
        ("Coordinate", "point") | ("Extrusion", "spine") => Some(3),
        ("CoordinateInterpolator" | "PositionInterpolator", "keyValue") => Some(3),
        ("Extrusion", "orientation") | ("OrientationInterpolator", "keyValue") => Some(4),
        _ => None,
    }
}

/// What to say of a list that begins here, if its numbers are not a multiple of some; nothing of one with anything else in it.
fn missing(list: &str, each: usize) -> Option<String> {
    let numbers =
        list.split(']').next()?.split(|c: char| c <= ' ' || c == ',').filter(|word| !word.is_empty());
    let is_digital = |word: &str| word.bytes().all(|byte| byte.is_ascii_digit() || b"+-.eE".contains(&byte));
    let count = numbers
        .map(|word| (is_digital(word) && word.parse::<f64>().is_ok()).then_some(1))
        .sum::<Option<usize>>()?;
    let over = count % each;
    (over > 0).then(|| {
        format!("{}; expected {each} for each value, what is over is left out", counted(count, "number"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn warnings(text: &str) -> Vec<String> {
        let mut warnings = Vec::new();
        uneven(text, |warning| warnings.push(warning));
        warnings
    }

    #[test]
    fn lists_with_missing_numbers_are_told() {
        let text = "#VRML V2.0 utf8\nShape { geometry IndexedFaceSet {\ncoord DEF C Coordinate { point [ 0 0, 1 0 0, 0 1 0 ] } } }
            WorldInfo { title \"Coordinate { point [ 0 \\\" ] }\" } Extrusion { spine [ 0 0 0 1 ] scale [ 1 1 ] orientation [] }";
        let expected = [
            "line 3: point has 8 numbers; expected 3 for each value, what is over is left out",
            "line 4: spine has 4 numbers; expected 3 for each value, what is over is left out",
        ];
        assert_eq!(warnings(text), expected);
    }

    /// The parser takes `1-2` and `1.5.3` for two numbers; what is no list of plain ones is left to it.
    #[test]
    fn what_is_not_plain_is_passed_over() {
        for list in
            ["[ 0 0 0 1-2.5 3 ]", "[ 1.5.3 0 ]", "[ 0x1 0 ]", "[ 0 0 0 ]", "[ nan ]", "[", "0 0", "IS p"]
        {
            assert!(warnings(&format!("#\nCoordinate {{ point {list}")).is_empty(), "{list}");
        }
    }
}
