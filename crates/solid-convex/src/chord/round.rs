//! The sphere, the cylinder and the capsule.

use glam::DVec3;

use super::{Chord, End, Line, slab};
use crate::{Capsule, Cylinder, Sphere};

/// The chord of a ball.
fn ball(foot: DVec3, along: DVec3, center: DVec3, radius: f64) -> Option<Chord> {
    let offset = foot - center;
    let middle = -offset.dot(along);
    // From the point closest to the centre: the square of the distance loses nothing to that along the line.
    let nearest = offset + along * middle;
    let squared = radius * radius - nearest.length_squared();
    let half = (squared >= 0.0).then(|| squared.sqrt())?;
    let end = |t: f64| End { t, normal: (offset + along * t) / radius };
    Some(Chord { enter: end(middle - half), leave: end(middle + half) })
}

/// The chord of the endless cylinder around the axis y.
fn endless_cylinder(foot: DVec3, along: DVec3, radius: f64) -> Option<Chord> {
    let across = along.x * along.x + along.z * along.z;
    if across == 0.0 {
        return (foot.x * foot.x + foot.z * foot.z <= radius * radius).then_some(Chord::WHOLE);
    }
    // Twice the area between the foot and the direction, in the plane: the distance from the axis times the length.
    let area = foot.x * along.z - foot.z * along.x;
    let squared = radius * radius * across - area * area;
    let half = (squared >= 0.0).then(|| squared.sqrt() / across)?;
    let middle = -(foot.x * along.x + foot.z * along.z) / across;
    let end = |t: f64| {
        let normal = DVec3::new(foot.x + t * along.x, 0.0, foot.z + t * along.z);
        End { t, normal: normal / radius }
    };
    Some(Chord { enter: end(middle - half), leave: end(middle + half) })
}

/// The chord of a cylinder around the axis y.
pub(super) fn capped_cylinder(foot: DVec3, along: DVec3, radius: f64, half_height: f64) -> Option<Chord> {
    endless_cylinder(foot, along, radius)?.and(slab(foot, along, 1, half_height)?)
}

impl Sphere {
    /// The part of a line that is in the ball.
    pub fn chord(&self, line: &Line) -> Option<Chord> {
        let (foot, scale) = line.near(self.radius())?;
        line.chord(ball(foot, line.along, DVec3::ZERO, self.radius() * scale), scale)
    }
}

impl Cylinder {
    /// The part of a line that is in the cylinder.
    pub fn chord(&self, line: &Line) -> Option<Chord> {
        let (radius, half) = (self.radius(), 0.5 * self.height());
        let (foot, scale) = line.near(radius.max(half))?;
        line.chord(capped_cylinder(foot, line.along, radius * scale, half * scale), scale)
    }
}

impl Capsule {
    /// The part of a line that is in the capsule.
    pub fn chord(&self, line: &Line) -> Option<Chord> {
        let (radius, half) = (self.radius(), 0.5 * self.height());
        let (foot, scale) = line.near(radius + half)?;
        let (radius, half) = (radius * scale, half * scale);
        let end = |y: f64| ball(foot, line.along, DVec3::Y * y, radius);
        let parts = [capped_cylinder(foot, line.along, radius, half), end(half), end(-half)];
        line.chord(parts.into_iter().flatten().reduce(Chord::hull), scale)
    }
}
