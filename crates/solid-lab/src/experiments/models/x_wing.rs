use std::f64::consts::{FRAC_PI_2, TAU};

use solid3d::glam::{DVec3, dvec3};

use super::grid;
use crate::comparators::tree::Triangle;

/// A slender craft with four wings, in place of the thesis's X-wing, which is not to be had: 6,084 triangles like that one, most of
/// them in long thin parts. It points along x.
pub fn x_wing() -> Vec<Triangle> {
    let mut triangles = Vec::new();
    // The fuselage: a tube that tapers towards the nose, and its tip.
    let radius = |u: f64| 0.55 - 0.4 * u;
    triangles.extend(grid(40, 24, |u, v| tube(dvec3(-4.0 + 9.0 * u, 0.0, 0.0), radius(u), v)));
    triangles.extend((0..4).map(|i| {
        let corner = |i: i32| tube(dvec3(5.0, 0.0, 0.0), radius(1.0), f64::from(i) / 4.0);
        [dvec3(5.4, 0.0, 0.0), corner(i), corner(i + 1)]
    }));
    for quarter in 0..4 {
        // Wings open like an X that is wider than high.
        let turn = f64::from(quarter) * FRAC_PI_2 + FRAC_PI_2 / 2.0;
        let out = dvec3(0.0, turn.cos(), 0.45 * turn.sin()).normalize();
        let up = DVec3::X.cross(out);
        triangles.extend(grid(16, 10, |u, v| tube(out * 0.9 + DVec3::X * (-4.2 + 2.5 * u), 0.3, v)));
        triangles.extend(grid(20, 8, |u, v| tube(out * 4.4 + DVec3::X * (-3.0 + 5.0 * u), 0.07, v)));
        for side in [-0.05, 0.05] {
            let wing =
                |u: f64, v: f64| out * (0.5 + 3.9 * u) + DVec3::X * (-3.4 + 0.8 * u + (1.9 - 0.9 * u) * v);
            triangles.extend(grid(10, 10, |u, v| wing(u, v) + up * side));
        }
    }
    triangles
}

/// A point of a circle around the direction x, `turn` in turns.
fn tube(center: DVec3, radius: f64, turn: f64) -> DVec3 {
    let (sin, cos) = (turn * TAU).sin_cos();
    center + radius * dvec3(0.0, cos, sin)
}
