//! Holes: joining several closed chains into one by doubled edges (thesis, section 2.1.1).

use glam::DVec2;

use super::error::{PolygonError, Result};
use super::exact::{segment_contains, segments_cross, segments_meet, turn};
use super::planar;

/// Joins holes to the boundary around them; chains are places in `points`. The result runs as `outer` does.
///
/// The thesis connects the closest points of the two chains. Those may lie inside edges, where a vertex would have to be added
/// that rounding puts beside the edge; and between the closest *vertices* an edge may pass. So the closest two vertices are
/// taken that see each other, which is checked exactly. Where there are none, a hole touches the boundary between vertices: there it
/// gets one. Cost: O(n^2 log n), at worst O(n^3).
pub(super) fn join(points: &[DVec2], outer: &[usize], holes: &[Vec<usize>]) -> Result<Vec<usize>> {
    let outer_points = at(points, outer);
    let hole_points: Vec<Vec<DVec2>> = holes.iter().map(|hole| at(points, hole)).collect();
    for (hole, chain) in hole_points.iter().enumerate() {
        if !is_inside(chain, &outer_points) || hole_points[..hole].iter().any(|other| overlap(chain, other)) {
            return Err(PolygonError::HoleOutside { hole });
        }
    }
    let clockwise = planar::doubled_area(&outer_points) < 0.0;
    // Holes run the other way round.
    let mut waiting: Vec<(usize, Vec<usize>)> = holes.iter().cloned().enumerate().collect();
    for (_, chain) in &mut waiting {
        if (planar::doubled_area(&at(points, chain)) < 0.0) == clockwise {
            chain.reverse();
        }
    }
    let mut joined = outer.to_vec();
    while !waiting.is_empty() {
        let Some((next, i, j)) = bridge(points, &joined, &waiting, if clockwise { -1.0 } else { 1.0 }) else {
            let mut holes = waiting.iter_mut().map(|(_, hole)| hole);
            if holes.any(|hole| split(points, &mut joined, hole) || split(points, hole, &joined)) {
                continue;
            }
            return Err(PolygonError::HoleOutside { hole: waiting[0].0 });
        };
        let (_, hole) = waiting.remove(next);
        // p_0 .. p_i, q_j .. q_(n-1), q_0 .. q_j, p_i .. p_(m-1).
        let around = hole[j..].iter().chain(&hole[..=j]).copied();
        let chain: Vec<usize> =
            joined[..=i].iter().copied().chain(around).chain(joined[i..].iter().copied()).collect();
        joined = chain;
    }
    Ok(joined)
}

/// 1 for a chain that runs counter-clockwise, else -1.
fn sense(chain: &[DVec2]) -> f64 {
    if planar::doubled_area(chain) < 0.0 { -1.0 } else { 1.0 }
}

/// Whether a hole lies in the polygon; they may touch.
fn is_inside(hole: &[DVec2], outer: &[DVec2]) -> bool {
    let is_outside = |x: DVec2| !planar::contains(outer, x);
    let inside = |x: DVec2| planar::contains_strictly(hole, x);
    !invades(hole, outer, -sense(outer), &is_outside)
        && !invades(outer, hole, sense(hole), &inside)
        && !run_along(hole, outer, -sense(hole) * sense(outer))
}

/// Whether two holes have more in common than parts of their boundaries.
fn overlap(a: &[DVec2], b: &[DVec2]) -> bool {
    invades(a, b, sense(b), &|x| planar::contains_strictly(b, x))
        || invades(b, a, sense(a), &|x| planar::contains_strictly(a, x))
        || run_along(a, b, sense(a) * sense(b))
}

/// Whether an edge of `chain` enters the open region that lies to the left of `border`, when `sense` is 1.
fn invades(chain: &[DVec2], border: &[DVec2], sense: f64, region: &dyn Fn(DVec2) -> bool) -> bool {
    if chain.iter().any(|&x| region(x)) {
        return true;
    }
    planar::edges(chain).any(|(p, q)| {
        // From either end, when it lies on the border.
        let enters = |from: DVec2, to: DVec2| {
            (0..border.len()).any(|k| {
                let n = border.len();
                let corner @ [_, v, after] = [(k + n - 1) % n, k, (k + 1) % n].map(|i| border[i]);
                let on_edge = from != v && from != after && segment_contains(v, after, from);
                (from == v && from != to && sees(corner, to, sense))
                    || (on_edge && sense * turn(v, after, to) > 0.0)
            })
        };
        enters(p, q) || enters(q, p) || planar::edges(border).any(|(r, s)| segments_cross(p, q, r, s))
    })
}

