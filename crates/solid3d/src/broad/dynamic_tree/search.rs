//! The search for all pairs of a tree that was just built, and for those of some of its leaves.

use super::Proxy;
use super::fat_box::FatBox;
use super::self_pairs::Lanes;
use super::tree::Tree;
use crate::broad::bits::Bits;
use crate::broad::boxes::Boxes;
use crate::broad::pair_lists::PairLists;
use crate::threads::{both, for_each};

/// Nodes that are searched in one piece, at least and at most: with some thousand pairs, whose boxes a core's own cache holds.
const NODES: [usize; 2] = [32, 512];

/// Pieces that are searched before their pairs are handed on: what these take is bounded by it, and threads have enough of them.
const PIECES: usize = 16;

/// So many nodes, of some 0.3 us each, are worth another thread.
const NODES_MANY: usize = 512;

/// So many leaves, of some 0.3 us each, are.
const LEAVES_MANY: usize = 256;

/// So many pairs before one is looked at its memory is asked for.
const AHEAD: usize = 32;

/// About so many times pairs are handed on in all: meanwhile the next are sought.
const ROUNDS: usize = 8;

/// Two boxes whose fat boxes overlap, and whether they do.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub proxies: [Proxy; 2],
    pub overlaps: bool,
}

/// One piece of the search; kept for its memory.
#[derive(Debug, Default)]
struct Piece {
    found: Vec<Found>,
    stack: Vec<Lanes>,
    nodes: Vec<u32>,
    /// Partners of one leaf, while it is searched for.
    known: Bits,
    visits: u64,
}

/// The working memory of the search: pieces that are searched, and those before them, whose pairs are handed on meanwhile.
#[derive(Debug, Default)]
pub(super) struct Search {
    next: Vec<Piece>,
    done: Vec<Piece>,
}

impl Search {
    /// Hands on every pair of leaves whose boxes overlap, each once, in an order that depends on the tree alone, and with each one that comes somewhat
    /// later; gives the number of nodes visited.
    pub fn run(
        &mut self,
        tree: &Tree,
        tight: &Boxes,
        mut visit: impl FnMut(&Found, Option<&Found>) + Send,
    ) -> u64 {
        let Self { next, done } = self;
        next.resize_with(PIECES, Piece::default);
        done.resize_with(PIECES, Piece::default);
        done.iter_mut().for_each(|piece| piece.found.clear());
        let count = tree.nodes.len();
        let nodes = (count / (PIECES * ROUNDS)).clamp(NODES[0], NODES[1]);
        let worth = count >= NODES_MANY;
        let mut visits = 0;
        for first in (0..count).step_by(nodes * PIECES) {
            let search = |i: usize, piece: &mut Piece| {
                let first = count.min(first + i * nodes);
                piece.search(tree, tight, first..count.min(first + nodes));
            };
            both(
                worth,
                || for_each(next, worth, search),
                || done.iter().for_each(|piece| piece.hand_on(&mut visit)),
            );
            visits += next.iter().map(|piece| piece.visits).sum::<u64>();
            std::mem::swap(next, done);
        }
        done.iter().for_each(|piece| piece.hand_on(&mut visit));
        visits
    }

    /// Finds every pair, which is not in `pairs`, of one of some leaves and another whose box overlaps its own: once, where `is_sought` tells
    /// of each leaf whether it is among these. Gives the number of nodes visited; see [`found`](Self::found).
    pub fn seek_of(
        &mut self,
        tree: &Tree,
        tight: &Boxes,
        fat: &[FatBox],
        leaves: &[Proxy],
        is_sought: impl Fn(Proxy) -> bool + Sync + Send,
        pairs: &PairLists,
    ) -> u64 {
        let worth = leaves.len() >= LEAVES_MANY;
        let of_piece = leaves.len().div_ceil(if worth { PIECES } else { 1 }).max(1);
        let pieces = leaves.len().div_ceil(of_piece);
        if self.next.len() < pieces {
            self.next.resize_with(pieces, Piece::default);
        }
        let (next, others) = self.next.split_at_mut(pieces);
        others.iter_mut().for_each(|piece| piece.found.clear());
        for_each(next, worth, |i, piece| {
            let leaves = &leaves[i * of_piece..];
            piece.search_of(tree, tight, fat, &leaves[..of_piece.min(leaves.len())], &is_sought, pairs);
        });
        next.iter().map(|piece| piece.visits).sum()
    }

    /// What was found of some leaves, in an order that depends on them and the tree alone.
    pub fn found(&self) -> impl Iterator<Item = &Found> {
        self.next.iter().flat_map(|piece| &piece.found)
    }
}

impl Piece {
    fn search(&mut self, tree: &Tree, tight: &Boxes, nodes: std::ops::Range<usize>) {
        let Self { found, stack, visits, .. } = self;
        found.clear();
        *visits = 0;
        for node in nodes {
            *visits += tree.pairs_within(node as u32, stack, |a, b| {
                found.push(Found { proxies: [a, b], overlaps: false });
            });
        }
        self.compare(tight);
    }

    fn search_of(
        &mut self,
        tree: &Tree,
        tight: &Boxes,
        fat: &[FatBox],
        leaves: &[Proxy],
        is_sought: impl Fn(Proxy) -> bool,
        pairs: &PairLists,
    ) {
        let Self { found, nodes, known, visits, .. } = self;
        found.clear();
        known.grow(fat.len());
        *visits = 0;
        for &leaf in leaves {
            pairs.for_each_partner(leaf, |partner| known.set(partner, true));
            *visits += tree.query(&fat[leaf as usize], nodes, |other| {
                if !known.is(other) && (leaf < other || leaf > other && !is_sought(other)) {
                    found.push(Found { proxies: [leaf, other], overlaps: false });
                }
            });
            pairs.for_each_partner(leaf, |partner| known.set(partner, false));
        }
        self.compare(tight);
    }

    /// Hands on what was found, each with what comes [`AHEAD`] pairs later.
    fn hand_on(&self, visit: &mut impl FnMut(&Found, Option<&Found>)) {
        for (i, found) in self.found.iter().enumerate() {
            visit(found, self.found.get(i + AHEAD));
        }
    }

    /// Finds which of the boxes overlap: in a loop of its own, as boxes are asked for ahead.
    fn compare(&mut self, tight: &Boxes) {
        for i in 0..self.found.len() {
            if let Some(later) = self.found.get(i + AHEAD) {
                later.proxies.into_iter().for_each(|proxy| tight.prefetch(proxy));
            }
            let Found { proxies: [a, b], overlaps } = &mut self.found[i];
            *overlaps = tight.overlap(*a, *b);
        }
    }
}
