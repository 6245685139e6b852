//! Holes: joining several closed chains into one by doubled edges (thesis, section 2.1.1).

use glam::DVec2;

use super::bridges::{Bridges, Waiting};
use super::error::{PolygonError, Result};
use super::exact::{segment_contains, segments_cross, segments_overlap};
use super::planar;

/// Joins holes to the boundary around them; chains are places in `points`. The result runs as `outer` does.
///
/// The thesis connects the closest points of the two chains. Those may lie inside edges, where a vertex would have to be added
/// that rounding puts beside the edge; and between the closest *vertices* an edge may pass. So the closest two vertices are
/// taken that see each other, which is checked exactly. Where there are none, a hole touches the boundary between vertices: there it
/// gets one. Cost: O(n^2), at worst O(n^3).
pub(super) fn join(points: &[DVec2], outer: &[usize], holes: &[Vec<usize>]) -> Result<Vec<usize>> {
    let outer_points = at(points, outer);
    let hole_points: Vec<Vec<DVec2>> = holes.iter().map(|hole| at(points, hole)).collect();
    let boxes: Vec<[DVec2; 2]> = hole_points.iter().map(|hole| bounds(hole)).collect();
    let are_near = |hole: usize, other: usize| {
        let ([low, high], [other_low, other_high]) = (boxes[hole], boxes[other]);
        low.cmple(other_high).all() && other_low.cmple(high).all()
    };
    for (hole, chain) in hole_points.iter().enumerate() {
        let overlaps = |other: usize| are_near(hole, other) && overlap(chain, &hole_points[other]);
        if !is_inside(chain, &outer_points) || (0..hole).any(overlaps) {
            return Err(PolygonError::HoleOutside { hole });
        }
    }
    let sense = planar::sense(&outer_points);
    // Holes run the other way round.
    let mut waiting: Waiting = holes.iter().cloned().enumerate().collect();
    for (chain, placed) in waiting.values_mut().zip(&hole_points) {
        if planar::sense(placed) == sense {
            chain.reverse();
        }
    }
    let mut joined = outer.to_vec();
    let mut bridges = Bridges::new(points, sense, &joined, &waiting);
    while let Some(&first) = waiting.keys().next() {
        if let Some(bridge) = bridges.next(&joined, &waiting) {
            let hole = bridge.join(&mut joined, &mut waiting);
            bridges.add(&hole, &waiting);
            continue;
        }
        let mut holes = waiting.values_mut();
        if !holes.any(|hole| split(points, &mut joined, hole) || split(points, hole, &joined)) {
            return Err(PolygonError::HoleOutside { hole: first });
        }
        bridges = Bridges::new(points, sense, &joined, &waiting);
    }
    Ok(joined)
}

/// The least and the greatest coordinates of a chain.
fn bounds(chain: &[DVec2]) -> [DVec2; 2] {
    chain.iter().fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], &p| [low.min(p), high.max(p)])
}

/// Whether a hole lies in the polygon; they may touch.
fn is_inside(hole: &[DVec2], outer: &[DVec2]) -> bool {
    !invades(hole, outer, false) && !invades(outer, hole, true) && !run_along(hole, outer, false)
}

/// Whether two holes have more in common than parts of their boundaries.
fn overlap(a: &[DVec2], b: &[DVec2]) -> bool {
    invades(a, b, true) || invades(b, a, true) || run_along(a, b, true)
}

/// Whether an edge of `chain` enters the inside of `border`, or the outside. What is all around a doubled edge is on both of its sides.
fn invades(chain: &[DVec2], border: &[DVec2], inside: bool) -> bool {
    let is_on_border = |x: DVec2| planar::edges(border).any(|(p, q)| segment_contains(p, q, x));
    if chain.iter().any(|&x| planar::contains(border, x) == inside && !is_on_border(x)) {
        return true;
    }
    planar::edges(chain).any(|(p, q)| {
        // From either end, when it lies on the border.
        let enters = |from: DVec2, to: DVec2| {
            let is_entered = |side: f64| planar::contains_beside(border, from, to, side) == inside;
            from != to && is_on_border(from) && is_entered(1.0) && is_entered(-1.0)
        };
        enters(p, q) || enters(q, p) || planar::edges(border).any(|(r, s)| segments_cross(p, q, r, s))
    })
}

/// Whether edges of two chains overlap that have the inside of `a` on a side where they have the inside of `b`, or the outside.
fn run_along(a: &[DVec2], b: &[DVec2], inside: bool) -> bool {
    planar::edges(a).any(|(p, q)| {
        planar::edges(b).filter(|&(r, s)| segments_overlap(p, q, r, s)).any(|(r, s)| {
            let first = if (q - p).dot(s - r) > 0.0 { r } else { s };
            let from = if segment_contains(r, s, p) { p } else { first };
            let beside = |chain: &[DVec2], side: f64| planar::contains_beside(chain, from, q, side);
            [1.0, -1.0].iter().any(|&side| beside(a, side) && beside(b, side) == inside)
        })
    })
}

/// Where the vertices of a chain are.
fn at(points: &[DVec2], chain: &[usize]) -> Vec<DVec2> {
    chain.iter().map(|&i| points[i]).collect()
}

/// Splits an edge of a chain at a vertex of another that lies within it. Returns whether there is one.
fn split(points: &[DVec2], chain: &mut Vec<usize>, other: &[usize]) -> bool {
    let found = (0..chain.len()).find_map(|i| {
        let (p, q) = (points[chain[i]], points[chain[(i + 1) % chain.len()]]);
        let within = |&&v: &&usize| points[v] != p && points[v] != q && segment_contains(p, q, points[v]);
        other.iter().find(within).map(|&v| (i, v))
    });
    if let Some((i, v)) = found {
        chain.insert(i + 1, v);
    }
    found.is_some()
}
