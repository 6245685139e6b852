//! The faces of what is round: a circle as a polygon, or the line or point of the surface that faces a direction.

use std::f64::consts::{FRAC_1_SQRT_2, TAU};

use glam::{DVec2, DVec3};
use libm::atan2;
use smallvec::smallvec;
use solid_convex::{Capsule, Cone, Cylinder, Sphere, Support};

use super::super::SAME_DEPTH;
use super::{Corners, Face, Placed};

/// Corners of the polygon that stands for a circle: what is cut off is 2 % of the radius.
pub const RIM: u32 = 16;

/// The side of a capsule counts along its length up to 60 degrees.
pub const SIDE_COSINE: f64 = 0.5;

impl Placed<'_> {
    pub(super) fn ball(&self, sphere: &Sphere, direction: DVec3, local: DVec3) -> Face {
        let corners = smallvec![self.corner(sphere.support(local), 0)];
        Face { corners, normal: direction, number: 0, cosine: 1.0 }
    }

    pub(super) fn cylinder(&self, cylinder: &Cylinder, direction: DVec3, local: DVec3) -> Face {
        let (radius, half) = (cylinder.radius(), 0.5 * cylinder.height());
        let y = if local.y < 0.0 { -half } else { half };
        let cap = self.map.normal(DVec3::Y * y.signum());
        let (x, z) = azimuth(local);
        let side = self.map.normal(DVec3::new(x, 0.0, z));
        let (of_cap, of_side) = (cap.dot(direction), side.dot(direction));
        if of_cap >= of_side {
            let first = if y < 0.0 { RIM } else { 0 };
            let number = u32::from(y < 0.0);
            return Face { corners: self.rim(radius, y, first, local), normal: cap, number, cosine: of_cap };
        }
        let end = |y: f64, vertex: u32| self.corner(DVec3::new(radius * x, y, radius * z), vertex);
        let corners = smallvec![end(half, 2 * RIM), end(-half, 2 * RIM + 1)];
        Face { corners, normal: side, number: 2, cosine: of_side }
    }

    pub(super) fn cone(&self, cone: &Cone, direction: DVec3, local: DVec3) -> Face {
        let (radius, half) = (cone.radius(), 0.5 * cone.height());
        let base = self.map.normal(DVec3::NEG_Y);
        let (x, z) = azimuth(local);
        let largest = radius.max(cone.height());
        let (across, along) = (cone.height() / largest, radius / largest);
        let side = self.map.normal(DVec3::new(x * across, along, z * across));
        let (of_base, of_side) = (base.dot(direction), side.dot(direction));
        if of_base >= of_side {
            let corners = self.rim(radius, -half, RIM, local);
            return Face { corners, normal: base, number: 1, cosine: of_base };
        }
        let corners = smallvec![
            self.corner(DVec3::new(0.0, half, 0.0), 2 * RIM),
            self.corner(DVec3::new(radius * x, -half, radius * z), 2 * RIM + 1),
        ];
        Face { corners, normal: side, number: 2, cosine: of_side }
    }

    pub(super) fn capsule(&self, capsule: &Capsule, direction: DVec3, local: DVec3) -> Face {
        let (radius, half) = (capsule.radius(), capsule.half_height());
        let (x, z) = azimuth(local);
        let side = self.map.normal(DVec3::new(x, 0.0, z));
        let cosine = side.dot(direction);
        let upper = u32::from(local.y >= 0.0);
        let mut corners: Corners = smallvec![self.corner(capsule.support(local), upper)];
        if cosine >= SIDE_COSINE {
            let far = if local.y < 0.0 { half } else { -half };
            corners.push(self.corner(DVec3::new(radius * x, far, radius * z), 1 - upper));
        }
        Face { corners, normal: side, number: 0, cosine }
    }

    /// A circle across the axis y: corners at places that stay with the body, and, where it reaches further than these, the furthest point.
    fn rim(&self, radius: f64, y: f64, first: u32, local: DVec3) -> Corners {
        let corner = |(x, z): (f64, f64), vertex| self.corner(DVec3::new(radius * x, y, radius * z), vertex);
        let mut corners: Corners = (0..RIM).map(|i| corner(on_circle(i), first + i)).collect();
        let (x, z) = azimuth(local);
        let turn = atan2(z, x) / TAU;
        let before = (turn - turn.floor()) * f64::from(RIM);
        let beside = (before - before.round()) * TAU / f64::from(RIM);
        let beyond = 0.5 * beside * beside * radius;
        if beyond * DVec2::new(local.x, local.z).length() > SAME_DEPTH {
            corners.insert((before as usize + 1).min(RIM as usize), corner((x, z), 2 * RIM + 2));
        }
        corners
    }
}

/// The cosine and the sine of sixteenths of a turn.
fn on_circle(i: u32) -> (f64, f64) {
    /// Those of an eighth of half a turn.
    const COSINE: f64 = 0.923_879_532_511_286_7;
    const SINE: f64 = 0.382_683_432_365_089_8;
    let (x, z) = [(1.0, 0.0), (COSINE, SINE), (FRAC_1_SQRT_2, FRAC_1_SQRT_2), (SINE, COSINE)][i as usize % 4];
    [(x, z), (-z, x), (-x, -z), (z, -x)][i as usize / 4]
}

/// The direction across the axis y, as a unit vector; x when there is none.
fn azimuth(local: DVec3) -> (f64, f64) {
    let largest = local.x.abs().max(local.z.abs());
    if largest == 0.0 {
        return (1.0, 0.0);
    }
    let (x, z) = (local.x / largest, local.z / largest);
    let length = (x * x + z * z).sqrt();
    (x / length, z / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: the corners of a rim are those of a regular polygon, in order.
    #[test]
    fn a_rim_is_regular() {
        for i in 0..RIM {
            let angle = TAU * f64::from(i) / f64::from(RIM);
            let (x, z) = on_circle(i);
            assert!((x - angle.cos()).abs() < 1e-15 && (z - angle.sin()).abs() < 1e-15, "{i}: {x} {z}");
        }
    }
}
