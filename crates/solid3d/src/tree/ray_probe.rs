//! A ray against the eight boxes of a node, in vectors.
//!
//! By slabs, in `f32`. In tree coordinates all boxes lie in `[-1, 1]^3`; a ray from afar is first moved to where it comes near, in `f64`.
//!
//! # Why nothing is lost
//!
//! The origin is not a point here but a box around it, so that what is computed in `f64`, and how the boxes of a moving box
//! grow, is all in one place: the sides of it are rounded outward to `f32`. Then a side of a slab is left to
//! `(side - origin) * inverse`: a difference whose sign is exact, and three roundings, of the difference, of the inverse and of the
//! product. [`ROUNDING`] is more than those of both ends of an interval, which is stretched by it (Ize, *Robust BVH Ray
//! Traversal*, 2013). A direction nearly along a plane has its least coordinate raised to [`DIRECTION_MIN`]; over the few
//! units of path that are left, the origin's box pays for that.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};
use glam::DVec3;
use solid_convex::unit_scale;

use super::TreeRay;
use super::node::WIDTH;
use super::normal::round_down;

/// Rounding of the two ends of an interval, relative: six times 2^-24, and some.
const ROUNDING: f32 = 4.0 * f32::EPSILON;

/// Relative rounding of what is computed in `f64`: some dozen operations.
pub(super) const ROUNDING_F64: f64 = 16.0 * f64::EPSILON;

/// The least coordinate of a direction whose greatest is from 1 to 2.
const DIRECTION_MIN: f64 = 1e-12;

/// More than what raising a direction's coordinate to [`DIRECTION_MIN`] moves over the path that is left.
const RAISED: f64 = 1e-10;

/// A ray from further away than this, beyond the moving box, is moved up. The tree lies within 1.
const FAR_AWAY: f64 = 4.0;

/// What is beyond is as good as endless, and its products do not overflow in `f32`.
const ENDLESS: f64 = 1e20;

/// The space of boxes in lanes.
pub(crate) struct Space {
    /// Tree coordinates, in which all boxes lie within 1, are those from here, times `inverse`.
    pub origin: DVec3,
    pub inverse: f64,
    /// Coordinates of lanes are tree coordinates times this, a power of two.
    pub scale: f64,
}

/// A ray in such a space, ready for lanes.
pub(crate) struct RayProbe {
    /// The sides of the origin's box that count for where a slab is entered, and where it is left.
    enter_from: [f32; 3],
    leave_from: [f32; 3],
    inverse: [f32; 3],
    /// Parameters times this are those of the lanes, from `start` on.
    speed: f64,
    start: f64,
}

impl RayProbe {
    /// `None` for a ray that clearly passes all boxes.
    pub fn new(space: &Space, ray: &TreeRay) -> Option<Self> {
        let to_tree = |v: DVec3| v * space.inverse;
        let largest = ray.direction.abs().max_element();
        // Rounded up, as the rounding of the origin is. Not cut off before it is added to that, which may be as far.
        let mut half = to_tree(ray.half_extents);
        let mut origin = to_tree(ray.origin - space.origin);
        let unit = unit_scale(largest);
        let direction = ray.direction * unit;
        let terms = to_tree(ray.origin.abs() + space.origin.abs());
        half += ROUNDING_F64 * (terms + half) + RAISED;
        let mut start = 0.0;
        if (origin.abs() - half).max_element() > FAR_AWAY {
            start = entry(origin, direction, half + FAR_AWAY)?;
            origin += direction * start;
            half += ROUNDING_F64 * (terms + DVec3::splat(start));
        }
        let low = (origin - half).to_array().map(|x| round_down(x.max(-ENDLESS) * space.scale));
        let high = (origin + half).to_array().map(|x| -round_down(-x.min(ENDLESS) * space.scale));
        let direction = direction.to_array().map(|d| d.abs().max(DIRECTION_MIN).copysign(d));
        let from =
            |ahead: bool| [0, 1, 2].map(|i| if (direction[i] > 0.0) == ahead { high[i] } else { low[i] });
        Some(RayProbe {
            enter_from: from(true),
            leave_from: from(false),
            inverse: direction.map(|d| (1.0 / (d * space.scale)) as f32),
            // One unit of the lanes' parameter is a way of `direction` in tree coordinates.
            speed: space.inverse / unit,
            start,
        })
    }

    /// A bound on the lanes' parameters, rounded up; negative when nothing is left.
    pub fn until(&self, until: f64) -> f32 {
        let left = until * self.speed - self.start;
        let slack = ROUNDING_F64 * self.start + f64::from(f32::MIN_POSITIVE);
        -round_down(-(left + slack).min(ENDLESS))
    }

    /// The lanes that it meets at a parameter up to `left`, as bits, and when it enters each.
    #[inline(always)]
    pub fn entries<S: Simd>(
        &self,
        simd: S,
        [mins, maxs]: [&[[f32; WIDTH]; 3]; 2],
        left: f32,
    ) -> (u32, [f32; WIDTH]) {
        let splat = |x: f32| f32x8::splat(simd, x);
        let mut enter = splat(0.0);
        let mut leave = splat(left);
        for axis in 0..3 {
            let (min, max) = (&mins[axis], &maxs[axis]);
            let (near, far) = if self.inverse[axis] > 0.0 { (min, max) } else { (max, min) };
            let inverse = splat(self.inverse[axis]);
            let near = (f32x8::from_slice(simd, near) - splat(self.enter_from[axis])) * inverse;
            let far = (f32x8::from_slice(simd, far) - splat(self.leave_from[axis])) * inverse;
            enter = near.max(enter);
            leave = (far * splat(1.0 + ROUNDING)).min(leave);
        }
        let enter = enter * splat(1.0 - ROUNDING);
        let hits = enter.simd_le(leave).to_bitmask() as u32;
        let mut enters = [0.0; WIDTH];
        enter.store_slice(&mut enters);
        (hits, enters)
    }
}

/// When a point comes into a box around the origin: `None` when it does not.
pub(crate) fn entry(origin: DVec3, direction: DVec3, half: DVec3) -> Option<f64> {
    let (mut enter, mut leave) = (0.0f64, f64::INFINITY);
    for axis in 0..3 {
        let (p, d, h) = (origin[axis], direction[axis], half[axis]);
        if d == 0.0 {
            if p.abs() > h {
                return None;
            }
            continue;
        }
        let side = h.copysign(d);
        enter = enter.max((-side - p) / d);
        leave = leave.min((side - p) / d);
    }
    (enter <= leave).then_some(enter)
}
