//! Triangulation by cutting ears, exactly.
//!
//! Every vertex is kept: n vertices give n - 2 triangles over the chain as it is, of which those at collinear vertices and at
//! edges that turn back have no area. So the union of the triangles is the polygon to the last bit, antennae included, and
//! it stays a covering of the polygon when the vertices move. (The crate `earcut` drops collinear vertices, which leaves gaps once
//! they move, and all that has no area.)

use std::cell::Cell;
use std::collections::BTreeSet;

use glam::DVec2;

use super::exact::turn;
use super::planar;

/// The triangles, as places in the chain, turned as the chain is. Cost: O(n^2), at worst O(n^3).
///
/// For a chain that crosses itself the triangles are n - 2 all the same, but cover something else.
pub(super) fn triangulate(chain: &[DVec2]) -> Vec<[u32; 3]> {
    let mut rest = Rest::new(chain);
    let mut triangles = Vec::with_capacity(chain.len().saturating_sub(2));
    let mut start = 0;
    while rest.places.len() > 3 {
        let ear = rest.find(start);
        triangles.push(rest.corner(ear).map(|place| place as u32));
        start = rest.cut(ear);
    }
    if let [a, b, c] = rest.places[..] {
        triangles.push([a, b, c].map(|place| place as u32));
    }
    triangles
}

/// What is left of the chain.
#[derive(Clone)]
struct Rest<'a> {
    chain: &'a [DVec2],
    /// 1 for a chain that runs counter-clockwise, else -1.
    sense: f64,
    places: Vec<usize>,
    /// The places where it folds: where it turns back, or a vertex is repeated.
    folds: BTreeSet<usize>,
    /// By place: one that was seen in the triangle of the corner there, while both corners are what they were. So of a spiral, most of whose corners
    /// have something in them, each is not searched again for each ear.
    blockers: Vec<Cell<Option<usize>>>,
}

impl<'a> Rest<'a> {
    fn new(chain: &'a [DVec2]) -> Self {
        let mut rest = Rest {
            chain,
            sense: planar::sense(chain),
            places: (0..chain.len()).collect(),
            folds: BTreeSet::new(),
            blockers: vec![Cell::new(None); chain.len()],
        };
        (0..chain.len()).for_each(|i| rest.note(i));
        rest
    }

    /// The corner to cut next: a tip; else an ear; else one without an area; else, which a simple polygon has not, any.
    fn find(&self, start: usize) -> usize {
        let n = self.places.len();
        let around = || (0..n).map(|k| (start + k) % n);
        let tip = if self.folds.is_empty() { None } else { around().find(|&i| self.is_tip(i)) };
        let first = tip.or_else(|| around().find(|&i| self.is_ear(i)));
        first.or_else(|| around().find(|&i| self.turn(self.corner(i)) == 0.0)).unwrap_or(start)
    }

    /// Cuts off a corner; gives the one to look at next.
    fn cut(&mut self, i: usize) -> usize {
        let n = self.places.len() - 1;
        let changed @ [before, _, after] = self.corner(i);
        self.folds.remove(&self.places.remove(i));
        for (place, blocker) in self.blockers.iter_mut().enumerate() {
            let is_other = place == before || place == after;
            if is_other || blocker.get().is_some_and(|blocker| changed.contains(&blocker)) {
                blocker.set(None);
            }
        }
        self.note((i + n - 1) % n);
        self.note(i % n);
        // Going on behind the neighbour makes fewer slivers than cutting a fan.
        if i + 1 < n { i + 1 } else { 0 }
    }

    /// Notes whether a corner is a fold, once it or one beside it is another.
    fn note(&mut self, i: usize) {
        let corner = self.corner(i);
        let [a, v, b] = corner.map(|place| self.chain[place]);
        let repeats = a == v || v == b;
        if repeats || self.turn(corner) == 0.0 && (a - v).dot(b - v) > 0.0 {
            self.folds.insert(corner[1]);
        } else {
            self.folds.remove(&corner[1]);
        }
    }

    /// Whether the corner is the tip of an antenna, or repeats a vertex. Such corners go first: beside them others look like
    /// ears that are not. A slit has a tip, too, but with the polygon around it.
    fn is_tip(&self, i: usize) -> bool {
        let place = self.places[i];
        self.folds.contains(&place) && {
            let [a, v, b] = self.corner(i).map(|place| self.chain[place]);
            let others =
                || self.places.iter().filter(|&&other| other != place).map(|&other| self.chain[other]);
            a == v || v == b || !planar::contains_strictly(&others().collect::<Vec<_>>(), v)
        }
    }

