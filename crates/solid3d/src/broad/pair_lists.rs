//! Pairs of proxies, with each proxy's own list of them, and what changed about them.

use super::room::{push, resize};
use super::{PROXY_MAX, PairChange, PairId, Proxy};

const END: u32 = u32::MAX;

/// Pairs whose marks stand in one word.
const MARKS: usize = u64::BITS as usize;

/// The proxies of a pair, the smaller first, and in the bits above those of the first what is known of it.
///
/// Of all that is kept of a pair this alone is read of each when everything moved; so it stands apart from the rest.
#[derive(Clone, Copy, Debug)]
struct Ends([u32; 2]);

impl Ends {
    /// The slot is not in use: the next such slot stands in the links.
    const UNUSED: Ends = Ends([0; 2]);
    /// The boxes overlap.
    const OVERLAPS: u32 = 1 << 31;
    /// They did when changes were last settled.
    const SHOWN: u32 = 1 << 30;
    const IN_USE: u32 = 1 << 29;

    fn new(a: Proxy, b: Proxy) -> Self {
        Ends([a.min(b) | Ends::IN_USE, a.max(b)])
    }

    fn proxies(self) -> [Proxy; 2] {
        [self.0[0] & PROXY_MAX, self.0[1]]
    }

    fn is(self, what: u32) -> bool {
        self.0[0] & what != 0
    }

    fn set(&mut self, what: u32, is: bool) {
        self.0[0] = if is { self.0[0] | what } else { self.0[0] & !what };
    }
}

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
#[derive(Debug)]
pub(super) struct PairLists {
    ends: Vec<Ends>,
    /// By pair, as `ends`.
    links: Vec<Links>,
    /// The first slot that is not in use.
    unused: u32,
    /// By proxy: the first link of its list.
    heads: Vec<u32>,
    /// Pairs whose `OVERLAPS` was changed since changes were last settled; some may have been taken out since.
    touched: Vec<PairId>,
    /// What was settled since the last [`begin`](Self::begin).
    changes: Vec<PairChange>,
    /// Working memory of `refresh_all`: a bit for each pair.
    marks: Vec<u64>,
}

impl Default for PairLists {
    fn default() -> Self {
        PairLists {
            ends: vec![],
            links: vec![],
            unused: END,
            heads: vec![],
            touched: vec![],
            changes: vec![],
            marks: vec![],
        }
    }
}

impl PairLists {
    /// Makes room for proxies below `proxies`.
    pub fn grow(&mut self, proxies: usize) {
        resize(&mut self.heads, proxies, END);
    }

    /// Gives back what room there is for more proxies.
    pub fn trim(&mut self) {
        self.heads.shrink_to_fit();
    }

    /// Adds a pair that is not there yet.
    pub fn insert(&mut self, a: Proxy, b: Proxy, overlaps: bool) -> PairId {
        let id = self.take_slot();
        self.ends[id as usize] = Ends::new(a, b);
        self.hang(id);
        self.set_overlaps(id, overlaps);
        id
    }

    /// Puts a pair at the head of both its lists.
    fn hang(&mut self, id: PairId) {
        let mut links = Links { next: [END; 2], previous: [END; 2] };
        for (side, &proxy) in self.ends[id as usize].proxies().iter().enumerate() {
            let link = 2 * id + side as u32;
            let head = std::mem::replace(&mut self.heads[proxy as usize], link);
            links.next[side] = head;
            if head != END {
                *self.previous_mut(head) = link;
            }
        }
        self.links[id as usize] = links;
    }

    fn take_slot(&mut self) -> PairId {
        let id = self.unused;
        match self.links.get(id as usize) {
            Some(slot) => {
                self.unused = slot.next[0];
                id
            }
            None => {
                push(&mut self.ends, Ends::UNUSED);
                push(&mut self.links, Links { next: [END; 2], previous: [END; 2] });
                self.ends.len() as PairId - 1
            }
        }
    }

    /// Takes a pair out, without a word.
    pub fn remove(&mut self, id: PairId) {
        let proxies = self.ends[id as usize].proxies();
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
        self.drop_slot(id);
    }

    fn drop_slot(&mut self, id: PairId) {
        self.ends[id as usize] = Ends::UNUSED;
        self.links[id as usize].next[0] = self.unused;
        self.unused = id;
    }

