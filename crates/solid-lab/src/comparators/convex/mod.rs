//! Two convex polytopes: do they intersect, and how far apart are they?
//!
//! The letters are the thesis's: `v` is the point of the simplex closest to the origin, or an axis; `w` the support point of
//! A-B against it. A positive `v . w` separates.

mod body;
mod bsp_trees;
mod chung_wang;
mod cone;
mod counters;
mod edges;
mod enhanced_gjk;
mod gjk_distance;
mod isa_gjk;
mod johnson;
mod library;
mod lin_canny;
mod linear_program;
mod memory;
mod pair;
mod polytope;
mod signed_volumes;
#[cfg(test)]
mod tests;

pub use bsp_trees::BspTrees;
pub use chung_wang::ChungWang;
pub use counters::Counters;
pub use enhanced_gjk::EnhancedGjk;
pub use gjk_distance::{Distance, End, Rules, distance};
pub use isa_gjk::IsaGjk;
pub use johnson::Johnson;
pub use library::Library;
pub use lin_canny::{Feature, LinCanny};
pub use linear_program::LinearProgram;
pub use memory::Memory;
pub use pair::{Pair, SupportPoint};
pub use polytope::Polytope;
pub use signed_volumes::SignedVolumes;

/// A test of two polytopes that may learn something about the pair for the next time.
pub trait ConvexTest {
    /// What it is called in charts.
    fn name(&self) -> &'static str;

    /// Whether the polytopes intersect. `memory` is what the same test left for the same pair, or new.
    fn intersects(&mut self, pair: &Pair, memory: &mut Memory) -> bool;

    /// The work done so far.
    fn counters(&self) -> Counters;
}
