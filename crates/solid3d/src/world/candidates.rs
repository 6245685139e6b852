//! The pairs that a test examines, with what is kept of each from test to test.
//!
//! A candidate is made when the boxes of two objects come to overlap and forgotten when they cease to. What its last examination
//! said stands until one of the two objects, its previous frame or the response of the pair changes: then the candidate is put
//! into the queue, which the next test examines. So the cost of a test follows what changed.

use solid_convex::gjk::Proof;
use solid_convex::simd::dispatch;

use super::arena::slot_of;
use super::findings::{FindingId, Findings};
use super::lapsed::Lapsed;
use super::near::{Near, Nearness};
use super::pair_map::{PairMap, Place};
use super::stirred::Staleness;
use super::threads::Workers;
use super::{Contact, ObjectId, World};
use crate::broad::room::{give_back, push};
use crate::broad::{ASKED_MANY, PairChange, PairId};
use crate::threads::{between, for_each_part, in_pool};

/// When one in so many objects changed, all candidates are looked at in one pass, rather than those of each that did.
const MANY: usize = 4;

/// A look at so many candidates, of some 5 ns each, is worth another thread.
const LOOKED_AT_MANY: usize = 1 << 13;

/// Two objects by their places in the order of pairs, the earlier first: the order of the results.
pub(super) type PairKey = (u64, u64);

/// A pair whose boxes overlap.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    /// In the order of pairs.
    pub a: ObjectId,
    pub b: ObjectId,
    /// What showed whether the pair collides when it was last examined.
    pub proof: Proof,
    /// Its collision, if it had one when it was last examined.
    pub found: Option<FindingId>,
    /// Whether that is one of which nothing is known but that it is there now.
    pub is_plain: bool,
    /// Whether its response was not to ignore it when it was last examined.
    pub matters: bool,
    /// Whether it waits to be examined.
    queued: bool,
    /// Whether what the last search for near pairs said of it still holds.
    nearness_holds: bool,
}

impl Candidate {
    /// Notes that something about it changed; whether it was not to be examined before.
    fn stir(&mut self) -> bool {
        self.nearness_holds = false;
        !std::mem::replace(&mut self.queued, true)
    }

    /// Whether it depends on what of one of its objects is out of date.
    fn depends_on(&self, staleness: Staleness, findings: &Findings) -> bool {
        let looks_back = || match self.found {
            Some(found) => matches!(findings.collision(found).contact, Contact::Smart { .. }),
            None => false,
        };
        staleness > Staleness::Previous || staleness == Staleness::Previous && looks_back()
    }
}

/// All candidates.
#[derive(Clone, Debug, Default)]
pub(super) struct Candidates {
    slots: PairMap<Candidate>,
    /// Candidates to be examined, some of them twice; some may be none any more.
    queue: Vec<Place>,
    /// Whether others wait to be examined too.
    more_wait: bool,
    /// How many matter.
    pub count: u64,
    /// The collisions of candidates that were forgotten since the last test.
    pub lapsed: Lapsed,
    /// What the last search for near pairs said, as far as it holds; as long as that search needed.
    nearness: Vec<Nearness>,
}

impl Candidates {
    /// Adds a candidate, to be examined.
    fn begin(&mut self, pair: PairId, a: ObjectId, b: ObjectId) {
        let candidate = Candidate {
            a,
            b,
            proof: Proof::None,
            found: None,
            is_plain: false,
            matters: false,
            queued: true,
            nearness_holds: false,
        };
        let place = self.slots.insert(pair, candidate);
        push(&mut self.queue, place);
    }

    /// Forgets a candidate. Its collision is still that of the last test, and lapses with the next.
    pub fn end(&mut self, pair: PairId) {
        if let Some(candidate) = self.slots.remove(pair) {
            self.count -= u64::from(candidate.matters);
            candidate.found.into_iter().for_each(|found| self.lapsed.add(found));
        }
    }

    /// Has a candidate examined by the next test.
    pub fn enqueue(&mut self, pair: PairId) {
        self.enqueue_if(pair, |_| true);
    }

    fn enqueue_if(&mut self, pair: PairId, is_concerned: impl Fn(&Candidate) -> bool) {
        if let Some(place) = self.slots.place(pair)
            && let Some(candidate) = self.slots.get_mut(place)
            && is_concerned(candidate)
            && candidate.stir()
        {
            self.queue.push(place);
        }
    }

