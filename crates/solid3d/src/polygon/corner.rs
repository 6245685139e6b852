//! What lies within the angle of a corner: of three points of a chain, before, at and after a vertex.

use glam::DVec2;

use super::exact::turn;
use super::planar;

/// Whether what begins at a corner of a chain and goes on to `x` begins in the polygon: within the corner's inner angle, or along the
/// edge by which the chain comes.
pub(super) fn holds(chain: &[DVec2], corner @ [before, v, after]: [DVec2; 3], x: DVec2, sense: f64) -> bool {
    if is_along(v, before, after) {
        // All around the tip of a slit is the polygon, and nothing of it around that of an antenna.
        return planar::contains_beside(chain, v, before, sense);
    }
    sees(corner, x, sense) || is_along(v, before, x)
}

/// Whether, of two corners at one point that both hold `x`, the first is the one in which it begins: the chain comes by an edge that is
/// nearer to it, or by the same, and goes on by a nearer one.
pub(super) fn is_nearer([before, v, after]: [DVec2; 3], than: [DVec2; 3], x: DVec2, sense: f64) -> bool {
    if is_along(v, before, than[0]) {
        return sees([x, v, than[2]], after, sense);
    }
    !is_along(v, than[0], x) && (is_along(v, before, x) || sees([than[0], v, x], before, sense))
}

/// Whether two points are in one direction from `v`.
fn is_along(v: DVec2, a: DVec2, b: DVec2) -> bool {
    turn(a, v, b) == 0.0 && (a - v).dot(b - v) > 0.0
}

/// Whether a point lies within the inner angle of a corner: to the left of the chain there, when `sense` is 1.
pub(super) fn sees([before, v, after]: [DVec2; 3], x: DVec2, sense: f64) -> bool {
    let turned = |a: DVec2, b: DVec2, c: DVec2| sense * turn(a, b, c);
    let corner = turned(before, v, after);
    let (left_of_first, left_of_second) = (turned(before, v, x) > 0.0, turned(v, after, x) > 0.0);
    if corner > 0.0 {
        left_of_first && left_of_second
    } else if corner < 0.0 {
        left_of_first || left_of_second
    } else if (after - v).dot(before - v) > 0.0 {
        // The chain turns back: all around but along it.
        turned(v, after, x) != 0.0 || (after - v).dot(x - v) < 0.0
    } else {
        left_of_first
    }
}
