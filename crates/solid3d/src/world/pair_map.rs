//! What is known of some of the broad phase's pairs.

use crate::broad::PairId;
use crate::broad::room::{give_back, push, resize};

/// No place.
const NONE: u32 = u32::MAX;

/// So many places without a value are no matter.
const UNUSED_FEW: usize = 1 << 10;

/// The place of a value: it keeps it while it is there, until [`PairMap::compact`].
pub(super) type Place = u32;

/// A map from pairs. The ids of pairs are dense, but more than half of them may be of boxes that do not overlap, of which
/// nothing is known: so they have a word each, and only what there is has more.
#[derive(Clone, Debug)]
pub(super) struct PairMap<T> {
    /// By pair: where its value stands.
    places: Vec<Place>,
    values: Vec<Option<T>>,
    /// Places without a value.
    unused: Vec<Place>,
}

impl<T> Default for PairMap<T> {
    fn default() -> Self {
        PairMap { places: Vec::new(), values: Vec::new(), unused: Vec::new() }
    }
}

impl<T> PairMap<T> {
    /// Sets what is known of a pair; gives its place.
    pub fn insert(&mut self, pair: PairId, value: T) -> Place {
        let at = pair as usize;
        if at >= self.places.len() {
            resize(&mut self.places, at + 1, NONE);
        }
        if self.places[at] == NONE {
            self.places[at] = self.unused.pop().unwrap_or_else(|| {
                push(&mut self.values, None);
                self.values.len() as Place - 1
            });
        }
        let place = self.places[at];
        self.values[place as usize] = Some(value);
        place
    }

    /// Forgets a pair.
    pub fn remove(&mut self, pair: PairId) -> Option<T> {
        let place = self.places.get_mut(pair as usize).filter(|place| **place != NONE)?;
        let place = std::mem::replace(place, NONE);
        push(&mut self.unused, place);
        self.values[place as usize].take()
    }

    /// Where the value of a pair stands.
    pub fn place(&self, pair: PairId) -> Option<Place> {
        self.places.get(pair as usize).copied().filter(|&place| place != NONE)
    }

    /// Whether most places have no value, and they are many.
    pub fn is_sparse(&self) -> bool {
        self.unused.len() > UNUSED_FEW.max(self.values.len() / 2)
    }

    /// Gives the values the first places, in the order of those that they had.
    pub fn compact(&mut self) {
        let Self { places, values, unused: compacted } = self;
        compacted.clear();
        let mut count = 0;
        compacted.extend(values.iter().map(|value| {
            let place = count;
            count += Place::from(value.is_some());
            place
        }));
        places.truncate(places.iter().rposition(|&place| place != NONE).map_or(0, |last| last + 1));
        places
            .iter_mut()
            .filter(|place| **place != NONE)
            .for_each(|place| *place = compacted[*place as usize]);
        values.retain(Option::is_some);
        compacted.clear();
        give_back(places);
        give_back(values);
        give_back(compacted);
    }

    pub fn get_mut(&mut self, place: Place) -> Option<&mut T> {
        self.values.get_mut(place as usize)?.as_mut()
    }

    /// By place.
    pub fn values(&self) -> &[Option<T>] {
        &self.values
    }

    pub fn values_mut(&mut self) -> &mut [Option<T>] {
        &mut self.values
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use rand::Rng;
    use solid_oracle::generate::seeded;

    use super::*;

    /// Law: to compact it changes nothing but places, and leaves none without a value.
    #[test]
    fn compact_it_is_the_same_map() {
        const PAIRS: PairId = 5_000;
        let mut map = PairMap::default();
        (0..PAIRS).for_each(|pair| _ = map.insert(pair, pair));
        assert!(!map.is_sparse());
        let stays = |pair: PairId| pair % 5 == 2 && pair < 4_000;
        (0..PAIRS).filter(|&pair| !stays(pair)).for_each(|pair| _ = map.remove(pair));
        assert!(map.is_sparse());
        let before: Vec<_> = map.values().iter().flatten().copied().collect();
        map.compact();
        assert!(!map.is_sparse() && map.values().iter().copied().eq(before.into_iter().map(Some)));
        for pair in 0..PAIRS {
            let value = map.place(pair).and_then(|place| map.get_mut(place).copied());
            assert_eq!(value, stays(pair).then_some(pair));
        }
        assert_eq!((map.insert(1, 1), map.places.len()), (800, 3_998));
    }

    /// Law: it is a map; what it holds takes no more places than there ever were values at once.
    #[test]
    fn it_says_what_a_tree_map_says() {
        let mut rng = seeded(841);
        let (mut map, mut truth) = (PairMap::default(), BTreeMap::new());
        let (mut most, mut hits) = (0, 0);
        for step in 0..10_000 {
            let pair = rng.random_range(0..100);
            hits += usize::from(truth.contains_key(&pair));
            assert_eq!(
                map.place(pair).and_then(|place| map.values()[place as usize].as_ref()),
                truth.get(&pair)
            );
            if rng.random_bool(0.5) {
                let place = map.insert(pair, step);
                assert_eq!((map.place(pair), map.get_mut(place)), (Some(place), Some(&mut { step })));
                truth.insert(pair, step);
            } else {
                assert_eq!(map.remove(pair), truth.remove(&pair));
            }
            most = most.max(truth.len());
        }
        let mut values: Vec<_> = map.values().iter().flatten().copied().collect();
        values.sort_unstable();
        assert!(values.iter().eq(truth.values().collect::<std::collections::BTreeSet<_>>()));
        assert!(map.values.len() == most && (3_000..7_000).contains(&hits), "{hits} hits, {most} values");
    }
}
