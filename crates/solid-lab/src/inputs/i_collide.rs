use rand::rngs::StdRng;
use solid_oracle::generate::in_cube;
use solid3d::glam::{DQuat, DVec3};

use super::polyhedron::Polyhedron;
use super::pose::{Pose, direction, rotation};
use super::track::bounce;

/// More objects than this share shapes.
const SHAPES_MAX: usize = 100;

/// The settings of the multi-body simulation of I-COLLIDE; the defaults are those of the thesis, section 4.4.3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How many objects.
    pub objects: usize,
    /// How many vertices each has.
    pub vertices: usize,
    /// The share of the space that they fill.
    pub density: f64,
    /// How far an object moves in a frame, in radii.
    pub translation: f64,
    /// How far it turns in a frame, in degrees.
    pub rotation: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Settings { objects: 20, vertices: 20, density: 0.05, translation: 0.05, rotation: 10.0 }
    }
}

/// The multi-body simulation of I-COLLIDE: polyhedra that move freely in a cube, bounce off its walls, and exchange their
/// velocities where they collide (thesis, section 4.4.3).
#[derive(Clone, Debug)]
pub struct ICollide {
    /// The shapes; object `i` has shape `i % shapes.len()`.
    pub shapes: Vec<Polyhedron>,
    bodies: Vec<Body>,
    /// Half of that of the cube.
    pub side: f64,
}

#[derive(Clone, Debug)]
struct Body {
    pose: Pose,
    velocity: DVec3,
    spin: DQuat,
}

impl ICollide {
    /// The bodies at random in the cube.
    pub fn new(rng: &mut StdRng, settings: &Settings) -> Self {
        let shapes: Vec<Polyhedron> = (0..settings.objects.min(SHAPES_MAX))
            .map(|_| Polyhedron::random(rng, settings.vertices))
            .collect();
        let mean_volume = shapes.iter().map(Polyhedron::volume).sum::<f64>() / shapes.len() as f64;
        let side = 0.5 * (mean_volume * settings.objects as f64 / settings.density).cbrt();
        let bodies = (0..settings.objects)
            .map(|_| Body {
                pose: Pose { rotation: rotation(rng), translation: in_cube(rng) * side },
                velocity: direction(rng) * settings.translation,
                spin: DQuat::from_axis_angle(direction(rng), settings.rotation.to_radians()),
            })
            .collect();
        ICollide { shapes, bodies, side }
    }

    /// The shape of an object.
    pub fn shape_of(&self, object: usize) -> &Polyhedron {
        &self.shapes[object % self.shapes.len()]
    }

    /// Where the objects are.
    pub fn poses(&self) -> Vec<Pose> {
        self.bodies.iter().map(|body| body.pose).collect()
    }

    /// One frame, given the pairs that collide in the present one.
    pub fn step(&mut self, colliding: impl IntoIterator<Item = (usize, usize)>) {
        for (a, b) in colliding {
            let velocity = self.bodies[a].velocity;
            self.bodies[a].velocity = self.bodies[b].velocity;
            self.bodies[b].velocity = velocity;
        }
        for Body { pose, velocity, spin } in &mut self.bodies {
            pose.translation += *velocity;
            pose.rotation = (*spin * pose.rotation).normalize();
            bounce(velocity, pose.translation, self.side);
        }
    }
}
