//! The children of nodes that are yet to be visited, the nearest of them first.
//!
//! Those of a node stay together with their bounds, and the nearest is found when it is wanted: most are never visited, as what is found before is
//! nearer. Sorting them as they came took a tenth of a walk, for branches that nobody can foretell.

use fearless_simd::Simd;
use fearless_simd::prelude::*;

use super::Place;
use super::node::WIDTH;

/// Room that most queries do with, taken at once.
const BROODS_USUAL: usize = 32;

/// Nodes with children to be visited, the last opened at the end.
#[derive(Clone, Debug, Default)]
pub(super) struct Broods(Vec<Brood>);

/// The children of a node that are to be visited.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Brood {
    /// Lower bounds of their distances by lane, infinite of those that are not to be visited, or were.
    bounds: [f64; WIDTH],
    /// The least of them.
    least: f64,
    node: usize,
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

    /// Adds the children of a node whose bounds are below a limit, or are no numbers.
    #[inline(always)]
    pub fn add<S: Simd>(&mut self, simd: S, node: usize, bounds: &[f64; WIDTH], limit: f64) {
        let mut brood = Brood { bounds: [0.0; WIDTH], least: 0.0, node };
        for from in (0..WIDTH).step_by(S::f64s::LEN) {
            let bound = S::f64s::from_slice(simd, &bounds[from..from + S::f64s::LEN]);
            let is_far = bound.simd_ge(S::f64s::splat(simd, limit));
            let is_number = bound.simd_ge(S::f64s::splat(simd, f64::NEG_INFINITY));
            let bound = is_number.select(bound, S::f64s::splat(simd, f64::NEG_INFINITY));
            let bound = is_far.select(S::f64s::splat(simd, f64::INFINITY), bound);
            bound.store_slice(&mut brood.bounds[from..from + S::f64s::LEN]);
        }
        brood.least = brood.least_of_all(simd);
        self.0.push(brood);
    }

    /// Takes the nearest child of the last so many nodes, at least one, with its bound; where none of these is below the limit, of those before them.
    #[inline(always)]
    pub fn take<S: Simd>(&mut self, simd: S, nodes: usize, limit: f64) -> Option<(f64, Place)> {
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
            let lane = brood.lane_of(simd, least);
            let place = Place::lane(brood.node, lane);
            brood.bounds[lane] = f64::INFINITY;
            brood.least = brood.least_of_all(simd);
            return Some((least, place));
        }
    }
}

impl Brood {
    #[inline(always)]
    fn least_of_all<S: Simd>(&self, simd: S) -> f64 {
        let mut least = S::f64s::from_slice(simd, &self.bounds[..S::f64s::LEN]);
        for from in (0..WIDTH).step_by(S::f64s::LEN).skip(1) {
            least = least.min(S::f64s::from_slice(simd, &self.bounds[from..from + S::f64s::LEN]));
        }
        least.reduce_min()
    }

    /// The lowest lane with a bound.
    #[inline(always)]
    fn lane_of<S: Simd>(&self, simd: S, bound: f64) -> usize {
        let mut lanes = 0;
        for from in (0..WIDTH).step_by(S::f64s::LEN) {
            let bounds = S::f64s::from_slice(simd, &self.bounds[from..from + S::f64s::LEN]);
            lanes |= (bounds.simd_eq(S::f64s::splat(simd, bound)).to_bitmask() as u32) << from;
        }
        lanes.trailing_zeros() as usize % WIDTH
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::tests::scenes::rng;
    use rand::Rng;
    use solid_convex::simd::{alike, dispatch};

    /// Law: of the last nodes the nearest child comes next, of equal ones that of the node opened last, and the lowest lane; each comes once, and
    /// none that is not below the limit; what has no bound comes first. On every level of instructions.
    #[test]
    fn the_nearest_of_the_last_nodes_comes_next() {
        let mut rng = rng(98);
        let mut taken_in_all = 0;
        for case in 0..2000 {
            let nodes = 1 + case % 4;
            let few = rng.random_range(1..20);
            let mut bound = || match rng.random_range(0..12) {
                0 => f64::NAN,
                1 => f64::INFINITY,
                _ => f64::from(rng.random_range(-2..few)),
            };
            let bounds: Vec<[f64; WIDTH]> =
                (0..1 + case % 5).map(|_| std::array::from_fn(|_| bound())).collect();
            let limit = [f64::INFINITY, 4.0, 0.0][case % 3];
            let taken = alike(|level| {
                let mut broods = Broods::default();
                dispatch!(widest level, simd => {
                    bounds.iter().enumerate().for_each(|(node, bounds)| broods.add(simd, node, bounds, limit));
                    std::iter::from_fn(|| broods.take(simd, nodes, limit)).collect::<Vec<_>>()
                })
            });
            let mut left: Vec<Vec<(f64, Place)>> = Vec::new();
            for (node, bounds) in bounds.iter().enumerate() {
                let known = bounds.map(|bound| if bound.is_nan() { f64::NEG_INFINITY } else { bound });
                let all = (0..WIDTH).map(|lane| (known[lane], Place::lane(node, lane)));
                left.push(all.filter(|child| child.0 < limit).collect());
            }
            let mut expected = Vec::new();
            while !left.is_empty() {
                let first = left.len().saturating_sub(nodes);
                let of_last = left[first..].iter().rev().flatten().copied();
                match of_last.reduce(|x, y| if y.0 < x.0 { y } else { x }) {
                    Some(next) => {
                        left.iter_mut().for_each(|children| children.retain(|child| child.1 != next.1));
                        expected.push(next);
                    }
                    None => left.truncate(first),
                }
            }
            taken_in_all += taken.len();
            assert_eq!(taken, expected, "case {case}");
        }
        assert!(taken_in_all > 10_000);
    }
}
