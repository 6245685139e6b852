//! 3D collision detection: SOLID (Gino van den Bergen, *Collision Detection in Interactive 3D Computer Animation*,
//! 1999), anew.
//!
//! A [`Shape`] is geometry: a sphere, box, cone, cylinder, capsule or convex hull, or a mesh or soup of polytopes that may deform. A [`World`] holds
//! objects, each a shape at an affine placement, and finds every collision of those whose [`Response`] says that it matters.
//!
//! ```
//! use solid3d::{Shape, World, glam::{DAffine3, DVec3}};
//!
//! let mut world = World::new();
//! let floor = world.add(&Shape::cuboid([10.0, 1.0, 10.0])?, DAffine3::IDENTITY)?;
//! let ball = world.add(&Shape::sphere(0.5)?, DAffine3::from_translation(DVec3::Y * 3.0))?;
//! assert!(world.test().is_empty());
//!
//! world.set_placement(ball, DAffine3::from_translation(DVec3::Y * 0.75))?;
//! let collisions = world.test();
//! assert_eq!((collisions[0].a, collisions[0].b), (floor, ball));
//! # Ok::<(), solid3d::Error>(())
//! ```
//!
//! - [`query`] asks about one shape or two without a world: distances, depths, contacts, rays, casts, times of impact.
//! - [`hull`], [`polygon`] and [`ccd`] are of use by themselves: hulls of points, polygons with holes, vertices and edges that move.
//! - [`convex`], [`tree`] and [`broad`] are what all of it is built on: support mappings and GJK, the tree of a mesh, the broad phase.
//!
//! Lengths are in any unit, from 1e-100 to 1e100. Shapes, queries and worlds refuse bad input with an [`Error`] that names the argument, its
//! value and its limit. All types can be sent to and shared among threads; with the feature `rayon` a test, a build and a refit use those
//! of the current pool. Results are the same bits for any number of them, and on every machine.

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
mod solid_angle;
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

#[cfg(test)]
mod tests {
    use super::{Collision, Error, Shape, World, hull::Hull, query::PairCache};

    /// Law: what a program keeps may be kept anywhere, and used by any thread.
    #[test]
    fn all_is_shared_among_threads() {
        fn is_shared<T: Send + Sync + 'static>() {}
        is_shared::<(Shape, World, PairCache)>();
        is_shared::<(Hull, Error, Collision)>();
    }
}
