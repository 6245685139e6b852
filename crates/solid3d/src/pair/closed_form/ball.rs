//! A ball, or a point, and a body that their placements leave what they are: all by how far the centre is from the surface of the body.

use glam::DVec3;
use solid_convex::{Closest, Penetration, Witness};

use super::point::Seen;
use super::round::DISTANCE_ERROR;
use super::similarity::Similarity;
use super::{Gap, Relation};
use crate::pair::Placed;

/// A ball and a body.
pub(super) struct BallAndBody {
    /// The centre.
    seen: Seen,
    /// World units.
    radius: f64,
    ball: Similarity,
}

/// A ball, or a point, that its placement leaves one: with its radius in the world.
#[inline(always)]
pub(super) fn placed_ball(ball: Placed) -> Option<(Similarity, f64)> {
    let radius = ball.shape.ball_radius()?;
    let at = Similarity::new(&ball.placement.matrix3)?;
    let radius = radius * at.stretch;
    Some((at, radius))
}

/// Whether there is no gap of this size, in the unit of the pair; `None` where it is too small to tell.
fn intersects(gap: f64) -> Option<bool> {
    Gap { least: gap, greatest: gap }.intersects()
}

/// Whether a point is in a body, as [`BallAndBody`] says of a ball without a radius.
pub(crate) fn contains(body: Placed, point: DVec3) -> Option<bool> {
    intersects(Seen::new(body, point, 0.0)?.distance())
}

/// How far a point is from a body, and the point of the body that is nearest, in the world: as of a ball without a radius.
pub(crate) fn closest_to(body: Placed, point: DVec3) -> Option<(f64, DVec3)> {
    let seen = Seen::new(body, point, 0.0)?;
    Some(match intersects(seen.distance())? {
        true => (0.0, point),
        false => (seen.distance() / seen.scale, body.placement.translation + seen.to_surface()),
    })
}

impl BallAndBody {
    /// `None` for other shapes, and for placements that are not a rotation with a uniform scale.
    #[inline(always)] // most callers want a part of it
    pub fn new(ball: Placed, body: Placed) -> Option<BallAndBody> {
        let (at, radius) = placed_ball(ball)?;
        Some(BallAndBody { seen: Seen::new(body, ball.placement.translation, radius)?, radius, ball: at })
    }

    /// In the unit of the pair.
    fn gap(&self) -> f64 {
        self.seen.distance() - self.radius * self.seen.scale
    }

    /// Whether they intersect; `None` where GJK has to say.
    pub fn intersects(&self) -> Option<bool> {
        intersects(self.gap())
    }

    /// Whether they intersect, with the evidence.
    pub fn relation(&self) -> Option<Relation> {
        Some(match self.intersects()? {
            true => Relation::Common(self.common_point()),
            false => Relation::Separated { axis: Some(self.seen.normal()) },
        })
    }

    /// The closest points.
    pub fn closest(&self) -> Option<Closest> {
        Some(match self.intersects()? {
            true => Closest { distance: 0.0, points: self.common_point() },
            false => Closest { distance: self.gap() / self.seen.scale, points: self.facing(self.radius) },
        })
    }

    /// How deep they are in each other, where they intersect.
    pub fn penetration(&self) -> Option<Penetration> {
        if !self.intersects()? {
            return None;
        }
        let (depth, error) = (-self.gap() / self.seen.scale, DISTANCE_ERROR / self.seen.scale);
        let points = self.facing(self.radius);
        let (lower, upper) = (depth - error, depth + error);
        Some(Penetration { depth, lower, upper, direction: self.seen.normal(), points })
    }

    /// The centre where it is in the body, else the point of the body that is nearest to it.
    fn common_point(&self) -> Witness {
        let distance = self.seen.distance();
        if distance > 0.0 {
            self.facing(distance / self.seen.scale)
        } else {
            Witness { on_a: DVec3::ZERO, on_b: self.seen.point() }
        }
    }

    /// The point of the body that is nearest to the centre, and the point so far from the centre towards it.
    fn facing(&self, way: f64) -> Witness {
        Witness { on_a: self.ball.local(self.seen.normal() * -way), on_b: self.seen.on_surface() }
    }
}
