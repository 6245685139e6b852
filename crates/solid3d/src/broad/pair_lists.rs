//! Pairs of proxies, with each proxy's own list of them, and what changed about them.

use super::room::{push, resize};
use super::{PairChange, PairId, Proxy};

const END: u32 = u32::MAX;

/// A pair, linked into the lists of both its proxies. In a slot that is not in use both proxies are [`END`], and `next[0]` is
/// the next such slot.
#[derive(Clone, Copy, Debug)]
struct Pair {
    /// The smaller proxy first.
    proxies: [Proxy; 2],
    /// The next and the previous link in the list of either proxy.
    next: [u32; 2],
    previous: [u32; 2],
    /// Whether the boxes overlap.
    overlaps: bool,
    /// Whether they did when changes were last settled.
    shown: bool,
}

const UNUSED: Pair =
    Pair { proxies: [END; 2], next: [END; 2], previous: [END; 2], overlaps: false, shown: false };

/// Pairs of proxies that overlap or may come to.
///
/// One vector holds them, so that visiting all is a linear scan and nothing is allocated per proxy; a pair keeps its slot, which
/// is its id. The links of the lists name a pair and a side of it: `2 * id + side`. Lists rather than vectors, because taking
/// one pair out of the list of, say, the ground must not cost a search in that list.
#[derive(Debug)]
pub(super) struct PairLists {
    pairs: Vec<Pair>,
    /// The first slot that is not in use.
    unused: u32,
    /// By proxy: the first link of its list.
    heads: Vec<u32>,
    /// Pairs whose `overlaps` was changed since changes were last settled; some may have been taken out since.
    touched: Vec<PairId>,
    /// What was settled since the last [`begin`](Self::begin).
    changes: Vec<PairChange>,
}

impl Default for PairLists {
    fn default() -> Self {
        PairLists { pairs: vec![], unused: END, heads: vec![], touched: vec![], changes: vec![] }
    }
}

impl PairLists {
    /// Makes room for proxies below `proxies`.
    pub fn grow(&mut self, proxies: usize) {
        resize(&mut self.heads, proxies, END);
    }

    /// Adds a pair that is not there yet.
    pub fn insert(&mut self, a: Proxy, b: Proxy, overlaps: bool) -> PairId {
        let id = self.take_slot();
        let proxies = [a.min(b), a.max(b)];
        let mut pair = Pair { proxies, ..UNUSED };
        for (side, &proxy) in proxies.iter().enumerate() {
            let link = 2 * id + side as u32;
            let head = std::mem::replace(&mut self.heads[proxy as usize], link);
            pair.next[side] = head;
            if head != END {
                *self.previous_mut(head) = link;
            }
        }
        self.pairs[id as usize] = pair;
        self.set_overlaps(id, overlaps);
        id
    }

    fn take_slot(&mut self) -> PairId {
        let id = self.unused;
        match self.pairs.get(id as usize) {
            Some(slot) => {
                self.unused = slot.next[0];
                id
            }
            None => {
                push(&mut self.pairs, UNUSED);
                self.pairs.len() as PairId - 1
            }
        }
    }

    /// Takes a pair out, without a word.
    pub fn remove(&mut self, id: PairId) {
        let pair = self.pairs[id as usize];
        for side in 0..2 {
            if pair.previous[side] == END {
                self.heads[pair.proxies[side] as usize] = pair.next[side];
            } else {
                let previous = pair.previous[side];
                self.pairs[previous as usize / 2].next[previous as usize % 2] = pair.next[side];
            }
            if pair.next[side] != END {
                *self.previous_mut(pair.next[side]) = pair.previous[side];
            }
        }
        self.pairs[id as usize] = Pair { next: [self.unused, END], ..UNUSED };
        self.unused = id;
    }

    /// Takes out every pair of a proxy, without a word; `taken` hears the partners. Ends, because each step takes out one pair.
    pub fn remove_all_of(&mut self, proxy: Proxy, mut taken: impl FnMut(Proxy)) {
        while let Some(&link) = self.heads.get(proxy as usize).filter(|&&link| link != END) {
            taken(self.pairs[link as usize / 2].proxies[1 - link as usize % 2]);
            self.remove(link / 2);
        }
    }

    /// Takes out the pairs of a proxy for which `stays` is false of the partner. They must not overlap, nor be shown to.
    pub fn retain_of(&mut self, proxy: Proxy, stays: impl Fn(Proxy) -> bool) {
        let mut link = self.heads[proxy as usize];
        while link != END {
            let (pair, side) = (&self.pairs[link as usize / 2], link as usize % 2);
            let (id, next) = (link / 2, pair.next[side]);
            if !stays(pair.proxies[1 - side]) {
                debug_assert!(!pair.overlaps && !pair.shown);
                self.remove(id);
            }
            link = next;
        }
    }

    /// Takes out the pairs for which `stays` is false. They must not overlap, nor be shown to.
    pub fn retain(&mut self, stays: impl Fn(Proxy, Proxy) -> bool) {
        for id in 0..self.pairs.len() as PairId {
            let Pair { proxies: [a, b], overlaps, shown, .. } = self.pairs[id as usize];
            if a != END && !stays(a, b) {
                debug_assert!(!overlaps && !shown);
                self.remove(id);
            }
        }
    }

    /// Says whether the boxes of a pair overlap.
    pub fn set_overlaps(&mut self, id: PairId, overlaps: bool) {
        let pair = &mut self.pairs[id as usize];
        if pair.overlaps != overlaps {
            pair.overlaps = overlaps;
            push(&mut self.touched, id);
        }
    }

