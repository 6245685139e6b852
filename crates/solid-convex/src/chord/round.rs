//! The sphere, the cylinder and the capsule.

use glam::DVec3;

use super::{Chord, End, Line, evening, is_slim, slab};
use crate::{Capsule, Cylinder, Sphere};

/// The chord of a ball whose centre is on the axis y, at `center`.
#[inline(always)]
fn ball(line: &Line, foot: DVec3, center: f64, radius: f64) -> Option<Chord> {
    let along = line.along;
    // From the point closest to the centre: the square of the distance loses nothing to that along the line.
    let middle = center * along.y * line.inverse_square;
    let offset = foot + along * middle - DVec3::Y * center;
    let inside = radius * radius - offset.length_squared();
    let half = (inside >= 0.0).then(|| (inside * line.inverse_square).sqrt())?;
    let shorten = 1.0 / radius;
    let end =
        |from_middle: f64| End { t: middle + from_middle, normal: (offset + along * from_middle) * shorten };
    Some(Chord { enter: end(-half), leave: end(half) })
}

/// The chord of the endless cylinder around the axis y.
#[inline(always)]
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
    let end = |t: f64| on_side(foot, along, radius, t);
    Some(Chord { enter: end(middle - half), leave: end(middle + half) })
}

/// An end on the side of a cylinder around the axis y.
#[inline(always)]
fn on_side(foot: DVec3, along: DVec3, radius: f64, t: f64) -> End {
    let normal = DVec3::new(foot.x + t * along.x, 0.0, foot.z + t * along.z);
    End { t, normal: normal / radius }
}

/// The chord of a cylinder around the axis y.
#[inline(always)]
fn capped_cylinder(foot: DVec3, along: DVec3, radius: f64, half_height: f64) -> Option<Chord> {
    endless_cylinder(foot, along, radius)?.and(slab(foot, along, 1, half_height)?)
}

impl Sphere {
    /// The part of a line that is in the ball.
    #[inline(always)]
    pub fn chord(&self, line: &Line) -> Option<Chord> {
        let (foot, scale) = line.near(self.radius())?;
        line.chord(ball(line, foot, 0.0, self.radius() * scale), scale)
    }
}

/// The chord of a cylinder around the axis y, in a space in which it is about as wide as it is long.
#[cold]
#[inline(never)] // the way of the others is short
fn slim_chord(line: &Line, radius: f64, half_height: f64) -> Option<Chord> {
    let by = evening(radius, half_height);
    let image = Cylinder::new(radius * by.x, 2.0 * half_height).ok()?;
    line.stretched(half_height, by, |line| image.chord(line))
}

impl Cylinder {
    /// The part of a line that is in the cylinder.
    #[inline(always)]
    pub fn chord(&self, line: &Line) -> Option<Chord> {
        let (radius, half) = (self.radius(), 0.5 * self.height());
        if is_slim(radius, half) {
            return slim_chord(line, radius, half);
        }
        let (foot, scale) = line.near(radius.max(half))?;
        line.chord(capped_cylinder(foot, line.along, radius * scale, half * scale), scale)
    }
}

impl Capsule {
    /// The part of a line that is in the capsule.
    #[inline(always)]
    pub fn chord(&self, line: &Line) -> Option<Chord> {
        let (radius, half) = (self.radius(), 0.5 * self.height());
        if is_slim(radius, half) {
            // Its ends are no more than rounding beyond the cylinder's.
            return slim_chord(line, radius, half);
        }
        let (foot, scale) = line.near(radius + half)?;
        let (radius, half) = (radius * scale, half * scale);
        let end = |center: f64| ball(line, foot, center, radius);
        // Its flat ends are within the balls, but for their rims, where the capsule is as steep as its side.
        let side = |end: End| on_side(foot, line.along, radius, end.t);
        let tube = capped_cylinder(foot, line.along, radius, half);
        let tube = tube.map(|tube| Chord { enter: side(tube.enter), leave: side(tube.leave) });
        let parts = [tube, end(half), end(-half)];
        line.chord(parts.into_iter().flatten().reduce(Chord::hull), scale)
    }
}
