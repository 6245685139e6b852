//! In single precision.

use parry3d as parry;

type Real = f32;
const PEER: crate::peers::Peer = crate::peers::Peer::ParrySingle;

fn real(x: f64) -> Real {
    x as Real
}

fn double(x: Real) -> f64 {
    f64::from(x)
}

#[path = "library.rs"]
mod library;
pub use library::{Parry, Swarm};
