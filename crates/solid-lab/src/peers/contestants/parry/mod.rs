//! parry, the collision library of rapier and avian, in both precisions: one file, compiled for each.

pub mod double;
pub mod single;
