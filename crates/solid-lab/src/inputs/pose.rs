use std::f64::consts::TAU;

use rand::Rng;
use rand::rngs::StdRng;
use solid3d::glam::{DAffine3, DQuat, DVec3};

/// Where a rigid object is: what every library understands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// A unit quaternion.
    pub rotation: DQuat,
    /// Of the local origin.
    pub translation: DVec3,
}

/// The poses of a pair.
pub type PairPose = [Pose; 2];

impl Pose {
    /// No rotation, at the origin.
    pub const IDENTITY: Pose = Pose { rotation: DQuat::IDENTITY, translation: DVec3::ZERO };

    /// A random rotation, the origin at the given place.
    pub fn random_at(rng: &mut StdRng, translation: DVec3) -> Self {
        Pose { rotation: rotation(rng), translation }
    }

    /// The same, so many times as far from the origin.
    pub fn scaled(&self, factor: f64) -> Self {
        Pose { translation: self.translation * factor, ..*self }
    }

    /// The pose as a placement of `solid3d`.
    pub fn affine(&self) -> DAffine3 {
        DAffine3::from_rotation_translation(self.rotation, self.translation)
    }
}

/// A rotation, all equally likely. Source: Shoemake, *Uniform random rotations*, Graphics Gems III, 1992.
pub fn rotation(rng: &mut StdRng) -> DQuat {
    let [u, v, w]: [f64; 3] = [rng.random(), rng.random::<f64>() * TAU, rng.random::<f64>() * TAU];
    let (r, s) = ((1.0 - u).sqrt(), u.sqrt());
    DQuat::from_xyzw(r * v.sin(), r * v.cos(), s * w.sin(), s * w.cos()).normalize()
}

/// A unit vector, all equally likely.
pub fn direction(rng: &mut StdRng) -> DVec3 {
    let (height, turn): (f64, f64) = (rng.random_range(-1.0..=1.0), rng.random::<f64>() * TAU);
    let radius = (1.0 - height * height).sqrt();
    DVec3::new(radius * turn.cos(), radius * turn.sin(), height)
}
