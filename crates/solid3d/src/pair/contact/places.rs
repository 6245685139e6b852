//! The places in which two surfaces meet: pairs of primitives that are connected there on both sides. Each has a contact.

use std::collections::HashMap;

use foldhash::fast::RandomState;
use smallvec::{SmallVec, smallvec};

use super::Patch;
use super::stars::few;
use crate::shape::Complex;

/// A primitive of each of two shapes, or a vertex; 0 of a body.
type Two = [u32; 2];

/// The pairs that told contacts, or led to some of others; ascending.
pub(super) fn told(patches: &[Patch], led: impl IntoIterator<Item = Two>) -> Vec<Two> {
    let told = patches.iter().filter(|patch| patch.touches()).map(|patch| patch.touches[0].primitives);
    let mut told: Vec<Two> = told.chain(led).collect();
    told.sort_unstable();
    told
}

/// Of ascending pairs the places in which none told a contact, as where a spear is through several walls, and its point is over one of them. Primitives of more than
/// three vertices tell theirs and connect nothing. Bodies are `None`. Cost: O(n) where a pair told none.
pub(super) fn untold(soups: [Option<&Complex>; 2], pairs: &[Two], told: &[Two]) -> Vec<Vec<Two>> {
    let mut rest = told.iter().peekable();
    let has_told = |pair: &Two| {
        while rest.next_if(|told| *told < pair).is_some() {}
        rest.peek() == Some(&pair)
    };
    let have_told: Vec<bool> = pairs.iter().map(has_told).collect();
    if have_told.iter().all(|told| *told) {
        return Vec::new();
    }
    let mut places = Places { next: (0..pairs.len()).collect() };
    let mut first_at = HashMap::with_capacity_and_hasher(pairs.len(), RandomState::default());
    for (pair, &[i, j]) in pairs.iter().enumerate() {
        let (of_i, of_j) = (vertices(soups[0], i), vertices(soups[1], j));
        for key in of_i.iter().flat_map(|&u| of_j.iter().map(move |&v| u64::from(u) << 32 | u64::from(v))) {
            let first = first_at.entry(key).or_insert(pair);
            *first = places.join(*first, pair);
        }
    }
    let mut tells = vec![false; pairs.len()];
    for pair in (0..pairs.len()).filter(|&pair| have_told[pair]) {
        tells[places.first(pair)] = true;
    }
    let (mut untold, mut number): (Vec<Vec<Two>>, _) = (Vec::new(), vec![0; pairs.len()]);
    for (pair, &primitives) in pairs.iter().enumerate() {
        let first = places.first(pair);
        if !tells[first] {
            if first == pair {
                number[first] = untold.len();
                untold.push(Vec::new());
            }
            untold[number[first]].push(primitives);
        }
    }
    untold
}

/// Sets of numbers that are joined: each leads to a lesser one of its set, the first to itself.
struct Places {
    next: Vec<usize>,
}

impl Places {
    fn first(&mut self, mut number: usize) -> usize {
        while self.next[number] != number {
            self.next[number] = self.next[self.next[number]];
            number = self.next[number];
        }
        number
    }

    /// Gives the first of what was joined.
    fn join(&mut self, i: usize, j: usize) -> usize {
        let (i, j) = (self.first(i), self.first(j));
        self.next[i.max(j)] = i.min(j);
        i.min(j)
    }
}

/// The vertices by which a primitive is connected to others.
fn vertices(soup: Option<&Complex>, primitive: u32) -> SmallVec<[u32; 4]> {
    let Some(soup) = soup else { return smallvec![0] };
    let vertices = soup.primitive(primitive);
    let connecting = if vertices.len() <= 3 { vertices } else { &[] };
    few(connecting, |vertex| soup.topology().welded(vertex))
}
