use std::f64::consts::TAU;

use solid3d::glam::dvec3;

use super::grid;
use crate::comparators::tree::Triangle;

/// The radius of the circle that the tube follows (thesis, section 5.2.1).
pub const MAJOR: f64 = 10.0;

/// The radius of the tube.
pub const MINOR: f64 = 2.0;

/// Cells along the circle, and around the tube. The thesis does not say; with as many of both the counts of its Table 5.4 come out
/// within a tenth, with 100 by 25 a third too low.
const CELLS: [usize; 2] = [50, 50];

/// A torus around the z axis.
pub fn torus() -> Vec<Triangle> {
    let point = |u: f64, v: f64| {
        let (u, v) = (u * TAU, v * TAU);
        let r = MAJOR + MINOR * v.cos();
        dvec3(r * u.cos(), r * u.sin(), MINOR * v.sin())
    };
    grid(CELLS[0], CELLS[1], point).collect()
}
