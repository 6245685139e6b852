//! What is known of some of the broad phase's pairs.

use crate::broad::PairId;
use crate::broad::room::{push, resize};

/// No place.
const NONE: u32 = u32::MAX;

/// A map from pairs. The ids of pairs are dense, but more than half of them may be of boxes that do not overlap, of which
/// nothing is known: so they have a word each, and only what there is has more.
#[derive(Debug)]
pub(super) struct PairMap<T> {
    /// By pair: where its value stands.
    places: Vec<u32>,
    values: Vec<T>,
    /// Where values stand that were taken out.
    unused: Vec<u32>,
}

impl<T> Default for PairMap<T> {
    fn default() -> Self {
        PairMap { places: Vec::new(), values: Vec::new(), unused: Vec::new() }
    }
}

impl<T: Copy> PairMap<T> {
    /// A number above that of every pair.
    pub fn end(&self) -> usize {
        self.places.len()
    }

    /// Sets what is known of a pair.
    pub fn insert(&mut self, pair: PairId, value: T) {
        let at = pair as usize;
        if at >= self.places.len() {
            resize(&mut self.places, at + 1, NONE);
        }
        if let Some(old) = self.get_mut(pair) {
            *old = value;
        } else if let Some(place) = self.unused.pop() {
            self.places[at] = place;
            self.values[place as usize] = value;
        } else {
            self.places[at] = self.values.len() as u32;
            push(&mut self.values, value);
        }
    }

    /// Forgets a pair.
    pub fn remove(&mut self, pair: PairId) -> Option<T> {
        let place = self.places.get_mut(pair as usize).filter(|place| **place != NONE)?;
        let place = std::mem::replace(place, NONE);
        push(&mut self.unused, place);
        Some(self.values[place as usize])
    }

    pub fn get(&self, pair: PairId) -> Option<&T> {
        self.places.get(pair as usize).and_then(|&place| self.values.get(place as usize))
    }

    pub fn get_mut(&mut self, pair: PairId) -> Option<&mut T> {
        self.places.get(pair as usize).and_then(|&place| self.values.get_mut(place as usize))
    }

    /// The pairs of which something is known.
    pub fn keys(&self) -> impl Iterator<Item = PairId> {
        (0..).zip(&self.places).filter(|&(_, &place)| place != NONE).map(|(pair, _)| pair)
    }

    /// What is known, and what was before it was taken out.
    pub fn values_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.values.iter_mut()
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use rand::Rng;
    use solid_oracle::generate::seeded;

    use super::*;

    /// Law: it is a map; what it holds takes no more places than there ever were values at once.
    #[test]
    fn it_says_what_a_tree_map_says() {
        let mut rng = seeded(841);
        let (mut map, mut truth) = (PairMap::default(), BTreeMap::new());
        let (mut most, mut hits) = (0, 0);
        for step in 0..10_000 {
            let pair = rng.random_range(0..100);
            hits += usize::from(truth.contains_key(&pair));
            assert_eq!(map.get(pair), truth.get(&pair));
            if rng.random_bool(0.5) {
                map.insert(pair, step);
                truth.insert(pair, step);
            } else {
                assert_eq!(map.remove(pair), truth.remove(&pair));
            }
            assert_eq!(map.get_mut(pair), truth.get_mut(&pair));
            most = most.max(truth.len());
        }
        assert!(map.keys().eq(truth.keys().copied()));
        assert!(map.values.len() == most && (3_000..7_000).contains(&hits), "{hits} hits, {most} values");
    }
}
