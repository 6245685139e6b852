//! A bit for each of many things.

use super::room::{give_back, resize};
use crate::tree::bits;

/// Bits of a word.
pub(super) const WORD: usize = u64::BITS as usize;

/// Bits that are named by dense integers; those that were never set are not.
#[derive(Clone, Debug, Default)]
pub(super) struct Bits(Vec<u64>);

impl Bits {
    /// Makes room for bits below `len`, which are not set.
    pub fn grow(&mut self, len: usize) {
        if len > self.0.len() * WORD {
            resize(&mut self.0, len.div_ceil(WORD), 0);
        }
    }

    /// Forgets the bits from `len` on.
    pub fn cut(&mut self, len: usize) {
        self.0.truncate(len.div_ceil(WORD));
        if let Some(last) = self.0.get_mut(len / WORD) {
            *last &= !(u64::MAX << (len % WORD));
        }
    }

    /// Gives back the memory of many that there no longer are.
    pub fn give_back(&mut self) {
        give_back(&mut self.0);
    }

    /// One more than the last that is set.
    pub fn end(&self) -> usize {
        let last = self.0.iter().rposition(|&word| word != 0);
        last.map_or(0, |at| (at + 1) * WORD - self.0[at].leading_zeros() as usize)
    }

    #[inline]
    pub fn is(&self, bit: u32) -> bool {
        self.0[bit as usize / WORD] >> (bit as usize % WORD) & 1 != 0
    }

    #[inline]
    pub fn set(&mut self, bit: u32, is: bool) {
        let (word, mask) = (&mut self.0[bit as usize / WORD], 1 << (bit as usize % WORD));
        *word = if is { *word | mask } else { *word & !mask };
    }

    pub fn words(&self) -> &[u64] {
        &self.0
    }

    pub fn words_mut(&mut self) -> &mut [u64] {
        &mut self.0
    }

    /// Those that are set, in ascending order.
    pub fn iter(&self) -> impl Iterator<Item = u32> {
        (0..)
            .step_by(WORD)
            .zip(&self.0)
            .flat_map(|(first, &word)| bits(word).map(move |bit| first + bit as u32))
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use rand::Rng;
    use solid_oracle::generate::seeded;

    use super::*;

    /// Law: they are a set of integers.
    #[test]
    fn they_say_what_a_tree_set_says() {
        let mut rng = seeded(813);
        let (mut those, mut truth, mut hits) = (Bits::default(), BTreeSet::new(), 0);
        for len in 1..1000 {
            those.grow(len);
            let bit = rng.random_range(0..len as u32);
            assert_eq!(those.is(bit), truth.contains(&bit));
            hits += usize::from(truth.contains(&bit));
            if rng.random_bool(0.7) {
                truth.insert(bit);
                those.set(bit, true);
            } else {
                truth.remove(&bit);
                those.set(bit, false);
            }
            if len % 50 == 0 {
                let end = rng.random_range(len - 10..=len);
                those.cut(end);
                those.grow(len);
                truth.retain(|&bit| (bit as usize) < end);
            }
            assert!(those.iter().eq(truth.iter().copied()), "{len}");
            assert_eq!(those.end(), truth.last().map_or(0, |&last| last as usize + 1));
        }
        assert!((300..700).contains(&hits), "{hits} bits were set");
    }
}
