//! Seeded random cases: the same seed gives the same cases on every machine.

mod pair;
mod placement;
mod shape;

pub use pair::{Pair, Regime, random_pair};
pub use placement::{PlacementKind, random_placement};
pub use shape::{random_flat, random_shape, random_sliver};

use glam::DVec3;
use rand::rngs::StdRng;
use rand::{Rng, SeedableRng};

/// The generator that every function of this module takes, from a seed to be printed by the test.
///
/// The environment variable `SOLID_SEED`, a number, is added to all seeds: so the same tests look at other cases. Some then say that
/// their cases are not representative; what else they say is a bug.
///
/// # Panics
/// If `SOLID_SEED` is not a number from 0 to 2^64 - 1.
pub fn seeded(seed: u64) -> StdRng {
    let more = std::env::var("SOLID_SEED").map_or(0, |more| {
        more.parse()
            .unwrap_or_else(|_| panic!("SOLID_SEED is {more:?}; it must be a number from 0 to 2^64 - 1"))
    });
    StdRng::seed_from_u64(seed.wrapping_add(more))
}

/// A direction, uniform on the sphere.
pub fn direction(rng: &mut StdRng) -> DVec3 {
    loop {
        let v = in_cube(rng);
        if (1e-3..=1.0).contains(&v.length_squared()) {
            return v.normalize();
        }
    }
}

/// A point, uniform in the cube from -1 to 1.
pub fn in_cube(rng: &mut StdRng) -> DVec3 {
    DVec3::from_array(core::array::from_fn(|_| rng.random_range(-1.0..=1.0)))
}

/// The triangles of a square grid of `side` times `side` vertices, row by row.
pub fn grid(side: u32) -> Vec<[u32; 3]> {
    let corners = (0..side * (side - 1)).filter(|i| i % side + 1 < side);
    corners.flat_map(|i| [[i, i + 1, i + side], [i + 1, i + side + 1, i + side]]).collect()
}

/// A number whose logarithm is uniform.
pub fn log_uniform(rng: &mut StdRng, low: f64, high: f64) -> f64 {
    rng.random_range(low.ln()..=high.ln()).exp()
}
