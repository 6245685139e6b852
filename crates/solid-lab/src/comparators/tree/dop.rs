use std::array;

use solid3d::glam::{DAffine3, DVec3};

use super::{Sat, Triangle, Volume};

/// How many directions the slabs of a k-DOP have: 18-DOPs in the count of Klosowski and others, who count both sides.
const K: usize = 9;

/// The axes, and the diagonals of the coordinate planes.
const DIRECTIONS: [DVec3; K] = [
    DVec3::X,
    DVec3::Y,
    DVec3::Z,
    DVec3::new(1.0, 1.0, 0.0),
    DVec3::new(1.0, -1.0, 0.0),
    DVec3::new(1.0, 0.0, 1.0),
    DVec3::new(1.0, 0.0, -1.0),
    DVec3::new(0.0, 1.0, 1.0),
    DVec3::new(0.0, 1.0, -1.0),
];

/// The discrete-orientation polytope of a k-DOP tree: what lies between k pairs of parallel planes. Space: that of the mesh.
///
/// Two trees are at different orientations, so the DOP of B is enclosed in slabs of A anew for each test, by the corners of its
/// box.
///
/// Source: Klosowski and others, *Efficient collision detection using bounding volume hierarchies of k-DOPs*, 1998.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dop {
    center: [f64; K],
    half: [f64; K],
}

/// Where tree B lies, and for each direction of A the reach along it of a unit of each half size of B's box.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    b_to_a: DAffine3,
    reach: [DVec3; K],
}

impl Volume for Dop {
    type Options = ();
    type Shared = Placed;
    type Frame = ();

    fn fit(triangles: &[Triangle], members: &[u32], (): ()) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; K], [f64::NEG_INFINITY; K]);
        for p in members.iter().flat_map(|&i| triangles[i as usize]) {
            for (i, direction) in DIRECTIONS.iter().enumerate() {
                let along = p.dot(*direction);
                low[i] = low[i].min(along);
                high[i] = high[i].max(along);
            }
        }
        Dop {
            center: array::from_fn(|i| 0.5 * (low[i] + high[i])),
            half: array::from_fn(|i| 0.5 * (high[i] - low[i])),
        }
    }

    /// Across the middle of the longest side of the box.
    fn split(&self, _: &[Triangle], _: &[u32]) -> (DVec3, f64) {
        let longest = DVec3::from_slice(&self.half).max_position();
        (DIRECTIONS[longest], self.center[longest])
    }

    fn size(&self) -> f64 {
        self.half[..3].iter().product()
    }

    fn shared(b_to_a: &DAffine3) -> Placed {
        let reach = DIRECTIONS.map(|direction| b_to_a.matrix3.mul_transpose_vec3(direction).abs());
        Placed { b_to_a: *b_to_a, reach }
    }

    fn frame(_: &Self, _: &Self, _: &DAffine3) {}

    fn frame_in_child_a((): &(), _: &Self) {}

    fn frame_in_child_b((): &(), _: &Self) {}

    fn exit_axis(a: &Self, b: &Self, placed: &Placed, (): &(), _: Sat) -> usize {
        let center = placed.b_to_a.transform_point3(DVec3::from_slice(&b.center));
        let half = DVec3::from_slice(&b.half);
        let apart = |i: usize| {
            let between = DIRECTIONS[i].dot(center) - a.center[i];
            between.abs() > (a.half[i] + placed.reach[i].dot(half)) * (1.0 + ROUNDING)
        };
        (0..K).find(|&i| apart(i)).map_or(0, |i| i + 1)
    }
}

/// Slabs are wider by this: some roundings.
const ROUNDING: f64 = 1e-14;
