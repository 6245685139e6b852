//! VRML97 files, by way of the crate's own door.

#![allow(clippy::print_stdout, reason = "tests tell what they found")]

mod animation;
mod bounds;
mod data;
mod files;
mod geometry;
mod hostile;
mod instances;
mod structure;
