//! Pairs of proxies, with each proxy's own list of them, and what changed about them.

use fearless_simd::Simd;
use solid_convex::simd::{dispatch, level, prefetch};

use super::bits::{Bits, WORD};
use super::boxes::{AXES, Boxes};
use super::pair_ids::{PairIds, Proxies, key};
use super::room::{extend, give_back, is_much, push, resize_on_threads};
use super::{PairChange, PairId, Proxy};
use crate::tree::bits;

const END: u32 = u32::MAX;

/// A list of more pairs than this is not walked along to find one.
const LONG: usize = 64;

/// A word of which so many pairs or fewer are in use is looked at pair by pair.
const SPARSE: u32 = 8;

/// The ends of a slot that is not in use: the next such slot stands in its links.
const UNUSED: [Proxy; 2] = [0; 2];

/// Where a pair hangs in the lists of its two proxies: the next and the previous link in the list of either. In a slot that is
/// not in use `next[0]` is the next such slot.
#[derive(Clone, Copy, Debug)]
struct Links {
    next: [u32; 2],
    previous: [u32; 2],
}

/// Pairs of proxies that overlap or may come to.
///
/// Vectors hold them, so that visiting all is a linear scan and nothing is allocated per proxy; a pair keeps its slot, which
/// is its id. The links of the lists name a pair and a side of it: `2 * id + side`. Lists rather than vectors, because taking
/// one pair out of the list of, say, the ground must not cost a search in that list.
#[derive(Clone, Debug)]
pub(super) struct PairLists {
    /// The proxies of each pair, the smaller first; of a slot that is not in use, 0 twice. Of all that is kept of a pair this alone is read
    /// of each when everything moved: so it stands apart from the rest, and what is yes or no of a pair in bits, of 64 at a time.
    ends: Vec<[Proxy; 2]>,
    in_use: Bits,
    /// Pairs whose boxes overlap.
    overlaps: Bits,
    /// Those that did when changes were last settled.
    shown: Bits,
    /// By pair, as `ends`.
    links: Vec<Links>,
    /// The first slot that is not in use.
    unused: u32,
    /// By proxy: the first link of its list.
    heads: Vec<u32>,
    /// Proxies all of whose pairs are in `ids`: those whose lists were found to be long, as in a crowd they are.
    listed: Proxies,
    ids: PairIds,
    /// Pairs whose `overlaps` was changed since changes were last settled; some may have been taken out since.
    touched: Vec<PairId>,
    /// What was settled since the last [`begin`](Self::begin).
    changes: Vec<PairChange>,
    /// Working memory of `refresh_all`: by word of the pairs, those that overlap.
    found: Vec<u64>,
}

impl Default for PairLists {
    fn default() -> Self {
        PairLists {
            ends: vec![],
            in_use: Bits::default(),
            overlaps: Bits::default(),
            shown: Bits::default(),
            links: vec![],
            unused: END,
            heads: vec![],
            listed: Proxies::default(),
            ids: PairIds::default(),
            touched: vec![],
            changes: vec![],
            found: vec![],
        }
    }
}

impl PairLists {
    /// Makes room for proxies below `proxies`.
    pub fn grow(&mut self, proxies: usize) {
        resize_on_threads(&mut self.heads, proxies, END);
    }

    /// Gives back what room there is for more proxies.
    pub fn trim(&mut self) {
        self.heads.shrink_to_fit();
    }

    /// Adds a pair that is not there yet.
    pub fn insert(&mut self, a: Proxy, b: Proxy, overlaps: bool) -> PairId {
        let id = self.take_slot();
        self.ends[id as usize] = [a.min(b), a.max(b)];
        self.in_use.set(id, true);
        self.hang(id);
        self.set_overlaps(id, overlaps);
        id
    }

    /// Asks for the memory of where the list of a proxy begins.
    pub fn prefetch(&self, proxy: Proxy) {
        prefetch(&self.heads[proxy as usize]);
    }

