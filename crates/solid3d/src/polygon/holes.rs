//! Holes: joining several closed chains into one by doubled edges (thesis, section 2.1.1).

use glam::DVec2;

use super::error::{PolygonError, Result};
use super::exact::{segments_meet, turn};
use super::planar;

/// Joins holes to the boundary around them; chains are places in `points`. The result runs as `outer` does.
///
/// The thesis connects the closest points of the two chains. Those may lie inside edges, where a vertex would have to be added
/// that rounding puts beside the edge; and between the closest *vertices* an edge may pass. So the closest two vertices are
/// taken that see each other, which is checked exactly. Cost: O(n^2 log n), at worst O(n^3).
pub(super) fn join(points: &[DVec2], outer: &[usize], holes: &[Vec<usize>]) -> Result<Vec<usize>> {
    let at = |chain: &[usize]| -> Vec<DVec2> { chain.iter().map(|&i| points[i]).collect() };
    let outer_points = at(outer);
    for (hole, chain) in holes.iter().enumerate() {
        let inside = |&i: &usize| planar::contains(&outer_points, points[i]);
        let in_another = |(k, other): (usize, &Vec<usize>)| {
            k != hole && planar::contains_strictly(&at(other), points[chain[0]])
        };
        if !chain.iter().all(inside) || holes.iter().enumerate().any(in_another) {
            return Err(PolygonError::HoleOutside { hole });
        }
    }
    let clockwise = planar::doubled_area(&outer_points) < 0.0;
    // Holes run the other way round.
    let mut waiting: Vec<(usize, Vec<usize>)> = holes.iter().cloned().enumerate().collect();
    for (_, chain) in &mut waiting {
        if (planar::doubled_area(&at(chain)) < 0.0) == clockwise {
            chain.reverse();
        }
    }
    let mut joined = outer.to_vec();
    while !waiting.is_empty() {
        let Some((next, i, j)) = bridge(points, &joined, &waiting, if clockwise { -1.0 } else { 1.0 }) else {
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
        let corner = |chain: &[usize], k: usize| {
            let n = chain.len();
            [chain[(k + n - 1) % n], chain[k], chain[(k + 1) % n]].map(|place| points[place])
        };
        let clear = if p == q {
            // The hole touches the boundary there: it must do so from inside this corner.
            sees(corner(joined, i), corner(hole, j)[2], sense)
        } else {
            sees(corner(joined, i), q, sense) && sees(corner(hole, j), p, sense) && is_clear(p, q)
        };
        clear.then_some((next, i, j))
    })
}

/// Whether two segments share more than a point.
fn overlaps(p: DVec2, q: DVec2, r: DVec2, s: DVec2) -> bool {
    let collinear = turn(p, q, r) == 0.0 && turn(p, q, s) == 0.0;
    let (low, high) = (p.min(q).max(r.min(s)), p.max(q).min(r.max(s)));
    collinear && low.cmple(high).all() && low != high
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
