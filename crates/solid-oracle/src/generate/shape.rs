use glam::DVec3;
use rand::Rng;
use rand::rngs::StdRng;

use super::{direction, in_cube, log_uniform};
use crate::shape::Convex;

/// Steps of the grid on which the points of exactly degenerate hulls lie, per unit of size.
const GRID: f64 = 64.0;

/// A shape of any kind, at most about `size` from its origin: half of them round, a quarter boxes and solid hulls, a
/// quarter hulls that are exactly points, segments or polygons, or have duplicates.
pub fn random_shape(rng: &mut StdRng, size: f64) -> Convex {
    let mut extent = || size * rng.random_range(0.2..=1.0);
    let (x, y, z) = (extent(), extent(), extent());
    match rng.random_range(0..16) {
        0 | 1 => Convex::Sphere { radius: x },
        2 | 3 => Convex::Cone { radius: x, half_height: y },
        4 | 5 => Convex::Cylinder { radius: x, half_height: y },
        6 | 7 => Convex::Capsule { radius: 0.5 * x, half_height: 0.5 * y },
        8 | 9 => Convex::Cuboid { half: DVec3::new(x, y, z) },
        10 => on_ellipsoid(rng, DVec3::new(x, y, z)),
        11 => cloud(rng, size),
        12 => with_duplicates(rng, size),
        13 => Convex::Hull { points: vec![on_grid(rng, size)] },
        14 => collinear(rng, size),
        _ => coplanar(rng, size),
    }
}

/// A shape thinner than 1e-3 of `size` in one direction, often of no thickness at all.
pub fn random_flat(rng: &mut StdRng, size: f64) -> Convex {
    let thickness = size * if rng.random() { log_uniform(rng, 1e-9, 1e-3) } else { 0.0 };
    let extent = size * rng.random_range(0.3..=1.0);
    match rng.random_range(0..5) {
        0 => Convex::Cylinder { radius: extent, half_height: thickness },
        1 => Convex::Cone { radius: extent, half_height: thickness },
        2 => coplanar(rng, size),
        3 => {
            let points = (0..8).map(|_| in_cube(rng) * DVec3::new(extent, thickness, extent)).collect();
            Convex::Hull { points }
        }
        _ => Convex::Cuboid { half: DVec3::new(extent, thickness, size) },
    }
}

/// A shape thinner than 1e-3 of `size` in two directions, often of no thickness at all.
pub fn random_sliver(rng: &mut StdRng, size: f64) -> Convex {
    let thickness = size * if rng.random() { log_uniform(rng, 1e-9, 1e-3) } else { 0.0 };
    match rng.random_range(0..6) {
        0 => Convex::Cylinder { radius: thickness, half_height: size },
        1 => Convex::Cone { radius: thickness, half_height: size },
        2 => Convex::Capsule { radius: thickness, half_height: size },
        3 => collinear(rng, size),
        4 => {
            let points = (0..6).map(|_| in_cube(rng) * DVec3::new(thickness, size, thickness)).collect();
            Convex::Hull { points }
        }
        _ => Convex::Cuboid { half: DVec3::new(thickness, size, thickness) },
    }
}

/// A point of a grid so coarse that sums of a few differences of such points are exact.
fn on_grid(rng: &mut StdRng, size: f64) -> DVec3 {
    (in_cube(rng) * GRID).round() * grid_step(size)
}

fn grid_step(size: f64) -> f64 {
    size.log2().floor().exp2() / GRID
}

/// Two to six points exactly on a line.
fn collinear(rng: &mut StdRng, size: f64) -> Convex {
    let (origin, step) = (0.5 * on_grid(rng, size), on_grid(rng, size) / 8.0);
    let count = rng.random_range(2..=6);
    let points = (0..count).map(|_| origin + step * f64::from(rng.random_range(-6..=6))).collect();
    Convex::Hull { points }
}

/// Three to nine points exactly in a plane.
fn coplanar(rng: &mut StdRng, size: f64) -> Convex {
    let (origin, u, v) = (0.25 * on_grid(rng, size), on_grid(rng, size) / 8.0, on_grid(rng, size) / 8.0);
    let count = rng.random_range(3..=9);
    let mut factor = || f64::from(rng.random_range(-6..=6));
    let points = (0..count).map(|_| origin + u * factor() + v * factor()).collect();
    Convex::Hull { points }
}

fn on_ellipsoid(rng: &mut StdRng, radii: DVec3) -> Convex {
    let count = rng.random_range(8..=60);
    Convex::Hull { points: (0..count).map(|_| direction(rng) * radii).collect() }
}

fn cloud(rng: &mut StdRng, size: f64) -> Convex {
    let count = rng.random_range(4..=20);
    Convex::Hull { points: (0..count).map(|_| in_cube(rng) * size).collect() }
}

fn with_duplicates(rng: &mut StdRng, size: f64) -> Convex {
    let mut points: Vec<DVec3> = (0..rng.random_range(4..=8)).map(|_| on_grid(rng, size)).collect();
    let again = points.clone();
    points.extend(again);
    Convex::Hull { points }
}
