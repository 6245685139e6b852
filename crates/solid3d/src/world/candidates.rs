//! The pairs that a test examines, with what is cached for each.

use glam::DVec3;

use super::{ObjectId, Response, World};

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
        for id in self.moved.drain(..) {
            if let Some(object) = self.objects.get_mut(id) {
                object.moved = false;
                self.broad.update(super::proxy(id), object.update_bounds());
            }
        }
        self.broad.flush();
        let old = std::mem::take(&mut self.candidates);
        let (objects, by_proxy, responses) = (&self.objects, &self.by_proxy, &self.responses);
        let candidates = &mut self.candidates;
        self.broad.for_each_pair(&mut |p, q| {
            let (mut a, mut b) = (by_proxy[p as usize], by_proxy[q as usize]);
            let mut key = (objects[a].order, objects[b].order);
            if key.1 < key.0 {
                (a, b, key) = (b, a, (key.1, key.0));
            }
            if responses.of(a, b) != Response::Ignore {
                candidates.push(Candidate { key, a, b, axis: None });
            }
        });
        candidates.sort_unstable_by_key(|candidate| candidate.key);
        carry_over(&old, candidates);
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
