//! The convex outline of points in a plane, up to a tolerance.

use glam::DVec2;

/// The corners of the convex hull of points, counter-clockwise, as indices: without those that are within `tolerance` of the
/// line between their neighbours. At least one, if there is a point. Andrew's monotone chain, 1979; O(n log n).
pub(crate) fn outline(points: &[DVec2], tolerance: f64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    let by_place = |&i: &usize, &j: &usize| {
        points[i].x.total_cmp(&points[j].x).then(points[i].y.total_cmp(&points[j].y)).then(i.cmp(&j))
    };
    order.sort_unstable_by(by_place);
    let mut lower = chain(points, order.iter().copied());
    let mut upper = chain(points, order.iter().rev().copied());
    // Each ends where the other begins.
    lower.pop();
    upper.pop();
    lower.append(&mut upper);
    if lower.is_empty() {
        order.truncate(1)
    } else {
        order = lower
    }
    pruned(points, order, tolerance)
}

/// An outline without the corners that are within a tolerance of the line between their neighbours, or of one of these. In a pass of its
/// own: while the outline is made, what is left out could be an end.
fn pruned(points: &[DVec2], outline: Vec<usize>, tolerance: f64) -> Vec<usize> {
    let same = |i: usize, j: usize| points[i].distance(points[j]) <= tolerance;
    let mut kept: Vec<usize> = Vec::with_capacity(outline.len());
    for (place, &corner) in outline.iter().enumerate() {
        let before = kept.last().or(outline.last()).copied().unwrap_or(corner);
        let after = outline.get(place + 1).or(kept.first()).copied().unwrap_or(corner);
        let along = points[after] - points[before];
        let t = along.dot(points[corner] - points[before]);
        let straight = along.perp_dot(points[corner] - points[before]).abs() <= tolerance * along.length();
        let between = (0.0..=along.length_squared()).contains(&t) && straight && !same(before, after);
        let doubled = kept.iter().rev().take(1).chain(kept.first()).any(|&other| same(other, corner));
        if !doubled && !between {
            kept.push(corner);
        }
    }
    if kept.is_empty() { outline.into_iter().take(1).collect() } else { kept }
}

/// One half of the outline.
fn chain(points: &[DVec2], order: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut chain: Vec<usize> = Vec::new();
    for next in order {
        while let [.., from, middle] = *chain {
            let along = points[next] - points[from];
            let left = along.perp_dot(points[middle] - points[from]);
            if left < 0.0 {
                break;
            }
            chain.pop();
        }
        chain.push(next);
    }
    chain
}

#[cfg(test)]
mod tests {
    use rand::Rng;
    use solid_oracle::generate::seeded;

    use super::*;
    use crate::hull::Hull;

    /// Law: whatever their order, and however small, points of a lattice have the corners that their hull has, in order around it.
    #[test]
    fn corners_are_those_of_the_hull() {
        let mut rng = seeded(421);
        for case in 0..2000 {
            let unit = [1.0, 1.0 / 131_072.0][case % 2];
            let mut point =
                || DVec2::new(rng.random_range(0..5).into(), rng.random_range(0..5).into()) * unit;
            let points: Vec<DVec2> = (0..1 + case % 15).map(|_| point()).collect();
            let hull = Hull::of(&points.iter().map(|p| p.extend(0.0)).collect::<Vec<_>>()).unwrap();
            let mut expected: Vec<DVec2> = hull.vertices().iter().map(|&i| points[i as usize]).collect();
            let found: Vec<DVec2> = outline(&points, 1e-9).into_iter().map(|i| points[i]).collect();
            let corner = |i: usize| found[i % found.len()];
            let turns = |i: usize| (corner(i + 1) - corner(i)).perp_dot(corner(i + 2) - corner(i));
            assert!(found.len() < 3 || (0..found.len()).all(|i| turns(i) > 0.0), "{points:?}: {found:?}");
            let by_place = |p: &DVec2, q: &DVec2| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y));
            let mut found = found;
            found.sort_by(by_place);
            expected.sort_by(by_place);
            assert_eq!(found, expected, "{points:?}");
        }
    }

    #[test]
    fn only_corners_are_left() {
        let grid: Vec<DVec2> = (0..25).map(|i| DVec2::new((i % 5) as f64, (i / 5) as f64)).collect();
        assert_eq!(outline(&grid, 1e-9), [0, 4, 24, 20]);
        assert_eq!(outline(&grid[..5], 1e-9), [0, 4]);
        assert_eq!(outline(&[DVec2::ONE; 3], 1e-9).len(), 1);
        assert_eq!(outline(&[DVec2::X, DVec2::ZERO], 1e-9).len(), 2);
        // Noise in the coordinate that is sorted by.
        let noisy = [(0.0, 0.0), (1e-17, 1.0), (2e-17, 0.5), (1.0, 0.5), (1e-16, 1e-16)].map(DVec2::from);
        assert_eq!(outline(&noisy, 1e-9).len(), 3);
        assert!(outline(&[], 1e-9).is_empty());
    }
}
