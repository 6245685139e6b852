//! In the plane: points in polygons, crossing edges.

use glam::{DVec2, DVec3};

use super::exact::{segment_contains, segments_cross, turn};
use crate::hull::Hull;

/// The edges of a closed chain.
pub(super) fn edges(chain: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> {
    chain.iter().copied().zip(chain.iter().copied().cycle().skip(1))
}

/// Whether a polygon contains a point, its boundary included: by counting how often a ray from the point crosses the
/// boundary (thesis, section 3.2.1).
pub(super) fn contains(chain: &[DVec2], x: DVec2) -> bool {
    let mut inside = false;
    for (p, q) in edges(chain) {
        if segment_contains(p, q, x) {
            return true;
        }
        // The ray goes to the right. An edge has its lower end but not its upper one, so that a vertex counts once.
        if (p.y > x.y) != (q.y > x.y) && (turn(p, q, x) > 0.0) == (q.y > p.y) {
            inside = !inside;
        }
    }
    inside
}

/// Whether a polygon contains a point, its boundary excluded.
pub(super) fn contains_strictly(chain: &[DVec2], x: DVec2) -> bool {
    contains(chain, x) && !edges(chain).any(|(p, q)| segment_contains(p, q, x))
}

/// Whether a polygon contains the points just beside the ray from `x` through another point, near `x`: those to the left of it when
/// `sense` is 1. `x` may lie on the boundary.
pub(super) fn contains_beside(chain: &[DVec2], x: DVec2, through: DVec2, sense: f64) -> bool {
    // The ray is turned infinitesimally to that side, so that no vertex lies on it.
    let is_beyond = |p: DVec2| {
        let turned = sense * turn(x, through, p);
        turned > 0.0 || (turned == 0.0 && (p - x).dot(through - x) < 0.0)
    };
    let crosses = |&(p, q): &(DVec2, DVec2)| {
        let (before, after) = if is_beyond(p) { (q, p) } else { (p, q) };
        p != x && q != x && is_beyond(p) != is_beyond(q) && sense * turn(before, after, x) > 0.0
    };
    edges(chain).filter(crosses).count() % 2 == 1
}

/// The first two edges that cross, by their places. Cost: O(n log n), and a look at each pair that is about the same x.
pub(super) fn crossing(chain: &[DVec2]) -> Option<[usize; 2]> {
    let edge = |i: usize| (chain[i], chain[(i + 1) % chain.len()]);
    let from = |i: usize| edge(i).0.x.min(edge(i).1.x);
    let mut order: Vec<usize> = (0..chain.len()).collect();
    order.sort_by(|&i, &j| from(i).total_cmp(&from(j)));
    let crossing_later = |k: usize| {
        let (p, q) = edge(order[k]);
        let to = p.x.max(q.x);
        let near = order[k + 1..].iter().take_while(move |&&j| from(j) <= to);
        let crossed = near.filter(move |&&j| segments_cross(p, q, edge(j).0, edge(j).1));
        crossed.map(|&j| [j.min(order[k]), j.max(order[k])]).min()
    };
    (0..order.len()).filter_map(crossing_later).min()
}

/// Twice the area, positive when the chain runs counter-clockwise; up to rounding.
pub(super) fn doubled_area(chain: &[DVec2]) -> f64 {
    let first = chain.first().copied().unwrap_or_default();
    edges(chain).map(|(p, q)| (p - first).perp_dot(q - first)).sum()
}

/// 1 for a chain that runs counter-clockwise, else -1.
pub(super) fn sense(chain: &[DVec2]) -> f64 {
    if doubled_area(chain) < 0.0 { -1.0 } else { 1.0 }
}

/// Whether a chain goes around a convex region once, without turning back.
pub(super) fn is_convex(chain: &[DVec2]) -> bool {
    let mut corners: Vec<DVec2> = chain.to_vec();
    corners.dedup();
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    let n = corners.len();
    let (mut left, mut right, mut reversals) = (false, false, 0);
    for i in 0..n {
        let [p, q, r] = [0, 1, 2].map(|k| corners[(i + k) % n]);
        let turned = turn(p, q, r);
        left |= turned > 0.0;
        right |= turned < 0.0;
        // A convex chain goes up once and down once in the lexicographic order.
        let goes_up = |p: DVec2, q: DVec2| (p.x, p.y) < (q.x, q.y);
        reversals += u32::from(goes_up(p, q) != goes_up(q, r));
    }
    !(left && right) && reversals <= 2
}

/// Whether what a chain without crossings bounds is its convex hull, but for what is within a tolerance of the edges of that: the chain passes
/// the corners of the hull in order, and between two of them is as near to the line through both.
pub(super) fn fills_hull(chain: &[DVec2], tolerance: f64) -> bool {
    let points: Vec<DVec3> = chain.iter().map(|p| p.extend(0.0)).collect();
    let hull = Hull::of(&points).expect("a chain has a vertex");
    let corners: Vec<usize> = hull.vertices().iter().map(|&i| i as usize).collect();
    let next = corners.iter().skip(1).copied().chain([corners[0] + chain.len()]);
    let follows = |(from, to): (usize, usize)| {
        let [p, q] = [from, to].map(|i| chain[i % chain.len()]);
        let off = |v: DVec2| (q - p).perp_dot(v - p).abs();
        (from + 1..to).all(|i| off(chain[i % chain.len()]) <= tolerance * p.distance(q))
    };
    let in_order: Vec<DVec2> = corners.iter().map(|&i| chain[i]).collect();
    is_convex(&in_order) && corners.iter().copied().zip(next).all(follows)
}

#[cfg(test)]
mod tests {
    use glam::DMat2;
    use rand::Rng;
    use solid_oracle::generate::seeded;

    use super::*;

    fn chain(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().map(|&point| DVec2::from(point)).collect()
    }

    /// Law: what fills its hull does so however it is turned and from wherever its chain begins, and so does what does not.
    #[test]
    fn a_chain_fills_its_hull_or_does_not() {
        let square = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
        let with = |points: &[(f64, f64)]| chain(&[&square[..], points].concat());
        let filled = [
            chain(&square),
            chain(&[(1.0, 1.0); 3]),
            chain(&[(0.0, 0.0), (3.0, 0.0), (1.0, 0.0)]),
            // An edge in pieces, one that is dented by less than the tolerance, and a corner twice.
            with(&[(0.0, 1.5), (0.0, 1.0), (0.0, 0.5)]),
            with(&[(1e-9, 1.5), (1e-9, 0.5)]),
            with(&[(0.0, 2.0), (0.0, 0.0)]),
        ];
        let not = [
            with(&[(1e-6, 1.0)]),
            // A notch that is narrow, walls that are thin, an antenna, a hole, and a slit.
            with(&[(0.0, 1.0 + 1e-12), (1.0, 1.0), (0.0, 1.0)]),
            with(&[(0.0, 2.0 - 1e-9), (2.0 - 1e-9, 2.0 - 1e-9), (2.0 - 1e-9, 1e-9), (0.0, 1e-9)]),
            with(&[(-1.0, 2.0), (0.0, 2.0)]),
            with(&[(0.5, 1.5), (0.5, 0.5), (1.5, 0.5), (1.5, 1.5), (0.5, 1.5), (0.0, 2.0)]),
            with(&[(1.0, 1.0), (0.0, 2.0)]),
            // Two triangles that touch in a corner.
            chain(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (2.0, 0.0), (1.0, 1.0), (0.0, 2.0)]),
        ];
        let mut rng = seeded(179);
        for round in 0..200 {
            let turn = DMat2::from_angle(rng.random_range(0.0..6.3));
            for (i, is_filled) in
                (0..filled.len()).map(|i| (i, true)).chain((0..not.len()).map(|i| (i, false)))
            {
                let mut chain = if is_filled { filled[i].clone() } else { not[i].clone() };
                let first = rng.random_range(0..chain.len());
                chain.rotate_left(first);
                if rng.random() {
                    chain.reverse();
                }
                if round > 0 {
                    chain.iter_mut().for_each(|p| *p = turn * *p);
                }
                assert_eq!(fills_hull(&chain, 1e-8), is_filled, "round {round}: {chain:?}");
            }
        }
    }

    /// Law: two edges cross when looking at all pairs finds some, and they are the first of those; also where many edges share an x.
    #[test]
    fn the_first_crossing_is_found() {
        let mut rng = seeded(178);
        let (mut crossed, mut not) = (0, 0);
        for case in 0..4000 {
            let count = rng.random_range(3..[5, 12][case % 2]);
            let mut coordinate = || match case % 3 {
                0 => f64::from(rng.random_range(0..4)),
                _ => rng.random_range(-1.0..1.0),
            };
            let chain: Vec<DVec2> = (0..count).map(|_| DVec2::new(coordinate(), coordinate())).collect();
            let all: Vec<_> = edges(&chain).collect();
            let crosses = |&[i, j]: &[usize; 2]| segments_cross(all[i].0, all[i].1, all[j].0, all[j].1);
            let pairs = (0..count).flat_map(|i| (i + 1..count).map(move |j| [i, j]));
            let expected = pairs.into_iter().find(crosses);
            assert_eq!(crossing(&chain), expected, "case {case}: {chain:?}");
            *(if expected.is_some() { &mut crossed } else { &mut not }) += 1;
        }
        assert!(crossed > 1000 && not > 1000, "{crossed}, {not}");
    }
}
