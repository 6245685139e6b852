//! The incremental sweep and prune of the thesis, section 5.2.2.
//!
//! The endpoints of the boxes' intervals on each axis are kept in three sorted sequences. A moved endpoint is swapped
//! up or down to its place at once; where a lower endpoint passes an upper one, two intervals begin or cease to overlap.
//!
//! Deviations from the thesis:
//!
//! * Arrays with back references, not doubly-linked lists. A swap then writes two neighbours in one cache line
//!   instead of chasing six pointers, and an endpoint is 16 bytes.
//! * Insertions and removals wait for [`flush`](BroadPhase::flush) and are done together: the new endpoints are sorted
//!   and merged in, and one sweep finds the pairs of the new boxes. `k` new boxes among `n` cost
//!   O(n + k log k + overlaps on the sweep axis), where one at a time would cost O(k n).
//! * A frame that has used up its swaps ([`SWAPS_PER_BOX`]) treats its further moves as removal and insertion, so
//!   that a scene in which everything teleports costs a sort, not O(n^2) swaps.

mod endpoint;
mod pair_set;

use super::{BroadPhase, Counters, PairChange, PairId, Proxy, assert_valid, matters};
use crate::bounds::Aabb;
use endpoint::{Sequence, Side};
use pair_set::PairSet;

/// Swaps a frame may spend, per box alive, before further moves are sorted in as a batch. A swap costs about 9 ns, a
/// box in a batch 1.3 us among 10,000 and 5 us among 100,000: so the bound is near the break-even.
const SWAPS_PER_BOX: u64 = 256;

/// Where a proxy stands between its calls and the next flush.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// Not in use, no endpoints.
    Absent,
    /// In use, its endpoints in place.
    Present,
    /// In use, its endpoints not yet in the sequences.
    New,
    /// Not in use, its endpoints still in the sequences.
    Gone,
    /// In use, its endpoints in the sequences at an old place: to be taken out and sorted in again.
    Stale,
}

/// Broad phase by the incremental sweep and prune of the thesis.
///
/// Good where little moves and all of it slowly; a box that crosses a crowd pays for every endpoint it passes.
///
/// ```
/// use solid3d::broad::{BroadPhase, SweepAndPrune};
/// use solid3d::{Aabb, glam::DVec3};
/// let mut broad = SweepAndPrune::default();
/// broad.insert(7, Aabb::new(DVec3::ZERO, DVec3::ONE));
/// broad.insert(3, Aabb::new(DVec3::splat(0.5), DVec3::splat(2.0)));
/// broad.flush();
/// assert_eq!(broad.sorted_pairs(), [(3, 7)]);
/// ```
#[derive(Clone, Debug, Default)]
pub struct SweepAndPrune {
    /// By proxy; the current box where the state is `Present`, `New` or `Stale`.
    boxes: Vec<Aabb>,
    states: Vec<State>,
    /// The three sorted sequences, over exactly the proxies `Present`, `Gone` and `Stale`.
    sequences: [Sequence; 3],
    /// The pairs of `Present` boxes that overlap, exactly; none of others does.
    pairs: PairSet,
    /// Proxies that were made `New` or `Stale`, perhaps more than once, since the last flush.
    pending: Vec<Proxy>,
    /// Whether any proxy was made `Gone` or `Stale` since the last flush.
    to_compact: bool,
    alive: u64,
    swaps_in_frame: u64,
    counters: Counters,
    /// Scratch of the sweep: the open boxes, old ones and new ones.
    open: [Vec<(Proxy, Aabb)>; 2],
    /// Scratch of the sweep: where in `open` a proxy stands.
    open_slot: Vec<u32>,
}

impl SweepAndPrune {
    fn state(&self, proxy: Proxy) -> State {
        self.states.get(proxy as usize).copied().unwrap_or(State::Absent)
    }

    /// Notes that a proxy was made `New` or `Stale`. Each may be, again and again, until the next flush.
    fn pend(&mut self, proxy: Proxy) {
        if self.pending.len() > 2 * self.states.len() {
            self.pending.sort_unstable();
            self.pending.dedup();
        }
        self.pending.push(proxy);
    }

    /// Swaps the six endpoints of a `Present` box to their places.
    fn move_endpoints(&mut self, proxy: Proxy, bounds: Aabb) {
        let old = std::mem::replace(&mut self.boxes[proxy as usize], bounds);
        let Self { boxes, states, sequences, pairs, .. } = self;
        let mut swaps = 0;
        for (axis, sequence) in sequences.iter_mut().enumerate() {
            // Growing moves come before shrinking ones. So the box's own endpoints never pass each other, and
            // an overlap never ends on an axis where it exists after the move.
            let (lower, upper) = (bounds.min[axis], bounds.max[axis]);
            let mut begin = |q: Proxy| {
                // All coordinates of both boxes are in place here, so this decision is final for this move.
                if states[q as usize] == State::Present && bounds.overlaps(&boxes[q as usize]) {
                    pairs.insert(proxy, q);
                }
            };
            if lower < old.min[axis] {
                swaps += sequence.move_down(proxy, Side::Lower, lower, &mut begin);
            }
            if upper > old.max[axis] {
                swaps += sequence.move_up(proxy, Side::Upper, upper, &mut begin);
            }
            let mut end = |q: Proxy| pairs.remove(proxy, q);
            if lower > old.min[axis] {
                swaps += sequence.move_up(proxy, Side::Lower, lower, &mut end);
            }
            if upper < old.max[axis] {
                swaps += sequence.move_down(proxy, Side::Upper, upper, &mut end);
            }
        }
        self.swaps_in_frame += swaps;
        self.counters.swaps += swaps;
    }

