//! Polyhedra, convex or not, as binary space partitionings: trees of planes whose leaves are inside or outside (thesis, sections 3.1.1
//! and 5.1.3).
//!
//! - [`BspTree`]: from a closed mesh; tells whether it contains a point.
//! - [`Merge`]: whether two of them intersect.
//!
//! # What is thin counts as nothing
//! Planes and cells are rounded. Everything is relative to the greatest coordinate of the objects, [`FLAT`] times which is the
//! *tolerance*: a point that near to a plane lies on it, so coplanar facets have one plane, and a cell that reaches no farther than that
//! beyond a plane is not cut by it. So cuts make no slivers along their plane; and solids that merely touch, or whose common part is
//! thinner than the tolerance, are apart.

mod build;
mod cell;
mod merge;
mod plane;
#[cfg(test)]
mod tests;

pub use build::{BspTree, Child, Node};
pub use merge::{Counters, Merge};
pub use plane::Plane;

/// How near to a plane a point lies on it, in greatest coordinates of the objects. A corner of a cell is where three planes meet; it is off
/// each by a few roundings (2^-53) divided by the sine of the angle between them. This leaves for the latter a factor of some 10^5.
pub const FLAT: f64 = 1e-10;
