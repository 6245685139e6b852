use rand::Rng;
use rand::rngs::StdRng;
use solid3d::glam::{DAffine3, DVec3};

use crate::inputs::{Pose, rotation, seeded};

/// The random numbers of one part of an experiment: parts do not shift each other's.
pub fn stream(seed: u64, part: &str) -> StdRng {
    // FNV-1a (Fowler, Noll and Vo): any hash that stays what it is would do.
    let hash = part
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
    seeded(seed ^ hash)
}

/// A random rotation, the origin at the given place.
pub fn turned_at(rng: &mut StdRng, translation: DVec3) -> DAffine3 {
    Pose { rotation: rotation(rng), translation }.affine()
}

/// A random rotation, the origin at random in a cube around the origin with the given side (thesis, section 5.2.4).
pub fn placement(rng: &mut StdRng, side: f64) -> DAffine3 {
    let translation = DVec3::from_array([0; 3].map(|_| rng.random_range(-0.5..=0.5))) * side;
    turned_at(rng, translation)
}
