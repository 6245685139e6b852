//! In the plane: points in polygons, crossing edges.

use glam::DVec2;

use super::exact::{segment_contains, segments_cross, turn};

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

#[cfg(test)]
mod tests {
    use rand::Rng;
    use solid_oracle::generate::seeded;

    use super::*;

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
