//! Two shapes on their way from one frame to the next: the volume swept between (thesis, section 2.2.2, figure 2.5a).
//!
//! Motion between two frames is, by definition, straight for each point: from where it was to where it is, at constant speed,
//! as if vertices were interpolated. With `A0`, `A1` and `B0`, `B1` the two configurations of convex objects, the
//! difference `a - b` of any two of their points then moves straight from `A0 - B0` to `A1 - B1`, so
//!
//! ```text
//! A and B have a point in common at some time   =>   the origin lies in conv((A0 - B0) + (A1 - B1))    (+: union)
//! ```
//!
//! The right side is what is tested: a convex object with a trivial support mapping. It is the thesis's encapsulation of two
//! consecutive configurations, applied to the *relative* motion, and so closer than that of each object by itself: two
//! objects that fly side by side, or one behind the other, do not meet. When one of the two stands still, both are the same.
//!
//! Complex shapes are tested primitive by primitive, each with its vertices as they were and as they are.
//!
//! [`impact`](mod@impact) says when two shapes first meet on their way, straight or turning ([`Path`]).

mod advance;
mod bodies;
mod body;
mod complex_complex;
mod complex_convex;
mod convex_convex;
mod hulls;
mod impact;
mod moving_box;
mod path;
mod query;

use glam::DVec3;

use bodies::MovingClass;
pub(crate) use bodies::{Moving, deformation, moving_bounds};
pub(crate) use impact::{Meeting, TOLERANCE_MIN, impact};
pub use path::Path;

use super::Scratch;

/// Whether two moving shapes meet on their way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Encounter {
    /// They do not; convex shapes come with an axis, from `B` to `A`, that separates them at every time.
    None {
        /// The axis.
        axis: Option<DVec3>,
    },
    /// They may: a point that the hulls of both ends of the way, of one primitive each, have in common. Space: world.
    At(DVec3),
}

/// Whether two shapes meet on their way, the two ends included.
pub(crate) fn encounter(a: &Moving, b: &Moving, scratch: &mut Scratch) -> Encounter {
    match (a.class(), b.class()) {
        (MovingClass::Convex(a), MovingClass::Convex(b)) => convex_convex::encounter(a, b, scratch),
        (MovingClass::Complex(a), MovingClass::Convex(b)) => complex_convex::encounter(a, b, scratch),
        (MovingClass::Convex(a), MovingClass::Complex(b)) => complex_convex::encounter(b, a, scratch),
        (MovingClass::Complex(a), MovingClass::Complex(b)) => complex_complex::encounter(a, b, scratch),
    }
}

/// Whether the axis of an earlier test clearly separates two convex shapes at every time; both [`encounter`] and
/// [`intersection`](super::intersection) then say that they are apart.
pub(crate) fn still_separated(axis: &DVec3, a: &Moving, b: &Moving) -> bool {
    match (a.class(), b.class()) {
        (MovingClass::Convex(a), MovingClass::Convex(b)) => convex_convex::still_separated(axis, a, b),
        _ => false,
    }
}
