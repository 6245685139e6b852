//! The laboratory: every system that the thesis compares and every experiment of it, measured again, and the library set
//! beside those that users would pick instead.
//!
//! - [`comparators`]: the other systems, each behind a trait, each judged by the oracle. None of them is in the library.
//! - [`inputs`]: shapes, pairs and motions to measure on, from a seed.
//! - [`experiments`]: the tables and figures of the thesis.
//! - [`peers`]: the library, the thesis's design and parry, on the same inputs in one run.
//! - [`questions`]: every question of every pair of kinds beside parry.
//! - [`threads`]: one thread against two.
//! - [`document`]: where the results are put.

pub mod comparators;
pub mod document;
pub mod experiments;
pub mod inputs;
pub mod peers;
pub mod questions;
pub mod threads;
