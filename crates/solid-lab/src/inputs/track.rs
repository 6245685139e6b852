use rand::rngs::StdRng;
use solid_oracle::generate::in_cube;
use solid3d::glam::{DQuat, DVec3};

use super::pairs::side_at_overlap;
use super::pose::{PairPose, Pose, direction, rotation};

/// How far a coherent object moves in a frame, in radii.
const STEP: f64 = 0.01;

/// How far it turns in a frame, in degrees.
const TURN: f64 = 1.0;

/// So many placements decide the size of the cube.
const SAMPLE: usize = 400;

/// A coherent motion of two objects, frame by frame: each moves by 1 % of its radius, which is 1, and by 1 degree a frame, in a cube in
/// which the share `rate` of all placements intersect; at the walls it turns back.
pub fn track_at_overlap(
    rng: &mut StdRng,
    frames: usize,
    rate: f64,
    reach: f64,
    mut intersects: impl FnMut(&PairPose) -> bool,
) -> Vec<PairPose> {
    let drawn: Vec<PairPose> = (0..SAMPLE)
        .map(|_| [(); 2].map(|()| Pose { rotation: rotation(rng), translation: in_cube(rng) }))
        .collect();
    let side = side_at_overlap(&drawn, rate, reach, |_, pair| intersects(pair));
    let mut movers = [(); 2].map(|()| Mover::new(rng, side));
    (0..frames).map(|_| movers.each_mut().map(Mover::step)).collect()
}

struct Mover {
    pose: Pose,
    velocity: DVec3,
    spin: DQuat,
    side: f64,
}

impl Mover {
    fn new(rng: &mut StdRng, side: f64) -> Self {
        Mover {
            pose: Pose { rotation: rotation(rng), translation: in_cube(rng) * side },
            velocity: direction(rng) * STEP,
            spin: DQuat::from_axis_angle(direction(rng), TURN.to_radians()),
            side,
        }
    }

    fn step(&mut self) -> Pose {
        let before = self.pose;
        self.pose.translation += self.velocity;
        self.pose.rotation = (self.spin * self.pose.rotation).normalize();
        bounce(&mut self.velocity, self.pose.translation, self.side);
        before
    }
}

/// Turns a velocity back towards the cube [-side, side]^3 on every axis on which the position has left it.
pub(super) fn bounce(velocity: &mut DVec3, position: DVec3, side: f64) {
    for axis in 0..3 {
        if position[axis].abs() > side {
            velocity[axis] = -velocity[axis].abs().copysign(position[axis]);
        }
    }
}
