//! Tree coordinates: `u = (x - origin) / scale`, `scale` a power of two, so that the root fits `[-1, 1]^3`.
//!
//! The origin keeps the resolution of `f32` on a mesh far from its local origin; the scale keeps it at any size, and
//! being a power of two it adds no rounding. What rounding there is (of `x - origin`, and to `f32`) goes outward.

use super::packed::{FAR, PackedBox};
use crate::Aabb;
use crate::exact::power_of_two;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4};
use glam::DVec3;
use solid_convex::simd::each;

/// The greatest magnitude of a coordinate of a primitive's box.
pub const COORDINATE_MAX: f64 = 1e100;

/// Relative growth of a coordinate on conversion: twice the unit roundoff of `f32`, 2^-24, of which one half pays for
/// rounding to `f32` and the other more than pays for that of `x - origin` to `f64`, 2^-53.
pub(super) const GROWTH_RELATIVE: f64 = f32::EPSILON as f64;

/// Absolute growth, in tree coordinates. It covers underflow, is below the resolution of `f64` on the root, 2^-53, and is so
/// far above the subnormal numbers of `f32` (which are slow) that a flat box does not meet them.
pub(super) const GROWTH: f64 = power_of_two(-60);

/// The root fills at most this much of `[-1, 1]`, so that it stays there when grown.
const FILL_MAX: f64 = 1.0 - 1.0 / 1048576.0;

/// A refit keeps the coordinates while the root fills at least this much: a mesh that moves a little keeps them.
const FILL_MIN: f64 = 0.125;

/// Bound on the exponent of the scale, so that the scale and its inverse are normal numbers.
const EXPONENT_MAX: i32 = 1022;

/// The exponent of the scale of a point, relative to its distance from the local origin.
const POINT_EXPONENT: i32 = -40;

/// The map from local to tree coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Normal {
    pub origin: DVec3,
    /// A power of two.
    pub scale: f64,
    /// `1 / scale`, exactly.
    pub inverse: f64,
}

impl Normal {
    /// The coordinates in which `bounds` fits `[-1, 1]^3`.
    pub fn of(bounds: &Aabb) -> Self {
        let origin = bounds.center();
        let radius = radius(bounds, origin);
        let distance = origin.abs().max_element();
        let exponent = match (radius > 0.0, distance > 0.0) {
            (true, _) => exponent_above(radius / FILL_MAX),
            (false, true) => exponent_above(distance) + POINT_EXPONENT,
            (false, false) => 0,
        };
        let exponent = exponent.clamp(-EXPONENT_MAX, EXPONENT_MAX);
        Normal { origin, scale: power_of_two(exponent), inverse: power_of_two(-exponent) }
    }

    /// Whether these coordinates still suit a root: it fits, and is not lost in them.
    pub fn suits(&self, bounds: &Aabb) -> bool {
        let fill = radius(bounds, self.origin) * self.inverse;
        (FILL_MIN..FILL_MAX).contains(&fill)
    }

    /// A box in tree coordinates, which contains the exact image of `bounds`.
    #[inline(always)]
    pub(super) fn pack(&self, bounds: &Aabb) -> PackedBox {
        let (min, max) =
            ((bounds.min - self.origin) * self.inverse, (self.origin - bounds.max) * self.inverse);
        let [x, y, z] = [round_down(min.x), round_down(min.y), round_down(min.z)];
        let [u, v, w] = [round_down(max.x), round_down(max.y), round_down(max.z)];
        PackedBox([x, y, z, FAR, u, v, w, FAR])
    }