    /// Takes out every pair of a proxy, without a word; `taken` hears the partners. Ends, because each step takes out one pair.
    pub fn remove_all_of(&mut self, proxy: Proxy, mut taken: impl FnMut(Proxy)) {
        while let Some(&link) = self.heads.get(proxy as usize).filter(|&&link| link != END) {
            taken(self.partner(link));
            self.remove(link / 2);
        }
    }

    /// Takes out the pairs of a proxy for which `stays` is false of the partner. They must not overlap, nor be shown to.
    pub fn retain_of(&mut self, proxy: Proxy, stays: impl Fn(Proxy) -> bool) {
        let mut link = self.heads[proxy as usize];
        while link != END {
            let (id, next) = (link / 2, self.next(link));
            if !stays(self.partner(link)) {
                debug_assert!(!self.ends[id as usize].is(Ends::OVERLAPS | Ends::SHOWN));
                self.remove(id);
            }
            link = next;
        }
    }

    /// Takes out the pairs that do not overlap. What was changed must have been settled.
    ///
    /// All lists are made anew: to take out one by one costs more, since the pairs before and after in both lists are somewhere else.
    pub fn forget_apart(&mut self) {
        debug_assert!(self.touched.is_empty());
        self.heads.fill(END);
        self.unused = END;
        for id in (0..self.ends.len() as PairId).rev() {
            if self.ends[id as usize].is(Ends::OVERLAPS) {
                self.hang(id);
            } else {
                self.drop_slot(id);
            }
        }
    }

    /// Says whether the boxes of a pair overlap.
    pub fn set_overlaps(&mut self, id: PairId, overlaps: bool) {
        let ends = &mut self.ends[id as usize];
        if ends.is(Ends::OVERLAPS) != overlaps {
            ends.set(Ends::OVERLAPS, overlaps);
            push(&mut self.touched, id);
        }
    }

