//! Shapes, pairs and motions to measure on: the same for the same seed.
//!
//! Everything has a radius of about 1, so that speeds can be given in radii.

mod i_collide;
mod mesh;
mod pairs;
mod polyhedron;
mod pose;
mod primitive;
mod swarm;
mod track;

pub use i_collide::{ICollide, Settings};
pub use mesh::Mesh;
pub use pairs::pairs_at_overlap;
pub use polyhedron::Polyhedron;
pub use pose::{PairPose, Pose, direction, rotation};
pub use primitive::Primitive;
pub use swarm::Swarm;
pub use track::track_at_overlap;

use rand::SeedableRng;
use rand::rngs::StdRng;

/// The seed that is used when none is given.
pub const SEED: u64 = 1999;

/// The random numbers of a seed.
pub fn seeded(seed: u64) -> StdRng {
    StdRng::seed_from_u64(seed)
}

#[cfg(test)]
mod tests;
