use std::f64::consts::{FRAC_PI_2, TAU};

use parry3d_f64::math::Pose as ParryPose;
use parry3d_f64::shape::TriMesh;
use rand::Rng;
use rand::rngs::StdRng;
use solid3d::glam::{DAffine3, DQuat, DVec3};
use solid3d::query::{self, ContactOptions};

use super::asked::{Asker, VALID, contact_points};
use super::kinds::{Kind, vectors};
use crate::inputs::{Mesh, Pose};
use crate::peers::Effort;
use crate::peers::contestants::Library;
use crate::peers::contestants::parry::double;

/// How the grounds are called, and by how much each stretches a terrain.
pub const GROUNDS: [(&str, DVec3); 2] =
    [("on flat ground", DVec3::new(5.0, 5.0, 0.0)), ("on hills", DVec3::new(5.0, 5.0, 2.5))];

/// How deep what stands on a ground is in it.
const DEPTH: f64 = 0.01;

/// A terrain of 5,000 triangles, of which some seventy are under a shape.
pub fn ground(effort: Effort, rng: &mut StdRng, (name, stretch): (&'static str, DVec3)) -> Kind {
    let mut terrain = Mesh::terrain(rng, effort.size(5_000));
    terrain.vertices.iter_mut().for_each(|vertex| *vertex *= stretch);
    let theirs = TriMesh::new(vectors(&terrain.vertices), terrain.triangles.clone());
    Kind { name, ours: terrain.shape(), theirs: Box::new(theirs.expect("the mesh is well formed")) }
}

/// Shapes of a kind that were let down on a ground, upright.
pub struct Standing<'k> {
    ground: &'k Kind,
    kind: &'k Kind,
    places: Vec<(DAffine3, ParryPose)>,
}

impl<'k> Standing<'k> {
    pub fn new(effort: Effort, rng: &mut StdRng, ground: &'k Kind, kind: &'k Kind) -> Self {
        let places = (0..effort.sample(100)).map(|_| {
            let rotation =
                DQuat::from_rotation_z(rng.random_range(0.0..TAU)) * DQuat::from_rotation_x(FRAC_PI_2);
            let high = DVec3::new(rng.random_range(-3.0..3.0), rng.random_range(-3.0..3.0), 4.0);
            let at = Pose { rotation, translation: high };
            let (here, still, down) = (DAffine3::IDENTITY, DVec3::ZERO, DVec3::NEG_Z * 8.0);
            let cast = query::cast_shape(&ground.ours, &here, still, &kind.ours, &at.affine(), down);
            let way = cast.expect(VALID).expect("the ground is below").time * 8.0 + DEPTH;
            let pose = Pose { translation: high - DVec3::Z * way, ..at };
            (pose.affine(), double::Parry::pose(&pose))
        });
        Standing { ground, kind, places: places.collect() }
    }

    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// All contacts, asked of ours and of parry.
    pub fn contacts(&self) -> (Asker<'_>, Option<Asker<'_>>) {
        let Standing { ground, kind, places } = self;
        let ours = |i: usize| {
            let (here, at) = (&DAffine3::IDENTITY, &places[i].0);
            let found = query::contacts(&ground.ours, here, &kind.ours, at, &ContactOptions::default());
            found.expect(VALID).iter().map(|manifold| manifold.points.len() as f64).sum()
        };
        let theirs = |i: usize| contact_points([ground, kind], [&ParryPose::IDENTITY, &places[i].1]);
        (Box::new(ours), Some(Box::new(theirs)))
    }
}
