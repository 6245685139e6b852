//! Laws of the tree, against brute force.

mod build;
mod nearest;
mod overlap;
mod pairs;
pub(super) mod scenes;
mod timing;
