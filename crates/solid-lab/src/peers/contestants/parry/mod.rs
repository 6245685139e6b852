//! parry, the collision library of rapier and avian, in both precisions: one file, compiled for each.
#![allow(clippy::duplicate_mod, reason = "the two crates have the same names for different types")]

pub mod double;
pub mod single;
