//! Patterns of object names.

/// A name with wildcards: `*` for any characters, also none, and `?` for one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    letters: Vec<char>,
}

impl Pattern {
    pub fn new(text: &str) -> Self {
        Pattern { letters: text.chars().collect() }
    }

    /// Whether it has no wildcards, so that only the name itself matches.
    pub fn is_name(&self) -> bool {
        !self.letters.iter().any(|c| matches!(c, '*' | '?'))
    }

    /// Whether every name matches.
    pub fn is_universal(&self) -> bool {
        !self.letters.is_empty() && self.letters.iter().all(|&c| c == '*')
    }

    /// Whether a whole name matches. Cost: at most the product of the lengths.
    pub fn matches(&self, name: &str) -> bool {
        let name: Vec<char> = name.chars().collect();
        let (mut i, mut j) = (0, 0);
        // The last `*` met, and where in the name the rest was tried after it. Only the last can need another try: what the
        // earlier ones take is as short as possible, which leaves the most for the rest.
        let mut retry: Option<(usize, usize)> = None;
        while j < name.len() {
            match self.letters.get(i) {
                Some('*') => {
                    retry = Some((i, j));
                    i += 1;
                }
                Some(&c) if c == '?' || c == name[j] => (i, j) = (i + 1, j + 1),
                _ => match retry {
                    Some((star, from)) => {
                        retry = Some((star, from + 1));
                        (i, j) = (star + 1, from + 1);
                    }
                    None => return false,
                },
            }
        }
        self.letters[i..].iter().all(|&c| c == '*')
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
            assert_eq!(Pattern::new(pattern).matches(name), expected, "{pattern} {name}");
        }
    }

    #[test]
    fn many_wildcards_take_no_exponential_time() {
        let pattern = Pattern::new(&"*a".repeat(500));
        assert!(!pattern.matches(&("a".repeat(499) + &"b".repeat(5000))));
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
            prop_assert_eq!(Pattern::new(&pattern).matches(&name), expected);
        }
    }
}
