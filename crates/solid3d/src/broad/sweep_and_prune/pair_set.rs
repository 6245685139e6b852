//! The set of overlapping pairs of the sweep and prune.

use super::super::pair_lists::PairLists;
use super::{PairId, Proxy};
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// A set of unordered pairs of proxies. One that ceased to overlap stays until that was told.
#[derive(Debug, Default)]
pub(super) struct PairSet {
    ids: HashMap<u64, PairId, BuildHasherDefault<PairHasher>>,
    pub lists: PairLists,
}

impl PairSet {
    pub fn grow(&mut self, proxies: usize) {
        self.lists.grow(proxies);
    }

    pub fn insert(&mut self, a: Proxy, b: Proxy) {
        let lists = &mut self.lists;
        let id = *self.ids.entry(key(a, b)).or_insert_with(|| lists.insert(a, b, true));
        lists.set_overlaps(id, true);
    }

    pub fn remove(&mut self, a: Proxy, b: Proxy) {
        if let Some(&id) = self.ids.get(&key(a, b)) {
            self.lists.set_overlaps(id, false);
        }
    }

    /// Makes no pair of a proxy overlap.
    pub fn end_all_of(&mut self, proxy: Proxy) {
        self.lists.refresh_of(proxy, |_| false);
    }

    /// Takes out the pairs of a proxy, without a word.
    pub fn remove_all_of(&mut self, proxy: Proxy) {
        let ids = &mut self.ids;
        self.lists.remove_all_of(proxy, |partner| {
            ids.remove(&key(proxy, partner));
        });
    }

    /// Notes the changes since this was last done, and takes out the pairs that do not overlap.
    pub fn settle(&mut self) {
        self.lists.begin();
        let ids = &mut self.ids;
        self.lists.settle(|[a, b]| {
            ids.remove(&key(a, b));
            false
        });
    }

    /// Visits each pair that overlaps, the smaller proxy first, in an order that depends on the history of calls alone.
    pub fn for_each(&self, visit: &mut dyn FnMut(Proxy, Proxy)) {
        self.lists.for_each(|_, [a, b]| visit(a, b));
    }

    /// Visits the proxies that overlap another.
    pub fn for_each_overlap_of(&self, proxy: Proxy, visit: &mut dyn FnMut(Proxy)) {
        self.lists.for_each_overlap_of(proxy, |_, partner| visit(partner));
    }

    pub fn validate(&self) {
        self.lists.validate();
        let mut known = 0;
        self.lists.for_each_known(|[a, b], _| known += usize::from(self.ids.contains_key(&key(a, b))));
        assert_eq!(known, self.ids.len());
    }
}

fn key(a: Proxy, b: Proxy) -> u64 {
    u64::from(a.min(b)) << 32 | u64::from(a.max(b))
}

/// Multiplicative hashing without a random seed: runs must repeat. The keys are the caller's own dense integers.
#[derive(Debug, Default)]
struct PairHasher(u64);

impl Hasher for PairHasher {
    fn write_u64(&mut self, key: u64) {
        // 2^64 / golden ratio, odd. The table takes its index from the low bits and its tag from the high ones.
        let product = (key ^ key >> 29).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        self.0 = product ^ product >> 32;
    }

    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_u64(self.0.rotate_left(8) ^ u64::from(byte));
        }
    }

    fn finish(&self) -> u64 {
        self.0
    }
}
