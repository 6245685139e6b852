//! Distinct points, with exact predicates.

use glam::DVec3;

use crate::exact::{flatten, orient2d, orient3d};

/// A distinct corner: an index into [`Sites`].
pub(super) type Site = u32;
/// Two sites, ascending.
pub(super) type Edge = [Site; 2];
/// Three sites, ascending.
pub(super) type Face = [Site; 3];

/// Distinct points of the common frame in lexicographic order; so, along a line, sites are in order.
#[derive(Debug)]
pub(super) struct Sites(Vec<DVec3>);

impl Sites {
    pub fn new(points: impl Iterator<Item = DVec3>) -> Self {
        let mut all: Vec<DVec3> = points.map(without_negative_zero).collect();
        all.sort_unstable_by(lexicographic);
        all.dedup();
        Sites(all)
    }

    /// The site of a point that is one.
    pub fn of(&self, point: DVec3) -> Site {
        let point = without_negative_zero(point);
        self.0.binary_search_by(|p| lexicographic(p, &point)).expect("the point is a site") as Site
    }

    pub fn at(&self, site: Site) -> DVec3 {
        self.0[site as usize]
    }

    /// The side of a plane that a site lies on: exact. Zero also where the three sites span no plane.
    pub fn height(&self, [a, b, c]: [Site; 3], d: Site) -> f64 {
        orient3d(self.at(a), self.at(b), self.at(c), self.at(d))
    }

    /// Whether three sites turn to the left, when a coordinate axis is left out: exact.
    pub fn turn(&self, dropped_axis: usize, [a, b, c]: [Site; 3]) -> f64 {
        let at = |site: Site| flatten(dropped_axis, self.at(site));
        orient2d(at(a), at(b), at(c))
    }

    /// The first axis that can be left out without making three sites collinear; `None` if they are.
    pub fn dropped_axis(&self, sites: [Site; 3]) -> Option<usize> {
        (0..3).find(|&axis| self.turn(axis, sites) != 0.0)
    }
}

fn lexicographic(p: &DVec3, q: &DVec3) -> std::cmp::Ordering {
    p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).then(p.z.total_cmp(&q.z))
}

/// Equal points shall have equal bits.
fn without_negative_zero(p: DVec3) -> DVec3 {
    p + DVec3::ZERO
}
