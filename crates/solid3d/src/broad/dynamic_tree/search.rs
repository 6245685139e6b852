//! The search for all pairs of a tree that was just built.

use super::self_pairs::Lanes;
use super::tree::Tree;
use super::{Proxy, overlap};
use crate::bounds::Aabb;

/// Nodes that are searched in one piece: with some thousand pairs, whose boxes a core's own cache holds.
const NODES: usize = 512;

/// Pieces that are searched before their pairs are handed on: what these take is bounded by it, and threads have enough of them.
const PIECES: usize = 16;

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
    visits: u64,
}

/// The working memory of the search.
#[derive(Debug, Default)]
pub(super) struct Search {
    pieces: Vec<Piece>,
}

impl Search {
    /// Hands on every pair of leaves whose boxes overlap, each once, in an order that depends on the tree alone; gives the number
    /// of nodes visited.
    pub fn run(&mut self, tree: &Tree, tight: &[Aabb], mut visit: impl FnMut(&Found)) -> u64 {
        self.pieces.resize_with(PIECES, Piece::default);
        let nodes = tree.nodes.len();
        let mut visits = 0;
        for first in (0..nodes).step_by(NODES * PIECES) {
            let pieces = self.pieces.len().min((nodes - first).div_ceil(NODES));
            let search = |(i, piece): (usize, &mut Piece)| {
                let first = first + i * NODES;
                piece.search(tree, tight, first..nodes.min(first + NODES));
            };
            for_each(&mut self.pieces[..pieces], search);
            for piece in &self.pieces[..pieces] {
                visits += piece.visits;
                piece.found.iter().for_each(&mut visit);
            }
        }
        visits
    }
}

impl Piece {
    fn search(&mut self, tree: &Tree, tight: &[Aabb], nodes: std::ops::Range<usize>) {
        let Self { found, stack, visits } = self;
        found.clear();
        *visits = 0;
        for node in nodes {
            *visits += tree.pairs_within(node as u32, stack, |a, b| {
                found.push(Found { proxies: [a, b], overlaps: false });
            });
        }
        // In a loop of its own, which waits for many boxes at a time.
        for Found { proxies: [a, b], overlaps } in found {
            *overlaps = overlap(tight, *a, *b);
        }
    }
}

/// Calls `search` with each piece and its number; with the feature `rayon` on the threads of the current pool.
fn for_each(pieces: &mut [Piece], search: impl Fn((usize, &mut Piece)) + Sync + Send) {
    #[cfg(feature = "rayon")]
    {
        use rayon::prelude::*;
        if pieces.len() > 1 && rayon::current_num_threads() > 1 {
            return pieces.par_iter_mut().enumerate().for_each(search);
        }
    }
    pieces.iter_mut().enumerate().for_each(search);
}
