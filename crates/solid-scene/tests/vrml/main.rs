//! VRML97 files, by way of the crate's own door.

mod animation;
mod bounds;
mod data;
mod files;
mod geometry;
mod hostile;
mod instances;
mod structure;