    /// Finds anew which boxes overlap, among all pairs.
    pub fn refresh_all(&mut self, overlaps: impl Fn(Proxy, Proxy) -> bool) {
        for (id, pair) in (0..).zip(&mut self.pairs) {
            let [a, b] = pair.proxies;
            if a != END {
                let overlaps = overlaps(a, b);
                if pair.overlaps != overlaps {
                    pair.overlaps = overlaps;
                    push(&mut self.touched, id);
                }
            }
        }
    }

    /// Finds anew which boxes overlap, among the pairs of one proxy.
    pub fn refresh_of(&mut self, proxy: Proxy, overlaps: impl Fn(Proxy) -> bool) {
        let mut link = self.heads[proxy as usize];
        while link != END {
            let (pair, side) = (&mut self.pairs[link as usize / 2], link as usize % 2);
            let overlaps = overlaps(pair.proxies[1 - side]);
            if pair.overlaps != overlaps {
                pair.overlaps = overlaps;
                push(&mut self.touched, link / 2);
            }
            link = pair.next[side];
        }
    }

    /// Forgets the changes that were settled before.
    pub fn begin(&mut self) {
        self.changes.clear();
    }

    /// Notes the changes since this was last done, and shows them. `stays` is asked of the pairs that were touched and do not
    /// overlap; where it says no they are taken out.
    pub fn settle(&mut self, mut stays: impl FnMut([Proxy; 2]) -> bool) {
        let mut touched = std::mem::take(&mut self.touched);
        for id in touched.drain(..) {
            let pair = &mut self.pairs[id as usize];
            let Pair { proxies, overlaps, .. } = *pair;
            // One may stand here twice, also because its slot was used anew since.
            if proxies[0] == END {
                continue;
            }
            if std::mem::replace(&mut pair.shown, overlaps) != overlaps {
                push(&mut self.changes, PairChange { pair: id, proxies, overlaps });
            }
            if !overlaps && !stays(proxies) {
                self.remove(id);
            }
        }
        self.touched = touched;
    }

    pub fn changes(&self) -> &[PairChange] {
        &self.changes
    }

    /// Visits the pairs that overlap.
    pub fn for_each(&self, mut visit: impl FnMut(PairId, [Proxy; 2])) {
        for (id, pair) in (0..).zip(&self.pairs) {
            if pair.overlaps {
                visit(id, pair.proxies);
            }
        }
    }

    /// Visits all pairs, and whether they overlap.
    pub fn for_each_known(&self, mut visit: impl FnMut([Proxy; 2], bool)) {
        for pair in self.pairs.iter().filter(|pair| pair.proxies[0] != END) {
            visit(pair.proxies, pair.overlaps);
        }
    }

    /// Visits the pairs of a proxy that were shown to overlap, and its partners.
    pub fn for_each_shown_of(&self, proxy: Proxy, mut visit: impl FnMut(PairId, Proxy)) {
        self.for_each_of(proxy, |id, pair, partner| {
            if pair.shown {
                visit(id, partner);
            }
        });
    }

    /// Visits the partners of a proxy.
    pub fn for_each_partner_of(&self, proxy: Proxy, mut visit: impl FnMut(Proxy)) {
        self.for_each_of(proxy, |_, _, partner| visit(partner));
    }

    /// Visits the partners of a proxy whose pair with it overlaps.
    pub fn for_each_overlap_of(&self, proxy: Proxy, mut visit: impl FnMut(PairId, Proxy)) {
        self.for_each_of(proxy, |id, pair, partner| {
            if pair.overlaps {
                visit(id, partner);
            }
        });
    }

    fn for_each_of(&self, proxy: Proxy, mut visit: impl FnMut(PairId, &Pair, Proxy)) {
        let mut link = self.heads.get(proxy as usize).copied().unwrap_or(END);
        while link != END {
            let (pair, side) = (&self.pairs[link as usize / 2], link as usize % 2);
            visit(link / 2, pair, pair.proxies[1 - side]);
            link = pair.next[side];
        }
    }

    /// The pair of two proxies, where it was shown to overlap. Cost: follows the shorter of their two lists.
    pub fn find_shown(&self, a: Proxy, b: Proxy) -> Option<PairId> {
        let head = |proxy: Proxy| self.heads.get(proxy as usize).copied().unwrap_or(END);
        let (mut of_a, mut of_b) = (head(a), head(b));
        while of_a != END && of_b != END {
            for (link, partner) in [(&mut of_a, b), (&mut of_b, a)] {
                let (pair, side) = (&self.pairs[*link as usize / 2], *link as usize % 2);
                if pair.proxies[1 - side] == partner {
                    return pair.shown.then_some(*link / 2);
                }
                *link = pair.next[side];
            }
        }
        None
    }

    fn previous_mut(&mut self, link: u32) -> &mut u32 {
        &mut self.pairs[link as usize / 2].previous[link as usize % 2]
    }

    pub fn validate(&self) {
        let mut links = 0;
        for (proxy, &head) in self.heads.iter().enumerate() {
            let (mut previous, mut link) = (END, head);
            while link != END {
                let (pair, side) = (&self.pairs[link as usize / 2], link as usize % 2);
                assert_eq!(pair.proxies[side] as usize, proxy);
                assert_eq!(pair.previous[side], previous);
                assert!(pair.proxies[0] < pair.proxies[1]);
                (previous, link) = (link, pair.next[side]);
                links += 1;
                assert!(links <= 2 * self.pairs.len(), "a list runs in a circle");
            }
        }
        let (mut unused, mut slot) = (0, self.unused);
        while slot != END {
            assert_eq!(self.pairs[slot as usize].proxies, [END; 2]);
            unused += 1;
            slot = self.pairs[slot as usize].next[0];
        }
        assert_eq!(links, 2 * (self.pairs.len() - unused), "a slot is lost");
    }
}
