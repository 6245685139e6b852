//! What changed since the candidates were brought up to date.

use crate::broad::Proxy;
use crate::broad::room::{push_word, resize};

/// What of an object is out of date in the candidates: each includes those before it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Staleness {
    /// Nothing.
    #[default]
    Fresh,
    /// What depends on its previous frame.
    Previous,
    /// All that was found about its pairs.
    Pairs,
    /// Its box in the broad phase, but that it was removed.
    Gone,
    /// Its box in the broad phase.
    Bounds,
}

/// Objects about which something changed, by their slots; some may have been removed since, and others added in their slots.
///
/// Apart from the objects, because a test looks at this of both objects of every pair: a byte for each is at hand always.
#[derive(Clone, Debug, Default)]
pub(super) struct Stirred {
    /// By slot, as far as any was stirred.
    staleness: Vec<Staleness>,
    /// Those whose box is out of date, and some that are gone, each once.
    elsewhere: Vec<Proxy>,
    /// Those of which only something else is out of date, each once, and perhaps some that are [elsewhere](Self::elsewhere).
    others: Vec<Proxy>,
}

impl Stirred {
    /// Notes what of an object is out of date.
    #[inline]
    pub fn stir(&mut self, slot: Proxy, what: Staleness) {
        let Some(staleness) = self.staleness.get_mut(slot as usize) else { return self.stir_new(slot, what) };
        if what == Staleness::Bounds {
            if *staleness < Staleness::Gone {
                push_word(&mut self.elsewhere, slot);
            }
        } else if *staleness == Staleness::Fresh {
            push_word(&mut self.others, slot);
        }
        *staleness = what.max(*staleness);
    }

    /// The same in a slot that is beyond those stirred before.
    #[cold]
    #[inline(never)]
    fn stir_new(&mut self, slot: Proxy, what: Staleness) {
        resize(&mut self.staleness, slot as usize + 1, Staleness::Fresh);
        self.stir(slot, what);
    }

    pub fn of(&self, slot: Proxy) -> Staleness {
        self.staleness.get(slot as usize).copied().unwrap_or_default()
    }

    /// Notes that the object in a slot is gone: it has no box that the broad phase is to be told.
    pub fn vacate(&mut self, slot: Proxy) {
        if self.is_elsewhere(slot) {
            self.staleness[slot as usize] = Staleness::Gone;
        }
    }

    /// Whether the broad phase has an earlier box of an object, which is in the world.
    pub fn is_elsewhere(&self, slot: Proxy) -> bool {
        self.of(slot) == Staleness::Bounds
    }

    /// How many there are at most.
    pub fn len(&self) -> usize {
        self.elsewhere.len() + self.others.len()
    }

    /// Those of whose objects the broad phase has earlier boxes.
    pub fn elsewhere(&self) -> impl Iterator<Item = Proxy> {
        self.elsewhere.iter().copied().filter(|&slot| self.is_elsewhere(slot))
    }

    /// Puts the slots in order, and leaves out what is gone, and what is elsewhere from the others.
    pub fn sort(&mut self) {
        let Self { staleness, elsewhere, others } = self;
        others.retain(|&slot| staleness[slot as usize] < Staleness::Gone);
        elsewhere.retain(|&slot| {
            let staleness = &mut staleness[slot as usize];
            let is_there = *staleness == Staleness::Bounds;
            if !is_there {
                *staleness = Staleness::Fresh;
            }
            is_there
        });
        elsewhere.sort_unstable();
        others.sort_unstable();
    }

    /// After a [`sort`](Self::sort), those that are [elsewhere](Self::elsewhere), and the others of which something is out of date.
    pub fn sorted(&self) -> [&[Proxy]; 2] {
        [&self.elsewhere, &self.others]
    }

    /// Notes that nothing is out of date any more.
    pub fn clear(&mut self) {
        for slot in self.elsewhere.drain(..).chain(self.others.drain(..)) {
            self.staleness[slot as usize] = Staleness::Fresh;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use rand::Rng;
    use solid_oracle::generate::seeded;

    use super::*;

    /// Law: a slot is as stale as the worst that was noted of it, and in one of the lists, once; but the box of what is gone is nowhere.
    #[test]
    fn each_slot_is_listed_once() {
        let mut rng = seeded(181);
        for _ in 0..200 {
            let (mut stirred, mut expected, mut is_there) = (Stirred::default(), BTreeMap::new(), [true; 12]);
            for _ in 0..rng.random_range(0..80) {
                let slot: Proxy = rng.random_range(0..12);
                let was_there = std::mem::replace(&mut is_there[slot as usize], true);
                let what = match rng.random_range(0..4) {
                    0 if was_there => {
                        stirred.vacate(slot);
                        expected.retain(|&other, what| other != slot || *what < Staleness::Gone);
                        is_there[slot as usize] = false;
                        continue;
                    }
                    1 if was_there => Staleness::Previous,
                    2 if was_there => Staleness::Pairs,
                    // What comes into the world has a new box.
                    _ => Staleness::Bounds,
                };
                stirred.stir(slot, what);
                let worst = expected.entry(slot).or_insert(what);
                *worst = what.max(*worst);
            }
            let listed = |is_elsewhere: bool| {
                let of_one =
                    expected.iter().filter(move |(_, what)| (**what == Staleness::Bounds) == is_elsewhere);
                of_one.map(|(&slot, _)| slot).collect::<Vec<Proxy>>()
            };
            let mut elsewhere: Vec<Proxy> = stirred.elsewhere().collect();
            elsewhere.sort_unstable();
            assert_eq!(elsewhere, listed(true));
            stirred.sort();
            assert_eq!(stirred.sorted(), [listed(true), listed(false)]);
            assert!(expected.iter().all(|(&slot, &what)| stirred.of(slot) == what));
            stirred.clear();
            assert!((0..12).all(|slot| stirred.of(slot) == Staleness::Fresh));
        }
    }
}
