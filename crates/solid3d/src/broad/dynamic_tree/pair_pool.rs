//! The pairs of overlapping fat boxes, with each proxy's own list of them, and whether the tight boxes overlap too.

use crate::broad::Proxy;

const END: u32 = u32::MAX;

/// A pair, linked into the lists of both its proxies.
#[derive(Clone, Copy, Debug)]
struct Pair {
    /// The smaller proxy first.
    proxies: [Proxy; 2],
    /// The next and the previous link in the list of either proxy.
    next: [u32; 2],
    previous: [u32; 2],
    /// Whether the tight boxes overlap.
    overlaps: bool,
}

/// Pairs of proxies; all pairs of one proxy can be taken out in time proportional to their number.
///
/// One dense vector holds them, so that visiting all is a linear scan and nothing is allocated per proxy. The links of
/// the lists name a pair and a side of it: `2 * index + side`. Lists rather than vectors, because taking one pair out of
/// the list of, say, the ground must not cost a search in that list.
#[derive(Debug, Default)]
pub(super) struct PairPool {
    pairs: Vec<Pair>,
    /// By proxy: the first link of its list.
    heads: Vec<u32>,
}

impl PairPool {
    /// Makes room for proxies below `proxies`.
    pub fn grow(&mut self, proxies: usize) {
        self.heads.resize(proxies, END);
    }

    pub fn clear(&mut self) {
        self.pairs.clear();
        self.heads.fill(END);
    }

    /// Adds a pair that is not there yet.
    pub fn insert(&mut self, a: Proxy, b: Proxy, overlaps: bool) {
        let proxies = [a.min(b), a.max(b)];
        let index = self.pairs.len() as u32;
        let mut pair = Pair { proxies, next: [END; 2], previous: [END; 2], overlaps };
        for (side, &proxy) in proxies.iter().enumerate() {
            let link = 2 * index + side as u32;
            let head = std::mem::replace(&mut self.heads[proxy as usize], link);
            pair.next[side] = head;
            if head != END {
                *self.previous_mut(head) = link;
            }
        }
        self.pairs.push(pair);
    }

    /// Takes out every pair of a proxy. Ends, because each step takes out one pair.
    pub fn remove_all_of(&mut self, proxy: Proxy) {
        while self.heads[proxy as usize] != END {
            self.swap_remove(self.heads[proxy as usize] / 2);
        }
    }

    /// Visits all pairs, and whether their tight boxes overlap.
    pub fn for_each(&self, mut visit: impl FnMut(Proxy, Proxy, bool)) {
        for pair in &self.pairs {
            visit(pair.proxies[0], pair.proxies[1], pair.overlaps);
        }
    }

    /// Visits the partners of a proxy, and whether the tight boxes overlap.
    pub fn for_each_of(&self, proxy: Proxy, mut visit: impl FnMut(Proxy, bool)) {
        let mut link = self.heads[proxy as usize];
        while link != END {
            let (pair, side) = (&self.pairs[link as usize / 2], link as usize % 2);
            visit(pair.proxies[1 - side], pair.overlaps);
            link = pair.next[side];
        }
    }

    /// Finds anew which tight boxes overlap, among all pairs.
    pub fn refresh_all(&mut self, overlaps: impl Fn(Proxy, Proxy) -> bool) {
        for pair in &mut self.pairs {
            pair.overlaps = overlaps(pair.proxies[0], pair.proxies[1]);
        }
    }

    /// Finds anew which tight boxes overlap, among the pairs of one proxy.
    pub fn refresh_of(&mut self, proxy: Proxy, overlaps: impl Fn(Proxy, Proxy) -> bool) {
        let mut link = self.heads[proxy as usize];
        while link != END {
            let pair = &mut self.pairs[link as usize / 2];
            pair.overlaps = overlaps(pair.proxies[0], pair.proxies[1]);
            link = pair.next[link as usize % 2];
        }
    }

    fn swap_remove(&mut self, index: u32) {
        let pair = self.pairs[index as usize];
        for side in 0..2 {
            self.relink(pair.previous[side], pair.proxies[side], pair.next[side]);
            if pair.next[side] != END {
                *self.previous_mut(pair.next[side]) = pair.previous[side];
            }
        }
        self.pairs.swap_remove(index as usize);
        if let Some(&moved) = self.pairs.get(index as usize) {
            for side in 0..2 {
                let link = 2 * index + side as u32;
                self.relink(moved.previous[side], moved.proxies[side], link);
                if moved.next[side] != END {
                    *self.previous_mut(moved.next[side]) = link;
                }
            }
        }
    }

    /// Makes `next` follow `previous`, or head the list of `proxy` where there is no previous one.
    fn relink(&mut self, previous: u32, proxy: Proxy, next: u32) {
        if previous == END {
            self.heads[proxy as usize] = next;
        } else {
            self.pairs[previous as usize / 2].next[previous as usize % 2] = next;
        }
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
        assert_eq!(links, 2 * self.pairs.len());
    }
}