    /// The same for a box that may be anywhere: beyond [`FAR`], where nothing is, it is cut off.
    #[inline(always)]
    pub(super) fn pack_any<S: Simd>(&self, simd: S, bounds: &Aabb) -> PackedBox {
        let far = f64::from(FAR);
        let [origin, min, max] = each(
            [self.origin, bounds.min, bounds.max],
            #[inline(always)]
            |p| f64x4::simd_from(simd, [p.x, p.y, p.z, p.z]),
        );
        // As `round_down`.
        let round = {
            #[inline(always)]
            |ends: f64x4<S>| {
                let ends = (ends * f64x4::splat(simd, self.inverse))
                    .min(f64x4::splat(simd, far))
                    .max(f64x4::splat(simd, -far));
                ends - (ends.abs() * f64x4::splat(simd, GROWTH_RELATIVE) + f64x4::splat(simd, GROWTH))
            }
        };
        PackedBox(simd.narrow_f64x4(round(min - origin), round(origin - max)).to_array())
    }

    /// A box in local coordinates, which contains the exact image of `packed`.
    pub(super) fn unpack(&self, packed: &PackedBox) -> Aabb {
        let [a, b, c, _, d, e, f, _] = packed.0.map(f64::from);
        let min = self.origin + DVec3::new(a, b, c) * self.scale;
        let max = self.origin - DVec3::new(d, e, f) * self.scale;
        // More than half of the last place: the scale is a power of two, and only the sum is rounded.
        let outward = |x: DVec3| x.abs() * f64::EPSILON + f64::MIN_POSITIVE;
        Aabb::new(min - outward(min), max + outward(max))
    }
}

/// An `f32` at most `v`, even if `v` itself is off by a few relative 2^-53. Half of the growth is left after rounding.
#[inline(always)]
pub(super) fn round_down(v: f64) -> f32 {
    (v - (v.abs() * GROWTH_RELATIVE + GROWTH)) as f32
}

/// The greatest distance along an axis from `origin` to the sides.
fn radius(bounds: &Aabb, origin: DVec3) -> f64 {
    (bounds.max - origin).max(origin - bounds.min).max_element()
}

/// The least `k` with `2^k > x`, for a positive normal `x`; a low bound for a subnormal one.
fn exponent_above(x: f64) -> i32 {
    (x.to_bits() >> 52) as i32 - 1022
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn powers_of_two() {
        assert_eq!(power_of_two(-3), 0.125);
        assert_eq!(power_of_two(exponent_above(1.0)), 2.0);
        assert_eq!(power_of_two(exponent_above(0.9)), 1.0);
        assert_eq!(GROWTH, 2f64.powi(-60));
    }

    proptest! {
        #[test]
        fn the_root_fits_and_rounding_goes_outward(
            a in prop::array::uniform3(-1.0..1.0f64), b in prop::array::uniform3(-1.0..1.0f64),
            far in -1e9..1e9f64, exponent in -290..90i32,
        ) {
            let size = 10f64.powi(exponent);
            let at = |p: [f64; 3]| (DVec3::from_array(p) + DVec3::splat(far.trunc())) * size;
            let bounds = Aabb::of_points([at(a), at(b)]);
            let normal = Normal::of(&bounds);
            prop_assert!(normal.suits(&bounds) || bounds.min == bounds.max);
            let packed = normal.pack(&bounds);
            prop_assert!(packed.min().iter().chain(&packed.max()).all(|u| u.abs() <= 1.0));
            prop_assert!(normal.unpack(&packed).contains(&bounds));
        }

        #[test]
        fn rounding_down_is_down_and_tight(v in -2.0..2.0f64, exponent in -70..0i32) {
            let v = v * 2f64.powi(exponent);
            let down = f64::from(round_down(v));
            prop_assert!(down < v);
            prop_assert!(v - down <= v.abs() * 2f64.powi(-22) + 2.0 * GROWTH);
        }
    }

    #[test]
    fn a_point_has_coordinates() {
        for p in [DVec3::ZERO, DVec3::splat(1e100), DVec3::new(0.0, 1e-310, -5.0)] {
            let normal = Normal::of(&Aabb::new(p, p));
            assert!(normal.unpack(&normal.pack(&Aabb::new(p, p))).contains(&Aabb::new(p, p)));
            assert!(normal.scale.is_normal() && normal.inverse.is_normal());
        }
    }
}