    /// Takes the endpoints of `Gone` and `Stale` proxies out.
    fn compact(&mut self) {
        let Self { states, sequences, .. } = self;
        let stays = |p: Proxy| states[p as usize] == State::Present;
        for sequence in sequences.iter_mut() {
            sequence.retain(stays);
        }
        for state in states.iter_mut() {
            match *state {
                State::Gone => *state = State::Absent,
                State::Stale => *state = State::New,
                State::Absent | State::Present | State::New => {}
            }
        }
    }

    /// Sorts the `New` boxes in and finds their pairs by one sweep.
    fn admit_pending(&mut self) {
        let Self { boxes, states, sequences, pending, .. } = self;
        pending.sort_unstable();
        pending.dedup();
        pending.retain(|&p| states[p as usize] == State::New);
        if pending.is_empty() {
            return;
        }
        self.counters.sweeps += 1;
        for (axis, sequence) in sequences.iter_mut().enumerate() {
            sequence.merge(boxes.len(), pending.iter().map(|&p| (p, &boxes[p as usize])), axis);
        }
        self.sweep(self.axis_of_greatest_spread());
        for proxy in self.pending.drain(..) {
            self.states[proxy as usize] = State::Present;
        }
    }

    /// Finds all pairs with at least one `New` box.
    fn sweep(&mut self, axis: usize) {
        let Self { boxes, states, sequences, pairs, open, open_slot, .. } = self;
        open_slot.resize(boxes.len(), 0);
        for endpoint in sequences[axis].endpoints() {
            let proxy = endpoint.proxy();
            let bounds = boxes[proxy as usize];
            let is_new = usize::from(states[proxy as usize] == State::New);
            match endpoint.side() {
                Side::Lower => {
                    // An old box meets only the open new ones: its pairs with old ones are known.
                    for group in &open[1 - is_new..] {
                        for (other, other_bounds) in group {
                            if bounds.overlaps(other_bounds) {
                                pairs.insert(proxy, *other);
                            }
                        }
                    }
                    open_slot[proxy as usize] = open[is_new].len() as u32;
                    open[is_new].push((proxy, bounds));
                }
                Side::Upper => {
                    let slot = open_slot[proxy as usize] as usize;
                    open[is_new].swap_remove(slot);
                    if let Some((moved, _)) = open[is_new].get(slot) {
                        open_slot[*moved as usize] = slot as u32;
                    }
                }
            }
        }
    }

    /// The axis on which the boxes stand farthest apart, in units of their size: fewest are open at once there.
    fn axis_of_greatest_spread(&self) -> usize {
        let mut best = (0, f64::INFINITY);
        for (axis, sequence) in self.sequences.iter().enumerate() {
            let (Some(first), Some(last)) = (sequence.endpoints().first(), sequence.endpoints().last())
            else {
                continue;
            };
            // Halves: the extent of finite boxes may overflow.
            let extent = 0.5 * last.value - 0.5 * first.value;
            let total: f64 = sequence
                .endpoints()
                .iter()
                .map(|e| match e.side() {
                    Side::Lower => -e.value / extent,
                    Side::Upper => e.value / extent,
                })
                .sum();
            // NaN where all boxes stand at one coordinate: never better.
            if total < best.1 {
                best = (axis, total);
            }
        }
        best.0
    }
}

impl BroadPhase for SweepAndPrune {
    fn boxed_clone(&self) -> Box<dyn BroadPhase> {
        Box::new(self.clone())
    }

    fn insert(&mut self, proxy: Proxy, bounds: Aabb) {
        assert_valid(proxy, &bounds);
        let slot = proxy as usize;
        if slot >= self.boxes.len() {
            self.boxes.resize(slot + 1, Aabb::EMPTY);
            self.states.resize(slot + 1, State::Absent);
            self.pairs.grow(slot + 1);
        }
        match self.states[slot] {
            State::Absent => self.states[slot] = State::New,
            State::Gone => self.states[slot] = State::Stale,
            State::Present | State::New | State::Stale => panic!("proxy {proxy} is already in use"),
        }
        self.boxes[slot] = bounds;
        self.pend(proxy);
        self.alive += 1;
    }

