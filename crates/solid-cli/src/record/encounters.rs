//! What comes near what, from when to when, and where it is nearest.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use crate::table::{self, Column, Style};
use crate::words;

/// Two things beside each other in a frame.
pub trait Sight: Copy {
    /// Which two.
    fn pair(&self) -> (usize, usize);

    /// How far they are from each other. World units.
    fn distance(&self) -> f64;
}

/// One entry for each two that are seen at some time.
#[derive(Debug)]
pub struct Encounters<T> {
    /// In the order in which they are first seen.
    entries: Vec<Encounter<T>>,
    places: HashMap<(usize, usize), usize>,
    frames: u64,
}

/// Two that are seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encounter<T> {
    /// The times of the first and last frame, in seconds.
    pub first: f64,
    pub last: f64,
    pub frames: u64,
    /// Where they are nearest, for the first time.
    pub nearest: T,
    /// When, in seconds.
    pub time: f64,
}

impl<T> Default for Encounters<T> {
    fn default() -> Self {
        Encounters { entries: Vec::new(), places: HashMap::new(), frames: 0 }
    }
}

impl<T: Sight> Encounters<T> {
    /// Takes in what is seen in a frame.
    pub fn count(&mut self, seen: &[T], time: f64) {
        self.frames += u64::from(!seen.is_empty());
        for &sight in seen {
            match self.places.entry(sight.pair()) {
                Entry::Occupied(place) => self.entries[*place.get()].extend(sight, time),
                Entry::Vacant(place) => {
                    place.insert(self.entries.len());
                    self.entries.push(Encounter { first: time, last: time, frames: 1, nearest: sight, time });
                }
            }
        }
    }

    /// Those so far.
    pub fn entries(&self) -> &[Encounter<T>] {
        &self.entries
    }

    /// The frames in which some two are seen.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// A table, ended by an empty line; empty without any. Its first two columns and its last two are of words, in which `words` puts the
    /// nearest of each.
    pub fn table(
        &self,
        style: Style,
        [one, other, at_one, at_other]: [&'static str; 4],
        words: impl Fn(&T) -> [String; 4],
    ) -> String {
        if self.entries.is_empty() {
            return String::new();
        }
        let columns = [
            Column::Left(one),
            Column::Left(other),
            Column::Right("first [s]"),
            Column::Right("last [s]"),
            Column::Right("frames"),
            Column::Right("nearest"),
            Column::Right("at [s]"),
            Column::Left(at_one),
            Column::Left(at_other),
        ];
        let row = |encounter: &Encounter<T>| encounter.row(words(&encounter.nearest));
        table::draw(style, &columns, self.entries.iter().map(row)) + "\n"
    }
}

impl<T: Sight> Encounter<T> {
    fn extend(&mut self, sight: T, time: f64) {
        self.last = time;
        self.frames += 1;
        if sight.distance() < self.nearest.distance() {
            (self.nearest, self.time) = (sight, time);
        }
    }

    fn row(&self, [one, other, at_one, at_other]: [String; 4]) -> Vec<String> {
        let [first, last, time] = [self.first, self.last, self.time].map(words::seconds);
        let (frames, nearest) = (self.frames.to_string(), words::figure(self.nearest.distance()));
        vec![one, other, first, last, frames, nearest, time, at_one, at_other]
    }
}
