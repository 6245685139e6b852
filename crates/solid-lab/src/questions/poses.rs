use std::f64::consts::PI;

use parry3d_f64::math::{Pose as ParryPose, Vector};
use parry3d_f64::query::NonlinearRigidMotion;
use rand::Rng;
use rand::rngs::StdRng;
use solid3d::glam::{DAffine3, DVec3};
use solid3d::query;

use super::kinds::Kind;
use crate::inputs::{PairPose, Pose, direction};
use crate::peers::contestants::parry::double::{self, vector};
use crate::peers::{Effort, Library};

/// Pairs of poses. What meets at all is in `meeting`, what does not in `apart`; `ways` begin far away and lead to each other.
pub struct Poses {
    /// Where both meet.
    pub meeting: Vec<Placed>,
    /// Where they do not.
    pub apart: Vec<Placed>,
    /// Where they come from, and where the second goes.
    pub ways: Vec<Way>,
}

/// Two poses, in the types of both libraries.
pub struct Placed {
    pub ours: [DAffine3; 2],
    pub theirs: [ParryPose; 2],
}

/// A way of the second shape; the first stays.
pub struct Way {
    pub from: Placed,
    /// Where it is after the whole way when it turns, and how it gets there.
    pub to: DAffine3,
    pub turning: [NonlinearRigidMotion; 2],
    /// How far it goes.
    pub motion: DVec3,
}

/// How far away ways begin.
const AWAY: f64 = 6.0;

/// How far beside the middle of the first shape ways lead.
const BESIDE: f64 = 0.6;

impl Poses {
    pub fn len(&self) -> usize {
        self.ways.len()
    }
}

/// Poses of two shapes.
pub fn of_pair(effort: Effort, rng: &mut StdRng, a: &Kind, b: &Kind) -> Poses {
    let meshes = [a, b].iter().filter(|kind| kind.theirs.as_trimesh().is_some()).count();
    let count = effort.sample([200, 40, 5][meshes]);
    let (mut meeting, mut apart) = (Vec::new(), Vec::new());
    while meeting.len() < count || apart.len() < count {
        let offset = direction(rng) * rng.random_range(0.3..2.4);
        let placed = Placed::new([Pose::random_at(rng, DVec3::ZERO), Pose::random_at(rng, offset)]);
        let [at_a, at_b] = &placed.ours;
        let meet = query::intersects(&a.ours, at_a, &b.ours, at_b).expect("the poses are valid");
        let side = if meet { &mut meeting } else { &mut apart };
        if side.len() < count {
            side.push(placed);
        }
    }
    let ways = (0..count).map(|_| Way::random(rng)).collect();
    Poses { meeting, apart, ways }
}

impl Placed {
    fn new(poses: PairPose) -> Placed {
        let theirs = [double::Parry::pose(&poses[0]), double::Parry::pose(&poses[1])];
        Placed { ours: poses.map(|pose| pose.affine()), theirs }
    }
}

impl Way {
    fn random(rng: &mut StdRng) -> Way {
        let from = direction(rng) * AWAY;
        let poses = [Pose::random_at(rng, DVec3::ZERO), Pose::random_at(rng, from)];
        let beside = direction(rng) * BESIDE;
        let to = Pose::random_at(rng, beside);
        let motion = to.translation - from;
        let placed = Placed::new(poses);
        // The shorter way around.
        let (axis, angle) = (to.rotation * poses[1].rotation.inverse()).to_axis_angle();
        let turn = axis * if angle > PI { angle - 2.0 * PI } else { angle };
        let [still, moving] = placed.theirs;
        let zero = Vector::ZERO;
        let turning = [
            NonlinearRigidMotion::new(still, zero, zero, zero),
            NonlinearRigidMotion::new(moving, zero, vector(motion), vector(turn)),
        ];
        Way { from: placed, to: to.affine(), turning, motion }
    }
}

/// A shape somewhere, and a point near it.
pub struct Sight {
    pub ours: DAffine3,
    pub theirs: ParryPose,
    pub point: DVec3,
}

/// Poses of one shape, away from the origin, and points in it or beside it.
pub fn of_one(effort: Effort, rng: &mut StdRng) -> Vec<Sight> {
    (0..effort.sample(500))
        .map(|_| {
            let place = direction(rng) * 3.0;
            let pose = Pose::random_at(rng, place);
            let point = pose.translation + direction(rng) * rng.random_range(0.0..1.3);
            Sight { ours: pose.affine(), theirs: double::Parry::pose(&pose), point }
        })
        .collect()
}