    /// The places before, at and after a corner.
    fn corner(&self, i: usize) -> [usize; 3] {
        let n = self.places.len();
        [self.places[(i + n - 1) % n], self.places[i], self.places[(i + 1) % n]]
    }

    fn turn(&self, [a, b, c]: [usize; 3]) -> f64 {
        self.sense * turn(self.chain[a], self.chain[b], self.chain[c])
    }

    /// Whether the corner is convex, and its triangle in the polygon with nothing of the chain in it.
    fn is_ear(&self, i: usize) -> bool {
        let ear = self.corner(i);
        self.turn(ear) > 0.0 && self.is_empty(ear) && !self.is_outside(ear)
    }

    /// Whether a convex corner is one of two doubled edges with the outside all around: an antenna that bends.
    fn is_outside(&self, [_, v, b]: [usize; 3]) -> bool {
        let (at_v, at_b) = (self.chain[v], self.chain[b]);
        // A doubled corner comes by twice.
        let doubled = self.places.iter().any(|&place| place != v && self.chain[place] == at_v);
        doubled && {
            let rest: Vec<DVec2> = self.places.iter().map(|&place| self.chain[place]).collect();
            !planar::contains_beside(&rest, at_v, at_b, self.sense)
        }
    }

    /// Whether nothing of the chain lies in the triangle of a convex corner.
    fn is_empty(&self, ear: [usize; 3]) -> bool {
        let blocker = &self.blockers[ear[1]];
        if blocker.get().is_none() {
            blocker.set(self.blocker(ear));
        }
        blocker.get().is_none()
    }

    /// A place of the chain that lies in the triangle of a convex corner.
    fn blocker(&self, ear: [usize; 3]) -> Option<usize> {
        let [a, v, b] = ear;
        let [at_a, at_v, at_b] = ear.map(|place| self.chain[place]);
        let (low, high) = (at_a.min(at_v).min(at_b), at_a.max(at_v).max(at_b));
        let is_clear = |j: usize, w: usize| {
            let x = self.chain[w];
            if x.cmplt(low).any() || x.cmpgt(high).any() || w == a || w == v || w == b {
                return true;
            }
            let [before, _, after] = self.corner(j);
            if x == at_v {
                // The chain comes by again; it may leave into the triangle and out of its far side.
                let enters = |y: usize| self.turn([a, v, y]) > 0.0 && self.turn([v, b, y]) > 0.0;
                return !enters(before) && !enters(after);
            }
            if x == at_a || x == at_b {
                return true;
            }
            let sides = [[a, v], [v, b], [b, a]];
            let turns = sides.map(|[from, to]| self.turn([from, to, w]));
            // On a side of the triangle the chain may touch it from outside.
            let on_side = turns.iter().position(|&turned| turned == 0.0);
            let outside = turns.iter().any(|&turned| turned < 0.0);
            outside
                || on_side.is_some_and(|k| {
                    let [from, to] = sides[k];
                    self.turn([from, to, before]) <= 0.0 && self.turn([from, to, after]) <= 0.0
                })
        };
        let in_it = self.places.iter().enumerate().find(|&(j, &w)| !is_clear(j, w));
        in_it.map(|(_, &w)| w)
    }
}

#[cfg(test)]
mod tests {
    use rand::Rng;
    use solid_oracle::generate::seeded;

    use super::*;

    /// Law: what is known of earlier searches changes no ear. In a spiral, where most corners have something in them; in what crosses and
    /// touches itself.
    #[test]
    fn what_is_known_changes_no_ear() {
        let arm = |radius: f64, i: u32| {
            let angle = 0.2 * f64::from(i);
            (radius + angle) * DVec2::from_angle(angle)
        };
        let spiral = (0..150).map(|i| arm(1.0, i)).chain((0..150).rev().map(|i| arm(2.0, i)));
        let mut rng = seeded(283);
        let mut chains = vec![spiral.collect::<Vec<_>>()];
        for _ in 0..300 {
            let mut cell = || f64::from(rng.random_range(0..6));
            chains.push((0..20).map(|_| DVec2::new(cell(), cell())).collect());
        }
        let mut known = 0;
        for chain in chains {
            let (mut rest, mut start) = (Rest::new(&chain), 0);
            while rest.places.len() > 3 {
                let forgetful = Rest { blockers: vec![Cell::new(None); chain.len()], ..rest.clone() };
                known += rest.blockers.iter().filter(|blocker| blocker.get().is_some()).count();
                let ear = rest.find(start);
                assert_eq!(ear, forgetful.find(start));
                start = rest.cut(ear);
            }
        }
        assert!(known > 5000, "{known} were known");
    }
}