    /// Puts a pair at the head of both its lists.
    fn hang(&mut self, id: PairId) {
        let mut links = Links { next: [END; 2], previous: [END; 2] };
        for (side, proxy) in self.ends[id as usize].into_iter().enumerate() {
            let link = 2 * id + side as u32;
            let head = std::mem::replace(&mut self.heads[proxy as usize], link);
            links.next[side] = head;
            if head != END {
                *self.previous_mut(head) = link;
            }
        }
        self.links[id as usize] = links;
        let [a, b] = self.ends[id as usize];
        if self.is_listed(a, b) {
            self.ids.insert(key(a, b), id);
        }
    }

    /// Whether the pair of two proxies is in `ids`, if there is one.
    fn is_listed(&self, a: Proxy, b: Proxy) -> bool {
        self.listed.contains(&a) || self.listed.contains(&b)
    }

    fn take_slot(&mut self) -> PairId {
        let id = self.unused;
        match self.links.get(id as usize) {
            Some(slot) => {
                self.unused = slot.next[0];
                id
            }
            None => {
                push(&mut self.ends, UNUSED);
                push(&mut self.links, Links { next: [END; 2], previous: [END; 2] });
                for bits in [&mut self.in_use, &mut self.overlaps, &mut self.shown] {
                    bits.grow(self.ends.len());
                }
                self.ends.len() as PairId - 1
            }
        }
    }

    /// Takes a pair out, without a word.
    pub fn remove(&mut self, id: PairId) {
        let proxies = self.ends[id as usize];
        let Links { next, previous } = self.links[id as usize];
        for side in 0..2 {
            if previous[side] == END {
                self.heads[proxies[side] as usize] = next[side];
            } else {
                self.links[previous[side] as usize / 2].next[previous[side] as usize % 2] = next[side];
            }
            if next[side] != END {
                *self.previous_mut(next[side]) = previous[side];
            }
        }
        let [a, b] = proxies;
        if self.is_listed(a, b) {
            self.ids.remove(&key(a, b));
        }
        self.drop_slot(id);
    }

    fn drop_slot(&mut self, id: PairId) {
        self.ends[id as usize] = UNUSED;
        for bits in [&mut self.in_use, &mut self.overlaps, &mut self.shown] {
            bits.set(id, false);
        }
        self.links[id as usize].next[0] = self.unused;
        self.unused = id;
    }

    /// Takes out every pair of a proxy, without a word; `taken` hears the partners. Ends, because each step takes out one pair.
    pub fn remove_all_of(&mut self, proxy: Proxy, mut taken: impl FnMut(Proxy)) {
        while let Some(&link) = self.heads.get(proxy as usize).filter(|&&link| link != END) {
            taken(self.partner(link));
            self.remove(link / 2);
        }
        self.listed.remove(&proxy);
    }

    /// Takes out the pairs of a proxy for which `stays` is false of the partner. They must not overlap, nor be shown to.
    pub fn retain_of(&mut self, proxy: Proxy, stays: impl Fn(Proxy) -> bool) {
        let mut link = self.heads[proxy as usize];
        while link != END {
            let (id, next) = (link / 2, self.next(link));
            if !stays(self.partner(link)) {
                assert!(!self.overlaps.is(id) && !self.shown.is(id));
                self.remove(id);
            }
            link = next;
        }
    }

    /// Takes out the pairs that do not overlap. What was changed must have been settled.
    ///
    /// All lists are made anew: to take out one by one costs more, since the pairs before and after in both lists are somewhere else.
    pub fn forget_apart(&mut self) {
        assert!(self.touched.is_empty());
        self.heads.fill(END);
        self.listed.clear();
        self.ids.clear();
        self.unused = END;
        self.cut(self.overlaps.end());
        for id in (0..self.ends.len() as PairId).rev() {
            if self.overlaps.is(id) {
                self.hang(id);
            } else {
                self.drop_slot(id);
            }
        }
    }

