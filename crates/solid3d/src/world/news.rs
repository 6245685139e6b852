//! What examining candidates gave, and where it is kept.

use super::candidates::{Candidate, PairKey};
use super::examine::Outcome;
use super::findings::Findings;
use super::pair_map::Place;
use super::threads::{Items, PART};
use super::{Collision, Contact, Statistics, When};

/// What examining some candidates gave that is not of one of them alone.
#[derive(Debug, Default)]
pub(super) struct News {
    /// Those whose collision is not what it was, or may not be, with their place in the order of pairs.
    pub changed: Vec<(Place, PairKey, Outcome)>,
    /// Of collisions that are so, in the order of the candidates.
    pub described: Vec<(When, Contact)>,
    /// How many matter, and how many did.
    pub matter: u64,
    pub mattered: u64,
    pub work: Statistics,
}

/// Adds something of one of the candidates of a part.
pub(super) fn push_of_part<T>(list: &mut Vec<T>, element: T) {
    // No part ever has more: so a world in which as much happens as before takes no memory.
    list.reserve_exact(PART.saturating_sub(list.len()));
    list.push(element);
}

/// Where it is kept what examinations gave.
pub(super) struct Notes<'a> {
    pub findings: &'a mut Findings,
    /// How many candidates matter.
    pub count: &'a mut u64,
    pub statistics: &'a mut Statistics,
}

impl Notes<'_> {
    /// Keeps what the examination of some candidates gave.
    pub fn keep(&mut self, mut examined: Items<Option<Candidate>>, news: &mut [News]) {
        for news in news.iter_mut().take(examined.places.len().div_ceil(PART)) {
            *self.statistics += std::mem::take(&mut news.work);
            *self.count += std::mem::take(&mut news.matter);
            *self.count -= std::mem::take(&mut news.mattered);
            let mut described = news.described.drain(..);
            for (place, key, outcome) in news.changed.drain(..) {
                let found = outcome.found(|| described.next());
                let candidate = examined.at(place).as_mut().expect("what was examined is a candidate");
                let &mut Candidate { a, b, found: ref mut id, .. } = candidate;
                match (*id, found) {
                    (None, None) => {}
                    (None, Some((when, contact))) => {
                        *id = Some(self.findings.add(key, Collision { a, b, when, contact }));
                    }
                    (Some(was), None) => {
                        self.findings.remove(was);
                        *id = None;
                    }
                    (Some(was), Some((when, contact))) => self.findings.replace(was, when, contact),
                }
            }
        }
    }
}
