use glam::{DAffine3, DMat3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;

use super::{direction, in_cube};

/// What a placement may do to a shape besides moving it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PlacementKind {
    /// A rotation, up to rounding.
    Rigid,
    /// A rotation and one factor for all directions.
    UniformScale,
    /// A factor for each local axis, then a rotation.
    NonUniformScale,
    /// A shear and a factor for each local axis, then a rotation.
    Shear,
    /// As `NonUniformScale`, with a reflection.
    Mirror,
}

impl PlacementKind {
    /// Every kind.
    pub const ALL: [Self; 5] =
        [Self::Rigid, Self::UniformScale, Self::NonUniformScale, Self::Shear, Self::Mirror];
}

/// A placement of that kind; factors between 0.4 and 2.5, one in eight along the axes exactly, translation within
/// the cube from -1 to 1.
pub fn random_placement(rng: &mut StdRng, kind: PlacementKind) -> DAffine3 {
    let rotation = random_rotation(rng);
    let mut factor = || rng.random_range(0.4f64.ln()..=2.5f64.ln()).exp();
    let factors = DVec3::new(factor(), factor(), factor());
    let local = match kind {
        PlacementKind::Rigid => DMat3::IDENTITY,
        PlacementKind::UniformScale => DMat3::from_diagonal(DVec3::splat(factors.x)),
        PlacementKind::NonUniformScale => DMat3::from_diagonal(factors),
        PlacementKind::Mirror => DMat3::from_diagonal(factors * DVec3::new(1.0, -1.0, 1.0)),
        PlacementKind::Shear => {
            let mut slant = || rng.random_range(-1.0..=1.0);
            let shear =
                DMat3::from_cols(DVec3::X, DVec3::new(slant(), 1.0, 0.0), DVec3::new(slant(), slant(), 1.0));
            shear * DMat3::from_diagonal(factors)
        }
    };
    DAffine3 { matrix3: rotation * local, translation: in_cube(rng) }
}

fn random_rotation(rng: &mut StdRng) -> DMat3 {
    if rng.random_range(0..8) == 0 {
        return DMat3::IDENTITY;
    }
    let angle = rng.random_range(0.0..core::f64::consts::TAU);
    DMat3::from_quat(DQuat::from_axis_angle(direction(rng), angle))
}
