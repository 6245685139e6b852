//! Arithmetic without rounding, and the predicates and the linear program built on it.

mod dyadic;
mod linear_program;
mod simplex;
mod vector;

pub(crate) use dyadic::Dyadic;
pub use linear_program::hulls_intersect_exact;
pub(crate) use linear_program::{Separation, separate};
pub(crate) use simplex::contains_origin;
pub(crate) use vector::ExactVec3;
