//! The cone.

use glam::DVec3;

use super::{Chord, End, Line, evening, is_slim, slab};
use crate::Cone;

/// A cone whose height is this part of its radius, or less, is no higher than the rounding of where a line is closest to its middle: its sides would be lost.
const FLAT: f64 = 16.0 * f64::EPSILON;

/// A normal this near to the apex, in the unit of length, that is on the wrong side of a line by the sine of [`WRONG_SIDE`], is of no digits.
const AT_APEX: f64 = 1e-6;

/// See [`AT_APEX`].
const WRONG_SIDE: f64 = 1e-9;

/// By how much, relative to it, the square of the steepness of a line that is parallel to the side may be off. Its `a` is -0: its endless root is then
/// that of those a little steeper. Where `a` is rounding, so would roots be that are one by it.
const PARALLEL: f64 = 16.0 * f64::EPSILON;

/// A quadratic `a t^2 + 2 b t + c`, whose sign says on which side of a double cone a point of a line is.
struct Quadratic {
    a: f64,
    b: f64,
    c: f64,
    /// What `b^2 - a c` is, found without that difference.
    discriminant: f64,
}

impl Quadratic {
    /// The roots in ascending order, endless when they are; `None` without real ones. A double root by rounding of a
    /// quadratic that opens downward counts: such a line runs through the apex.
    fn roots(&self) -> Option<[f64; 2]> {
        let Quadratic { a, b, c, discriminant } = *self;
        if discriminant < 0.0 && a > 0.0 {
            return None;
        }
        // No difference of nearly equal numbers (Press et al., *Numerical Recipes*, section 5.6).
        let q = -(b + discriminant.max(0.0).sqrt().copysign(b));
        if q == 0.0 {
            // Where `a` is 0 too, it has the sign of `c` everywhere.
            return (a != 0.0 || c <= 0.0).then_some([0.0, 0.0]);
        }
        let (x, y) = (q / a, c / q);
        Some([x.min(y), x.max(y)])
    }
}

/// The chord of the endless cone below its apex at `apex` on the axis y, which has the radius `radius` at `height` below it.
fn endless_cone(foot: DVec3, along: DVec3, apex: f64, radius: f64, height: f64) -> Option<Chord> {
    // A point at depth w below the apex and at distance s from the axis is in the double cone when
    // (height s)^2 - (radius w)^2 <= 0.
    let (h, r) = (height * height, radius * radius);
    let depth = apex - foot.y;
    // In b^2 - a c of a flat cone nearly all would cancel, and its sides be lost.
    let at_apex = foot * along.y + along * depth;
    let turn = foot.x * along.z - foot.z * along.x;
    let down = r * along.y * along.y;
    let steeper = down - h * (along.x * along.x + along.z * along.z);
    let quadratic = Quadratic {
        discriminant: h * (r * (at_apex.x * at_apex.x + at_apex.z * at_apex.z) - h * turn * turn),
        a: if steeper.abs() <= PARALLEL * down { -0.0 } else { -steeper },
        b: h * (foot.x * along.x + foot.z * along.z) + r * depth * along.y,
        c: h * (foot.x * foot.x + foot.z * foot.z) - r * depth * depth,
    };
    let depth_at = |t: f64| depth - t * along.y;
    // By the way from the axis alone: near to the apex the depth is rounded. At it that way is, too: where it leads to the wrong side of the
    // line, that of the line itself will do, which is `outward` along it.
    let normal =
        |x: f64, z: f64| DVec3::new(height * x, radius * (x * x + z * z).sqrt(), height * z).try_normalize();
    let end = |t: f64, outward: f64| {
        let (x, z) = (foot.x + along.x * t, foot.z + along.z * t);
        let is_off_apex = DVec3::new(x, depth_at(t), z).abs().max_element() > AT_APEX;
        let there = normal(x, z).filter(|normal| is_off_apex || normal.dot(along) * outward > -WRONG_SIDE);
        let normal = there.or_else(|| normal(along.x * outward, along.z * outward)).unwrap_or(DVec3::Y);
        End { t, normal }
    };
    let [first, last] = quadratic.roots()?;
    if quadratic.a > 0.0 {
        // Flatter than the cone: both ends are in one half of it, or at the apex.
        let below = depth_at(0.5 * first + 0.5 * last) >= 0.0;
        return below.then(|| Chord { enter: end(first, -1.0), leave: end(last, 1.0) });
    }
    // Steeper: from one end on downward; which is endless where the line is parallel to the side, in the upper half.
    Some(if along.y < 0.0 {
        Chord { enter: end(last, -1.0), ..Chord::WHOLE }
    } else {
        Chord { leave: end(first, 1.0), ..Chord::WHOLE }
    })
}

impl Cone {
    /// The part of a line that is in the cone.
    pub fn chord(&self, line: &Line) -> Option<Chord> {
        let (radius, half) = (self.radius(), 0.5 * self.height());
        if is_slim(radius, half) || 2.0 * half <= FLAT * radius {
            let by = evening(radius, half);
            let image = Cone::new(radius * by.x, self.height()).ok()?;
            return line.stretched(radius.max(half), by, |line| image.chord(line));
        }
        let (foot, scale) = line.near(radius.max(half))?;
        let (radius, half) = (radius * scale, half * scale);
        let sides = endless_cone(foot, line.along, half, radius, 2.0 * half)?;
        line.chord(sides.and(slab(foot, line.along, 1, half)?), scale)
    }
}
