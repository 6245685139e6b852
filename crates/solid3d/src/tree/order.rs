//! Some of up to 64 in the order of their numbers: what is likely nearest goes on where a first distance is sought.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, i32x8};
use solid_convex::simd::part;

use super::lanes::bits;
use super::node::WIDTH;

/// As many as two nodes have pairs of children.
pub(super) const PAIRS_MAX: usize = WIDTH * WIDTH;

/// The bits of a key that tell apart equal ones: as many as tell apart 64.
pub(super) const TIE_BITS: i32 = PAIRS_MAX as i32 - 1;

/// Some of up to 64, in an order.
pub(super) struct Order {
    places: [u8; PAIRS_MAX],
    count: usize,
}

impl Order {
    /// The set bits of a mask by the magnitudes of their numbers, the greatest last; these are compared to within 2^-17 of them. Of equal ones
    /// the highest comes last.
    ///
    /// Each is told its place by how many come before it, eight at a time and without a branch: of the ten or so that two nodes have as a
    /// rule, an insertion takes seven times as long.
    #[inline(always)]
    pub fn ascending<S: Simd>(simd: S, mask: u64, numbers: &[f32]) -> Self {
        part!(simd => Self::ascending_on(simd, mask, numbers))
    }

    #[inline(always)]
    fn ascending_on<S: Simd>(simd: S, mask: u64, numbers: &[f32]) -> Self {
        let mut places = [[0; WIDTH]; WIDTH];
        let mut keys = [[i32::MAX; WIDTH]; WIDTH];
        let mut count = 0;
        for place in bits(mask) {
            places.as_flattened_mut()[count] = place as u8;
            // The bits of numbers that are not negative are in their order.
            let magnitude = numbers[place].abs().to_bits() as i32;
            keys.as_flattened_mut()[count] = magnitude & !TIE_BITS | count as i32;
            count += 1;
        }
        let mut order = Order { places: [0; PAIRS_MAX], count };
        let one = i32x8::splat(simd, 1);
        let zero = i32x8::splat(simd, 0);
        for (of_eight, places) in keys.iter().zip(places.as_flattened()[..count].chunks(WIDTH)) {
            let eight = i32x8::load_array_ref(simd, of_eight);
            let mut before = zero;
            for &key in &keys.as_flattened()[..count] {
                before += eight.simd_gt(i32x8::splat(simd, key)).select(one, zero);
            }
            for (&place, before) in places.iter().zip(before.to_array()) {
                order.places[before as usize % PAIRS_MAX] = place;
            }
        }
        order
    }

    /// What there is, in this order.
    #[inline(always)]
    pub fn as_slice(&self) -> &[u8] {
        &self.places[..self.count]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::tests::scenes::rng;
    use rand::Rng;
    use solid_convex::simd::{alike, dispatch};

    /// Law: all that are asked for are there once, none after one that is clearly deeper, of equal ones the highest last; on every level of
    /// instructions.
    #[test]
    fn the_deepest_comes_last() {
        let mut rng = rng(97);
        for case in 0..3000 {
            let few = 1 + case % 7;
            let gaps: Vec<f32> = (0..PAIRS_MAX)
                .map(|_| match case % 3 {
                    0 => -rng.random_range(0.0..1.0f32),
                    1 => -(rng.random_range(0..few) as f32),
                    _ => -1.0 - rng.random_range(0..few) as f32 * 2f32.powi(-20),
                })
                .collect();
            let mut mask = rng.random::<u64>();
            (0..case % 5).for_each(|_| mask &= rng.random::<u64>());
            let found = alike(|level| {
                dispatch!(widest level, simd => Order::ascending(simd, mask, &gaps)).as_slice().to_vec()
            });
            let mut expected: Vec<u8> = (0..PAIRS_MAX as u8).filter(|&i| mask >> i & 1 == 1).collect();
            // As the key has it: less the last bits.
            let depth = |&i: &u8| gaps[usize::from(i)].abs().to_bits() >> 6;
            expected.sort_by_key(depth); // stable
            assert_eq!(found, expected, "case {case}");
        }
    }
}
