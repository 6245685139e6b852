//! A map in the order of pairs.

use super::PairKey;

/// Entries of a block. Larger ones cost more to insert into, smaller ones more to find: with 64, blocks are a few cache lines.
const BLOCK_MAX: usize = 64;

/// Blocks of a shelf: the list of its blocks is a few pages at most.
const SHELF_MAX: usize = 256;

/// A sorted map in three levels: blocks of entries, shelves of blocks, and the list of shelves. What is inserted or removed moves at most
/// one block's entries and, seldom, the list of a shelf's blocks. Memory of blocks and shelves that became empty is kept for new ones.
#[derive(Clone, Debug)]
pub(super) struct Ordered<T> {
    /// None is empty; all keys of one are below those of the next.
    shelves: Vec<Shelf<T>>,
    spare: Spare<T>,
    len: usize,
}

#[derive(Clone, Debug)]
struct Shelf<T> {
    /// None is empty; all keys of one are below those of the next.
    blocks: Vec<Block<T>>,
    /// The first key of each: a search reads these side by side, where to look into the blocks was to wait for memory at each step.
    firsts: Vec<PairKey>,
}

type Block<T> = Vec<(PairKey, T)>;

#[derive(Clone, Debug)]
struct Spare<T> {
    /// With room for all that were made, so that what becomes empty allocates nothing.
    blocks: Vec<Block<T>>,
    blocks_made: usize,
    shelves: Vec<Shelf<T>>,
}

impl<T> Default for Ordered<T> {
    fn default() -> Self {
        let spare = Spare { blocks: Vec::new(), blocks_made: 0, shelves: Vec::new() };
        Ordered { shelves: Vec::new(), spare, len: 0 }
    }
}

impl<T: Copy> Ordered<T> {
    pub fn len(&self) -> usize {
        self.len
    }

    /// Adds an entry whose key is not there yet.
    pub fn insert(&mut self, key: PairKey, value: T) {
        self.len += 1;
        if self.shelves.is_empty() {
            let shelf = self.spare.shelf();
            self.shelves.push(shelf);
        }
        let at = self.shelf_of(key);
        let shelf = &mut self.shelves[at];
        shelf.insert(key, value, &mut self.spare);
        if shelf.blocks.len() > SHELF_MAX {
            let mut upper = self.spare.shelf();
            shelf.move_to(&mut upper, SHELF_MAX / 2);
            self.shelves.insert(at + 1, upper);
        }
    }

    /// Takes an entry out; gives its value.
    pub fn remove(&mut self, key: PairKey) -> Option<T> {
        let at = self.shelf_of(key);
        let value = self.shelves.get_mut(at)?.remove(key, &mut self.spare)?;
        self.len -= 1;
        let [shelf, rest @ ..] = &mut self.shelves[at..] else { unreachable!("an entry was on this shelf") };
        let dropped = match rest.first_mut() {
            _ if shelf.blocks.is_empty() => at,
            Some(next) if shelf.blocks.len() + next.blocks.len() <= SHELF_MAX / 2 => {
                next.move_to(shelf, 0);
                at + 1
            }
            _ => return Some(value),
        };
        self.spare.shelves.push(self.shelves.remove(dropped));
        Some(value)
    }

    /// The first entry beyond a key.
    pub fn beyond(&self, last: Option<PairKey>) -> Option<(PairKey, T)> {
        let Some(last) = last else { return self.iter().next() };
        let at = self.shelf_of(last);
        self.shelves.get(at..)?.iter().find_map(|shelf| shelf.beyond(last))
    }

    /// All entries, in order.
    pub fn iter(&self) -> impl Iterator<Item = (PairKey, T)> {
        self.blocks().flatten().copied()
    }

    /// All entries but the first so many, in order. Cost: follows the number of blocks.
    pub fn iter_from(&self, count: usize) -> impl Iterator<Item = (PairKey, T)> {
        let (mut blocks, mut left) = (self.blocks(), count);
        let first = blocks.find(|block| {
            let is_here = left < block.len();
            left -= if is_here { 0 } else { block.len() };
            is_here
        });
        first.into_iter().flat_map(move |block| &block[left..]).chain(blocks.flatten()).copied()
    }

    pub fn clear(&mut self) {
        self.len = 0;
        for mut shelf in self.shelves.drain(..) {
            shelf.firsts.clear();
            shelf.blocks.drain(..).for_each(|block| self.spare.take(block));
            self.spare.shelves.push(shelf);
        }
    }

    fn blocks(&self) -> impl Iterator<Item = &Block<T>> {
        self.shelves.iter().flat_map(|shelf| &shelf.blocks)
    }

    /// The last shelf that begins at or before a key, or else the first.
    fn shelf_of(&self, key: PairKey) -> usize {
        self.shelves.partition_point(|shelf| shelf.firsts.first() <= Some(&key)).saturating_sub(1)
    }
}

