use solid3d::glam::{DVec3, dvec3};

use super::bezier::{Patch, point};
use super::grid;
use super::newell::{HANDLE, HalfTube, KNOB_RADIUS, KNOB_ROUND, PROFILES, Profile, ROUND, SPOUT};
use crate::comparators::tree::Triangle;

/// Cells around a quarter of the body, and along each of its six profiles.
const BODY: [usize; 2] = [10, 6];

/// Cells around a half of the handle, and along each length of it.
const HANDLE_CELLS: [usize; 2] = [7, 8];

/// The same for the spout. With these the teapot has 3,752 triangles, as in the thesis, which does not say how it was cut.
const SPOUT_CELLS: [usize; 2] = [7, 9];

/// The teapot, all 32 patches, z up.
pub fn teapot() -> Vec<Triangle> {
    let mut triangles = Vec::new();
    for profile in &PROFILES {
        for quarter in 0..4 {
            let patch = turned(profile, quarter);
            triangles.extend(grid(BODY[1], BODY[0], |u, v| point(&patch, u, v)));
        }
    }
    for (lengths, [around, along]) in [(&HANDLE, HANDLE_CELLS), (&SPOUT, SPOUT_CELLS)] {
        for half in lengths {
            for mirror in [1.0, -1.0] {
                let patch = tube(half, mirror);
                triangles.extend(grid(along, around, |u, v| point(&patch, u, v)));
            }
        }
    }
    triangles
}

/// A quarter of a surface of revolution.
fn turned(profile: &Profile, quarter: usize) -> Patch {
    profile.map(|[r, z]| {
        let inner = r * if r == KNOB_RADIUS { KNOB_ROUND } else { ROUND };
        [(r, 0.0), (r, -inner), (inner, -r), (0.0, -r)].map(|(x, y)| {
            let (x, y) = (0..quarter).fold((x, y), |(x, y), _| (y, -x));
            // No negative zeros, so that equal points are the same.
            dvec3(x, y, z) + DVec3::ZERO
        })
    })
}

fn tube(half: &HalfTube, mirror: f64) -> Patch {
    half.map(|(row, y)| {
        let depth = [0.0, y * mirror, y * mirror, 0.0];
        std::array::from_fn(|i| dvec3(row[i][0], depth[i], row[i][1]) + DVec3::ZERO)
    })
}
