//! How two convex bodies lie to each other: along which normal, and how deep.

use glam::DVec3;
use solid_convex::{Penetration, Support, epa, gjk};

use super::super::closed_form;
use super::super::depth::of_common;
use super::Pair;

/// Closest points nearer to each other than this, in the unit of the pair, give a direction of few digits. A separating axis is better where it is that
/// direction up to those: across what is flat or straight it can only be off by their distance over the extent. At corners it may be any.
const NEAR: f64 = 1e-9;

/// How two convex bodies lie to each other.
#[derive(Clone, Copy)]
pub(super) struct Meeting {
    /// From `b` to `a`, unit.
    pub normal: DVec3,
    /// How far the normal may be off by the rounding of closest points; 0 of any other.
    pub tilt: f64,
    /// Negative for a gap. Space: common.
    pub depth: f64,
    /// The deepest point of each, or the closest. Space: common.
    pub on_a: DVec3,
    pub on_b: DVec3,
}

impl Meeting {
    /// Of what is known to have a common point.
    pub fn touching(self) -> Meeting {
        Meeting { depth: self.depth.max(0.0), ..self }
    }

    /// `None` for what is further apart than a margin.
    pub fn within(self, margin: f64) -> Option<Meeting> {
        (self.depth >= -margin).then_some(self)
    }
}

/// Of what lies to each other in some ways the deepest, the first of several.
pub(super) fn deepest<T>(meetings: impl Iterator<Item = (T, Meeting)>) -> Option<(T, Meeting)> {
    meetings.reduce(|most, other| if other.1.depth > most.1.depth { other } else { most })
}

impl Pair<'_> {
    /// How the shapes lie to each other, of which these are the bodies; `None` when they are further apart than the margin.
    pub(super) fn meeting_of_bodies(&self, a: &dyn Support, b: &dyn Support) -> Option<Meeting> {
        let of_any = || epa::penetration(a, self.a.placement, b, self.b.placement);
        self.meeting_by(closed_form::penetration(self.a, self.b).or_else(of_any), a, b)
    }

    /// How two primitives lie to each other; `None` when they are further apart than the margin. `must` says that they are known
    /// to have a common point.
    pub(super) fn meeting(&self, a: &dyn Support, b: &dyn Support, must: bool) -> Option<Meeting> {
        let (at_a, at_b) = (self.a.placement, self.b.placement);
        let found =
            if must { Some(of_common((a, at_a), (b, at_b))) } else { epa::penetration(a, at_a, b, at_b) };
        self.meeting_by(found, a, b)
    }

    /// The same by how deep they are in each other, if they are.
    fn meeting_by(&self, found: Option<Penetration>, a: &dyn Support, b: &dyn Support) -> Option<Meeting> {
        let (at_a, at_b) = (self.a.placement, self.b.placement);
        if let Some(found) = found {
            let [on_a, on_b] = self.placed(found.points);
            let depth = found.depth * self.frame.scale;
            return Some(Meeting { normal: found.direction, tilt: 0.0, depth, on_a, on_b });
        }
        if self.margin == 0.0 {
            return None;
        }
        let closest = gjk::closest_points(a, at_a, b, at_b);
        let distance = closest.distance * self.frame.scale;
        if distance > self.margin {
            return None;
        }
        let [on_a, on_b] = self.placed(closest.points);
        let between = (on_a - on_b).try_normalize();
        // Each end of the way is off by that; unit vectors never by more than 2.
        let tilt = (2.0 * self.frame.rounding / distance).min(2.0);
        let is_between = |axis: &DVec3| between.is_none_or(|between| between.distance(*axis) <= tilt);
        let axis = || match gjk::intersection(a, at_a, b, at_b) {
            gjk::Outcome::Separated { axis } => Some(axis).filter(is_between),
            _ => None,
        };
        let axis = if distance < NEAR { axis() } else { None };
        let (normal, tilt) = match axis {
            Some(axis) => (axis, 2.0 * tilt),
            None => (between?, tilt),
        };
        Some(Meeting { normal, tilt, depth: -distance, on_a, on_b })
    }
}