impl<T: Copy> Shelf<T> {
    fn insert(&mut self, key: PairKey, value: T, spare: &mut Spare<T>) {
        if self.blocks.is_empty() {
            self.blocks.push(spare.block());
            self.firsts.push(key);
        }
        let mut at = self.block_of(key);
        if self.blocks[at].len() == BLOCK_MAX {
            let mut upper = spare.block();
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

    fn remove(&mut self, key: PairKey, spare: &mut Spare<T>) -> Option<T> {
        let at = self.block_of(key);
        let block = self.blocks.get_mut(at)?;
        let place = block.binary_search_by_key(&key, |entry| entry.0).ok()?;
        let (_, value) = block.remove(place);
        if let Some((first, _)) = block.first() {
            self.firsts[at] = *first;
        }
        self.join(at, spare);
        Some(value)
    }

    /// Drops a block that is empty, or joins it with the next when both are nearly so.
    fn join(&mut self, at: usize, spare: &mut Spare<T>) {
        let [block, rest @ ..] = &mut self.blocks[at..] else { return };
        let dropped = match rest.first_mut() {
            _ if block.is_empty() => at,
            Some(next) if block.len() + next.len() <= BLOCK_MAX / 2 => {
                block.append(next);
                at + 1
            }
            _ => return,
        };
        self.firsts.remove(dropped);
        spare.take(self.blocks.remove(dropped));
    }

    fn beyond(&self, last: PairKey) -> Option<(PairKey, T)> {
        let at = self.block_of(last);
        let block = self.blocks.get(at)?;
        let place = block.partition_point(|entry| entry.0 <= last);
        block.get(place).or_else(|| self.blocks.get(at + 1)?.first()).copied()
    }

    /// Moves the blocks from `at` on to the end of another shelf.
    fn move_to(&mut self, other: &mut Shelf<T>, at: usize) {
        other.blocks.extend(self.blocks.drain(at..));
        other.firsts.extend(self.firsts.drain(at..));
    }

    /// The last block that begins at or before a key, or else the first.
    fn block_of(&self, key: PairKey) -> usize {
        self.firsts.partition_point(|first| *first <= key).saturating_sub(1)
    }
}

impl<T> Spare<T> {
    /// A block that is empty.
    fn block(&mut self) -> Block<T> {
        self.blocks.pop().unwrap_or_else(|| {
            // How many blocks as many entries take depends on the order in which they came: some more, so that others like them find room.
            let more = self.blocks_made / 4;
            self.blocks_made += 1 + more;
            self.blocks.reserve(self.blocks_made);
            self.blocks.extend((0..more).map(|_| Vec::with_capacity(BLOCK_MAX)));
            Vec::with_capacity(BLOCK_MAX)
        })
    }

    /// Keeps the memory of a block.
    fn take(&mut self, mut block: Block<T>) {
        block.clear();
        self.blocks.push(block);
    }

    /// A shelf that is empty.
    fn shelf(&mut self) -> Shelf<T> {
        self.shelves.pop().unwrap_or_else(|| Shelf { blocks: Vec::new(), firsts: Vec::new() })
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use rand::Rng;
    use solid_oracle::generate::seeded;

    use super::*;

    fn validate<T: Copy>(map: &Ordered<T>) {
        for shelf in &map.shelves {
            assert!((1..=SHELF_MAX).contains(&shelf.blocks.len()));
            assert!(shelf.blocks.iter().map(|block| block[0].0).eq(shelf.firsts.iter().copied()));
        }
        let is_block =
            |block: &Block<T>| (1..=BLOCK_MAX).contains(&block.len()) && block.capacity() == BLOCK_MAX;
        assert!(map.blocks().all(is_block));
        assert!(map.iter().map(|(key, _)| key).is_sorted() && map.iter().count() == map.len());
    }

    /// Law: it is a sorted map, also of so many entries that shelves are split and joined.
    #[test]
    fn many_come_in_any_order_and_go_in_another() {
        const COUNT: u64 = 60_000;
        let (mut map, mut most) = (Ordered::default(), 0);
        // Multiplied by what has no common factor with their number, all come once, far from one another.
        let mixed = |i: u64, by: u64| (i * by % COUNT, i * by % 7);
        for i in 0..COUNT {
            map.insert(mixed(i, 7919), i);
            most = most.max(map.shelves.len());
        }
        validate(&map);
        for i in 0..COUNT {
            let key = mixed(i, 7919);
            assert_eq!(map.remove(key), Some(i));
            assert_eq!(map.remove(key), None);
            if i % 5000 == 0 {
                validate(&map);
                let next = map.iter().map(|(key, _)| key).find(|&other| other > key);
                assert_eq!(map.beyond(Some(key)).map(|(key, _)| key), next);
            }
        }
        assert!(most > 5 && map.shelves.is_empty() && map.len() == 0, "{most} shelves");
    }

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
                    validate(&map);
                }
            }
            assert!((6_000..14_000).contains(&hits), "{hits} keys of {keys} were there");
        }
    }

    #[test]
    fn ascending_keys_fill_their_blocks() {
        let mut map = Ordered::default();
        (0..10_000).for_each(|i| map.insert((i, 0), i));
        assert!(map.blocks().count() <= 10_000 / (BLOCK_MAX - 1) + 1);
        map.clear();
        assert_eq!((map.len(), map.beyond(None)), (0, None));
    }
}
