//! What two facets have in common.

use super::facets::{Facet, Facets};
use super::sites::{Edge, Face, Site, Sites};
use super::{Pair, planar};

/// A point at which a segment may end, by what meets there: the least parts of the two facets that contain it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Node {
    /// A corner, on whatever of the other facet.
    Corner(Site),
    /// The insides of two edges that are not collinear; the lesser first.
    Edges([Edge; 2]),
    /// The insides of an edge and a face that are not coplanar.
    EdgeFace(Edge, Face),
}

impl Node {
    pub fn edges(e: Edge, f: Edge) -> Node {
        Node::Edges([e.min(f), e.max(f)])
    }
}

/// How a segment came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Origin {
    /// It is all that two facets have in common, which are not coplanar, or not both triangles.
    Crossing,
    /// It is all that two coplanar triangles have in common.
    Touching,
    /// It bounds the region of two coplanar facets, which lies to the left of it, seen with an axis of the plane's left out,
    /// from the lesser to the greater point.
    RimLeft,
    /// The same with the region to the right.
    RimRight,
}

/// A part of what two facets have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Piece {
    Point(Node),
    Segment([Node; 2], Origin),
}

/// The pieces of all pairs of primitives, in their order.
pub(super) fn all(facets: &Facets, pairs: &[Pair]) -> Vec<(Piece, Pair)> {
    let mut pieces = Vec::new();
    let mut nodes = Vec::new();
    for &pair in pairs {
        for x in facets.of(0, pair[0]) {
            for y in facets.of(1, pair[1]).iter().filter(|y| x.bounds.overlaps(&y.bounds)) {
                meet(x, y, &facets.sites, &mut nodes, |piece| pieces.push((piece, pair)));
            }
        }
    }
    pieces
}

/// Finds what two facets have in common; `nodes` is working memory.
pub(super) fn meet(x: &Facet, y: &Facet, sites: &Sites, nodes: &mut Vec<Node>, mut found: impl FnMut(Piece)) {
    let sides = [sides(x, y, sites), sides(y, x, sites)];
    if sides.contains(&Sides::Apart) {
        return;
    }
    if sides.contains(&Sides::Within) || (x.collinear && y.collinear) {
        return planar::meet(x, y, sites, nodes, found);
    }
    nodes.clear();
    cross(x, y, &sides[0], sites, nodes);
    cross(y, x, &sides[1], sites, nodes);
    nodes.sort_unstable();
    nodes.dedup();
    // Where an edge of a degenerate triangle is crossed, so is another at the same place: the segment between them has no
    // length, and joins what ends at the triangle's neighbours. More than two points there are only where coordinates are so far apart
    // in magnitude that products of them are lost, and with them their signs.
    match nodes[..] {
        [] => {}
        [node] => found(Piece::Point(node)),
        [one, .., other] => found(Piece::Segment([one, other], Origin::Crossing)),
    }
}

/// Where the corners of a facet lie to the plane of another.
#[derive(Debug, PartialEq)]
enum Sides {
    /// All strictly on one side.
    Apart,
    /// All on the plane.
    Within,
    /// On both sides, or some on the plane: the orientations.
    Across([f64; 3]),
    /// The other is degenerate and has no plane.
    NoPlane,
}

fn sides(of: &Facet, to: &Facet, sites: &Sites) -> Sides {
    let Some(face) = to.face() else {
        return Sides::NoPlane;
    };
    let mut heights = [0.0; 3];
    let corners = of.corners();
    for (height, &corner) in heights.iter_mut().zip(corners) {
        *height = sites.height(face, corner);
    }
    let heights_of_corners = &heights[..corners.len()];
    if heights_of_corners.iter().all(|&h| h > 0.0) || heights_of_corners.iter().all(|&h| h < 0.0) {
        Sides::Apart
    } else if heights_of_corners.iter().all(|&h| h == 0.0) {
        Sides::Within
    } else {
        Sides::Across(heights)
    }
}

/// The nodes where a corner of `x` lies on `y`, or an edge of `x` passes through `y`.
fn cross(x: &Facet, y: &Facet, sides: &Sides, sites: &Sites, nodes: &mut Vec<Node>) {
    let (Sides::Across(heights), Some(face)) = (sides, y.face()) else {
        let on_edge = |&&corner: &&Site| y.edges().iter().any(|&e| on_segment(corner, y.edge(e), sites));
        nodes.extend(x.corners().iter().filter(on_edge).map(|&corner| Node::Corner(corner)));
        return;
    };
    for (&corner, &height) in x.corners().iter().zip(heights) {
        if height == 0.0 && in_triangle(corner, face, sites) {
            nodes.push(Node::Corner(corner));
        }
    }
    for &[i, j] in x.edges() {
        if (heights[i] > 0.0 && heights[j] < 0.0) || (heights[i] < 0.0 && heights[j] > 0.0) {
            nodes.extend(pierce(x.edge([i, j]), face, sites));
        }
    }
}

/// Where an edge whose ends lie strictly on both sides of a face passes through it. Through a corner of the face: that is
/// found as the corner on the other facet.
fn pierce(edge: Edge, face: Face, sites: &Sites) -> Option<Node> {
    let [a, b, c] = face;
    let sides: [Edge; 3] = [[a, b], [b, c], [a, c]];
    // In one sense around the face: a to b to c to a.
    let around = [[a, b], [b, c], [c, a]];
    let turns = around.map(|[k, l]| sites.height([edge[0], edge[1], k], l));
    if turns.iter().any(|&turn| turn > 0.0) && turns.iter().any(|&turn| turn < 0.0) {
        return None;
    }
    let on: Vec<Edge> = (0..3).filter(|&k| turns[k] == 0.0).map(|k| sides[k]).collect();
    match on[..] {
        [] => Some(Node::EdgeFace(edge, face)),
        [side] => Some(Node::edges(edge, side)),
        _ => None,
    }
}

/// Whether a site in the plane of a triangle lies in it or on its edges.
fn in_triangle(site: Site, face: Face, sites: &Sites) -> bool {
    let axis = sites.dropped_axis(face).expect("a face is not degenerate");
    planar::contains(axis, &face, site, sites)
}

/// Whether a site lies on a closed segment.
fn on_segment(site: Site, [p, q]: Edge, sites: &Sites) -> bool {
    (p..=q).contains(&site) && sites.dropped_axis([p, q, site]).is_none()
}
