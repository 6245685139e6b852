//! The children of nodes that are yet to be visited, the nearest of them first.
//!
//! Those of a node stay together with the [keys](super::squares::keys) of their squares, and the nearest is found when it is wanted: most are never visited, as what is found before is
//! nearer. Sorting them as they came took a tenth of a walk, for branches that nobody can foretell.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, i32x8};

use super::Place;
use super::node::WIDTH;
use super::squares::lane;

/// Room that most queries do with, taken at once.
const BROODS_USUAL: usize = 32;

/// In place of the key of a child that is not to be visited, or was.
const NONE: i32 = i32::MAX;

/// Nodes with children to be visited, the last opened at the end.
#[derive(Clone, Debug, Default)]
pub(super) struct Broods(Vec<Brood>);

/// The children of a node that are to be visited.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Brood {
    /// The keys of their squared distances by lane.
    keys: [i32; WIDTH],
    /// The least of them.
    least: i32,
    node: u32,
}

impl Broods {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.0.clear();
        self.0.reserve(BROODS_USUAL);
    }

    /// The memory that they own, in bytes.
    pub fn bytes(&self) -> usize {
        self.0.capacity() * size_of::<Brood>()
    }

    /// Adds the children of a node whose keys are below a limit, of which there are some; then [takes](Self::take) one. Mostly it is of these, and then
    /// at hand.
    #[inline(always)]
    pub fn add_and_take<S: Simd>(
        &mut self,
        simd: S,
        (node, keys): (usize, i32x8<S>),
        nodes: usize,
        limit: i32,
    ) -> Option<(i32, Place)> {
        let least = keys.reduce_min();
        let is_near = keys.simd_lt(i32x8::splat(simd, limit));
        let near = is_near.select(keys, i32x8::splat(simd, NONE));
        let mut brood = Brood { keys: [NONE; WIDTH], least, node: node as u32 };
        let earlier = &self.0[self.0.len().saturating_sub(nodes - 1)..];
        if earlier.iter().all(|brood| least <= brood.least) {
            let place = brood.take(simd, near);
            self.0.push(brood);
            return Some((least, place));
        }
        near.store_slice(&mut brood.keys);
        self.0.push(brood);
        self.take(simd, nodes, limit)
    }

    /// Takes the nearest child of the last so many nodes, at least one, with its key; where none of these is below the limit, of those before them.
    #[inline(always)]
    pub fn take<S: Simd>(&mut self, simd: S, nodes: usize, limit: i32) -> Option<(i32, Place)> {
        loop {
            let last = self.0.len().checked_sub(1)?;
            let first = self.0.len().saturating_sub(nodes);
            let mut at = last;
            for i in (first..last).rev() {
                at = if self.0[i].least < self.0[at].least { i } else { at };
            }
            let brood = &mut self.0[at];
            let least = brood.least;
            if least >= limit {
                self.0.truncate(first);
                continue;
            }
            let keys = i32x8::from_slice(simd, &brood.keys);
            return Some((least, brood.take(simd, keys)));
        }
    }
}

impl Brood {
    /// Takes the nearest child out of the keys that it is to have. These are written as a vector, as they will be read: a lane that is written alone would
    /// be waited for.
    #[inline(always)]
    fn take<S: Simd>(&mut self, simd: S, keys: i32x8<S>) -> Place {
        let taken = self.least;
        let is_taken = keys.simd_eq(i32x8::splat(simd, taken));
        let left = is_taken.select(i32x8::splat(simd, NONE), keys);
        left.store_slice(&mut self.keys);
        self.least = left.reduce_min();
        Place::lane(self.node as usize, lane(taken))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::squares::{key_limit, keys};
    use crate::tree::tests::scenes::rng;
    use fearless_simd::f32x8;
    use rand::Rng;
    use solid_convex::simd::{alike, dispatch};

    /// Law: of the last nodes the nearest child comes next, of equal ones the lowest lane, and that of the node opened last; each comes once, and none that
    /// is not below the limit. On every level of instructions.
    #[test]
    fn the_nearest_of_the_last_nodes_comes_next() {
        let mut rng = rng(98);
        let mut taken_in_all = 0;
        for case in 0..2000 {
            let nodes = 1 + case % 4;
            let few = rng.random_range(1..20);
            let limit = [f32::INFINITY, 4.0, 0.5][case % 3];
            let mut square = || match rng.random_range(0..12) {
                0 => f32::INFINITY,
                _ => rng.random_range(0..few) as f32,
            };
            let mut squares: Vec<[f32; WIDTH]> =
                (0..1 + case % 5).map(|_| std::array::from_fn(|_| square())).collect();
            // Some child is near.
            squares.iter_mut().for_each(|squares| squares[case % WIDTH] = 0.0);
            let taken = alike(|level| {
                let mut broods = Broods::default();
                dispatch!(widest level, simd => {
                    let mut taken = Vec::new();
                    for (node, squares) in squares.iter().enumerate() {
                        let keys = keys(simd, f32x8::from_slice(simd, squares));
                        taken.extend(broods.add_and_take(simd, (node, keys), nodes, key_limit(limit)));
                    }
                    taken.extend(std::iter::from_fn(|| broods.take(simd, nodes, key_limit(limit))));
                    taken.into_iter().map(|(_, place)| place).collect::<Vec<_>>()
                })
            });
            let mut left: Vec<Vec<((f32, usize), Place)>> = Vec::new();
            let mut expected = Vec::new();
            let mut squares = squares.iter().enumerate();
            loop {
                if let Some((node, squares)) = squares.next() {
                    let all = (0..WIDTH).map(|lane| ((squares[lane], lane), Place::lane(node, lane)));
                    left.push(all.filter(|child| child.0.0 < limit).collect());
                }
                let first = left.len().saturating_sub(nodes);
                let of_last = left[first..].iter().rev().flatten().copied();
                match of_last.reduce(|x, y| if y.0 < x.0 { y } else { x }) {
                    Some(next) => {
                        left.iter_mut().for_each(|children| children.retain(|child| child.1 != next.1));
                        expected.push(next.1);
                    }
                    None if left.is_empty() => break,
                    None => left.truncate(first),
                }
            }
            taken_in_all += taken.len();
            assert_eq!(taken, expected, "case {case}");
        }
        assert!(taken_in_all > 10_000);
    }
}
