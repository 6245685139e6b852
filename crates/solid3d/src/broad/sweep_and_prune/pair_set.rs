//! The set of overlapping pairs of the sweep and prune.

use super::Proxy;
use std::collections::HashSet;
use std::hash::{BuildHasherDefault, Hasher};

/// A set of unordered pairs of proxies.
#[derive(Debug, Default)]
pub(super) struct PairSet(HashSet<u64, BuildHasherDefault<PairHasher>>);

impl PairSet {
    pub fn insert(&mut self, a: Proxy, b: Proxy) {
        self.0.insert(key(a, b));
    }

    pub fn remove(&mut self, a: Proxy, b: Proxy) {
        self.0.remove(&key(a, b));
    }

    pub fn retain(&mut self, stays: impl Fn(Proxy, Proxy) -> bool) {
        self.0.retain(|&k| stays((k >> 32) as Proxy, k as Proxy));
    }

    /// Visits each pair, the smaller proxy first, in an order that depends on the history of calls alone.
    pub fn for_each(&self, visit: &mut dyn FnMut(Proxy, Proxy)) {
        for &k in &self.0 {
            visit((k >> 32) as Proxy, k as Proxy);
        }
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
