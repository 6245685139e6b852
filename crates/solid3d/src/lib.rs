//! 3D collision detection: SOLID (Gino van den Bergen, *Collision Detection in Interactive 3D Computer Animation*,
//! 1999), anew.

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod bounds;
pub mod broad;
pub mod ccd;
mod error;
mod exact;
pub mod hull;
mod pair;
mod placement;
pub mod polygon;
pub mod query;
mod shape;
mod threads;
pub mod tree;
mod triangle_triangle;
mod working;
mod world;

pub use bounds::Aabb;
pub use broad::BroadPhaseKind;
pub use error::{Error, Result};
pub use glam;
pub use shape::{ComplexShapeBuilder, OpenEdge, OpenEdges, Shape, ShapeKind};
pub use solid_convex as convex;
pub use world::{
    Boxes, Collision, Contact, Event, EventKind, Motion, Near, ObjectCast, ObjectDistance, ObjectHit,
    ObjectId, ObjectPoint, Response, Statistics, TestProgress, When, World, WorldOptions,
};

/// The code of the guide and of the README, as tests.
#[cfg(doctest)]
mod documents {
    #[doc = include_str!("../../../docs/guide.md")]
    struct Guide;
    #[doc = include_str!("../../../README.md")]
    struct Readme;
}
