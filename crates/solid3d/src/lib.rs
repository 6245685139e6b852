//! 3D collision detection.

pub mod bounds;
pub mod broad;
pub mod hull;

pub use bounds::Aabb;
pub use glam;
