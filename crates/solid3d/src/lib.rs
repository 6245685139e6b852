//! 3D collision detection.

pub mod bounds;

pub use bounds::Aabb;
pub use glam;
