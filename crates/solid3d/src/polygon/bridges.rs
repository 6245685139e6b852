//! The bridges from a chain to the holes in it, the shortest first.
//!
//! Each vertex of the chain has its nearest vertex of a hole that still waits, and gets the next one when that was looked at. What
//! is no bridge never becomes one: edges stay where they are, and a corner at which a bridge begins is divided, not widened.

use std::cmp::{Ordering, Reverse};
use std::collections::{BTreeMap, BinaryHeap};

use glam::DVec2;

use super::corner::{holds, is_nearer, sees};
use super::exact::{segments_meet, segments_overlap};

/// The holes that are not joined yet, by their numbers; they run the other way round than what is around them.
pub(super) type Waiting = BTreeMap<usize, Vec<usize>>;

/// From place `i` of the chain to place `j` of a hole.
#[derive(Debug, PartialEq)]
pub(super) struct Bridge {
    pub hole: usize,
    pub i: usize,
    pub j: usize,
}

impl Bridge {
    /// Makes the hole part of the chain. Returns its vertices.
    pub fn join(&self, chain: &mut Vec<usize>, waiting: &mut Waiting) -> Vec<usize> {
        let Bridge { hole, i, j } = *self;
        let hole = waiting.remove(&hole).expect("a bridge leads to a hole that waits");
        // p_0 .. p_i, q_j .. q_(n-1), q_0 .. q_j, p_i .. p_(m-1).
        let around = [&chain[i..=i], &hole[j..], &hole[..=j]].concat();
        chain.splice(i..i, around);
        hole
    }
}

/// Two vertices that may be joined.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Candidate {
    /// The square of their distance.
    distance: f64,
    hole: usize,
    /// The place in the hole.
    j: usize,
    /// The vertex of the chain.
    from: usize,
}

impl Eq for Candidate {}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        let names = |candidate: &Candidate| (candidate.hole, candidate.j, candidate.from);
        self.distance.total_cmp(&other.distance).then_with(|| names(self).cmp(&names(other)))
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The candidates of each vertex of a chain, whose vertices are places in `points`.
pub(super) struct Bridges<'p> {
    points: &'p [DVec2],
    /// 1 for a chain that runs counter-clockwise, else -1.
    sense: f64,
    nearest: BinaryHeap<Reverse<Candidate>>,
}

impl<'p> Bridges<'p> {
    pub fn new(points: &'p [DVec2], sense: f64, chain: &[usize], waiting: &Waiting) -> Self {
        let mut bridges = Bridges { points, sense, nearest: BinaryHeap::new() };
        bridges.add(chain, waiting);
        bridges
    }

    /// Takes in vertices that are now of the chain.
    pub fn add(&mut self, vertices: &[usize], waiting: &Waiting) {
        for &from in vertices {
            self.find_next(from, None, waiting);
        }
    }

    /// The shortest bridge, if there is one. Cost: O(n) for each candidate that is looked at.
    pub fn next(&mut self, chain: &[usize], waiting: &Waiting) -> Option<Bridge> {
        let boundary: Vec<DVec2> = chain.iter().map(|&i| self.points[i]).collect();
        while let Some(Reverse(candidate)) = self.nearest.pop() {
            let Candidate { hole, j, from, .. } = candidate;
            self.find_next(from, Some(candidate), waiting);
            let place = waiting.get(&hole).and_then(|hole| {
                let mut places = (0..chain.len()).filter(|&i| chain[i] == from);
                places.find(|&i| self.is_bridge((chain, &boundary, i), (hole, j), waiting))
            });
            if let Some(i) = place {
                return Some(Bridge { hole, i, j });
            }
        }
        None
    }

    /// Finds the vertex of a hole that comes after the last one, by its distance.
    fn find_next(&mut self, from: usize, last: Option<Candidate>, waiting: &Waiting) {
        let after_last = |candidate: &Candidate| last.is_none_or(|last| *candidate > last);
        let next = self.candidates(from, waiting).filter(after_last).min();
        self.nearest.extend(next.map(Reverse));
    }

    /// From a vertex to all of the holes.
    fn candidates(&self, from: usize, waiting: &Waiting) -> impl Iterator<Item = Candidate> {
        let points = self.points;
        waiting.iter().flat_map(move |(&hole, chain)| {
            let distance = move |q: usize| points[from].distance_squared(points[q]);
            chain.iter().enumerate().map(move |(j, &q)| Candidate { distance: distance(q), hole, j, from })
        })
    }

    /// Whether a place of the chain and one of a hole see each other.
    fn is_bridge(
        &self,
        (chain, boundary, i): (&[usize], &[DVec2], usize),
        (hole, j): (&[usize], usize),
        waiting: &Waiting,
    ) -> bool {
        let (p, q) = (boundary[i], self.points[hole[j]]);
        // Where the hole touches the boundary, it must do so from inside the corner.
        let onwards = if p == q { self.corner(hole, j)[2] } else { q };
        let own = self.corner(chain, i);
        let mut others = (0..chain.len()).filter(|&k| boundary[k] == p).map(|k| self.corner(chain, k));
        holds(boundary, own, onwards, self.sense)
            && !others.any(|other| {
                is_nearer(other, own, onwards, self.sense) && holds(boundary, other, onwards, self.sense)
            })
            && (p == q
                || sees(self.corner(hole, j), p, self.sense)
                    && std::iter::once(chain)
                        .chain(waiting.values().map(|hole| &hole[..]))
                        .all(|chain| self.is_clear(p, q, chain)))
    }

