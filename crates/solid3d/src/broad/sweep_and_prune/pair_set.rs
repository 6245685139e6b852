//! The set of overlapping pairs of the sweep and prune.

use super::Proxy;
use crate::broad::pair_ids::{PairIds, key};
use crate::broad::pair_lists::PairLists;

/// A set of unordered pairs of proxies. One that ceased to overlap stays until that was told.
#[derive(Clone, Debug, Default)]
pub(super) struct PairSet {
    ids: PairIds,
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
