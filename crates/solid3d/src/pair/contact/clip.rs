//! What two convex polygons in a plane have in common, and where each of its corners comes from.

use glam::DVec2;
use smallvec::SmallVec;

use super::ring::against;

/// Coordinates are below some units: a point this far outside an edge is on it.
pub(super) const ON_EDGE: f64 = 1e-9;

/// Segments whose directions have a lesser sine between them run side by side.
pub(super) const PARALLEL_SINE: f64 = 0.01;

/// Where a corner comes from. Edge `i` of a polygon runs from its corner `i` to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Origin {
    /// A corner of the first polygon, in the second.
    OfA(usize),
    /// A corner of the second polygon, in the first.
    OfB(usize),
    /// An edge of each.
    Crossing(usize, usize),
}

impl Origin {
    fn swapped(self) -> Origin {
        match self {
            Origin::OfA(i) => Origin::OfB(i),
            Origin::OfB(i) => Origin::OfA(i),
            Origin::Crossing(i, j) => Origin::Crossing(j, i),
        }
    }
}

/// A corner of what is left.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clipped {
    pub at: DVec2,
    pub origin: Origin,
}

/// Two faces of four corners have at most eight in common.
pub(super) type Corners = SmallVec<[Clipped; 8]>;

/// The corners of the intersection of two convex polygons, either way around, segments or points. Of two segments or points only where
/// they run side by side.
pub(super) fn clip(a: &[DVec2], b: &[DVec2]) -> Corners {
    match (a.len(), b.len()) {
        (0, _) | (_, 0) => Corners::new(),
        (_, 3..) => against(a, b),
        (3.., _) => swapped(against(b, a)),
        (2, 2) => side_by_side([a[0], a[1]], [b[0], b[1]]),
        _ => Corners::new(),
    }
}

fn swapped(mut corners: Corners) -> Corners {
    corners.iter_mut().for_each(|corner| corner.origin = corner.origin.swapped());
    corners
}

/// The ends of what two segments have in common along their way, when that is the same.
fn side_by_side(a: [DVec2; 2], b: [DVec2; 2]) -> Corners {
    let (of_a, of_b) = (a[1] - a[0], b[1] - b[0]);
    let Some(along) =
        (if of_a.length_squared() >= of_b.length_squared() { of_a } else { of_b }).try_normalize()
    else {
        return Corners::new();
    };
    if of_a.perp_dot(of_b).abs() > PARALLEL_SINE * of_a.length() * of_b.length() {
        return Corners::new();
    }
    let place = |p: DVec2| along.dot(p);
    let range = |ends: [DVec2; 2]| {
        let [x, y] = ends.map(place);
        if x <= y { (x, y) } else { (y, x) }
    };
    let ((low_a, high_a), (low_b, high_b)) = (range(a), range(b));
    let within = |p: DVec2, low: f64, high: f64| (low - ON_EDGE..=high + ON_EDGE).contains(&place(p));
    let mut corners = Corners::new();
    for (i, at) in a.into_iter().enumerate() {
        if within(at, low_b, high_b) {
            corners.push(Clipped { at, origin: Origin::OfA(i) });
        }
    }
    for (j, at) in b.into_iter().enumerate() {
        let new = corners.iter().all(|corner| (place(corner.at) - place(at)).abs() > ON_EDGE);
        if within(at, low_a, high_a) && new {
            corners.push(Clipped { at, origin: Origin::OfB(j) });
        }
    }
    corners
}

/// Twice the area, positive when counter-clockwise.
pub(super) fn area(polygon: &[DVec2]) -> f64 {
    let first = polygon[0];
    polygon.windows(2).map(|edge| (edge[0] - first).perp_dot(edge[1] - first)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(center: DVec2, half: f64, turn: f64) -> Vec<DVec2> {
        let corner = |(x, y): (f64, f64)| center + DVec2::from_angle(turn).rotate(DVec2::new(x, y) * half);
        [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(corner).to_vec()
    }

    #[test]
    fn squares() {
        let unit = square(DVec2::ZERO, 1.0, 0.0);
        let count = |other: &[DVec2]| (clip(&unit, other).len(), clip(other, &unit).len());
        assert_eq!(count(&unit), (4, 4));
        assert_eq!(count(&square(DVec2::ZERO, 1.0, std::f64::consts::FRAC_PI_4)), (8, 8));
        assert_eq!(count(&square(DVec2::ONE, 1.0, 0.0)), (4, 4));
        assert_eq!(count(&square(DVec2::ONE * 3.0, 1.0, 0.0)), (0, 0));
        assert_eq!(count(&[DVec2::ZERO]), (1, 1));
        assert_eq!(count(&[DVec2::new(-3.0, 0.5), DVec2::new(3.0, 0.5)]), (2, 2));
        let small = square(DVec2::ZERO, 0.5, 0.0);
        assert!(clip(&unit, &small).iter().all(|corner| matches!(corner.origin, Origin::OfB(_))));
        let ring: Vec<DVec2> =
            (0..16).map(|i| 1.2 * DVec2::from_angle(f64::from(i) * std::f64::consts::FRAC_PI_8)).collect();
        let cut = clip(&square(DVec2::new(0.2, 0.1), 1.0, 0.0), &ring);
        assert!(cut.iter().all(|corner| corner.at.x > -0.8 - 1e-9 && corner.at.length() < 1.2 + 1e-9));
        let reversed: Vec<DVec2> = small.iter().rev().copied().collect();
        assert_eq!(clip(&unit, &reversed).len(), 4);
    }

    /// What runs along a sliver ends where that does.
    #[test]
    fn slivers() {
        for thin in [1e-2, 1e-4, 1e-6, 1e-8] {
            let sliver = [DVec2::ZERO, DVec2::X, DVec2::new(0.5, thin)];
            for (height, beyond) in [0.0, 1e-12, 1e-10, 0.1 * thin].into_iter().zip([1e-4, 1e-3, 1e-2, 1.0]) {
                let along = [DVec2::new(-beyond, height), DVec2::new(1.0 + beyond, height)];
                for corner in clip(&along, &sliver) {
                    assert!((-1e-5..=1.0 + 1e-5).contains(&corner.at.x), "{thin:e}, {height:e}: {corner:?}");
                }
            }
        }
    }

    #[test]
    fn segments_side_by_side() {
        let a = [DVec2::ZERO, DVec2::X * 2.0];
        let ends = |b: &[DVec2]| clip(&a, b).iter().map(|corner| corner.origin).collect::<Vec<_>>();
        assert_eq!(ends(&[DVec2::X * 3.0, DVec2::X]), [Origin::OfA(1), Origin::OfB(1)]);
        assert_eq!(ends(&a), [Origin::OfA(0), Origin::OfA(1)]);
        assert!(ends(&[DVec2::Y, DVec2::NEG_Y]).is_empty());
    }
}
