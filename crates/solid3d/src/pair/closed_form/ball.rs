//! A ball, or a point, and a body that their placements leave what they are: all by how far the centre is from the surface of the body.

use fearless_simd::Simd;
use glam::DVec3;
use solid_convex::{Closest, Penetration, Witness};

use super::Relation;
use super::foot::{Foot, extent, of_body};
use super::quick::{MARGIN_TO_ERROR, View};
use crate::pair::Placed;

/// A ball and a body.
pub(super) struct BallAndBody<'a> {
    view: View<'a>,
    /// The centre, and where the surface is nearest to it: in the directions of the body's own space, from its origin. World units.
    center: DVec3,
    foot: Foot<DVec3>,
    /// World units.
    radius: f64,
    /// The least gap or overlap that is decided. World units.
    margin: f64,
}

/// A ball and a body, in this order, with the least gap or overlap that is decided. `None` for other shapes, for placements that are not a rotation
/// with a uniform scale, and for sizes that are not plain.
#[inline(always)]
pub(super) fn plain_view<'a, S: Simd>(
    simd: S,
    ball: Placed<'a>,
    body: Placed<'a>,
) -> Option<(View<'a>, f64)> {
    let (radius, extent) = (ball.shape.ball_radius()?, extent(&body.shape.body()?)?);
    let view = View::of(simd, [ball.placement, body.placement])?;
    let margin = view.margin([radius, extent])?;
    Some((view, margin))
}

impl<'a> BallAndBody<'a> {
    /// `None` for other shapes, for placements that are not a rotation with a uniform scale, for sizes that are not plain, and where the planes of a
    /// hull do not tell.
    #[inline(always)] // most callers want a part of it
    pub fn new<S: Simd>(simd: S, ball: Placed<'a>, body: Placed<'a>) -> Option<Self> {
        let (view, margin) = plain_view(simd, ball, body)?;
        let center = view.other_origin(1) / view.scales[1];
        let foot = of_body(&body.shape.body()?, view.scales[1], center)?;
        let radius = ball.shape.ball_radius()? * view.scales[0];
        Some(BallAndBody { view, center, foot, radius, margin })
    }

    /// The closest points of the two, where [`new`](Self::new) and [`closest`](Self::closest) say them.
    #[inline(always)]
    pub fn quickly_closest<S: Simd>(simd: S, ball: Placed<'a>, body: Placed<'a>) -> Option<Closest> {
        BallAndBody::new(simd, ball, body)?.closest()
    }

    #[inline(always)]
    fn gap(&self) -> f64 {
        self.foot.distance - self.radius
    }

    /// The outward normal of the body where it is nearest to the centre. Space: world.
    #[inline(always)]
    fn normal(&self) -> DVec3 {
        self.view.at[1].matrix3 * self.foot.normal / self.view.scales[1]
    }

    /// The same in the directions of the body's own space.
    #[inline(always)]
    pub fn own_normal(&self) -> DVec3 {
        self.foot.normal
    }

    /// Whether they intersect; `None` where GJK has to say.
    #[inline(always)]
    pub fn intersects(&self) -> Option<bool> {
        (self.gap().abs() > self.margin).then_some(self.gap() < 0.0)
    }

    /// Whether they intersect, with the evidence.
    #[inline(always)]
    pub fn relation(&self) -> Option<Relation> {
        Some(match self.intersects()? {
            true => Relation::Common(self.common_point()),
            false => Relation::Separated { axis: Some(self.normal()) },
        })
    }

    /// The closest points.
    #[inline(always)]
    pub fn closest(&self) -> Option<Closest> {
        Some(match self.intersects()? {
            true => Closest { distance: 0.0, points: self.common_point() },
            false => Closest { distance: self.gap(), points: self.facing(self.radius) },
        })
    }

    /// How deep they are in each other, where they intersect.
    #[inline(always)]
    pub fn penetration(&self) -> Option<Penetration> {
        if !self.intersects()? {
            return None;
        }
        let (depth, error) = (-self.gap(), self.margin * MARGIN_TO_ERROR);
        let points = self.facing(self.radius);
        Some(Penetration {
            depth,
            lower: depth - error,
            upper: depth + error,
            direction: self.normal(),
            points,
        })
    }

    /// The centre where it is in the body, else the point of the body that is nearest to it.
    #[inline(always)]
    fn common_point(&self) -> Witness {
        if self.foot.distance > 0.0 {
            self.facing(self.foot.distance)
        } else {
            Witness { on_a: DVec3::ZERO, on_b: self.center / self.view.scales[1] }
        }
    }

    /// The point of the body that is nearest to the centre, and the point so far from the centre towards it.
    #[inline(always)]
    fn facing(&self, way: f64) -> Witness {
        let on_a = self.view.local(0, self.normal()) * (-way / self.view.squares[0]);
        Witness { on_a, on_b: self.foot.at / self.view.scales[1] }
    }
}
