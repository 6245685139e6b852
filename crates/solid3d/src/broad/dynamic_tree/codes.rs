//! Codes along a Morton curve: the centres of boxes, quantised to 10 bits an axis and interleaved. An entry has its code in the high half and
//! the proxy in the low one, so that sorting is a sort of plain integers.

#[cfg(feature = "rayon")]
use rayon::prelude::*;

use super::fat_box::FatBox;
use crate::broad::Proxy;
use crate::broad::room::resize;
use crate::threads::for_each_part;
#[cfg(feature = "rayon")]
use crate::threads::share;

/// Bits of a code for each axis.
const BITS: u32 = 10;

/// Leaves that are looked at in one piece.
pub(super) const PART: usize = 1 << 11;

/// So many, each of some 60 ns, are worth another thread.
pub(super) const MANY: usize = 1 << 13;

pub(super) fn proxy(entry: u64) -> Proxy {
    entry as Proxy
}

pub(super) fn code(entry: u64) -> u32 {
    (entry >> 32) as u32
}

/// Gives the entries codes relative to their own bounds. False if all centres are one.
pub(super) fn encode(order: &mut [u64], boxes: &[FatBox]) -> bool {
    let FatBox { min, max } = bounds_of_centers(order, boxes);
    // In `f64`: the extent of finite `f32` boxes may overflow, and the inverse of a tiny one too.
    let scale: [f64; 3] = std::array::from_fn(|k| {
        let extent = f64::from(max[k]) - f64::from(min[k]);
        if extent > 0.0 { f64::from(1 << BITS) / extent } else { 0.0 }
    });
    if scale == [0.0; 3] {
        return false;
    }
    for_each_part(order, PART, MANY, |_, order| {
        for entry in order {
            let center = boxes[proxy(*entry) as usize].center();
            let cell = |k: usize| {
                let cell = (f64::from(center[k]) - f64::from(min[k])) * scale[k];
                spread((cell as u32).min((1 << BITS) - 1))
            };
            let code = cell(0) | cell(1) << 1 | cell(2) << 2;
            *entry = u64::from(code) << 32 | u64::from(proxy(*entry));
        }
    });
    true
}

fn bounds_of_centers(order: &[u64], boxes: &[FatBox]) -> FatBox {
    let none = FatBox { min: [f32::MAX; 3], max: [-f32::MAX; 3] };
    let of_part = |order: &[u64]| {
        order.iter().fold(none, |sum, &entry| {
            let center = boxes[proxy(entry) as usize].center();
            sum.union(&FatBox { min: center, max: center })
        })
    };
    #[cfg(feature = "rayon")]
    if share(order.len(), MANY) {
        return order.par_chunks(PART).map(of_part).reduce(|| none, |a, b| a.union(&b));
    }
    of_part(order)
}

/// Entries are all different, so there is one order.
pub(super) fn sort(order: &mut [u64]) {
    #[cfg(feature = "rayon")]
    if share(order.len(), MANY) {
        return order.par_sort_unstable();
    }
    order.sort_unstable();
}

/// Sorts entries that ascend by proxy: by digits of their codes, the lowest first, in half the time of a sort by comparison.
pub(super) fn sort_ascending(order: &mut Vec<u64>, sorted: &mut Vec<u64>) {
    /// Fewer are not worth the buckets.
    const ENTRIES_MIN: usize = 1 << 10;
    const BUCKETS: usize = 1 << BITS;
    if order.len() < ENTRIES_MIN {
        return order.sort_unstable();
    }
    sorted.clear();
    resize(sorted, order.len(), 0);
    // As many digits as axes.
    for digit in 0..3 {
        let bucket = |entry: u64| (code(entry) >> (digit * BITS)) as usize % BUCKETS;
        let mut next = [0_u32; BUCKETS];
        order.iter().for_each(|&entry| next[bucket(entry)] += 1);
        let mut start = 0;
        for next in &mut next {
            start += std::mem::replace(next, start);
        }
        for &entry in order.iter() {
            let place = &mut next[bucket(entry)];
            sorted[*place as usize] = entry;
            *place += 1;
        }
        std::mem::swap(order, sorted);
    }
}

/// Puts two zero bits between the ten low bits.
fn spread(x: u32) -> u32 {
    let x = (x | x << 16) & 0x0300_00FF;
    let x = (x | x << 8) & 0x0300_F00F;
    let x = (x | x << 4) & 0x030C_30C3;
    (x | x << 2) & 0x0924_9249
}
