//! Where a straight line runs through a convex shape: closed forms, one for each kind that has one, in the shape's own
//! space. An affine map takes lines to lines, so they serve under any placement.
//!
//! A line meets a convex set in an interval, a *chord*, perhaps endless or empty. A shape that is the intersection of simpler
//! sets has the intersection of their chords; a capsule, a union that is convex, has the hull of them.

mod cone;
mod polytope;
mod round;
#[cfg(test)]
mod tests;

use glam::DVec3;

use crate::direction::direction;
use crate::{Cuboid, unit_scale};

/// A line through a shape's own space, with a parameter `t`: the points `origin + t * direction`.
///
/// ```
/// use solid_convex::{Line, Sphere};
/// use glam::DVec3;
/// let line = Line::new(DVec3::new(-3.0, 0.0, 0.0), DVec3::new(2.0, 0.0, 0.0)).unwrap();
/// let chord = Sphere::new(1.0)?.chord(&line).unwrap();
/// assert_eq!((chord.enter.t, chord.leave.t), (1.0, 2.0));
/// assert_eq!(chord.enter.normal, DVec3::NEG_X);
/// assert!(Line::new(DVec3::ZERO, DVec3::ZERO).is_none());
/// # Ok::<(), solid_convex::SizeError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// The point of the line closest to the local origin: what is computed from it loses nothing to a far origin.
    foot: DVec3,
    /// The direction times `scale`: the unit of what is along the line.
    along: DVec3,
    /// The power of two by which the longest coordinate of `along` is from 1 to 2, so that squares neither overflow nor vanish.
    scale: f64,
    /// What `along` times itself is, inverted.
    inverse_square: f64,
    /// From the line's origin to the foot.
    to_foot: f64,
}

impl Line {
    /// `None` when the direction is zero or something is not finite. Coordinates may be up to 1e200.
    #[inline(always)]
    pub fn new(origin: DVec3, direction: DVec3) -> Option<Line> {
        let largest = direction.abs().max_element();
        if !(largest > 0.0 && largest.is_finite() && origin.is_finite()) {
            return None;
        }
        let scale = unit_scale(largest);
        let along = direction * scale;
        let inverse_square = 1.0 / along.length_squared();
        let behind = origin.dot(along) * inverse_square;
        let near = origin - along * behind;
        // Twice, because the first time leaves a part along the line that is small to the origin only.
        let rest = near.dot(along) * inverse_square;
        Some(Line { foot: near - along * rest, along, scale, inverse_square, to_foot: -behind - rest })
    }

    /// The foot in a unit near `size`, and the factor to that unit; `None` when the line clearly passes a shape that
    /// reaches no further than `size` along any axis.
    #[inline(always)]
    fn near(&self, size: f64) -> Option<(DVec3, f64)> {
        /// The foot of a line that meets such a shape is within sqrt(3) of it.
        const BEYOND: f64 = 2.0;
        let scale = unit_scale(size);
        (self.foot.abs().max_element() <= BEYOND * size).then(|| (self.foot * scale, scale))
    }

    /// The chord of a shape that reaches no further than `size`, by that of its image, with axes stretched by powers of two.
    #[cold]
    fn stretched(&self, size: f64, by: DVec3, image: impl Fn(&Line) -> Option<Chord>) -> Option<Chord> {
        /// What is left of the way to the foot is each time a part of 1e-32 of that before, down to 1e-200 of it where the image is stretched the most.
        const FEET: usize = 7;
        self.near(size)?;
        let mut line = Line::new(self.foot * by, self.along * by)?;
        for _ in 1..FEET {
            let nearer = Line::new(line.foot, line.along)?;
            line = Line { to_foot: line.to_foot + nearer.to_foot, foot: nearer.foot, ..line };
        }
        let chord = image(&line)?;
        // Normals go by the inverse transpose.
        let end = |end: End| End { t: end.t, normal: direction(end.normal * by).unwrap_or(end.normal) };
        self.chord(Some(Chord { enter: end(chord.enter), leave: end(chord.leave) }), 1.0)
    }

