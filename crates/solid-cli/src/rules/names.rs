//! Finding objects by pattern.

use std::collections::HashMap;

use anyhow::{Result, anyhow};

use super::file::Names;
use crate::suggest;
use crate::words::{self, quoted};

/// For how many names that match nothing one is suggested: each is compared with all names.
const HINTS_MAX: usize = 20;

/// How many steps patterns with `*` or `?` may take, one and more for each name: some seconds.
const STEPS_MAX: u64 = 1_000_000_000;

/// The names of a scene's objects, to look them up.
pub struct NameIndex<'a> {
    names: &'a [&'a str],
    places: HashMap<&'a str, usize>,
    /// How many more steps patterns may take.
    steps: u64,
    warnings: Vec<String>,
}

impl<'a> NameIndex<'a> {
    /// An index of unique names.
    pub fn new(names: &'a [&'a str]) -> Self {
        let places = names.iter().enumerate().map(|(place, &name)| (name, place)).collect();
        NameIndex { names, places, steps: STEPS_MAX, warnings: Vec::new() }
    }

    /// The places of the names that match, in order. Notes when there are none.
    pub fn matching(&mut self, wanted: &Names) -> Result<Vec<usize>> {
        let found: Vec<usize> = if wanted.pattern.is_name() {
            self.places.get(wanted.text.as_str()).copied().into_iter().collect()
        } else {
            self.matching_pattern(wanted)?
        };
        if found.is_empty() {
            self.warnings.push(self.nothing_matches(wanted));
        }
        Ok(found)
    }

    fn matching_pattern(&mut self, wanted: &Names) -> Result<Vec<usize>> {
        let mut found = Vec::new();
        for (place, name) in self.names.iter().enumerate() {
            let matches = wanted.pattern.matches(name, &mut self.steps);
            let too_long = || {
                let (place, objects) = (&wanted.place, words::count(words::size(self.names.len()), "object"));
                anyhow!(
                    "{place}: to find which of {objects} match the patterns so far takes more than {STEPS_MAX} steps, the \
                     limit; fewer patterns with `*` or `?` take fewer, names none"
                )
            };
            if matches.ok_or_else(too_long)? {
                found.push(place);
            }
        }
        Ok(found)
    }

    /// Of several that a pattern matches those that are meshes. Notes when there are none.
    pub fn meshes_matching(&mut self, wanted: &Names, is_mesh: impl Fn(usize) -> bool) -> Result<Vec<usize>> {
        let mut found = self.matching(wanted)?;
        if !wanted.pattern.is_name() && !found.is_empty() {
            found.retain(|&place| is_mesh(place));
            if found.is_empty() {
                self.warnings.push(format!("{}: {} matches no mesh", wanted.place, quoted(&wanted.text)));
            }
        }
        Ok(found)
    }

    /// Notes that both sides of a rule for pairs name one object.
    pub fn note_one_object(&mut self, name: &Names) {
        let (place, text) = (&name.place, quoted(&name.text));
        self.warnings.push(format!("{place}: a and b are both {text}; a pair needs two objects"));
    }

    /// What matched nothing, or no pair, in words, a line each.
    pub fn into_warnings(self) -> Vec<String> {
        self.warnings
    }

    fn nothing_matches(&self, wanted: &Names) -> String {
        let hints = wanted.pattern.is_name() && self.warnings.len() < HINTS_MAX;
        let candidates = if hints { self.names } else { &[] };
        let hint = suggest::hint(&wanted.text, candidates.iter().copied());
        format!("{}: {} matches no object{hint}", wanted.place, quoted(&wanted.text))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rules::Rules;

    #[test]
    fn patterns_have_a_limit_of_steps() {
        let rules = "[[object]]\nname = \"*a*ab\"\nresponse = \"ignore\"\n";
        let rules = Rules::parse(std::path::Path::new("r.toml"), rules).expect("the rules are well formed");
        let mut index = NameIndex { steps: 30, ..NameIndex::new(&["aaa", "ab", "aab"]) };
        assert_eq!(index.matching(&rules.objects[0].name).ok(), Some(vec![2]));
        let error = index.matching(&rules.objects[0].name).expect_err("too many steps").to_string();
        assert_eq!(
            error,
            "r.toml:2: to find which of 3 objects match the patterns so far takes more than 1000000000 steps, the \
             limit; fewer patterns with `*` or `?` take fewer, names none"
        );
    }
}
