//! The children of nodes that are yet to be visited, the nearest of them first.
//!
//! Those of a node stay together with their squares, and the nearest is found when it is wanted: most are never visited, as what is found before is
//! nearer. Sorting them as they came took a tenth of a walk, for branches that nobody can foretell.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};

use super::Place;
use super::node::WIDTH;

/// Room that most queries do with, taken at once.
const BROODS_USUAL: usize = 32;

/// The numbers of the lanes.
const LANES: [f32; WIDTH] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

/// Nodes with children to be visited, the last opened at the end.
#[derive(Clone, Debug, Default)]
pub(super) struct Broods(Vec<Brood>);

/// The children of a node that are to be visited.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Brood {
    /// Lower bounds of their squared distances by lane, infinite of those that are not to be visited, or were.
    squares: [f32; WIDTH],
    /// The least of them.
    least: f32,
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

    /// Adds the children of a node whose squares are below a limit, of which there are some; then [takes](Self::take) one. Mostly it is of these, and then
    /// at hand.
    #[inline(always)]
    pub fn add_and_take<S: Simd>(
        &mut self,
        simd: S,
        (node, squares): (usize, f32x8<S>),
        nodes: usize,
        limit: f32,
    ) -> Option<(f32, Place)> {
        let least = squares.reduce_min();
        let is_far = squares.simd_ge(f32x8::splat(simd, limit));
        let near = is_far.select(f32x8::splat(simd, f32::INFINITY), squares);
        let mut brood = Brood { squares: [0.0; WIDTH], least, node: node as u32 };
        let earlier = &self.0[self.0.len().saturating_sub(nodes - 1)..];
        if earlier.iter().all(|brood| least <= brood.least) {
            let place = brood.take(simd, near);
            self.0.push(brood);
            return Some((least, place));
        }
        near.store_slice(&mut brood.squares);
        self.0.push(brood);
        self.take(simd, nodes, limit)
    }

    /// Takes the nearest child of the last so many nodes, at least one, with its square; where none of these is below the limit, of those before them.
    #[inline(always)]
    pub fn take<S: Simd>(&mut self, simd: S, nodes: usize, limit: f32) -> Option<(f32, Place)> {
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
            let squares = f32x8::from_slice(simd, &brood.squares);
            return Some((least, brood.take(simd, squares)));
        }
    }
}

impl Brood {
    /// Takes the nearest child out of the squares that it is to have, the lowest lane of equal ones. These are written as a vector, as they will be
    /// read: a lane that is written alone would be waited for.
    #[inline(always)]
    fn take<S: Simd>(&mut self, simd: S, squares: f32x8<S>) -> Place {
        let nearest = squares.simd_eq(f32x8::splat(simd, self.least)).to_bitmask();
        let lane = nearest.trailing_zeros() as usize % WIDTH;
        let is_taken = f32x8::from_slice(simd, &LANES).simd_eq(f32x8::splat(simd, LANES[lane]));
        let left = is_taken.select(f32x8::splat(simd, f32::INFINITY), squares);
        left.store_slice(&mut self.squares);
        self.least = left.reduce_min();
        Place::lane(self.node as usize, lane)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::tests::scenes::rng;
    use rand::Rng;
    use solid_convex::simd::{alike, dispatch};

    /// Law: of the last nodes the nearest child comes next, of equal ones that of the node opened last, and the lowest lane; each comes once, and
    /// none that is not below the limit. On every level of instructions.
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
                        let squares = f32x8::from_slice(simd, squares);
                        taken.extend(broods.add_and_take(simd, (node, squares), nodes, limit));
                    }
                    taken.extend(std::iter::from_fn(|| broods.take(simd, nodes, limit)));
                    taken
                })
            });
            let mut left: Vec<Vec<(f32, Place)>> = Vec::new();
            let mut expected = Vec::new();
            let mut squares = squares.iter().enumerate();
            loop {
                if let Some((node, squares)) = squares.next() {
                    let all = (0..WIDTH).map(|lane| (squares[lane], Place::lane(node, lane)));
                    left.push(all.filter(|child| child.0 < limit).collect());
                }
                let first = left.len().saturating_sub(nodes);
                let of_last = left[first..].iter().rev().flatten().copied();
                match of_last.reduce(|x, y| if y.0 < x.0 { y } else { x }) {
                    Some(next) => {
                        left.iter_mut().for_each(|children| children.retain(|child| child.1 != next.1));
                        expected.push(next);
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
