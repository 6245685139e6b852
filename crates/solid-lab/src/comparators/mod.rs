//! The other systems: each behind the trait of its kind, each judged by the oracle or by brute force. None of them is in the
//! library.
//!
//! - [`convex`]: two convex polytopes. [`ConvexTest`](convex::ConvexTest).
//! - [`tree`]: two triangle meshes under hierarchies of bounding volumes. [`Volume`](tree::Volume).
//! - [`polygon`]: two polygons, as the thesis tests them.
//! - [`bsp`]: two solids as trees of planes.
//! - [`broad`]: many moving boxes. [`BroadTest`](broad::BroadTest).

pub mod broad;
pub mod bsp;
pub mod convex;
pub mod polygon;
pub mod tree;