    /// Forgets the slots from `len` on.
    fn cut(&mut self, len: usize) {
        self.ends.truncate(len);
        self.links.truncate(len);
        for bits in [&mut self.in_use, &mut self.overlaps, &mut self.shown] {
            bits.cut(len);
        }
    }

    /// Gives back the memory of many pairs that there no longer are.
    pub fn give_back(&mut self) {
        give_back(&mut self.ends);
        give_back(&mut self.links);
        for bits in [&mut self.in_use, &mut self.overlaps, &mut self.shown] {
            bits.give_back();
        }
        if is_much(self.ids.capacity(), self.ends.len()) {
            self.ids.shrink_to_fit();
            self.listed.shrink_to_fit();
        }
    }

    /// Whether there is no pair.
    pub fn is_empty(&self) -> bool {
        self.in_use.end() == 0
    }

    /// Says whether the boxes of a pair overlap.
    pub fn set_overlaps(&mut self, id: PairId, overlaps: bool) {
        if self.overlaps.is(id) != overlaps {
            self.overlaps.set(id, overlaps);
            push(&mut self.touched, id);
        }
    }

    /// Finds anew which boxes overlap, among all pairs.
    ///
    /// Which pairs overlap is written down first, and what changed is acted upon afterwards, because nobody can foretell it: where each was
    /// a branch, the boxes of the pairs that follow were not fetched from memory before the branch was taken. The processor waits for the
    /// boxes of as many pairs at a time as it has room for the instructions of: so a pair takes few; and where boxes are not in the caches, those of
    /// the next word are asked for before.
    ///
    /// Of boxes that several threads were told (`shared`), less of this is worth another thread: some are nearer to it.
    pub fn refresh_all(&mut self, boxes: &Boxes, shared: bool) {
        let Self { ends, in_use, overlaps, touched, found, .. } = self;
        /// More boxes than this are not in the caches.
        const NEAR_MAX: usize = 1 << 18;
        let (level, near) = (level(), boxes.len() <= NEAR_MAX);
        found.clear();
        extend(found, in_use.words());
        for_each_word(found, shared, |(at, found): (usize, &mut u64)| {
            let pairs = &ends[WORD * at..];
            let (pairs, later) = pairs.split_at(pairs.len().min(WORD));
            if !near {
                later.iter().take(WORD).flatten().for_each(|&proxy| boxes.prefetch(proxy));
            }
            *found &= if found.count_ones() <= SPARSE {
                let overlap = |&at: &usize| boxes.overlap(pairs[at][0], pairs[at][1]);
                bits(*found).filter(overlap).fold(0, |all, at| all | 1 << at)
            } else if near {
                dispatch!(level, simd => overlapping::<_, false>(simd, pairs, boxes))
            } else {
                dispatch!(level, simd => overlapping::<_, true>(simd, pairs, boxes))
            };
        });
        for (at, (was, &is)) in (0..).zip(overlaps.words_mut().iter_mut().zip(&*found)) {
            for bit in bits(std::mem::replace(was, is) ^ is) {
                push(touched, (at * WORD + bit) as PairId);
            }
        }
    }

    /// Finds anew which boxes overlap, among the pairs of one proxy.
    pub fn refresh_of(&mut self, proxy: Proxy, overlaps: impl Fn(Proxy) -> bool) {
        let mut link = self.heads[proxy as usize];
        while link != END {
            let overlaps = overlaps(self.partner(link));
            self.set_overlaps(link / 2, overlaps);
            link = self.next(link);
        }
    }