    /// A chord whose ends are measured along the line from its foot, in a unit of the given scale.
    #[inline(always)]
    fn chord(&self, span: Option<Chord>, scale: f64) -> Option<Chord> {
        let unit = 1.0 / scale;
        let end = |end: End| End { t: (self.to_foot + end.t * unit) * self.scale, ..end };
        span.map(|chord| Chord { enter: end(chord.enter), leave: end(chord.leave) })
    }
}

/// A round shape is slim whose radius is below this part of its length: fourth powers of it, which are computed in the unit of the length, would
/// soon have no digits.
const SLIM: f64 = 1e-60;

#[inline(always)]
fn is_slim(radius: f64, half_height: f64) -> bool {
    radius < SLIM * half_height
}

/// The powers of two along the axes by which what is around the axis y becomes about as wide as it is long.
fn evening(radius: f64, half_height: f64) -> DVec3 {
    let wide = unit_scale(radius) / unit_scale(half_height);
    DVec3::new(wide, 1.0, wide)
}

/// An end of a chord.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// Where on the line, as its parameter.
    pub t: f64,
    /// The outward normal of the surface there, a unit vector in the shape's own space.
    pub normal: DVec3,
}

/// The part of a line that is in a convex shape; `enter.t <= leave.t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chord {
    /// Where the line comes into the shape.
    pub enter: End,
    /// Where it leaves the shape.
    pub leave: End,
}

impl Chord {
    /// All of the line.
    const WHOLE: Chord = Chord {
        enter: End { t: f64::NEG_INFINITY, normal: DVec3::ZERO },
        leave: End { t: f64::INFINITY, normal: DVec3::ZERO },
    };

    /// What two chords of a line have in common.
    #[inline(always)]
    fn and(self, other: Chord) -> Option<Chord> {
        let enter = if other.enter.t > self.enter.t { other.enter } else { self.enter };
        let leave = if other.leave.t < self.leave.t { other.leave } else { self.leave };
        (enter.t <= leave.t).then_some(Chord { enter, leave })
    }

    /// From the first end to the last of two chords.
    #[inline(always)]
    fn hull(self, other: Chord) -> Chord {
        Chord {
            enter: if other.enter.t < self.enter.t { other.enter } else { self.enter },
            leave: if other.leave.t > self.leave.t { other.leave } else { self.leave },
        }
    }
}

/// The chord of what lies within `half` of the origin along an axis.
#[inline(always)]
fn slab(foot: DVec3, along: DVec3, axis: usize, half: f64) -> Option<Chord> {
    let (p, d) = (foot[axis], along[axis]);
    if d == 0.0 {
        return (p.abs() <= half).then_some(Chord::WHOLE);
    }
    let side = half.copysign(d);
    let mut normal = DVec3::ZERO;
    normal[axis] = 1f64.copysign(d);
    Some(Chord {
        enter: End { t: (-side - p) / d, normal: -normal },
        leave: End { t: (side - p) / d, normal },
    })
}

impl Cuboid {
    /// The part of a line that is in the box.
    ///
    /// ```
    /// use solid_convex::{Cuboid, Line};
    /// use glam::DVec3;
    /// let line = Line::new(DVec3::new(0.0, 0.0, 3.0), DVec3::NEG_Z).unwrap();
    /// let chord = Cuboid::new(DVec3::splat(2.0))?.chord(&line).unwrap();
    /// assert_eq!((chord.enter.t, chord.enter.normal), (2.0, DVec3::Z));
    /// # Ok::<(), solid_convex::SizeError>(())
    /// ```
    #[inline(always)] // into a kernel
    pub fn chord(&self, line: &Line) -> Option<Chord> {
        let half = 0.5 * self.size();
        let (foot, scale) = line.near(half.max_element())?;
        let slab = |axis: usize| slab(foot, line.along, axis, half[axis] * scale);
        let span = slab(0)?.and(slab(1)?)?.and(slab(2)?);
        line.chord(span, scale)
    }
}