    /// Finds anew which boxes overlap, among all pairs.
    ///
    /// Which pairs change is written down first and acted upon afterwards, because nobody can foretell it: where each was a branch,
    /// the boxes of the pairs that follow were not fetched from memory before the branch was taken. `fetch` reads something of a
    /// box, so that it is at hand.
    pub fn refresh_all(
        &mut self,
        fetch: impl Fn(Proxy) -> u64 + Sync,
        overlaps: impl Fn(Proxy, Proxy) -> bool + Sync,
    ) {
        /// Fewer boxes than this are at hand always. Of a million, a pass takes a fifth less time when they are fetched before.
        const FETCH_MIN: usize = 1 << 16;
        let far = self.heads.len() >= FETCH_MIN;
        let mark = |(block, marks): (&[Ends], &mut u64)| {
            if far {
                // This loop does nothing but wait for memory, for as many boxes at a time as the machine can.
                let read =
                    |bits, ends: &Ends| ends.proxies().iter().fold(bits, |bits, &proxy| bits ^ fetch(proxy));
                std::hint::black_box(block.iter().fold(0, read));
            }
            let changes = |ends: &Ends| {
                let [a, b] = ends.proxies();
                // In a slot that is not in use both are 0.
                ends.is(Ends::IN_USE) & (overlaps(a, b) != ends.is(Ends::OVERLAPS))
            };
            *marks = (0..).zip(block).fold(0, |bits, (i, ends)| bits | u64::from(changes(ends)) << i);
        };
        let Self { ends, touched, marks, .. } = self;
        marks.clear();
        resize(marks, ends.len().div_ceil(MARKS), 0);
        for_each_block(ends, marks, mark);
        for id in marked(marks) {
            ends[id as usize].0[0] ^= Ends::OVERLAPS;
            push(touched, id);
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

    /// Forgets the changes that were settled before.
    pub fn begin(&mut self) {
        self.changes.clear();
    }

    /// Notes the changes since this was last done, and shows them. `stays` is asked of the pairs that were touched and do not
    /// overlap; where it says no they are taken out.
    pub fn settle(&mut self, mut stays: impl FnMut([Proxy; 2]) -> bool) {
        let mut touched = std::mem::take(&mut self.touched);
        for id in touched.drain(..) {
            let ends = &mut self.ends[id as usize];
            // One may stand here twice, also because its slot was used anew since.
            if !ends.is(Ends::IN_USE) {
                continue;
            }
            let (proxies, overlaps) = (ends.proxies(), ends.is(Ends::OVERLAPS));
            if ends.is(Ends::SHOWN) != overlaps {
                ends.set(Ends::SHOWN, overlaps);
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
        for (id, ends) in (0..).zip(&self.ends) {
            if ends.is(Ends::OVERLAPS) {
                visit(id, ends.proxies());
            }
        }
    }

    /// Visits all pairs, and whether they overlap.
    pub fn for_each_known(&self, mut visit: impl FnMut([Proxy; 2], bool)) {
        for ends in self.ends.iter().filter(|ends| ends.is(Ends::IN_USE)) {
            visit(ends.proxies(), ends.is(Ends::OVERLAPS));
        }
    }

    /// Visits the pairs of a proxy that were shown to overlap, and its partners.
    pub fn for_each_shown_of(&self, proxy: Proxy, visit: impl FnMut(PairId, Proxy)) {
        self.for_each_of(proxy, Ends::SHOWN, visit);
    }

    /// Visits the partners of a proxy whose pair with it overlaps.
    pub fn for_each_overlap_of(&self, proxy: Proxy, visit: impl FnMut(PairId, Proxy)) {
        self.for_each_of(proxy, Ends::OVERLAPS, visit);
    }

    fn for_each_of(&self, proxy: Proxy, what: u32, mut visit: impl FnMut(PairId, Proxy)) {
        let mut link = self.head(proxy);
        while link != END {
            if self.ends[link as usize / 2].is(what) {
                visit(link / 2, self.partner(link));
            }
            link = self.next(link);
        }
    }

    /// The pair of two proxies. Cost: follows the shorter of their two lists.
    pub fn find(&self, a: Proxy, b: Proxy) -> Option<PairId> {
        let (mut of_a, mut of_b) = (self.head(a), self.head(b));
        while of_a != END && of_b != END {
            for (link, partner) in [(&mut of_a, b), (&mut of_b, a)] {
                if self.partner(*link) == partner {
                    return Some(*link / 2);
                }
                *link = self.next(*link);
            }
        }
        None
    }

    /// The same, where it was shown to overlap.
    pub fn find_shown(&self, a: Proxy, b: Proxy) -> Option<PairId> {
        self.find(a, b).filter(|&id| self.ends[id as usize].is(Ends::SHOWN))
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
        self.ends[link as usize / 2].proxies()[1 - link as usize % 2]
    }

    pub fn validate(&self) {
        let mut hanging = 0;
        for (proxy, &head) in self.heads.iter().enumerate() {
            let (mut previous, mut link) = (END, head);
            while link != END {
                let (proxies, side) = (self.ends[link as usize / 2].proxies(), link as usize % 2);
                assert!(self.ends[link as usize / 2].is(Ends::IN_USE));
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
            assert!(!self.ends[slot as usize].is(Ends::IN_USE));
            unused += 1;
            slot = self.links[slot as usize].next[0];
        }
        assert_eq!(hanging, 2 * (self.ends.len() - unused), "a slot is lost");
    }
}

/// Calls `mark` with the pairs of each word of marks; with the feature `rayon` on the threads of the current pool, if there are many.
fn for_each_block(ends: &[Ends], marks: &mut [u64], mark: impl Fn((&[Ends], &mut u64)) + Sync + Send) {
    #[cfg(feature = "rayon")]
    {
        use rayon::prelude::*;
        /// Fewer words than this, of pairs that take some 5 ns each, are not worth another thread.
        const SHARE_MIN: usize = 128;
        if crate::threads::share(marks.len(), SHARE_MIN) {
            let blocks = ends.par_chunks(MARKS).zip(marks);
            return blocks.with_min_len(SHARE_MIN / 2).for_each(mark);
        }
    }
    ends.chunks(MARKS).zip(marks).for_each(mark);
}

/// The pairs of the bits that are set, in ascending order.
fn marked(marks: &[u64]) -> impl Iterator<Item = PairId> {
    (0..).step_by(MARKS).zip(marks).flat_map(|(first, &bits)| {
        let mut bits = bits;
        std::iter::from_fn(move || {
            (bits != 0).then(|| {
                let mark = bits.trailing_zeros();
                bits &= bits - 1;
                first + mark
            })
        })
    })
}
