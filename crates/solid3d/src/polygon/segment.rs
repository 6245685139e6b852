//! A segment against a polygon: exactly.

use glam::DVec3;

use super::chain::{Base, Chain};
use super::counters::Counters;
use super::exact::{flatten, height, same_strict_side, segments_meet};
use super::planar;

/// Whether a segment of the polygon's plane shares a point with the polygon.
pub(super) fn meets_in_plane(polygon: &Chain, base: Base, p: DVec3, q: DVec3) -> bool {
    let flat = |i: usize| flatten(base.dropped, polygon.vertices[i]);
    let (p, q) = (flatten(base.dropped, p), flatten(base.dropped, q));
    polygon.edges().any(|[i, j]| segments_meet(p, q, flat(i), flat(j))) || contains(polygon, base, p)
}

/// Whether the polygon contains a point of its plane, given without the dropped coordinate.
pub(super) fn contains(polygon: &Chain, base: Base, x: glam::DVec2) -> bool {
    planar::contains(&polygon.flattened(base.dropped), x)
}

/// Whether the line through `p` and `q`, which crosses the plane of the polygon in a point `x` that is neither, meets the
/// polygon: the crossings test in terms of `p` and `q`, without computing `x`.
///
/// The ray from `x` runs in the plane through `p`, `q` and a corner `w` of the polygon. Which side of that plane a vertex
/// lies on, and which way an edge passes the line, are signs of determinants; so the answer is exact.
pub(super) fn line_meets(polygon: &Chain, base: Base, p: DVec3, q: DVec3) -> bool {
    let vertex = |i: usize| polygon.vertices[i];
    let [w, one, other] = base.corners.map(vertex);
    let (to_one, to_other) = (height(p, q, w, one), height(p, q, w, other));
    if to_one == 0.0 && to_other == 0.0 {
        // Only if w is x: otherwise the corners would be collinear.
        return true;
    }
    // A corner off the plane of the ray, to tell points on its line apart.
    let aside = if to_one == 0.0 { other } else { one };
    let mut inside = false;
    let mut from = height(p, q, w, vertex(polygon.len() - 1));
    let mut i = polygon.len() - 1;
    for j in 0..polygon.len() {
        let (r, s) = (vertex(i), vertex(j));
        let to = height(p, q, w, s);
        if from == 0.0 && to == 0.0 {
            // The edge lies on the line of the ray.
            if !same_strict_side(height(p, q, aside, r), height(p, q, aside, s)) {
                return true;
            }
        } else if !same_strict_side(from, to) {
            let passes = height(p, q, r, s);
            if passes == 0.0 {
                return true;
            }
            let straddles = (from < 0.0) != (to < 0.0);
            if straddles && (passes > 0.0) == (from < 0.0) {
                inside = !inside;
            }
        }
        (from, i) = (to, j);
    }
    inside
}

/// Whether a closed segment shares a point with a polygon. Exact for a flat polygon; the plane of another is that of its
/// base.
pub(super) fn meets_polygon(polygon: &Chain, base: Base, p: DVec3, q: DVec3) -> bool {
    let sides = [polygon.side(base, p), polygon.side(base, q)];
    meets_polygon_given(polygon, base, [p, q], sides, &mut Counters::default())
}

/// The same, given the heights of both ends over the polygon's plane.
pub(super) fn meets_polygon_given(
    polygon: &Chain,
    base: Base,
    [p, q]: [DVec3; 2],
    [p_side, q_side]: [f64; 2],
    counters: &mut Counters,
) -> bool {
    counters.edge_plane_tests += 1;
    if same_strict_side(p_side, q_side) {
        return false;
    }
    counters.point_in_polygon_tests += 1;
    match (p_side == 0.0, q_side == 0.0) {
        (true, true) => meets_in_plane(polygon, base, p, q),
        (true, false) => contains(polygon, base, flatten(base.dropped, p)),
        (false, true) => contains(polygon, base, flatten(base.dropped, q)),
        (false, false) => line_meets(polygon, base, p, q),
    }
}
