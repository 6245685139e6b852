//! Finding objects by pattern.

use std::collections::HashMap;

use super::file::Names;
use crate::suggest;
use crate::words::quoted;

/// For how many names that match nothing one is suggested: each is compared with all names.
const HINTS_MAX: usize = 20;

/// The names of a scene's objects, to look them up.
pub struct NameIndex<'a> {
    names: &'a [&'a str],
    places: HashMap<&'a str, usize>,
    warnings: Vec<String>,
}

impl<'a> NameIndex<'a> {
    /// An index of unique names.
    pub fn new(names: &'a [&'a str]) -> Self {
        let places = names.iter().enumerate().map(|(place, &name)| (name, place)).collect();
        NameIndex { names, places, warnings: Vec::new() }
    }

    /// The places of the names that match, in order. Notes when there are none.
    pub fn matching(&mut self, wanted: &Names) -> Vec<usize> {
        let found: Vec<usize> = if wanted.pattern.is_name() {
            self.places.get(wanted.text.as_str()).copied().into_iter().collect()
        } else {
            (0..self.names.len()).filter(|&place| wanted.pattern.matches(self.names[place])).collect()
        };
        if found.is_empty() {
            self.warnings.push(self.nothing_matches(wanted));
        }
        found
    }

    /// Of several that a pattern matches those that are meshes. Notes when there are none.
    pub fn meshes_matching(&mut self, wanted: &Names, is_mesh: impl Fn(usize) -> bool) -> Vec<usize> {
        let mut found = self.matching(wanted);
        if !wanted.pattern.is_name() && !found.is_empty() {
            found.retain(|&place| is_mesh(place));
            if found.is_empty() {
                self.warnings.push(format!("{}: {} matches no mesh", wanted.place, quoted(&wanted.text)));
            }
        }
        found
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