/// Whether edges of two chains overlap that run the same way, when `same` is 1, or opposite ways.
fn run_along(a: &[DVec2], b: &[DVec2], same: f64) -> bool {
    planar::edges(a)
        .any(|(p, q)| planar::edges(b).any(|(r, s)| overlaps(p, q, r, s) && same * (q - p).dot(s - r) > 0.0))
}

/// Where the vertices of a chain are.
fn at(points: &[DVec2], chain: &[usize]) -> Vec<DVec2> {
    chain.iter().map(|&i| points[i]).collect()
}

/// The shortest bridge from the chain to a waiting hole: the hole's place among those waiting, and the places of the ends in
/// the two chains.
fn bridge(
    points: &[DVec2],
    joined: &[usize],
    waiting: &[(usize, Vec<usize>)],
    sense: f64,
) -> Option<(usize, usize, usize)> {
    let mut candidates: Vec<(f64, usize, usize, usize)> = Vec::new();
    for (next, (_, hole)) in waiting.iter().enumerate() {
        for (i, &p) in joined.iter().enumerate() {
            for (j, &q) in hole.iter().enumerate() {
                candidates.push((points[p].distance_squared(points[q]), next, i, j));
            }
        }
    }
    candidates.sort_by(|x, y| x.0.total_cmp(&y.0));
    let boundary = at(points, joined);
    let chains = || std::iter::once(joined).chain(waiting.iter().map(|(_, hole)| &hole[..]));
    let is_clear = |p: DVec2, q: DVec2| {
        chains().all(|chain| {
            (0..chain.len()).all(|k| {
                let (r, s) = (points[chain[k]], points[chain[(k + 1) % chain.len()]]);
                let touches_at_ends = [r, s].iter().any(|&end| end == p || end == q);
                // An edge that begins where the bridge ends must not run along it, nor reach to its other end.
                if touches_at_ends { !overlaps(p, q, r, s) } else { !segments_meet(p, q, r, s) }
            })
        })
    };
    candidates.into_iter().find_map(|(_, next, i, j)| {
        let hole = &waiting[next].1;
        let (p, q) = (points[joined[i]], points[hole[j]]);
        // Bridges of no length repeat vertices: the neighbours are the nearest that differ.
        let corner = |chain: &[usize], k: usize| {
            let (n, v) = (chain.len(), points[chain[k]]);
            let other = |mut places: Box<dyn Iterator<Item = usize>>| {
                places.find_map(|i| Some(points[chain[i % n]]).filter(|&x| x != v)).unwrap_or(v)
            };
            [other(Box::new((k + 1..k + n).rev())), v, other(Box::new(k + 1..k + n))]
        };
        // Where the hole touches the boundary, it must do so from inside the corner.
        let onwards = if p == q { corner(hole, j)[2] } else { q };
        let own = corner(joined, i);
        let mut others = (0..joined.len()).filter(|&k| boundary[k] == p).map(|k| corner(joined, k));
        let clear = holds(&boundary, own, onwards, sense)
            && !others.any(|other| {
                is_nearer(other, own, onwards, sense) && holds(&boundary, other, onwards, sense)
            })
            && (p == q || sees(corner(hole, j), p, sense) && is_clear(p, q));
        clear.then_some((next, i, j))
    })
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

/// Whether two segments share more than a point.
fn overlaps(p: DVec2, q: DVec2, r: DVec2, s: DVec2) -> bool {
    let collinear = turn(p, q, r) == 0.0 && turn(p, q, s) == 0.0;
    let (low, high) = (p.min(q).max(r.min(s)), p.max(q).min(r.max(s)));
    collinear && low.cmple(high).all() && low != high
}

/// Whether what begins at a corner of a chain and goes on to `x` begins in the polygon: within the corner's inner angle, or along the
/// edge by which the chain comes.
fn holds(chain: &[DVec2], corner @ [before, v, after]: [DVec2; 3], x: DVec2, sense: f64) -> bool {
    if is_along(v, before, after) {
        // All around the tip of a slit is the polygon, and nothing of it around that of an antenna.
        return planar::contains_beside(chain, v, before, sense);
    }
    sees(corner, x, sense) || is_along(v, before, x)
}

/// Whether, of two corners at one point that both hold `x`, the first is the one in which it begins: the chain comes by an edge that is
/// nearer to it, or by the same, and goes on by a nearer one.
fn is_nearer([before, v, after]: [DVec2; 3], than: [DVec2; 3], x: DVec2, sense: f64) -> bool {
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
fn sees([before, v, after]: [DVec2; 3], x: DVec2, sense: f64) -> bool {
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
