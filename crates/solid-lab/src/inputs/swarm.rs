use rand::rngs::StdRng;
use solid_oracle::generate::in_cube;
use solid3d::Aabb;
use solid3d::glam::DVec3;

use super::pose::direction;
use super::track::bounce;

/// How far a box moves in a frame, in its sides: 5 % of half of its diagonal, as the objects of I-COLLIDE.
const STEP: f64 = 0.043;

/// Moving unit cubes, so many in so large a space that there are about half as many overlapping pairs as cubes.
#[derive(Clone, Debug)]
pub struct Swarm {
    centers: Vec<DVec3>,
    velocities: Vec<DVec3>,
    /// Half of that of the space.
    side: f64,
}

impl Swarm {
    /// `n` cubes. Two of them overlap when their centres differ by less than 1 on each axis: n^2 / 2 pairs, each with a
    /// probability of 8 / volume, make n / 2 where the volume is 8 n.
    pub fn random(rng: &mut StdRng, n: usize) -> Self {
        let side = (n as f64).cbrt();
        let centers = (0..n).map(|_| in_cube(rng) * side).collect();
        let velocities = (0..n).map(|_| direction(rng) * STEP).collect();
        Swarm { centers, velocities, side }
    }

    /// The box of a cube.
    pub fn bounds(&self, i: usize) -> Aabb {
        Aabb::new(self.centers[i] - 0.5, self.centers[i] + 0.5)
    }

    /// The number of cubes.
    pub fn count(&self) -> usize {
        self.centers.len()
    }

    /// Moves the first `movers` cubes, which are spread at random over the space, by one frame.
    pub fn step(&mut self, movers: usize) {
        for (center, velocity) in self.centers.iter_mut().zip(&mut self.velocities).take(movers) {
            *center += *velocity;
            bounce(velocity, *center, self.side);
        }
    }
}
