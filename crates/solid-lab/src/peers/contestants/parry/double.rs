//! In double precision.

use parry3d_f64 as parry;

type Real = f64;
const PEER: crate::peers::Peer = crate::peers::Peer::ParryDouble;

fn real(x: f64) -> Real {
    x
}

fn double(x: Real) -> f64 {
    x
}

#[path = "library.rs"]
mod library;
pub use library::{Crowd, Parry, Swarm, vector};