    fn update(&mut self, proxy: Proxy, bounds: Aabb) {
        assert_valid(proxy, &bounds);
        match self.state(proxy) {
            State::Present if self.swaps_in_frame <= SWAPS_PER_BOX * self.alive => {
                self.move_endpoints(proxy, bounds);
            }
            State::Present => {
                if self.boxes[proxy as usize] != bounds {
                    self.boxes[proxy as usize] = bounds;
                    self.states[proxy as usize] = State::Stale;
                    self.pairs.end_all_of(proxy);
                    self.pend(proxy);
                    self.to_compact = true;
                }
            }
            State::New | State::Stale => self.boxes[proxy as usize] = bounds,
            State::Absent | State::Gone => panic!("proxy {proxy} is not in use"),
        }
    }

    fn remove(&mut self, proxy: Proxy) {
        match self.state(proxy) {
            State::New => self.states[proxy as usize] = State::Absent,
            State::Present | State::Stale => {
                self.states[proxy as usize] = State::Gone;
                self.pairs.remove_all_of(proxy);
                self.to_compact = true;
            }
            State::Absent | State::Gone => panic!("proxy {proxy} is not in use"),
        }
        self.alive -= 1;
    }

    fn flush(&mut self) {
        if std::mem::take(&mut self.to_compact) {
            self.compact();
        }
        if !self.pending.is_empty() {
            self.admit_pending();
        }
        self.swaps_in_frame = 0;
        self.pairs.settle();
    }

    fn for_each_pair(&self, visit: &mut dyn FnMut(Proxy, Proxy)) {
        assert!(self.pending.is_empty() && !self.to_compact, "boxes changed since the last flush");
        self.pairs.for_each(visit);
    }

    fn for_each_partner(&self, proxy: Proxy, visit: &mut dyn FnMut(Proxy)) {
        assert!(self.pending.is_empty() && !self.to_compact, "boxes changed since the last flush");
        self.pairs.for_each_overlap_of(proxy, visit);
    }

    fn changes(&self) -> &[PairChange] {
        self.pairs.lists.changes()
    }

    fn for_each_pair_of(&self, proxy: Proxy, visit: &mut dyn FnMut(PairId, Proxy)) {
        self.pairs.lists.for_each_shown_of(proxy, visit);
    }

    fn pair(&self, a: Proxy, b: Proxy) -> Option<PairId> {
        self.pairs.lists.find_shown(a, b)
    }

    fn bounds(&self, proxy: Proxy) -> Aabb {
        self.boxes[proxy as usize]
    }

    fn for_each_nearest(
        &self,
        bound: &dyn Fn(&Aabb) -> f64,
        mut until: f64,
        visit: &mut dyn FnMut(Proxy) -> f64,
    ) {
        for (proxy, (bounds, state)) in (0..).zip(self.boxes.iter().zip(&self.states)) {
            if !matches!(state, State::Absent | State::Gone) && matters(bound(bounds), until) {
                until = visit(proxy);
            }
        }
    }

    fn counters(&self) -> Counters {
        self.counters
    }

    fn validate(&self) {
        self.pairs.validate();
        let has_endpoints =
            |p: Proxy| matches!(self.states[p as usize], State::Present | State::Gone | State::Stale);
        let expected = (0..self.states.len() as Proxy).filter(|&p| has_endpoints(p)).count();
        for (axis, sequence) in self.sequences.iter().enumerate() {
            assert_eq!(sequence.endpoints().len(), 2 * expected, "axis {axis}");
            sequence.validate();
            for endpoint in sequence.endpoints() {
                let proxy = endpoint.proxy();
                if self.states[proxy as usize] == State::Present {
                    let bounds = &self.boxes[proxy as usize];
                    let value = match endpoint.side() {
                        Side::Lower => bounds.min[axis],
                        Side::Upper => bounds.max[axis],
                    };
                    assert!(
                        endpoint.value == value,
                        "axis {axis}, proxy {proxy}: {} is {value}",
                        endpoint.value
                    );
                }
            }
        }
        self.pairs.for_each(&mut |a, b| {
            assert!(a < b);
            let present = self.state(a) == State::Present && self.state(b) == State::Present;
            assert!(present, "pair ({a}, {b}) of a box that is not there");
            assert!(self.boxes[a as usize].overlaps(&self.boxes[b as usize]), "pair ({a}, {b}) is apart");
        });
        let in_use = self.states.iter().filter(|s| !matches!(s, State::Absent | State::Gone)).count();
        assert_eq!(in_use as u64, self.alive);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    /// Boxes that come and go without a flush leave no more behind than there are proxies.
    #[test]
    fn what_comes_and_goes_without_a_flush_leaves_no_trace() {
        let unit = Aabb::new(DVec3::ZERO, DVec3::ONE);
        let mut broad = SweepAndPrune::default();
        broad.insert(0, unit);
        broad.flush();
        for _ in 0..1000 {
            broad.remove(0);
            broad.insert(0, unit);
            broad.insert(1, unit);
            broad.remove(1);
            assert!(broad.pending.len() <= 2 * 2 + 1, "{}", broad.pending.len());
        }
        broad.flush();
        assert!(broad.sorted_pairs().is_empty());
        broad.insert(1, unit);
        broad.flush();
        assert_eq!(broad.sorted_pairs(), [(0, 1)]);
    }
}
