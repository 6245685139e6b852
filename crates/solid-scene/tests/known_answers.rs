//! Answers that other libraries, exact arithmetic and published test suites give, against ours.
//!
//! The data is in the folder that the environment variable `SOLID_DATA` names; without it every test says so and passes.
//! Each test prints how many rows it compared, how many of them hit, and the worst error.
#![cfg(test)]

#[path = "known_answers/bad_meshes.rs"]
mod bad_meshes;
#[path = "known_answers/casts.rs"]
mod casts;
#[path = "known_answers/ccd.rs"]
mod ccd;
#[path = "known_answers/convex.rs"]
mod convex;
#[path = "known_answers/data.rs"]
mod data;
#[path = "known_answers/deform.rs"]
mod deform;
#[path = "known_answers/faces.rs"]
mod faces;
#[path = "known_answers/hard_cases.rs"]
mod hard_cases;
#[path = "known_answers/motion.rs"]
mod motion;
#[path = "known_answers/queries.rs"]
mod queries;
#[path = "known_answers/rigid.rs"]
mod rigid;
#[path = "known_answers/simulation.rs"]
mod simulation;
#[path = "known_answers/tally.rs"]
mod tally;
#[path = "known_answers/touching.rs"]
mod touching;