    /// The same with every candidate: each is looked at once, in the order in which they are kept.
    fn enqueue_where(&mut self, is_concerned: impl Fn(&Candidate) -> bool + Sync + Send) {
        /// One thread looks at so many at a time.
        const PART: usize = 1 << 10;
        self.more_wait = true;
        for_each_part(self.slots.values_mut(), PART, LOOKED_AT_MANY, |_, part| {
            for candidate in part.iter_mut().flatten().filter(|candidate| is_concerned(candidate)) {
                candidate.stir();
            }
        });
    }

    /// Whether a look at all is worth another thread.
    fn are_many(&self) -> bool {
        self.slots.values().len() >= LOOKED_AT_MANY
    }

    /// Puts the candidates side by side where most are gone that once were: so passes over all follow how many there are.
    fn compact(&mut self) {
        if self.slots.is_sparse() {
            let mut values = self.slots.values().iter();
            self.nearness.retain(|_| values.next().is_some_and(Option::is_some));
            give_back(&mut self.nearness);
            self.slots.compact();
            self.forget_queue();
        }
    }

    /// Leaves it to a look at every candidate to find those that wait: each knows whether it does.
    fn forget_queue(&mut self) {
        self.queue.clear();
        self.more_wait = true;
    }

    /// Forgets the queue where it is longer than a look at every candidate: pairs come and go, and there may be no test for long.
    fn shorten_queue(&mut self) {
        if self.queue.len() > self.slots.values().len() {
            self.forget_queue();
        }
    }

    /// Has every candidate examined by the next test.
    pub fn enqueue_all(&mut self) {
        self.enqueue_where(|_| true);
    }

    /// Forgets what was learned about pairs that may help to examine them.
    pub fn forget_proofs(&mut self) {
        self.slots.values_mut().iter_mut().flatten().for_each(|candidate| candidate.proof = Proof::None);
    }

    /// How many wait to be examined at most.
    pub fn waiting_max(&self) -> usize {
        if self.more_wait { self.slots.values().len() } else { self.queue.len() }
    }

    /// Moves those that wait to be examined to `places`, each once.
    pub fn take_queue(&mut self, places: &mut Vec<Place>) {
        places.clear();
        let Self { slots, queue, more_wait, .. } = self;
        let take = |candidate: &mut Candidate| std::mem::take(&mut candidate.queued);
        if std::mem::take(more_wait) {
            queue.clear();
            let values = (0..).zip(slots.values_mut());
            places.extend(
                values.filter_map(|(place, value)| value.as_mut().is_some_and(take).then_some(place)),
            );
        } else {
            places.extend(queue.drain(..).filter(|&place| slots.get_mut(place).is_some_and(take)));
        }
    }

    /// Forgets how near all candidates are.
    pub fn forget_nearness(&mut self) {
        self.slots.values_mut().iter_mut().flatten().for_each(|candidate| candidate.nearness_holds = false);
    }

    /// Puts into `places` the candidates of which it is not known how near they are, in ascending order: each is to be looked at.
    pub fn take_unknown(&mut self, places: &mut Vec<Place>) {
        places.clear();
        self.nearness.resize(self.slots.values().len(), Nearness::Far);
        let take = |candidate: &mut Candidate| !std::mem::replace(&mut candidate.nearness_holds, true);
        let values = (0..).zip(self.slots.values_mut());
        places.extend(values.filter_map(|(place, value)| value.as_mut().is_some_and(take).then_some(place)));
    }

    /// All candidates, and how near they are, by place.
    pub fn with_nearness_mut(&mut self) -> (&[Option<Candidate>], &mut [Nearness]) {
        (self.slots.values(), &mut self.nearness)
    }

    /// The candidates that are near, in any order, once those that were [not known](Self::take_unknown) were looked at.
    pub fn near(&self) -> impl Iterator<Item = &Near> {
        let known = self.slots.values().iter().zip(&self.nearness).filter(|(value, _)| value.is_some());
        known.filter_map(|(_, nearness)| match nearness {
            Nearness::Near(near) => Some(near),
            Nearness::Far => None,
        })
    }

    #[cfg(test)]
    pub fn queued(&self) -> usize {
        self.queue.len()
    }

    /// All candidates, by place, and how many matter.
    pub fn values_and_count_mut(&mut self) -> (&mut [Option<Candidate>], &mut u64) {
        (self.slots.values_mut(), &mut self.count)
    }
}

