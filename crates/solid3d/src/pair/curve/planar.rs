//! What two facets in one plane have in common.

use super::facets::Facet;
use super::meeting::{Node, Origin, Piece};
use super::sites::{Edge, Site, Sites};

/// Like [`meet`](super::meeting::meet), for facets that lie in one plane, and for two degenerate ones.
pub(super) fn meet(x: &Facet, y: &Facet, sites: &Sites, nodes: &mut Vec<Node>, mut found: impl FnMut(Piece)) {
    let ((x, x_count), (y, y_count)) = (x.spanning(), y.spanning());
    let (x, y) = (&x[..x_count], &y[..y_count]);
    let ([first_x, .., last_x], [first_y, .., last_y]) = (closed(x), closed(y));
    if x_count < 3 && y_count < 3 && sites.height([first_x, last_x, first_y], last_y) != 0.0 {
        return;
    }
    let Some(axis) = common_axis(x, y, sites) else {
        // On one line sites are in order.
        let (first, last) = (first_x.max(first_y), last_x.min(last_y));
        if first == last {
            found(Piece::Point(Node::Corner(first)));
        } else if first < last {
            found(Piece::Segment([Node::Corner(first), Node::Corner(last)], Origin::Crossing));
        }
        return;
    };
    nodes.clear();
    let inside = |corners: &[Site], of: &[Site], nodes: &mut Vec<Node>| {
        let inside = corners.iter().filter(|&&corner| contains(axis, of, corner, sites));
        nodes.extend(inside.map(|&corner| Node::Corner(corner)));
    };
    inside(x, y, nodes);
    inside(y, x, nodes);
    for &(e, _) in edges(x).iter() {
        let crossed = edges(y).into_iter().filter(|&(f, _)| properly_cross(axis, e, f, sites));
        nodes.extend(crossed.map(|(f, _)| Node::edges(e, f)));
    }
    nodes.sort_unstable();
    nodes.dedup();
    match nodes[..] {
        [] => {}
        [node] => found(Piece::Point(node)),
        [one, other] => {
            let regions = x_count == 3 && y_count == 3;
            found(Piece::Segment([one, other], if regions { Origin::Touching } else { Origin::Crossing }));
        }
        _ => rim(axis, [x, y], nodes, sites, found),
    }
}

/// The edges of the region that two triangles have in common. Each lies on an edge of one of them.
fn rim(axis: usize, triangles: [&[Site]; 2], nodes: &[Node], sites: &Sites, mut found: impl FnMut(Piece)) {
    for (edge, third) in triangles.into_iter().flat_map(edges) {
        let lies_on = |&&node: &&Node| match node {
            Node::Corner(corner) => contains(axis, &edge, corner, sites),
            Node::Edges(edges) => edges.contains(&edge),
            Node::EdgeFace(..) => false,
        };
        let ends: Vec<Node> = nodes.iter().filter(lies_on).copied().collect();
        if let [one, other] = ends[..] {
            let left = sites.turn(axis, [edge[0], edge[1], third]) > 0.0;
            found(Piece::Segment([one, other], if left { Origin::RimLeft } else { Origin::RimRight }));
        }
    }
}

/// Whether a site of a plane lies in the hull of one, two or three, in ascending order; no two of the plane's points coincide
/// when the axis is left out.
pub(super) fn contains(axis: usize, hull: &[Site], site: Site, sites: &Sites) -> bool {
    match *hull {
        [a, b, c] => {
            let turns = [[a, b, site], [b, c, site], [c, a, site]].map(|turn| sites.turn(axis, turn));
            turns.iter().all(|&turn| turn >= 0.0) || turns.iter().all(|&turn| turn <= 0.0)
        }
        [a, b] => (a..=b).contains(&site) && sites.turn(axis, [a, b, site]) == 0.0,
        _ => hull.contains(&site),
    }
}

/// Whether the insides of two edges meet in one point.
fn properly_cross(axis: usize, [p, q]: Edge, [r, s]: Edge, sites: &Sites) -> bool {
    let parts = |i: Site, j: Site, k: Site, l: Site| {
        let (one, other) = (sites.turn(axis, [i, j, k]), sites.turn(axis, [i, j, l]));
        (one > 0.0 && other < 0.0) || (one < 0.0 && other > 0.0)
    };
    parts(p, q, r, s) && parts(r, s, p, q)
}

/// The first axis that can be left out without two points of the common plane coinciding; the same for all facets of the
/// plane. `None` if all corners lie on one line.
fn common_axis(x: &[Site], y: &[Site], sites: &Sites) -> Option<usize> {
    let ([a, b, c], [d, e, f]) = (closed(x), closed(y));
    let triples = [[a, b, c], [d, e, f], [a, c, d], [a, c, f], [d, f, a], [d, f, c]];
    (0..3).find(|&axis| triples.iter().any(|&triple| sites.turn(axis, triple) != 0.0))
}

/// One, two or three sites as three: the last repeated.
fn closed(sites: &[Site]) -> [Site; 3] {
    let last = sites[sites.len() - 1];
    [sites[0], sites[1.min(sites.len() - 1)], last]
}

/// The edges of the hull of one, two or three sites, each with the corner that is not on it; with one of its own for a
/// segment.
fn edges(hull: &[Site]) -> Vec<(Edge, Site)> {
    match *hull {
        [a, b, c] => vec![([a, b], c), ([b, c], a), ([a, c], b)],
        [a, b] => vec![([a, b], a)],
        _ => Vec::new(),
    }
}
