//! Laws of the tree, against brute force.

mod build;
mod overlap;
mod pairs;
mod scenes;
mod timing;
