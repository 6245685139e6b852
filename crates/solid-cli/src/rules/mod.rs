//! The response table: which pairs matter, and what is wanted of them, by the names of the objects.

mod file;
mod names;
mod pattern;
mod table;

pub use file::Rules;
pub use table::{Objects, apply};
