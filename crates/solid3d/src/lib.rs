//! 3D collision detection.

pub mod bounds;
pub mod tree;

pub use bounds::Aabb;
pub use glam;
