//! GJK in double-double arithmetic. Guesses only: nothing here is trusted before it is proven exactly.

mod gjk;
mod simplex;

pub(crate) use gjk::{Found, Limits, search};
pub(crate) use simplex::{Simplex, closest_on_affine_hull};
