//! Convex shapes as support mappings, and the algorithms that need nothing else of a shape: the
//! Gilbert-Johnson-Keerthi (GJK) family.
//!
//! A *support mapping* of a convex object `A` takes a direction `d` to a point of `A` that lies furthest along
//! `d`. Given the support mappings of two objects under affine placements, GJK finds a separating axis, a common
//! point, or the closest points, and [`epa`] how deep they are in each other (van den Bergen, *Collision Detection in Interactive 3D Computer Animation*, 1999,
//! sections 4.4.1 to 4.4.4).
//!
//! ```
//! use solid_convex::{Cuboid, Outcome, Sphere, gjk};
//! use glam::{DAffine3, DVec3};
//!
//! let ball = Sphere::new(1.0)?;
//! let block = Cuboid::new(DVec3::new(2.0, 2.0, 2.0))?;
//! let apart = DAffine3::from_translation(DVec3::new(3.0, 0.0, 0.0));
//! let outcome = gjk::intersection(&ball, &DAffine3::IDENTITY, &block, &apart);
//! assert!(matches!(outcome, Outcome::Separated { .. }));
//! # Ok::<(), solid_convex::SizeError>(())
//! ```
//!
//! This crate knows no tree and no world; `solid3d` builds on it.

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod chord;
#[doc(hidden)]
pub mod determinant;
mod difference;
#[doc(hidden)]
pub mod direction;
pub mod epa;
mod feature;
pub mod gjk;
mod kinds;
mod polytope_difference;
mod rounded;
pub mod simd;
#[doc(hidden)]
pub mod similarity;
mod simplex;
mod size;
mod support;
#[cfg(test)]
mod testing;

pub use chord::{Chord, End, Line};
pub use epa::Penetration;
pub use gjk::{Closest, Impact, Outcome, Witness};
pub use kinds::{Capsule, Cone, Cuboid, Cylinder, FaceTowards, IndexedPoints, Points, Polytope, Sphere};
pub use size::{MAGNITUDE_MAX, MAGNITUDE_MIN, SizeError, unit_scale};
pub use support::{Locus, Support};

pub use glam;
