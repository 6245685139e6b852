//! The pairs that a test examines, with what is cached for each.

use std::ops::Bound;

use glam::DVec3;

use super::{ObjectId, Response, World};
use crate::broad::Proxy;

/// Two objects by their places in the order of pairs, the earlier first: the order of the results.
pub(super) type PairKey = (u64, u64);

/// A pair whose boxes overlap and that is not ignored.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub key: PairKey,
    pub a: ObjectId,
    pub b: ObjectId,
    /// The axis that separated the pair when it was last examined.
    pub axis: Option<DVec3>,
}

impl World {
    /// Brings the candidates up to date.
    pub(super) fn refresh(&mut self) {
        if !std::mem::replace(&mut self.stale, false) {
            return;
        }
        self.response_changed = false;
        self.late.clear();
        let moved = std::mem::take(&mut self.moved);
        self.update_broad(&moved);
        let old = std::mem::take(&mut self.candidates);
        let mut candidates = Vec::with_capacity(old.len());
        self.broad.for_each_pair(&mut |p, q| candidates.extend(self.candidate(p, q)));
        candidates.sort_unstable_by_key(|candidate| candidate.key);
        carry_over(&old, &mut candidates);
        self.candidates = candidates;
    }

    /// Sees to it that a test that pauses does not miss the pairs beyond `last` that came to overlap since: at the cost of what
    /// moved, not of all candidates. Those that no longer are candidates are passed over when their turn comes.
    pub(super) fn refresh_beyond(&mut self, last: PairKey) {
        if self.response_changed {
            return self.refresh();
        }
        let moved = std::mem::take(&mut self.moved);
        if moved.is_empty() {
            return;
        }
        self.update_broad(&moved);
        let mut late = std::mem::take(&mut self.late);
        for id in moved.into_iter().filter(|&id| self.contains(id)) {
            let proxy = super::proxy(id);
            self.broad.for_each_partner(proxy, &mut |partner| {
                let candidate = self.candidate(proxy, partner).filter(|candidate| candidate.key > last);
                if let Some(candidate) = candidate.filter(|candidate| self.place_of(candidate.key).is_err()) {
                    late.insert(candidate.key, candidate);
                }
            });
        }
        self.late = late;
    }

    /// The first candidate beyond `last`.
    pub(super) fn next_candidate(&self, last: Option<PairKey>) -> Option<Candidate> {
        let next = self.candidates.partition_point(|candidate| Some(candidate.key) <= last);
        let early = self.candidates.get(next);
        let beyond = (last.map_or(Bound::Unbounded, Bound::Excluded), Bound::Unbounded);
        let late = self.late.range(beyond).next().map(|(_, candidate)| candidate);
        match (early, late) {
            (Some(early), Some(late)) => Some(if late.key < early.key { *late } else { *early }),
            (early, late) => early.or(late).copied(),
        }
    }

    /// Whether a candidate still is one, when the world may have changed since the candidates were found.
    pub(super) fn is_candidate(&self, candidate: &Candidate) -> bool {
        !self.stale
            || match (self.objects.get(candidate.a), self.objects.get(candidate.b)) {
                (Some(a), Some(b)) => a.bounds.overlaps(&b.bounds),
                _ => false,
            }
    }

    /// Notes the axis that separates a candidate.
    pub(super) fn cache_axis(&mut self, key: PairKey, axis: Option<DVec3>) {
        match self.place_of(key) {
            Ok(place) => self.candidates[place].axis = axis,
            Err(_) => {
                self.late.entry(key).and_modify(|candidate| candidate.axis = axis);
            }
        }
    }

    fn place_of(&self, key: PairKey) -> std::result::Result<usize, usize> {
        self.candidates.binary_search_by_key(&key, |candidate| candidate.key)
    }

    /// Gives the broad phase the boxes of what moved.
    fn update_broad(&mut self, moved: &[ObjectId]) {
        for &id in moved {
            if let Some(object) = self.objects.get_mut(id) {
                object.moved = false;
                object.update_bounds();
                self.broad.update(super::proxy(id), object.bounds);
            }
        }
        self.broad.flush();
    }

    /// The candidate that two overlapping boxes make, unless it is to be ignored.
    fn candidate(&self, p: Proxy, q: Proxy) -> Option<Candidate> {
        let candidate = self.candidate_of(self.by_proxy[p as usize], self.by_proxy[q as usize]);
        (self.responses.of(candidate.a, candidate.b) != Response::Ignore).then_some(candidate)
    }

    /// Two objects of the world as a candidate, in the order of pairs.
    pub(super) fn candidate_of(&self, a: ObjectId, b: ObjectId) -> Candidate {
        let key = (self.objects[a].order, self.objects[b].order);
        if key.0 <= key.1 {
            Candidate { key, a, b, axis: None }
        } else {
            Candidate { key: (key.1, key.0), a: b, b: a, axis: None }
        }
    }
}

/// Takes over what is cached for pairs that were candidates before. Both are sorted.
fn carry_over(old: &[Candidate], new: &mut [Candidate]) {
    let mut old = old.iter().peekable();
    for candidate in new {
        while old.next_if(|earlier| earlier.key < candidate.key).is_some() {}
        if let Some(earlier) = old.next_if(|earlier| earlier.key == candidate.key) {
            candidate.axis = earlier.axis;
        }
    }
}
