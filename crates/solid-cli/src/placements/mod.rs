//! Placements per frame from a CSV file, in place of a scene's animation.

mod fields;
mod file;
mod row;

pub use file::Placements;
pub use row::Row;
