//! Placements per frame from a CSV file, in place of a scene's animation.
//!
//! ```csv
//! frame,object,tx,ty,tz,qx,qy,qz,qw
//! 0,ship,0,0,0,0,0,0,1
//! 12,ship,1.5,0,0,0,0,0.7071,0.7071
//! ```
//!
//! A row places an object from its frame on: a translation and a quaternion, which is normalised, and optionally a scale,
//! `sx,sy,sz`, which comes first. Rows come in any order; of two for the same object and frame the later one holds.

mod fields;
mod file;
mod row;

pub use file::Placements;
