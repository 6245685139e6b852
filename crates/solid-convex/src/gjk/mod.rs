//! GJK and its incremental form: do two objects intersect, along which axis are they separate, how far apart are they?
//!
//! One descent (Algorithm 4.1 of the thesis) serves all: it walks from simplex to simplex in `A - B`, each nearer to the
//! origin than the one before, until the question asked is answered. What differs from the thesis, and why:
//!
//! - Three outcomes instead of two. [`Separated`](Outcome::Separated) is claimed only with an axis along which the gap
//!   exceeds the rounding error, [`Intersecting`](Outcome::Intersecting) only with a tetrahedron whose exact signs say
//!   that it contains the origin; what is neither is [`Touching`](Outcome::Touching).
//! - No absolute tolerance: everything is scaled by a power of two to size one first ([`TOUCHING_ERROR`]).
//! - The thesis ends on a repeated support point (section 4.4.4). So does this, but only after the normal of the final
//!   simplex was computed anew from the edges of the two objects, which gives it the precision of the edges instead of
//!   that of the positions; a plate of 1000 x 1000 x 0.001 needs it.

mod again;
mod balls;
mod cast;
mod clock;
mod coherent;
mod descent;
mod distance;
mod intersection;
mod lean;
mod nearby_feature;
mod nearest;
mod newton;
mod pairs;
mod proof;
mod task;
#[cfg(test)]
mod tests;

pub use balls::{Ball, Balls, Glance, glance, glance_by};
pub use cast::{CAST_ERROR, Impact, cast};
pub use coherent::{Coherent, Memory};
pub(crate) use descent::{End, Goal, descend};
pub(crate) use distance::DISTANCE_TOLERANCE;
pub use distance::{
    Closest, ClosestInWorld, closest_points, closest_points_or_axis, closest_points_within, quickly_closest,
};
pub use intersection::{
    Outcome, Witness, intersection, intersects, intersects_closely, separates, separating_axis,
};
pub(crate) use newton::{nearest_boundary, newton};
pub(crate) use pairs::Pair;
pub use proof::{Decision, Proof, Vertices};

/// Objects nearer to each other than this, or overlapping less, relative to the size of the data, may be reported
/// as touching. The size of the data is the sum of the objects' extents and of the distance of their local origins.
///
/// The rounding of positions alone accounts for 1e-14 of it. The rest is for thin slivers of facets, as a cone's surface
/// makes them near its tip. Of 1.2 * 10^6 pairs of all kinds, half of them flat or thin down to 10^-9, with a gap of 2, 10 or 1,000 times this
/// opened along their normal, and of 2 * 10^5 with 1.05 times this, none was said to touch.
pub const TOUCHING_ERROR: f64 = 1e-12;

/// A gap or a depth beyond which no question takes objects to touch, in the unit of the difference.
pub(crate) const BEYOND_TOUCHING: f64 = 4.0 * TOUCHING_ERROR;
