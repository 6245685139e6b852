//! The name that was perhaps meant.

use crate::words::quoted;

/// How much of a name is compared: enough for a slip of the pen, and a bound on the work for hostile names.
const CHARACTERS_MAX: usize = 64;

/// The one of the names that is closest to a wrong one, the first of several; `None` when there are no names.
pub fn closest<'a>(wrong: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let wrong = letters(wrong);
    names.into_iter().min_by_key(|name| edits(&wrong, &letters(name)))
}

/// `; did you mean "ship"?`, or nothing.
pub fn hint<'a>(wrong: &str, names: impl IntoIterator<Item = &'a str>) -> String {
    closest(wrong, names).map(|name| format!("; did you mean {}?", quoted(name))).unwrap_or_default()
}

fn letters(name: &str) -> Vec<char> {
    name.chars().flat_map(char::to_lowercase).take(CHARACTERS_MAX).collect()
}

/// How many letters must be inserted, removed or replaced to make one word of the other (Levenshtein).
fn edits(a: &[char], b: &[char]) -> usize {
    // row[j]: the edits from the letters of a so far to the first j of b.
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.iter().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn distance(a: &str, b: &str) -> usize {
        edits(&letters(a), &letters(b))
    }

    #[test]
    fn edits_are_a_metric() {
        assert_eq!(distance("kitten", "sitting"), 3);
        assert_eq!(distance("", "abc"), 3);
        assert_eq!(distance("Ship", "ship"), 0);
        for (a, b) in [("flaw", "lawn"), ("ab", "ba"), ("", "")] {
            assert_eq!(distance(a, b), distance(b, a));
        }
    }

    #[test]
    fn the_closest_name_is_suggested() {
        assert_eq!(closest("shpi", ["mine", "ship", "sweeper"]), Some("ship"));
        assert_eq!(closest("x", []), None);
        assert_eq!(hint("shp", ["ship"]), "; did you mean \"ship\"?");
    }

    #[test]
    fn endless_names_are_cut() {
        let long = "x".repeat(10_000_000);
        assert_eq!(closest(&long, [long.as_str(), "y"]), Some(long.as_str()));
    }
}
