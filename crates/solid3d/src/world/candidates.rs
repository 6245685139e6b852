//! The pairs that a test examines, with what is kept of each from test to test.
//!
//! A candidate is made when the boxes of two objects come to overlap and forgotten when they cease to. What its last examination
//! said stands until one of the two objects, its previous frame or the response of the pair changes: then the candidate is put
//! into the queue, which the next test examines. So the cost of a test follows what changed.

use glam::DVec3;

use super::arena::Arena;
use super::findings::{FindingId, Findings};
use super::near::{Near, Nearness};
#[cfg(feature = "rayon")]
use super::object::Object;
use super::object::Staleness;
use super::pair_map::PairMap;
#[cfg(feature = "rayon")]
use super::threads::{BATCH, Workers};
use super::{Contact, ObjectId, World};
use crate::broad::room::push;
use crate::broad::{PairChange, PairId};

/// What the box of an object costs that moved, at least, in units of [`Workers::share`].
#[cfg(feature = "rayon")]
const UNITS_PER_BOX: u64 = 4;

/// When one in so many objects changed, all candidates are looked at in one pass, rather than those of each that did.
const MANY: usize = 4;

/// Two objects by their places in the order of pairs, the earlier first: the order of the results.
pub(super) type PairKey = (u64, u64);

/// A pair whose boxes overlap.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    /// In the order of pairs.
    pub a: ObjectId,
    pub b: ObjectId,
    /// The axis that separated the pair when it was last examined.
    pub axis: Option<DVec3>,
    /// Its collision, if it had one when it was last examined.
    pub found: Option<FindingId>,
    /// Whether its response was not to ignore it when it was last examined.
    pub matters: bool,
    /// Whether it waits to be examined.
    pub queued: bool,
}

/// All candidates.
#[derive(Debug, Default)]
pub(super) struct Candidates {
    slots: PairMap<Candidate>,
    /// Pairs to be examined, some of them twice; some may be none any more.
    queue: Vec<PairId>,
    /// How many matter.
    pub count: u64,
    /// What the last search for near pairs said, by the broad phase's pair; as long as that search needed.
    nearness: Vec<Nearness>,
}

impl Candidates {
    /// Adds a candidate, to be examined.
    fn begin(&mut self, pair: PairId, a: ObjectId, b: ObjectId) {
        self.stir_nearness(pair);
        let candidate = Candidate { a, b, axis: None, found: None, matters: false, queued: true };
        self.slots.insert(pair, candidate);
        push(&mut self.queue, pair);
    }

    /// Forgets a candidate and its collision.
    pub fn end(&mut self, pair: PairId, findings: &mut Findings) {
        if let Some(candidate) = self.slots.remove(pair) {
            self.stir_nearness(pair);
            self.count -= u64::from(candidate.matters);
            if let Some(found) = candidate.found {
                findings.remove(found);
            }
        }
    }

    /// Has a candidate examined by the next test.
    pub fn enqueue(&mut self, pair: PairId) {
        self.stir_nearness(pair);
        if let Some(candidate) = self.slots.get_mut(pair)
            && !std::mem::replace(&mut candidate.queued, true)
        {
            self.queue.push(pair);
        }
    }

    /// Has a candidate examined by the next test if it depends on what of one of its objects is out of date.
    fn enqueue_if(&mut self, pair: PairId, staleness: Staleness, findings: &Findings) {
        let looks_back = || match self.get(pair).found {
            Some(found) => matches!(findings.collision(found).contact, Contact::Smart { .. }),
            None => false,
        };
        if staleness > Staleness::Previous || staleness == Staleness::Previous && looks_back() {
            self.enqueue(pair);
        }
    }

    /// The same with every candidate: each is looked at once, in the order in which they are kept.
    fn enqueue_stirred(&mut self, objects: &Arena, findings: &Findings) {
        for pair in 0..self.slots.end() as PairId {
            if let Some(&Candidate { a, b, .. }) = self.slots.get(pair) {
                let staleness = objects[a].staleness.max(objects[b].staleness);
                self.enqueue_if(pair, staleness, findings);
            }
        }
    }

    /// Has every candidate examined by the next test.
    pub fn enqueue_all(&mut self) {
        for pair in 0..self.slots.end() as PairId {
            self.enqueue(pair);
        }
    }

    /// Forgets what was learned about pairs that may help to examine them.
    pub fn forget_axes(&mut self) {
        self.slots.values_mut().for_each(|candidate| candidate.axis = None);
    }

    /// Moves the queue to `pairs`, each pair once.
    pub fn take_queue(&mut self, pairs: &mut Vec<PairId>) {
        pairs.clear();
        for pair in self.queue.drain(..) {
            if let Some(candidate) = self.slots.get_mut(pair)
                && std::mem::replace(&mut candidate.queued, false)
            {
                pairs.push(pair);
            }
        }
    }

