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
    /// Its box in the broad phase.
    Bounds,
}

/// Objects about which something changed, by their slots; some may have been removed since, and others added in their slots.
///
/// Apart from the objects, because a test looks at this of both objects of every pair: a byte for each is at hand always.
#[derive(Debug, Default)]
pub(super) struct Stirred {
    /// By slot, as far as any was stirred.
    staleness: Vec<Staleness>,
    /// Those that are not fresh, each once.
    slots: Vec<Proxy>,
}

impl Stirred {
    /// Notes what of an object is out of date.
    #[inline]
    pub fn stir(&mut self, slot: Proxy, what: Staleness) {
        let Some(staleness) = self.staleness.get_mut(slot as usize) else { return self.stir_new(slot, what) };
        if *staleness == Staleness::Fresh {
            push_word(&mut self.slots, slot);
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
            self.staleness[slot as usize] = Staleness::Pairs;
        }
    }

    /// Whether the broad phase has an earlier box of an object, which is in the world.
    pub fn is_elsewhere(&self, slot: Proxy) -> bool {
        self.of(slot) == Staleness::Bounds
    }

    pub fn slots(&self) -> &[Proxy] {
        &self.slots
    }

    /// Puts those that are [elsewhere](Self::is_elsewhere) first, and both them and the others in order.
    pub fn sort(&mut self) {
        let Self { staleness, slots } = self;
        slots.sort_unstable();
        let is_elsewhere = |slot: Proxy| staleness[slot as usize] == Staleness::Bounds;
        // Mostly all are. A sort by both at once took 130 us for 100,000, in place of 31 for that above.
        if !slots.iter().all(|&slot| is_elsewhere(slot)) {
            slots.sort_unstable_by_key(|&slot| (!is_elsewhere(slot), slot));
        }
    }

    /// Those that are elsewhere, in order, after a [`sort`](Self::sort).
    pub fn elsewhere(&self) -> &[Proxy] {
        &self.slots[..self.slots.partition_point(|&slot| self.is_elsewhere(slot))]
    }

    /// Notes that nothing is out of date any more.
    pub fn clear(&mut self) {
        for slot in self.slots.drain(..) {
            self.staleness[slot as usize] = Staleness::Fresh;
        }
    }
}
