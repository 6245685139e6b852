//! Whether a ray crosses a triangle: exactly, and without special cases.
//!
//! The ray runs along the axis x, so the question is in the plane (y, z) first, where the point is moved from `p` by
//! (e, e^2) for an infinitesimal e (*simulation of simplicity*, Edelsbrunner and Muecke 1990): it then lies on the line of
//! no edge, and of the triangles at an edge or a vertex that the ray would hit, it crosses just those that it must for
//! counts to be right. The thesis (section 3.1.2) tries other rays until one hits no edge; this is never in doubt.

use glam::{DVec2, DVec3, Vec3Swizzles};
use solid_convex::simd::each;

use crate::exact::{orient2d, orient3d};

use super::triangle_triangle::{Triangle, intersect};

/// How the ray from `p` along +x crosses a triangle: 1 from its back to its front, -1 the other way, 0 not at all. `None`
/// when `p` lies on the triangle.
pub(super) fn crossing(triangle: &Triangle, p: DVec3) -> Option<i64> {
    let [a, b, c] = *triangle;
    let (least, greatest) = (a.min(b).min(c), a.max(b).max(c));
    if greatest.cmplt(p).any() || least.y > p.y || least.z > p.z {
        return Some(0);
    }
    let [u, v, w] = each(*triangle, |corner| corner.yz());
    let edges = [[u, v], [v, w], [w, u]];
    let turns = each(edges, |[u, v]| sign(orient2d(u, v, p.yz())));
    if turns.contains(&1) && turns.contains(&-1) {
        return Some(0);
    }
    // `p` is in the triangle's projection, or on the border of it, or the projection has no inside.
    let side = sign(orient3d(a, b, c, p));
    if side == 0 && intersect(triangle, &[p; 3]) {
        return None;
    }
    let winding = winding(turns, edges);
    // Seen from +x a triangle that winds counterclockwise is above `p` when `p` is on its positive side.
    Some(if side == winding { winding } else { 0 })
}

/// How a triangle of a plane winds around a point that is moved: 1 counterclockwise, -1 clockwise, 0 not at all. `turns` are the
/// orientations of the edges and the point before, 0 where that is on the edge's line.
pub(super) fn winding(turns: [i64; 3], edges: [[DVec2; 2]; 3]) -> i64 {
    let [x, y, z] = [0, 1, 2].map(|i| if turns[i] == 0 { turn_moved(edges[i]) } else { turns[i] });
    if x == y && y == z { x } else { 0 }
}

/// The orientation of a point on the edge's line, once moved: the sign of the derivative by the first coordinate, else by the second. 0 for an
/// edge that is a point here, of which the triangle has no inside.
fn turn_moved([u, v]: [DVec2; 2]) -> i64 {
    let by_first = sign(u.y - v.y);
    if by_first == 0 { sign(v.x - u.x) } else { by_first }
}

pub(super) fn sign(x: f64) -> i64 {
    i64::from(x > 0.0) - i64::from(x < 0.0)
}