    /// Notes that a candidate may be nearer or further than it was.
    fn stir_nearness(&mut self, pair: PairId) {
        if let Some(nearness) = self.nearness.get_mut(pair as usize) {
            *nearness = Nearness::Unknown;
        }
    }

    /// Forgets how near all candidates are.
    pub fn forget_nearness(&mut self) {
        self.nearness.clear();
    }

    /// Puts into `pairs` the candidates of which it is not known how near they are.
    pub fn unknown(&mut self, pairs: &mut Vec<PairId>) {
        pairs.clear();
        self.nearness.resize(self.slots.end(), Nearness::Unknown);
        let is_unknown = |&pair: &PairId| matches!(self.nearness[pair as usize], Nearness::Unknown);
        pairs.extend(self.slots.keys().filter(is_unknown));
    }

    pub fn set_nearness(&mut self, pair: PairId, nearness: Nearness) {
        self.nearness[pair as usize] = nearness;
    }

    /// The candidates that are near, in any order.
    pub fn near(&self) -> impl Iterator<Item = &Near> {
        self.nearness.iter().filter_map(|nearness| match nearness {
            Nearness::Near(near) => Some(near),
            Nearness::Unknown | Nearness::Far => None,
        })
    }

    pub fn get(&self, pair: PairId) -> &Candidate {
        self.slots.get(pair).expect("pairs in the queue are candidates")
    }

    pub fn get_mut(&mut self, pair: PairId) -> &mut Candidate {
        self.slots.get_mut(pair).expect("pairs in the queue are candidates")
    }
}

impl World {
    /// Brings the candidates up to date, and queues those about which something changed.
    pub(super) fn refresh(&mut self) {
        if !std::mem::replace(&mut self.stale, false) {
            return;
        }
        self.update_broad();
        let Self { broad, candidates, findings, objects, stirred, .. } = self;
        for &PairChange { pair, proxies, overlaps } in broad.changes() {
            if overlaps {
                let [a, b] = proxies.map(|proxy| objects.id_of(proxy));
                let (a, b) = if objects[a].order <= objects[b].order { (a, b) } else { (b, a) };
                candidates.begin(pair, a, b);
            } else {
                candidates.end(pair, findings);
            }
        }
        if MANY * stirred.len() >= objects.len() {
            candidates.enqueue_stirred(objects, findings);
            stirred.drain(..).for_each(|id| objects.freshen(id));
        }
        for id in stirred.drain(..) {
            let staleness = objects.get(id).map_or(Staleness::Fresh, |object| object.staleness);
            objects.freshen(id);
            if staleness > Staleness::Fresh {
                let mut enqueue = |pair, _| candidates.enqueue_if(pair, staleness, findings);
                broad.for_each_pair_of(super::proxy(id), &mut enqueue);
            }
        }
        if std::mem::take(&mut self.default_changed) {
            candidates.enqueue_all();
        }
    }

    /// Gives the broad phase the boxes of what moved.
    fn update_broad(&mut self) {
        #[cfg(feature = "rayon")]
        if Workers::share(UNITS_PER_BOX * self.stirred.len() as u64) {
            self.update_boxes_on_threads();
            return self.broad.flush();
        }
        let Self { broad, objects, stirred, clearances, .. } = self;
        for &id in stirred.iter() {
            if let Some(object) = objects.get_mut(id).filter(|object| object.staleness == Staleness::Bounds) {
                let bounds = object.bounds();
                broad.update(super::proxy(id), clearances.grown(object.set_bounds(bounds)));
            }
        }
        broad.flush();
    }

    #[cfg(feature = "rayon")]
    fn update_boxes_on_threads(&mut self) {
        let Self { broad, objects, stirred, clearances, workers, new_bounds, .. } = self;
        for batch in stirred.chunks(BATCH) {
            workers.map(batch, new_bounds, |&id, _| {
                let object = objects.get(id).filter(|object| object.staleness == Staleness::Bounds);
                object.map(Object::bounds)
            });
            for (&id, bounds) in batch.iter().zip(new_bounds.drain(..)) {
                if let Some(bounds) = bounds {
                    let bounds = objects[id].set_bounds(bounds);
                    broad.update(super::proxy(id), clearances.grown(bounds));
                }
            }
        }
    }

    /// Two objects of the world in the order of pairs.
    pub(super) fn in_order(&self, a: ObjectId, b: ObjectId) -> (ObjectId, ObjectId) {
        if self.objects[a].order <= self.objects[b].order { (a, b) } else { (b, a) }
    }

    /// The place of a pair in the order; the earlier object first.
    pub(super) fn key(&self, a: ObjectId, b: ObjectId) -> PairKey {
        (self.objects[a].order, self.objects[b].order)
    }
}
