//! Patterns of object names.

use std::str::Chars;

/// A name with wildcards: `*` for any characters, also none, and `?` for one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    letters: Vec<char>,
}

impl Pattern {
    pub fn new(text: &str) -> Self {
        let mut letters: Vec<char> = text.chars().collect();
        // As good as one, which leaves nothing to be gone through after the end of a name.
        letters.dedup_by(|a, b| (*a, *b) == ('*', '*'));
        Pattern { letters }
    }

    /// Whether it has no wildcards, so that only the name itself matches.
    pub fn is_name(&self) -> bool {
        !self.letters.iter().any(|c| matches!(c, '*' | '?'))
    }

    /// Whether every name matches.
    pub fn is_universal(&self) -> bool {
        !self.letters.is_empty() && self.letters.iter().all(|&c| c == '*')
    }

    /// Whether a whole name matches; `None` where that takes more steps than there are, which are counted down: at most the product of
    /// the lengths.
    pub fn matches(&self, name: &str, steps: &mut u64) -> Option<bool> {
        let (mut i, mut rest) = (0, name.chars());
        // The last `*` met, and from where in the name the rest was tried after it. Only the last can need another try: what the
        // earlier ones take is as short as possible, which leaves the most for the rest.
        let mut retry: Option<(usize, Chars)> = None;
        *steps = steps.checked_sub(1)?;
        while let Some(letter) = rest.clone().next() {
            *steps = steps.checked_sub(1)?;
            match (self.letters.get(i), &mut retry) {
                (Some('*'), _) => {
                    retry = Some((i, rest.clone()));
                    i += 1;
                }
                (Some(&c), _) if c == '?' || c == letter => {
                    i += 1;
                    rest.next();
                }
                (_, Some((star, from))) => {
                    from.next();
                    (i, rest) = (*star + 1, from.clone());
                }
                (_, None) => return Some(false),
            }
        }
        Some(self.letters[i..].iter().all(|&c| c == '*'))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The definition, slow and right.
    fn matches(pattern: &[char], name: &[char]) -> bool {
        match (pattern, name) {
            ([], _) => name.is_empty(),
            (['*', rest @ ..], _) => matches(rest, name) || !name.is_empty() && matches(pattern, &name[1..]),
            (['?', rest @ ..], [_, others @ ..]) => matches(rest, others),
            ([c, rest @ ..], [d, others @ ..]) => c == d && matches(rest, others),
            (_, []) => false,
        }
    }

    #[test]
    fn wildcards_stand_for_any_and_for_one() {
        for (pattern, name, expected) in [
            ("mine*", "mine", true),
            ("mine*", "mine12", true),
            ("mine?", "mine", false),
            ("*ship", "starship", true),
            ("a*b*c", "aXbYbZc", true),
            ("a*b*c", "aXcYb", false),
            ("w?rfel", "würfel", true),
            ("", "", true),
            ("", "x", false),
        ] {
            let found = Pattern::new(pattern).matches(name, &mut 100);
            assert_eq!(found, Some(expected), "{pattern} {name}");
        }
    }

    #[test]
    fn many_wildcards_take_no_exponential_time() {
        let pattern = Pattern::new(&"*a".repeat(500));
        let name = "a".repeat(499) + &"b".repeat(5000);
        assert_eq!(pattern.matches(&name, &mut 10_000), Some(false));
        assert_eq!(pattern.matches(&name, &mut 5_000), None);
    }

    #[test]
    fn universal_patterns_and_names_are_told() {
        assert!(Pattern::new("**").is_universal() && !Pattern::new("").is_universal());
        assert!(Pattern::new("ship").is_name() && !Pattern::new("sh?p").is_name());
    }

    proptest! {
        #[test]
        fn it_matches_what_the_definition_matches(pattern in "[ab*?]{0,8}", name in "[ab]{0,8}") {
            let letters = |text: &str| text.chars().collect::<Vec<_>>();
            let expected = matches(&letters(&pattern), &letters(&name));
            prop_assert_eq!(Pattern::new(&pattern).matches(&name, &mut 1_000), Some(expected));
        }
    }
}
