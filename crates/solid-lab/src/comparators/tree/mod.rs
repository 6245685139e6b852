//! Two triangle meshes under binary hierarchies of bounding volumes (thesis, sections 5.2.3 to 5.2.5).
//!
//! One build, one traversal, and a [`Volume`] for each kind of tree: [`AlignedBox`] (the thesis's AABB tree), [`OrientedBox`]
//! (RAPID), [`Ball`] (sphere trees), [`Dop`] (k-DOP trees).

mod aligned_box;
mod build;
mod distance;
mod dop;
mod eigen;
mod oriented_box;
mod sat;
mod sphere;
#[cfg(test)]
mod tests;
mod traversal;
mod triangle;
mod volume;

pub use aligned_box::AlignedBox;
pub use build::{Child, Node, Tree};
pub use distance::distance;
pub use dop::Dop;
pub use oriented_box::{Fit, OrientedBox};
pub use sat::{Sat, Scalar, exit_axis};
pub use sphere::Ball;
pub use traversal::{Counters, Traversal};
pub use triangle::{Triangle, triangle_distance, triangles_intersect};
pub use volume::Volume;
