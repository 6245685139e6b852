//! From segments to polylines.

use super::Pair;
use super::meeting::{Node, Origin, Piece};

/// Segments joined end to end, or a single node.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Chain {
    pub nodes: Vec<Node>,
    /// For each segment, or for the single node.
    pub pairs: Vec<Pair>,
    pub closed: bool,
}

/// A segment, from all that gave it.
#[derive(Clone, Copy, Debug)]
struct Segment {
    ends: [Node; 2],
    /// The smallest.
    pair: Pair,
    crossing: bool,
    rim_left: bool,
    rim_right: bool,
}

/// The longest chains without a fork, in the order of the smallest pair in each. A closed one without a fork begins with it.
pub(super) fn chains(pieces: Vec<(Piece, Pair)>) -> Vec<Chain> {
    let mut points = Vec::new();
    let mut segments = Vec::new();
    for (piece, pair) in pieces {
        match piece {
            Piece::Point(node) => points.push((node, pair)),
            Piece::Segment(ends, origin) => segments.push(Segment::new(ends, origin, pair)),
        }
    }
    merge(&mut segments);
    let mut chains = lone(points, &segments);
    segments.retain(Segment::counts);
    segments.sort_unstable_by_key(|segment| (segment.pair, segment.ends));
    chains.extend(Graph::new(&segments).chains());
    chains.sort_by_key(|chain| chain.pairs.iter().min().copied());
    chains
}

impl Segment {
    fn new(mut ends: [Node; 2], origin: Origin, pair: Pair) -> Self {
        ends.sort_unstable();
        let is = |other: Origin| origin == other;
        let (crossing, rim_left, rim_right) =
            (is(Origin::Crossing), is(Origin::RimLeft), is(Origin::RimRight));
        Segment { ends, pair, crossing, rim_left, rim_right }
    }

    /// Not when it is only an edge inside a region, with the region on both sides.
    fn counts(&self) -> bool {
        self.crossing || !(self.rim_left && self.rim_right)
    }
}

/// Makes one segment of those with the same ends.
fn merge(segments: &mut Vec<Segment>) {
    segments.sort_unstable_by_key(|segment| (segment.ends, segment.pair));
    segments.dedup_by(|later, kept| {
        let same = later.ends == kept.ends;
        if same {
            kept.crossing |= later.crossing;
            kept.rim_left |= later.rim_left;
            kept.rim_right |= later.rim_right;
        }
        same
    });
}

/// The points where no segment ends.
fn lone(mut points: Vec<(Node, Pair)>, segments: &[Segment]) -> Vec<Chain> {
    let mut ends: Vec<Node> = segments.iter().flat_map(|segment| segment.ends).collect();
    ends.sort_unstable();
    points.sort_unstable();
    points.dedup_by_key(|(node, _)| *node);
    points.retain(|(node, _)| ends.binary_search(node).is_err());
    points
        .into_iter()
        .map(|(node, pair)| Chain { nodes: vec![node], pairs: vec![pair], closed: false })
        .collect()
}

/// Nodes joined by segments.
struct Graph<'a> {
    segments: &'a [Segment],
    /// Ascending.
    nodes: Vec<Node>,
    /// The segments at node `i` are `incident[starts[i]..starts[i + 1]]`.
    starts: Vec<usize>,
    incident: Vec<usize>,
}

impl<'a> Graph<'a> {
    fn new(segments: &'a [Segment]) -> Self {
        let mut by_node: Vec<(Node, usize)> =
            segments.iter().enumerate().flat_map(|(i, segment)| segment.ends.map(|node| (node, i))).collect();
        by_node.sort_unstable();
        let (mut nodes, mut starts) = (Vec::new(), Vec::new());
        for (i, &(node, _)) in by_node.iter().enumerate() {
            if nodes.last() != Some(&node) {
                nodes.push(node);
                starts.push(i);
            }
        }
        starts.push(by_node.len());
        Graph { segments, nodes, starts, incident: by_node.into_iter().map(|(_, i)| i).collect() }
    }

    fn chains(&self) -> Vec<Chain> {
        let mut used = vec![false; self.segments.len()];
        let mut chains = Vec::new();
        for first in 0..self.segments.len() {
            if !used[first] {
                chains.push(self.chain(first, &mut used));
            }
        }
        chains
    }

