use rand::rngs::StdRng;
use solid_oracle::generate::in_cube;

use super::pose::{PairPose, Pose, rotation};

/// So often is the interval of the cube's side halved; the sample is coarser than that.
const HALVINGS: usize = 20;

/// `count` random placements of a pair, of which about the share `rate` intersect.
///
/// Thesis, section 5.2.4: random rotations, the local origins at random in a cube whose side makes the rate what it is. The side is
/// found by bisection on these placements themselves; `reach` is one at which hardly any of them intersect.
pub fn pairs_at_overlap(
    rng: &mut StdRng,
    count: usize,
    rate: f64,
    reach: f64,
    intersects: impl FnMut(usize, &PairPose) -> bool,
) -> Vec<PairPose> {
    let drawn: Vec<PairPose> = (0..count)
        .map(|_| [(); 2].map(|()| Pose { rotation: rotation(rng), translation: in_cube(rng) }))
        .collect();
    let side = side_at_overlap(&drawn, rate, reach, intersects);
    drawn.iter().map(|pair| pair.map(|pose| pose.scaled(side))).collect()
}

/// By what to multiply the translations so that the share `rate` of the pairs intersects.
pub(super) fn side_at_overlap(
    drawn: &[PairPose],
    rate: f64,
    reach: f64,
    mut intersects: impl FnMut(usize, &PairPose) -> bool,
) -> f64 {
    let (mut near, mut far) = (0.0, reach);
    for _ in 0..HALVINGS {
        let side = 0.5 * (near + far);
        let hits =
            (0..drawn.len()).filter(|&i| intersects(i, &drawn[i].map(|pose| pose.scaled(side)))).count();
        if hits as f64 > rate * drawn.len() as f64 { near = side } else { far = side }
    }
    far
}
