//! Slow and right answers to collision queries, independent of the library they judge.
//!
//! # What is proven, and how
//! An answer is *searched* with GJK in double-double arithmetic ([`search`](crate::verdict())) and then *proven* with
//! exact dyadic arithmetic, which shares no code with the search. Every `f64` is a dyadic rational, so placing a point
//! (a product and a sum) never rounds; the only roots, those of the round shapes, are bounded from the proper side.
//!
//! 1. **Separated** rests on a verified axis: the exact support functions of both shapes leave a gap along it.
//! 2. **Intersecting** rests on at most four points of the Minkowski difference A-B, each the exact difference of a
//!    point proven to lie in A and a point proven to lie in B, whose convex hull is proven to contain the origin.
//! 3. For two polytopes an exact linear program decides what the search could not: they are never uncertain.
//!
//! # Layers, from the ground
//! `exact` (dyadic numbers, the linear program) and `double_double` know no shapes; `shape` and `placed` know no
//! queries; `search` and `penetration` guess; `verdict`, `distance` and `mesh` prove; `generate` makes the cases.
//!
//! All input numbers must be finite and between about 1e-30 and 1e30 in magnitude (or zero).

mod decide;
mod distance;
mod double_double;
mod exact;
pub mod generate;
mod known_answers;
mod mesh;
mod penetration;
mod placed;
mod search;
mod shape;
mod verdict;

pub use distance::{contains_within, distance_bounds};
pub use exact::hulls_intersect_exact;
pub use known_answers::known_answers;
pub use mesh::{mesh_distance, mesh_pairs, triangle_distance, triangles_intersect, winding_number};
pub use penetration::penetration_bounds;
pub use placed::verify_axis;
pub use shape::Convex;
pub use verdict::{Verdict, verdict};
