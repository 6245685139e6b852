//! Laws of the tree, against brute force.

mod build;
mod nearest;
mod overlap;
mod pairs;
mod scenes;
mod timing;
