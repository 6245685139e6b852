//! A map in the order of pairs.

use super::PairKey;

/// Entries of a block. Larger ones cost more to insert into, smaller ones more to find: with 64, blocks are a few cache lines.
const BLOCK_MAX: usize = 64;

/// A sorted map in two levels: blocks of entries, and the list of blocks. What is inserted or removed moves at most one block's
/// entries and, seldom, the list. Memory of blocks that became empty is kept for new ones.
#[derive(Debug)]
pub(super) struct Ordered<T> {
    /// None is empty; all keys of one are below those of the next.
    blocks: Vec<Vec<(PairKey, T)>>,
    /// The first key of each: a search reads these side by side, where to look into the blocks was to wait for memory at each step.
    firsts: Vec<PairKey>,
    spare: Vec<Vec<(PairKey, T)>>,
    len: usize,
}

impl<T> Default for Ordered<T> {
    fn default() -> Self {
        Ordered { blocks: Vec::new(), firsts: Vec::new(), spare: Vec::new(), len: 0 }
    }
}

impl<T: Copy> Ordered<T> {
    pub fn len(&self) -> usize {
        self.len
    }

    /// Adds an entry whose key is not there yet.
    pub fn insert(&mut self, key: PairKey, value: T) {
        self.len += 1;
        if self.blocks.is_empty() {
            let mut block = self.new_block();
            block.push((key, value));
            self.firsts.push(key);
            return self.blocks.push(block);
        }
        let mut at = self.block_of(key);
        if self.blocks[at].len() == BLOCK_MAX {
            let mut upper = self.new_block();
            let lower = &mut self.blocks[at];
            // Keys that come in ascending order leave full blocks behind.
            let ascends = lower[BLOCK_MAX - 1].0 < key;
            upper.extend(lower.drain(if ascends { BLOCK_MAX - 1 } else { BLOCK_MAX / 2 }..));
            let first = upper[0].0;
            self.blocks.insert(at + 1, upper);
            self.firsts.insert(at + 1, first);
            at += usize::from(first <= key);
        }
        let block = &mut self.blocks[at];
        let place = block.partition_point(|entry| entry.0 < key);
        block.insert(place, (key, value));
        self.firsts[at] = block[0].0;
    }

    /// Takes an entry out; gives its value.
    pub fn remove(&mut self, key: PairKey) -> Option<T> {
        let at = self.block_of(key);
        let block = self.blocks.get_mut(at)?;
        let place = block.binary_search_by_key(&key, |entry| entry.0).ok()?;
        let (_, value) = block.remove(place);
        self.len -= 1;
        if let Some((first, _)) = block.first() {
            self.firsts[at] = *first;
        }
        self.join(at);
        Some(value)
    }

    /// The first entry beyond a key.
    pub fn beyond(&self, last: Option<PairKey>) -> Option<(PairKey, T)> {
        let Some(last) = last else { return self.iter().next() };
        let at = self.block_of(last);
        let block = self.blocks.get(at)?;
        let place = block.partition_point(|entry| entry.0 <= last);
        block.get(place).or_else(|| self.blocks.get(at + 1)?.first()).copied()
    }

    /// All entries, in order.
    pub fn iter(&self) -> impl Iterator<Item = (PairKey, T)> {
        self.blocks.iter().flatten().copied()
    }

    /// All entries but the first so many, in order. Cost: follows the number of blocks.
    pub fn iter_from(&self, count: usize) -> impl Iterator<Item = (PairKey, T)> {
        let (mut blocks, mut left) = (self.blocks.iter(), count);
        let first = blocks.find(|block| {
            let is_here = left < block.len();
            left -= if is_here { 0 } else { block.len() };
            is_here
        });
        first.into_iter().flat_map(move |block| &block[left..]).chain(blocks.flatten()).copied()
    }

    pub fn clear(&mut self) {
        self.len = 0;
        self.firsts.clear();
        for mut block in self.blocks.drain(..) {
            block.clear();
            self.spare.push(block);
        }
    }

    /// The last block that begins at or before a key, or else the first.
    fn block_of(&self, key: PairKey) -> usize {
        self.firsts.partition_point(|first| *first <= key).saturating_sub(1)
    }

    fn new_block(&mut self) -> Vec<(PairKey, T)> {
        self.spare.pop().unwrap_or_else(|| Vec::with_capacity(BLOCK_MAX))
    }

    /// Drops a block that is empty, or joins it with the next when both are nearly so.
    fn join(&mut self, at: usize) {
        let [block, rest @ ..] = &mut self.blocks[at..] else { return };
        match rest.first_mut() {
            _ if block.is_empty() => {}
            Some(next) if block.len() + next.len() <= BLOCK_MAX / 2 => {
                block.append(next);
                return self.drop_block(at + 1);
            }
            _ => return,
        }
        self.drop_block(at);
    }

    fn drop_block(&mut self, at: usize) {
        let block = self.blocks.remove(at);
        self.firsts.remove(at);
        self.spare.push(block);
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use rand::Rng;
    use solid_oracle::generate::seeded;

    use super::*;

    /// Law: it is a sorted map.
    #[test]
    fn it_says_what_a_tree_map_says() {
        let mut rng = seeded(800);
        for keys in [3, 40, 300, 1500] {
            let (mut map, mut truth) = (Ordered::default(), BTreeMap::new());
            let mut hits = 0;
            for step in 0..20_000 {
                // Waves of growing and shrinking.
                let grows = rng.random_range(0..10) < if step / 4000 % 2 == 0 { 7 } else { 3 };
                let key = (rng.random_range(0..keys), rng.random_range(0..3));
                hits += usize::from(truth.contains_key(&key));
                if !grows {
                    assert_eq!(map.remove(key), truth.remove(&key));
                } else if truth.insert(key, step).is_none() {
                    map.insert(key, step);
                } else {
                    map.remove(key);
                    map.insert(key, step);
                }
                let last = rng.random_bool(0.9).then(|| (rng.random_range(0..keys), 1));
                let beyond =
                    truth.iter().find(|&(&key, _)| Some(key) > last).map(|(&key, &value)| (key, value));
                assert_eq!(map.beyond(last), beyond);
                assert_eq!(map.len(), truth.len());
                if step % 1000 == 0 {
                    assert!(map.iter().eq(truth.iter().map(|(&key, &value)| (key, value))));
                    let count = rng.random_range(0..=map.len() + 1);
                    assert!(map.iter_from(count).eq(map.iter().skip(count)));
                    assert!(map.blocks.iter().map(|block| block[0].0).eq(map.firsts.iter().copied()));
                    assert!(
                        map.blocks.iter().all(|block| !block.is_empty() && block.capacity() == BLOCK_MAX)
                    );
                }
            }
            assert!((6_000..14_000).contains(&hits), "{hits} keys of {keys} were there");
        }
    }

    #[test]
    fn ascending_keys_fill_their_blocks() {
        let mut map = Ordered::default();
        (0..10_000).for_each(|i| map.insert((i, 0), i));
        assert!(map.blocks.len() <= 10_000 / (BLOCK_MAX - 1) + 1);
        map.clear();
        assert_eq!((map.len(), map.beyond(None)), (0, None));
    }
}
