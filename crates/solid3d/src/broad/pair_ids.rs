//! The ids of pairs by their proxies.

use std::collections::{HashMap, HashSet};
use std::hash::{BuildHasherDefault, Hasher};

use super::{PairId, Proxy};

/// Ids by [`key`].
pub(super) type PairIds = HashMap<u64, PairId, BuildHasherDefault<ProxyHasher>>;

/// Some proxies.
pub(super) type Proxies = HashSet<Proxy, BuildHasherDefault<ProxyHasher>>;

/// A pair, in whichever order.
pub(super) fn key(a: Proxy, b: Proxy) -> u64 {
    u64::from(a.min(b)) << 32 | u64::from(a.max(b))
}

/// Multiplicative hashing without a random seed: runs must repeat. The keys are the caller's own dense integers.
#[derive(Clone, Debug, Default)]
pub(super) struct ProxyHasher(u64);

impl Hasher for ProxyHasher {
    fn write_u32(&mut self, proxy: u32) {
        self.write_u64(proxy.into());
    }

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