    /// Whether a bridge touches a chain at its own ends at most.
    fn is_clear(&self, p: DVec2, q: DVec2, chain: &[usize]) -> bool {
        (0..chain.len()).all(|k| {
            let (r, s) = (self.points[chain[k]], self.points[chain[(k + 1) % chain.len()]]);
            let touches_at_ends = [r, s].iter().any(|&end| end == p || end == q);
            // An edge that begins where the bridge ends must not run along it, nor reach to its other end.
            if touches_at_ends { !segments_overlap(p, q, r, s) } else { !segments_meet(p, q, r, s) }
        })
    }

    /// The corner of a chain at a place. Bridges of no length repeat vertices: the neighbours are the nearest that differ.
    fn corner(&self, chain: &[usize], k: usize) -> [DVec2; 3] {
        let (n, v) = (chain.len(), self.points[chain[k]]);
        let other = |i: usize| Some(self.points[chain[i % n]]).filter(|&x| x != v);
        [(k + 1..k + n).rev().find_map(other).unwrap_or(v), v, (k + 1..k + n).find_map(other).unwrap_or(v)]
    }
}

#[cfg(test)]
mod tests {
    use rand::Rng;
    use rand::rngs::StdRng;
    use solid_oracle::generate::seeded;

    use super::*;

    /// The slow twin of [`Bridges::next`]: from each place of the chain to each of the holes.
    fn shortest(bridges: &Bridges, chain: &[usize], waiting: &Waiting) -> Option<Bridge> {
        let boundary: Vec<DVec2> = chain.iter().map(|&i| bridges.points[i]).collect();
        let from = |(i, &from): (usize, &usize)| {
            bridges.candidates(from, waiting).map(move |candidate| (candidate, i))
        };
        let mut all: Vec<(Candidate, usize)> = chain.iter().enumerate().flat_map(from).collect();
        all.sort();
        let is_bridge = |&(Candidate { hole, j, .. }, i): &(Candidate, usize)| {
            bridges.is_bridge((chain, &boundary, i), (&waiting[&hole], j), waiting)
        };
        all.into_iter().find(is_bridge).map(|(Candidate { hole, j, .. }, i)| Bridge { hole, i, j })
    }

    /// A square of cells, many with a hole whose corners are where the cell has its quarters: holes touch each other and the square.
    fn sieve(rng: &mut StdRng, side: i32) -> (Vec<DVec2>, Vec<usize>, Waiting) {
        let mut points: Vec<DVec2> = [(0, 0), (side, 0), (side, side), (0, side)]
            .map(|(x, y)| DVec2::new(f64::from(4 * x), f64::from(4 * y)))
            .to_vec();
        let mut waiting = Waiting::new();
        for (x, y) in (0..side).flat_map(|x| (0..side).map(move |y| (x, y))) {
            let mut corner = |low: [i32; 2], high: [i32; 2]| {
                let [u, v] = [0, 1].map(|k| rng.random_range(low[k]..=high[k]));
                DVec2::new(f64::from(4 * x + u), f64::from(4 * y + v))
            };
            // Clockwise, around the middle of the cell.
            let hole = [
                corner([0, 0], [1, 1]),
                corner([0, 3], [1, 4]),
                corner([3, 3], [4, 4]),
                corner([3, 0], [4, 1]),
            ];
            if (x + y) % 3 != 0 {
                waiting.insert(waiting.len(), (points.len()..points.len() + 4).collect());
                points.extend(hole);
            }
        }
        (points, vec![0, 1, 2, 3], waiting)
    }

    /// Law: the next bridge is the shortest of all, until there is none; what was no bridge once is none later.
    #[test]
    fn the_next_bridge_is_the_shortest() {
        let mut rng = seeded(179);
        let [mut found, mut touching, mut stuck] = [0; 3];
        for case in 0..200 {
            let (points, mut chain, mut waiting) = sieve(&mut rng, 2 + case % 4);
            let mut bridges = Bridges::new(&points, 1.0, &chain, &waiting);
            while !waiting.is_empty() {
                let expected = shortest(&bridges, &chain, &waiting);
                let next = bridges.next(&chain, &waiting);
                assert_eq!(next, expected, "case {case}: {points:?}, {chain:?}");
                let Some(bridge) = next else {
                    stuck += 1;
                    break;
                };
                let hole = bridge.join(&mut chain, &mut waiting);
                bridges.add(&hole, &waiting);
                found += 1;
                touching += usize::from(points[chain[bridge.i]] == points[hole[bridge.j]]);
            }
        }
        println!("{found} found, {touching} of no length, {stuck} times none");
        assert!(found > 500 && touching > 50 && stuck > 0);
    }
}
