//! Polytopes: convex hulls of points.

use glam::DVec3;

use crate::Support;

/// The convex hull of points: a polytope of any dimension, given by any points whose hull it is (thesis,
/// section 2.1.2). The support mapping is a scan over the points; ties go to the first.
///
/// ```
/// use solid_convex::{Points, Support};
/// use glam::DVec3;
/// let segment = [DVec3::ZERO, DVec3::X];
/// assert_eq!(Points::new(&segment).unwrap().support(DVec3::ONE), DVec3::X);
/// assert!(Points::new(&[]).is_none());
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Points<'a> {
    points: &'a [DVec3],
}

impl<'a> Points<'a> {
    /// The hull of `points`; `None` for no points.
    pub fn new(points: &'a [DVec3]) -> Option<Self> {
        (!points.is_empty()).then_some(Points { points })
    }
}

impl Support for Points<'_> {
    fn support(&self, direction: DVec3) -> DVec3 {
        furthest(self.points.iter().copied(), direction)
    }

    fn reach(&self) -> DVec3 {
        reach(self.points.iter().copied())
    }

    fn center(&self) -> DVec3 {
        mean(self.points.iter().copied())
    }

    fn is_polytope(&self) -> bool {
        true
    }
}

/// The convex hull of some vertices of a buffer, named by index: a primitive of a complex shape.
#[derive(Clone, Copy, Debug)]
pub struct IndexedPoints<'a> {
    vertices: &'a [DVec3],
    indices: &'a [u32],
}

impl<'a> IndexedPoints<'a> {
    /// The hull of the vertices that `indices` names; `None` for no index, or one out of range.
    pub fn new(vertices: &'a [DVec3], indices: &'a [u32]) -> Option<Self> {
        let in_range = indices.iter().all(|&i| (i as usize) < vertices.len());
        (!indices.is_empty() && in_range).then_some(IndexedPoints { vertices, indices })
    }

    fn points(&self) -> impl Iterator<Item = DVec3> + Clone + '_ {
        self.indices.iter().map(|&i| self.vertices[i as usize])
    }
}

impl Support for IndexedPoints<'_> {
    fn support(&self, direction: DVec3) -> DVec3 {
        furthest(self.points(), direction)
    }

    fn reach(&self) -> DVec3 {
        reach(self.points())
    }

    fn center(&self) -> DVec3 {
        mean(self.points())
    }

    fn is_polytope(&self) -> bool {
        true
    }
}

fn furthest(points: impl Iterator<Item = DVec3> + Clone, direction: DVec3) -> DVec3 {
    // The first, where no product is a number.
    let mut best = points.clone().next().unwrap_or_default();
    let mut best_dot = f64::NEG_INFINITY;
    for p in points {
        let dot = p.dot(direction);
        if dot > best_dot {
            (best, best_dot) = (p, dot);
        }
    }
    best
}

pub(super) fn reach(points: impl Iterator<Item = DVec3>) -> DVec3 {
    points.fold(DVec3::ZERO, |r, p| r.max(p.abs()))
}

/// The mean, each point divided before it is added, so that the sum stays in range.
pub(super) fn mean(points: impl Iterator<Item = DVec3> + Clone) -> DVec3 {
    let share = 1.0 / points.clone().count() as f64;
    points.map(|p| p * share).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a support point is one of the object, also where products overflow.
    #[test]
    fn products_may_overflow() {
        let points = [DVec3::X * 1e100, DVec3::new(1e100, 1.0, 0.0)];
        assert_eq!(Points::new(&points).unwrap().support(DVec3::X * -1e300), points[0]);
        assert_eq!(Points::new(&points).unwrap().support(DVec3::NAN), points[0]);
    }
}
