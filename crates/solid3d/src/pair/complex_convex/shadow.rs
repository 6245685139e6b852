//! The convex shape as the primitives of the complex one see it.

use std::cell::OnceCell;

use fearless_simd::Simd;
use glam::{DAffine3, DVec3};
use solid_convex::Support;
use solid_convex::gjk::Balls;
use solid_convex::similarity::SKEW_MAX;

use super::super::closed_form::Similarity;
use super::super::direct::Direct;
use super::super::frame::Frame;
use super::super::reach::convex_bounds;
use super::super::row::{Near, Row, exceed};
use crate::bounds::Aabb;
use crate::tree::Around;

/// Where a ball in a shape is this part of one around it, or more, the latter alone says how far the shape is: boxes say little more, and take as long.
pub(super) const ROUND: f64 = 0.4;

/// The convex shape in the common frame.
pub(super) struct Shadow<'s> {
    shape: &'s dyn Support,
    map: DAffine3,
    /// By which bounds are grown.
    margin: f64,
    /// A box around it, found when first asked for.
    bounds: OnceCell<Aabb>,
    /// A box around it in the space of the complex one, found when first asked for.
    in_complex: OnceCell<Aabb>,
    /// What tells the primitives looked at last from the shape, pointing to them; at first none.
    axis: DVec3,
    /// The greatest coordinate of the shape along it.
    greatest: f64,
}

impl<'s> Shadow<'s> {
    /// With bounds grown by a margin.
    pub fn new(shape: &'s dyn Support, frame: &Frame, margin: f64) -> Self {
        Shadow {
            shape,
            map: frame.common[1],
            margin,
            bounds: OnceCell::new(),
            in_complex: OnceCell::new(),
            axis: DVec3::ZERO,
            greatest: 0.0,
        }
    }

    /// A box around the shape.
    pub fn bounds(&self, direct: &Direct) -> &Aabb {
        self.bounds.get_or_init(|| {
            let bounds = match direct {
                Direct::Round(round) => round.bounds(),
                _ => {
                    let (Aabb { min, max }, to) =
                        (convex_bounds(self.shape, &self.map.matrix3), self.map.translation);
                    Aabb::new(min + to, max + to)
                }
            };
            bounds.inflated(self.margin)
        })
    }

    /// A box around the shape in the space of the complex one.
    pub fn in_complex(&self, frame: &Frame) -> &Aabb {
        self.in_complex.get_or_init(|| bounds_in_complex(self.shape, frame))
    }

    /// Where the shape is, in the space of the complex one: in all of these.
    pub fn around(&self, direct: &Direct, frame: &Frame) -> (Option<Aabb>, Around) {
        let within = |points: &[DVec3], radius: f64| {
            let points = points.iter().map(|&point| frame.b_to_a.transform_point3(point));
            Around { bounds: Aabb::of_points(points).inflated(frame.slack_in_a), radius }
        };
        let in_complex = || *self.in_complex(frame);
        if let Direct::Round(round) = direct {
            return (None, within(&round.local_ends, round.radius));
        }
        if let Some((Balls { inner, outer }, at)) = self.shape.balls().zip(Similarity::new(&self.map.matrix3))
        {
            let radius = outer.radius * at.stretch * (1.0 + 2.0 * SKEW_MAX) + self.margin;
            let ball = within(&[outer.center], radius);
            if inner.radius >= ROUND * outer.radius {
                return (None, ball);
            }
            return (Some(in_complex()), ball);
        }
        let center = self.shape.center();
        let (placed, bounds) = (self.map.transform_point3(center), self.bounds(direct));
        let furthest = (bounds.max - placed).max(placed - bounds.min);
        let ball = within(&[center], furthest.length());
        (Some(in_complex()), ball)
    }

    /// What told the primitives looked at last from the shape.
    pub fn axis(&self) -> DVec3 {
        self.axis
    }

    /// Takes another axis.
    pub fn turn(&mut self, axis: DVec3) {
        (self.axis, self.greatest) = (axis, self.reach(axis));
    }

    /// How far the shape reaches along a direction.
    fn reach(&self, direction: DVec3) -> f64 {
        let furthest = self.shape.support(self.map.matrix3.transpose() * direction);
        direction.dot(self.map.transform_point3(furthest))
    }

    /// Whether the triangle in a lane is apart from the shape by a gap, along the way from a point to what is closest to it.
    #[inline(always)]
    pub fn parted(&self, from: DVec3, known: &Near, lane: usize, gap: f64) -> bool {
        let way = -known.axis(lane);
        known.least[lane] - (self.reach(way) - way.dot(from)) >= gap
    }

    /// The lanes that are further along the axis than the shape, by a gap, as bits.
    #[inline(always)]
    pub fn beyond<S: Simd>(&self, simd: S, row: &Row, gap: f64) -> u32 {
        exceed(simd, &row.least_along(simd, self.axis), self.greatest + gap)
    }
}

/// A box around a convex shape in the space of the complex one, grown by the error of the map.
pub(super) fn bounds_in_complex(convex: &dyn Support, frame: &Frame) -> Aabb {
    let map = frame.b_to_a;
    let bounds = convex_bounds(convex, &map.matrix3);
    Aabb::new(bounds.min + map.translation, bounds.max + map.translation).inflated(frame.slack_in_a)
}