    /// Puts the pairs that were changed and are to be settled into the order of their ids.
    pub fn sort_touched(&mut self) {
        self.touched.sort_unstable();
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
            // One may stand here twice, also because its slot was used anew since.
            if !self.in_use.is(id) {
                continue;
            }
            let (proxies, overlaps) = (self.ends[id as usize], self.overlaps.is(id));
            if self.shown.is(id) != overlaps {
                self.shown.set(id, overlaps);
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
        self.overlaps.iter().for_each(|id| visit(id, self.ends[id as usize]));
    }

    /// Visits all pairs, and whether they overlap.
    pub fn for_each_known(&self, mut visit: impl FnMut([Proxy; 2], bool)) {
        self.in_use.iter().for_each(|id| visit(self.ends[id as usize], self.overlaps.is(id)));
    }

    /// Visits the pairs of a proxy that were shown to overlap, and its partners.
    pub fn for_each_shown_of(&self, proxy: Proxy, visit: impl FnMut(PairId, Proxy)) {
        self.for_each_of(proxy, &self.shown, visit);
    }

    /// Visits the partners of a proxy whose pair with it overlaps.
    pub fn for_each_overlap_of(&self, proxy: Proxy, visit: impl FnMut(PairId, Proxy)) {
        self.for_each_of(proxy, &self.overlaps, visit);
    }

    /// Visits the partners of a proxy.
    pub fn for_each_partner(&self, proxy: Proxy, mut visit: impl FnMut(Proxy)) {
        self.links_of(proxy).for_each(|link| visit(self.partner(link)));
    }

    fn for_each_of(&self, proxy: Proxy, those: &Bits, mut visit: impl FnMut(PairId, Proxy)) {
        let links = self.links_of(proxy).filter(|&link| those.is(link / 2));
        links.for_each(|link| visit(link / 2, self.partner(link)));
    }

    /// The list of a proxy.
    fn links_of(&self, proxy: Proxy) -> impl Iterator<Item = u32> {
        let there = |link| (link != END).then_some(link);
        std::iter::successors(there(self.head(proxy)), move |&link| there(self.next(link)))
    }

    /// The pair of two proxies. Cost: follows the shorter of their two lists.
    pub fn find(&self, a: Proxy, b: Proxy) -> Option<PairId> {
        self.find_within(a, b, usize::MAX).0
    }

    /// Adds a pair if it is not there. Of a crowd, in which each list is long, each is gone through once for all of its pairs.
    pub fn insert_new(&mut self, a: Proxy, b: Proxy, overlaps: bool) {
        let (mut id, steps) = self.find_within(a, b, LONG);
        if id.is_none() && steps == LONG {
            self.list_shorter(a, b);
            id = self.ids.get(&key(a, b)).copied();
        }
        if id.is_none() {
            self.insert(a, b, overlaps);
        }
    }

    /// The pair of two proxies, if it is among the first so many of either list; and how far the lists were gone through.
    fn find_within(&self, a: Proxy, b: Proxy, steps_max: usize) -> (Option<PairId>, usize) {
        if self.is_listed(a, b) {
            return (self.ids.get(&key(a, b)).copied(), 0);
        }
        let (mut of_a, mut of_b) = (self.head(a), self.head(b));
        let mut steps = 0;
        while of_a != END && of_b != END && steps < steps_max {
            for (link, partner) in [(&mut of_a, b), (&mut of_b, a)] {
                if self.partner(*link) == partner {
                    return (Some(*link / 2), steps);
                }
                *link = self.next(*link);
            }
            steps += 1;
        }
        (None, steps)
    }

    /// Lists the one of two proxies whose list is shorter.
    fn list_shorter(&mut self, a: Proxy, b: Proxy) {
        let (mut of_a, mut of_b) = (self.head(a), self.head(b));
        while of_a != END && of_b != END {
            (of_a, of_b) = (self.next(of_a), self.next(of_b));
        }
        let shorter = if of_a == END { a } else { b };
        self.listed.insert(shorter);
        let mut link = self.head(shorter);
        while link != END {
            self.ids.insert(key(shorter, self.partner(link)), link / 2);
            link = self.next(link);
        }
    }

    /// The same, where it was shown to overlap.
    pub fn find_shown(&self, a: Proxy, b: Proxy) -> Option<PairId> {
        self.find(a, b).filter(|&id| self.shown.is(id))
    }

    fn head(&self, proxy: Proxy) -> u32 {
        self.heads.get(proxy as usize).copied().unwrap_or(END)
    }

    fn next(&self, link: u32) -> u32 {
        self.links[link as usize / 2].next[link as usize % 2]
    }

    fn previous_mut(&mut self, link: u32) -> &mut u32 {
        &mut self.links[link as usize / 2].previous[link as usize % 2]
    }

    /// The other proxy of a pair.
    fn partner(&self, link: u32) -> Proxy {
        self.ends[link as usize / 2][1 - link as usize % 2]
    }

    pub fn validate(&self) {
        let mut hanging = 0;
        let listed =
            (0..).zip(&self.ends).filter(|&(id, &[a, b])| self.in_use.is(id) && self.is_listed(a, b));
        let mut known = 0;
        for (id, &[a, b]) in listed {
            assert_eq!(self.ids.get(&key(a, b)), Some(&id));
            known += 1;
        }
        assert_eq!(known, self.ids.len());
        let mut pairs: Vec<_> = self.in_use.iter().map(|id| self.ends[id as usize]).collect();
        pairs.sort_unstable();
        assert!(pairs.is_sorted_by(|a, b| a < b), "a pair is there twice");
        for (proxy, &head) in self.heads.iter().enumerate() {
            let (mut previous, mut link) = (END, head);
            while link != END {
                let (proxies, side) = (self.ends[link as usize / 2], link as usize % 2);
                assert!(self.in_use.is(link / 2));
                assert_eq!(proxies[side] as usize, proxy);
                assert_eq!(self.links[link as usize / 2].previous[side], previous);
                assert!(proxies[0] < proxies[1]);
                (previous, link) = (link, self.next(link));
                hanging += 1;
                assert!(hanging <= 2 * self.ends.len(), "a list runs in a circle");
            }
        }
        let (mut unused, mut slot) = (0, self.unused);
        while slot != END {
            assert!(!self.in_use.is(slot) && !self.overlaps.is(slot) && !self.shown.is(slot));
            unused += 1;
            slot = self.links[slot as usize].next[0];
        }
        assert_eq!(hanging, 2 * (self.ends.len() - unused), "a slot is lost");
    }
}

/// Of up to as many pairs as a word has bits those that overlap.
///
/// The bits that say on which axes the boxes of a pair are apart are put aside as they are, four for each pair and each fourth pair into one
/// word, and are looked at once for all of a word: a bit of its own for each pair cost four more instructions a pair.
#[inline(always)]
fn overlapping<S: Simd, const FAR: bool>(simd: S, pairs: &[[Proxy; 2]], boxes: &Boxes) -> u64 {
    const WORDS: usize = 4;
    const AXES_OF_ALL: u64 = AXES * (u64::MAX / 0b1111);
    let mut words = [0; WORDS];
    let (fours, rest) = pairs.as_chunks::<WORDS>();
    // Loops: what a fold is given is not always inlined, and is then called without vectors for each pair.
    let mut shift = 0;
    for four in fours {
        for (word, &[a, b]) in words.iter_mut().zip(four) {
            *word |= boxes.apart_with::<S, FAR>(simd, a, b) << shift;
        }
        shift += WORDS;
    }
    for (word, &[a, b]) in words.iter_mut().zip(rest) {
        *word |= boxes.apart_with::<S, FAR>(simd, a, b) << shift;
    }
    let mut apart = 0;
    for (at, word) in words.into_iter().enumerate() {
        // What is not zero carries into the fourth bit, and no further.
        apart |= (((word & AXES_OF_ALL) + AXES_OF_ALL) & !AXES_OF_ALL) >> (WORDS - 1 - at);
    }
    !apart
}

/// Calls `find` with each word and its number; with the feature `rayon` on the threads of the current pool, if there are many.
fn for_each_word(words: &mut [u64], shared: bool, find: impl Fn((usize, &mut u64)) + Sync + Send) {
    #[cfg(feature = "rayon")]
    {
        use rayon::prelude::*;
        /// Fewer words than this, of pairs that take some 3 ns each, are not worth another thread.
        const SHARE_MIN: usize = 512;
        let enough = if shared { SHARE_MIN / 8 } else { SHARE_MIN };
        if crate::threads::share(words.len(), enough) {
            return words.par_iter_mut().enumerate().with_min_len(enough / 2).for_each(find);
        }
    }
    let _ = shared;
    words.iter_mut().enumerate().for_each(find);
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use rand::Rng;
    use solid_oracle::generate::seeded;

    use super::*;

    /// Law: they are a map from pairs of which each is there once, also where all lists are long.
    #[test]
    fn they_say_what_a_tree_map_says_of_a_crowd() {
        const PROXIES: Proxy = 3 * LONG as Proxy;
        let mut rng = seeded(817);
        let (mut lists, mut truth) = (PairLists::default(), BTreeMap::new());
        lists.grow(PROXIES as usize);
        for round in 0..4 {
            for step in 0..20_000 {
                let [a, b] = [0, 0].map(|_| rng.random_range(0..PROXIES));
                if a == b {
                    continue;
                }
                let pair = [a.min(b), a.max(b)];
                assert_eq!(lists.find(a, b), truth.get(&pair).copied());
                if rng.random_bool(0.8) {
                    lists.insert_new(a, b, rng.random_bool(0.7));
                    truth.insert(pair, lists.find(a, b).unwrap());
                } else if let Some(id) = truth.remove(&pair) {
                    lists.remove(id);
                }
                if step % 1000 == 0 {
                    lists.remove_all_of(a, |_| {});
                    truth.retain(|pair, _| !pair.contains(&a));
                }
            }
            lists.validate();
            assert!(lists.listed.len() > PROXIES as usize / 2 && lists.listed.len() < PROXIES as usize);
            lists.settle(|_| true);
            lists.forget_apart();
            truth.retain(|_, &mut id| (id as usize) < lists.ends.len() && lists.overlaps.is(id));
            lists.validate();
            assert!(lists.ids.is_empty() && truth.len() > 5_000, "{round}: {}", truth.len());
        }
    }

    /// Law: to find whether a pair is there takes few steps; each list that is long is gone through once.
    #[test]
    fn a_crowd_is_found_in_few_steps() {
        const PROXIES: Proxy = 10 * LONG as Proxy;
        let mut lists = PairLists::default();
        lists.grow(PROXIES as usize);
        for b in 0..PROXIES {
            for a in 0..b {
                lists.insert_new(a, b, true);
                let (found, steps) = lists.find_within(a, b, usize::MAX);
                assert!(found.is_some() && steps <= LONG, "{a}, {b}: {steps} steps");
            }
        }
        lists.validate();
        // One whose list is as long as all others', but whose partners have short ones, as the ground has, is never gone through.
        let mut lists = PairLists::default();
        lists.grow(PROXIES as usize);
        (1..PROXIES).for_each(|ball| lists.insert_new(0, ball, true));
        assert!(lists.listed.is_empty());
    }

    /// Law: what a crowd took is given back when it is gone, and what there is then stands side by side.
    #[test]
    fn what_a_crowd_leaves_is_little() {
        const PROXIES: Proxy = 300;
        let mut lists = PairLists::default();
        lists.grow(PROXIES as usize);
        (0..PROXIES).for_each(|b| (0..b).for_each(|a| lists.insert_new(a, b, true)));
        lists.settle(|_| true);
        let neighbours: Vec<_> = (1..PROXIES).filter_map(|b| lists.find(b - 1, b)).collect();
        for id in 0..lists.ends.len() as PairId {
            lists.set_overlaps(id, id < 2000 && neighbours.contains(&id));
        }
        lists.settle(|_| true);
        lists.forget_apart();
        lists.give_back();
        lists.validate();
        assert!(lists.ends.len() <= 2000 && lists.ends.capacity() <= 4000 && lists.links.capacity() <= 4000);
        assert!(lists.ids.capacity() == 0, "{}", lists.ids.capacity());
    }
}
