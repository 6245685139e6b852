//! Many moving boxes: which overlap? (Thesis, sections 5.1 and 5.2.2.)

mod baraff;
mod field_tree;
mod filing;
mod linked_sweep;
mod order;
mod space_tree;
#[cfg(test)]
mod tests;
mod voxel_grid;

pub use baraff::Baraff;
pub use field_tree::FieldTree;
pub use linked_sweep::LinkedSweep;
use solid3d::Aabb;
pub use space_tree::{Cut, SpaceTree};
pub use voxel_grid::VoxelGrid;

/// Keeps the pairs of boxes that overlap while the boxes move. Boxes that touch overlap.
pub trait BroadTest {
    /// What it is called in charts.
    fn name(&self) -> &'static str;

    /// Moves some boxes, and brings the pairs up to date.
    ///
    /// # Panics
    /// When there is no box of that number.
    fn update(&mut self, moved: &[(u32, Aabb)]);

    /// The pairs that overlap, the smaller number first, ascending.
    fn pairs(&self) -> Vec<(u32, u32)>;

    /// The work done so far: swaps of neighbours for the sweeps, visits of cells for the others.
    fn steps(&self) -> u64;

    /// Tests of two boxes so far, where pairs are looked for anew in each frame; none for the sweeps.
    fn box_tests(&self) -> u64 {
        0
    }
}