    /// The chain through a segment.
    fn chain(&self, first: usize, used: &mut [bool]) -> Chain {
        used[first] = true;
        let [start, end] = self.segments[first].ends;
        let onward = self.follow(end, first, used);
        // Nothing is left at the start of a cycle.
        let back = self.follow(start, first, used);
        let mut nodes: Vec<Node> = back.iter().rev().map(|&(node, _)| node).collect();
        nodes.extend([start, end]);
        nodes.extend(onward.iter().map(|&(node, _)| node));
        let this = (end, first);
        let steps = back.iter().rev().chain([&this]).chain(&onward);
        let pairs = steps.map(|&(_, segment)| self.segments[segment].pair).collect();
        let closed = nodes.first() == nodes.last();
        if closed {
            nodes.pop();
        }
        Chain { nodes, pairs, closed }
    }

    /// The way on from a node, as far as there is no fork: each segment with the node that it leads to.
    fn follow(&self, mut node: Node, mut segment: usize, used: &mut [bool]) -> Vec<(Node, usize)> {
        let mut way = Vec::new();
        // Each step uses up a segment.
        while let Some(next) = self.beyond(&node, segment).filter(|&next| !used[next]) {
            used[next] = true;
            let [start, end] = self.segments[next].ends;
            node = if start == node { end } else { start };
            segment = next;
            way.push((node, segment));
        }
        way
    }

    /// The other segment at a node where two end.
    fn beyond(&self, node: &Node, segment: usize) -> Option<usize> {
        let slot = self.nodes.binary_search(node).expect("segments end at nodes");
        match self.incident[self.starts[slot]..self.starts[slot + 1]] {
            [one, other] => Some(if one == segment { other } else { one }),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn segments(ends: &[[u32; 2]]) -> Vec<(Piece, Pair)> {
        let piece = |&[i, j]: &[u32; 2]| Piece::Segment([Node::Corner(i), Node::Corner(j)], Origin::Crossing);
        ends.iter().zip(0..).map(|(ends, i)| (piece(ends), [i, 0])).collect()
    }

    fn corners(chain: &Chain) -> Vec<u32> {
        let corner = |node: &Node| match node {
            Node::Corner(site) => *site,
            _ => panic!("{node:?}"),
        };
        chain.nodes.iter().map(corner).collect()
    }

    #[test]
    fn a_cycle_begins_with_its_smallest_pair() {
        let found = chains(segments(&[[2, 3], [1, 2], [3, 4], [4, 1]]));
        assert_eq!(found.len(), 1);
        assert_eq!(corners(&found[0]), [2, 3, 4, 1]);
        assert_eq!(found[0].pairs, [[0, 0], [2, 0], [3, 0], [1, 0]]);
        assert!(found[0].closed);
    }

    #[test]
    fn chains_end_at_forks() {
        // A path that ends at a fork, from which a loop comes back to it.
        let found = chains(segments(&[[5, 6], [6, 7], [7, 8], [8, 9], [9, 7]]));
        let [path, cycle] = &found[..] else { panic!("{found:?}") };
        assert_eq!((corners(path), path.closed), (vec![5, 6, 7], false));
        assert_eq!((corners(cycle), cycle.closed, cycle.pairs.len()), (vec![7, 8, 9], true, 3));
    }

    #[test]
    fn points_on_segments_are_no_chains() {
        let mut pieces = segments(&[[1, 2]]);
        pieces.extend([1, 3, 3].map(|i| (Piece::Point(Node::Corner(i)), [0, i])));
        let found = chains(pieces);
        assert_eq!(found.iter().map(corners).collect::<Vec<_>>(), [vec![1, 2], vec![3]]);
    }

    #[test]
    fn edges_inside_a_region_are_left_out() {
        let ends = [Node::Corner(1), Node::Corner(2)];
        let of = |origins: &[Origin]| {
            chains(origins.iter().map(|&origin| (Piece::Segment(ends, origin), [0, 0])).collect()).len()
        };
        assert_eq!(of(&[Origin::RimLeft, Origin::RimRight]), 0);
        assert_eq!(of(&[Origin::RimLeft, Origin::Touching, Origin::RimRight]), 0);
        assert_eq!(of(&[Origin::Touching]), 1);
        assert_eq!(of(&[Origin::RimLeft, Origin::RimLeft]), 1);
        assert_eq!(of(&[Origin::RimLeft, Origin::RimRight, Origin::Crossing]), 1);
    }
}