impl World {
    /// Places what was added, moved or deformed in the broad phase, as a [`test`](World::test) and a search for what is
    /// [near](World::near) do first. Until then [rays](World::cast_ray) and [regions](World::objects_in) look at each such object; answers
    /// are the same before and after. For worlds that are seldom tested, or asked between a motion and the test.
    ///
    /// Cost: that of a test of which no pair is examined; nothing when nothing changed.
    ///
    /// ```
    /// use solid3d::{Shape, World, glam::{DAffine3, DVec3}, query::{Ray, RayOptions}};
    /// let (mut world, ball) = (World::new(), Shape::sphere(0.5)?);
    /// for i in 0..1000 {
    ///     world.add(&ball, DAffine3::from_translation(2.0 * DVec3::new(f64::from(i % 100), f64::from(i / 100), 0.0)))?;
    /// }
    /// world.refresh();
    /// let hit = world.cast_ray(&Ray::new(DVec3::X * -2.0, DVec3::X), &RayOptions::default(), |_| true)?;
    /// assert_eq!(hit.unwrap().hit.t, 1.5);
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn refresh(&mut self) {
        if std::mem::replace(&mut self.stale, false) {
            in_pool(Workers::is_worth_entering(self.work_ahead()), || {
                let shared = self.stirred.len() >= ASKED_MANY;
                between(shared, || self.stirred.sort());
                self.update_broad();
                between(shared, || self.begin_and_end_candidates());
                between(shared && !self.candidates.are_many(), || self.enqueue_changed());
            });
        }
    }

    /// What a test will cost, as far as is known before the boxes are: in units of [`Statistics::units_for`](super::Statistics::units_for).
    pub(super) fn work_ahead(&self) -> u64 {
        const UNITS_PER_BOX: u64 = 2;
        let (all, stirred) = (self.objects.len() as u64, self.stirred.len() as u64);
        // Of the pairs of an object those with others that changed are counted twice.
        let changed = if self.caching && !self.default_changed { all.min(2 * stirred) } else { all };
        let candidates = self.candidates.count * changed / all.max(1);
        UNITS_PER_BOX * stirred + self.statistics.units_for(candidates as usize)
    }

    /// Begins and ends candidates as pairs of boxes came and went.
    fn begin_and_end_candidates(&mut self) {
        let Self { broad, candidates, objects, .. } = self;
        for &PairChange { pair, proxies, overlaps } in broad.changes() {
            if overlaps {
                let [a, b] = proxies.map(|proxy| objects.id_of(proxy));
                let (a, b) = objects.in_order(a, b);
                candidates.begin(pair, a, b);
            } else {
                candidates.end(pair);
            }
        }
    }

    /// Has those examined about which something changed.
    fn enqueue_changed(&mut self) {
        let Self { broad, candidates, findings, objects, stirred, .. } = self;
        let stale = stirred.sorted();
        if MANY * stale.iter().map(|slots| slots.len()).sum::<usize>() >= objects.len() {
            candidates.enqueue_where(|candidate| {
                let [a, b] = [candidate.a, candidate.b].map(|id| stirred.of(slot_of(id)));
                candidate.depends_on(a.max(b), findings)
            });
        } else {
            for &slot in stale.into_iter().flatten() {
                let staleness = stirred.of(slot);
                broad.for_each_pair_of(slot, &mut |pair, _| {
                    candidates.enqueue_if(pair, |candidate| candidate.depends_on(staleness, findings));
                });
            }
        }
        candidates.compact();
        candidates.shorten_queue();
        stirred.clear();
        if std::mem::take(&mut self.default_changed) {
            candidates.enqueue_all();
        }
    }

    /// Gives the broad phase the boxes of what moved: in the order of slots, in which both have them in memory.
    fn update_broad(&mut self) {
        let Self { broad, objects, stirred, clearances, .. } = self;
        broad.update_with(stirred.sorted()[0], &|boxes| {
            dispatch!(simd => for (slot, bounds) in &mut *boxes {
                let object = objects.at(*slot).expect("what is elsewhere is in the world");
                object.bounds_into(simd, bounds);
            });
            clearances.grow(boxes.iter_mut().map(|(slot, bounds)| (objects.id_of(*slot), bounds)));
        });
        broad.flush();
    }
}
