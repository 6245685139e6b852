//! `libsolid`: the C interface of SOLID 2.0 (thesis, appendix B), on `solid3d`. The headers in `include/SOLID` say what each
//! function does; `docs/solid2.md` compares it with the original.
//!
//! - `abi`: the functions that C sees. All `unsafe` of the crate is here: it turns pointers into values, checks what C's types
//!   do not, and turns errors and panics into codes. Nothing unwinds out of it, save what a client's own callback throws.
//! - `engine`: the state behind them, in one lock, all safe. It calls nobody back: a test is made collision by collision, so
//!   that callbacks run without the lock.
//! - `builder`: a complex shape under construction.
//! - `soup`: from polytopes over a vertex array to a `Shape`, and its deformation.
//! - `fault`: what a wrong call gives.

mod abi;
mod builder;
mod engine;
mod fault;
mod reference;
mod soup;

pub use abi::*;
