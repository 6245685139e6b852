//! A point and a body that its placement leaves what it is.

use std::hint::select_unpredictable;

use fearless_simd::{Simd, f64x2, prelude::*};
use glam::{DAffine3, DMat3, DVec3};
use solid_convex::simd::dispatch;
use solid_convex::{MAGNITUDE_MAX, unit_scale};

use super::GAP_MIN;
use super::foot::{Foot, extent, is_within, of_body};
use super::similarity::{stretch, to_body, to_world};
use crate::error::Result;
use crate::pair::{Placed, SignedDistance};
use crate::shape::Body;

/// The point of a shape that is closest to another point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestPoint {
    /// The closest point of the shape. Space: world.
    pub point: DVec3,
    /// The distance to it, at least 0.
    pub distance: f64,
}

/// A point beside a body that its placement leaves what it is, in the body's own directions.
struct Beside<'a> {
    body: Body<'a>,
    linear: &'a DMat3,
    /// What the scale of the placement times this is 1.
    shrink: f64,
    /// How many times its own size the body is. In the unit of the pair.
    stretch: f64,
    /// The unit of the pair, a power of two of the world's, in which the size of the data is in [1, 2): squares neither overflow nor underflow.
    unit: f64,
    /// From the body's origin. In the unit of the pair.
    point: DVec3,
}

impl<'a> Beside<'a> {
    /// `None` for a mesh or a complex shape, for placements that are not a rotation with a uniform scale, or not good, and for a point that is out of range.
    #[inline(always)]
    fn new<S: Simd>(simd: S, body: Placed<'a>, point: &DVec3) -> Option<Self> {
        let DAffine3 { matrix3: linear, translation } = body.placement;
        let of = body.shape.body()?;
        let extent = extent(&of)?;
        let stretch = stretch(simd, body.placement)?;
        // By pairs of numbers, as a copy is written: what is read in other pairs is waited for.
        let lanes = |v: &DVec3| (f64x2::from_slice(simd, &v.as_ref()[..2]), v.z);
        let (xy, z) = lanes(point);
        let (at_xy, at_z) = lanes(translation);
        let is_in_range =
            xy.abs().simd_le(f64x2::splat(simd, MAGNITUDE_MAX)).all_true() & (z.abs() <= MAGNITUDE_MAX);
        let xy = xy - at_xy;
        let offset = DVec3::new(xy.as_slice()[0], xy.as_slice()[1], z - at_z);
        let scale = unit_scale(extent * stretch + offset.abs().element_sum());
        let shrink = 1.0 / stretch;
        let point = to_body(linear, offset * scale) * shrink;
        is_in_range.then_some(Beside {
            body: of,
            linear,
            shrink,
            stretch: stretch * scale,
            unit: 1.0 / scale,
            point,
        })
    }

    /// A vector in the body's own directions as the world has it.
    #[inline(always)]
    fn turned(&self, v: DVec3) -> DVec3 {
        to_world(self.linear, v) * self.shrink
    }
}

/// Whether a point is in a body; `None` where it is too near to the surface to tell. The placement need not have been checked: that of an answer is good.
pub(crate) fn contains(body: Placed, point: DVec3) -> Option<bool> {
    dispatch!(simd => {
        let beside = Beside::new(simd, body, &point)?;
        is_within(&beside.body, beside.stretch, beside.point, 0.0, GAP_MIN)
    })
}

/// The point of the surface of a body nearest to a point of the world; by another way as [`Beside::new`] says, and in a hull, or near to it, where its planes
/// do not tell. The placement as in [`contains`].
pub(crate) fn nearest_on_surface(
    body: Placed,
    point: DVec3,
    otherwise: impl Fn() -> Result<SignedDistance>,
) -> Result<SignedDistance> {
    // What is given back is written once, where the caller has it.
    dispatch!(simd => match foot_beside(simd, body, point) {
        Some((beside, foot)) => {
            Ok(SignedDistance {
                distance: foot.distance * beside.unit,
                point: body.placement.translation + beside.turned(foot.at) * beside.unit,
                normal: beside.turned(foot.normal),
            })
        }
        None => otherwise(),
    })
}

/// The point of a body that is closest to a point of the world; by another way as [`nearest_on_surface`] says, and too near to the surface.
pub(crate) fn closest_to(
    body: Placed,
    point: DVec3,
    otherwise: impl Fn() -> Result<ClosestPoint>,
) -> Result<ClosestPoint> {
    dispatch!(simd => match foot_beside(simd, body, point) {
        Some((beside, foot)) if foot.distance.abs() > GAP_MIN => {
            let on_surface = body.placement.translation + beside.turned(foot.at) * beside.unit;
            // Nobody can foretell which it is.
            let (is_inside, outside) = (foot.distance < 0.0, foot.distance * beside.unit);
            let pick = |k: usize| select_unpredictable(is_inside, point[k], on_surface[k]);
            Ok(ClosestPoint {
                point: DVec3::new(pick(0), pick(1), pick(2)),
                distance: select_unpredictable(is_inside, 0.0, outside),
            })
        }
        _ => otherwise(),
    })
}

/// Where the surface is nearest.
#[inline(always)]
fn foot_beside<S: Simd>(simd: S, body: Placed, point: DVec3) -> Option<(Beside, Foot<DVec3>)> {
    let beside = Beside::new(simd, body, &point)?;
    let foot = of_body(&beside.body, beside.stretch, beside.point)?;
    Some((beside, foot))
}
