//! Laws of the tree, against brute force.

mod build;
mod nearest;
mod overlap;
mod pairs;
pub mod scenes;
mod slabs;
mod timing;
