//! Finding objects by pattern.

use std::collections::HashMap;

use super::file::Names;
use crate::suggest;

/// The names of a scene's objects, to look them up.
pub struct NameIndex<'a> {
    names: &'a [&'a str],
    places: HashMap<&'a str, usize>,
}

impl<'a> NameIndex<'a> {
    /// An index of unique names.
    pub fn new(names: &'a [&'a str]) -> Self {
        NameIndex { names, places: names.iter().enumerate().map(|(place, &name)| (name, place)).collect() }
    }

    /// The places of the names that match, in order.
    pub fn matching(&self, wanted: &Names) -> Vec<usize> {
        if wanted.pattern.is_name() {
            return self.places.get(wanted.text.as_str()).copied().into_iter().collect();
        }
        (0..self.names.len()).filter(|&place| wanted.pattern.matches(self.names[place])).collect()
    }

    /// In words, that nothing matches.
    pub fn nothing_matches(&self, wanted: &Names) -> String {
        let hint = if wanted.pattern.is_name() {
            suggest::hint(&wanted.text, self.names.iter().copied())
        } else {
            String::new()
        };
        format!("{}: {:?} matches no object{hint}", wanted.place, wanted.text)
    }
}
