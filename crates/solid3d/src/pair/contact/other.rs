//! What a primitive is in contact with, in the common frame.

use glam::DVec3;
use solid_convex::Support;
use solid_convex::simd::each;

use super::map::Map;

/// A convex body, or a primitive of the other soup.
#[derive(Clone, Copy)]
pub(super) struct Other<'a> {
    /// The number of a primitive; 0 of a body.
    pub primitive: u32,
    pub support: &'a dyn Support,
    pub map: &'a Map,
    /// Of a primitive, where its corners are, of what is round the ends of its core, which of a ball are one; none of others.
    pub corners: &'a [DVec3],
    /// How far it reaches around these.
    pub radius: f64,
}

impl Other<'_> {
    pub fn center(&self) -> DVec3 {
        self.map.point(self.support.center())
    }

    /// A point of it that is furthest along a direction.
    pub fn furthest(&self, direction: DVec3) -> DVec3 {
        self.map.point(self.support.support(self.map.linear().transpose() * direction))
    }

    /// How far it reaches back behind what of some points is furthest along a unit normal, and along its opposite.
    #[inline(always)]
    pub fn depths(&self, points: &[DVec3], out: DVec3) -> [f64; 2] {
        let [low, high] = extremes(points, out);
        let [behind, beyond] = self.extremes(out);
        [high - behind, beyond - low]
    }

    /// The former of these.
    pub fn depth(&self, points: &[DVec3], out: DVec3) -> f64 {
        highest(points, out) - self.lowest(out)
    }

    /// The least height along a unit vector.
    pub fn lowest(&self, direction: DVec3) -> f64 {
        if !self.corners.is_empty() {
            return extremes(self.corners, direction)[0] - self.radius;
        }
        direction.dot(self.furthest(-direction))
    }

    /// The least and the greatest height along a unit vector.
    #[inline]
    pub fn extremes(&self, direction: DVec3) -> [f64; 2] {
        if !self.corners.is_empty() {
            let [low, high] = extremes(self.corners, direction);
            return [low - self.radius, high + self.radius];
        }
        each([-direction, direction], |way| direction.dot(self.furthest(way)))
    }
}

/// The greatest height of points along a direction.
pub(super) fn highest(points: &[DVec3], direction: DVec3) -> f64 {
    extremes(points, direction)[1]
}

/// The least and the greatest height of points along a direction.
#[inline]
fn extremes(points: &[DVec3], direction: DVec3) -> [f64; 2] {
    let heights = points.iter().map(|point| direction.dot(*point));
    heights
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], height| [low.min(height), high.max(height)])
}
