use std::f64::consts::TAU;

use rand::Rng;
use rand::rngs::StdRng;
use solid3d::Shape;
use solid3d::glam::DVec3;

/// The radius of the circle around which a torus runs, and that of its tube.
const TORUS_RADII: [f64; 2] = [1.0, 0.4];

/// A terrain covers [-1, 1] in x and y; so high is each of its waves.
const WAVE_HEIGHT: f64 = 0.08;

/// How many waves make a terrain, each shorter than the one before.
const WAVES: usize = 5;

/// A triangle mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Positions.
    pub vertices: Vec<DVec3>,
    /// Indices of vertices, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// A torus around the z axis of exactly `triangles`, an even number of at least 18.
    pub fn torus(triangles: usize) -> Self {
        let [around, across] = grid(triangles, 3);
        let [major, minor] = TORUS_RADII;
        let point = |i: usize, j: usize| {
            let (u, v) = (TAU * i as f64 / around as f64, TAU * j as f64 / across as f64);
            let r = major + minor * v.cos();
            DVec3::new(r * u.cos(), r * u.sin(), minor * v.sin())
        };
        let vertices = rows(around, across).map(|(i, j)| point(i, j)).collect();
        let index = |i: usize, j: usize| ((i % around) * across + j % across) as u32;
        Mesh { vertices, triangles: quads(around, across, index) }
    }

    /// A terrain over [-1, 1] x [-1, 1] of exactly `triangles`, an even number of at least 2.
    pub fn terrain(rng: &mut StdRng, triangles: usize) -> Self {
        let [nx, ny] = grid(triangles, 1);
        let mut waves = Vec::new();
        for k in 0..WAVES {
            let turn = rng.random_range(0.0..TAU);
            let frequency = 2.0 * f64::from(1u32 << k);
            let along = DVec3::new(turn.cos(), turn.sin(), 0.0) * frequency;
            waves.push((along, rng.random_range(0.0..TAU), WAVE_HEIGHT / f64::from(1u32 << k)));
        }
        let vertices = rows(nx + 1, ny + 1)
            .map(|(i, j)| {
                let p = DVec3::new(i as f64 / nx as f64, j as f64 / ny as f64, 0.5) * 2.0 - 1.0;
                let z = waves.iter().map(|(along, phase, height)| height * (p.dot(*along) + phase).sin());
                p.with_z(z.sum())
            })
            .collect();
        let index = |i: usize, j: usize| (i * (ny + 1) + j) as u32;
        Mesh { vertices, triangles: quads(nx, ny, index) }
    }

    /// The same, for the library.
    pub fn shape(&self) -> Shape {
        Shape::mesh(self.vertices.clone(), self.triangles.clone()).expect("the mesh is well formed")
    }

    /// A deformed copy of the vertices: a wave that runs through the mesh, at time `t`.
    pub fn deformed(&self, t: f64) -> Vec<DVec3> {
        let wave = |v: &DVec3| {
            *v + 0.05 * DVec3::new((3.0 * v.y + t).sin(), (3.0 * v.z + t).sin(), (3.0 * v.x + t).sin())
        };
        self.vertices.iter().map(wave).collect()
    }
}

/// The most nearly square grid of quadrilaterals that gives so many triangles, at least `least` wide.
fn grid(triangles: usize, least: usize) -> [usize; 2] {
    let quads = triangles / 2;
    assert!(triangles.is_multiple_of(2) && quads >= least * least, "no grid has {triangles} triangles");
    let side = (least..=quads.isqrt()).rev().find(|&d| quads.is_multiple_of(d));
    let across = side.unwrap_or(least);
    [quads / across, across]
}

fn rows(n: usize, m: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |i| (0..m).map(move |j| (i, j)))
}

fn quads(n: usize, m: usize, index: impl Fn(usize, usize) -> u32) -> Vec<[u32; 3]> {
    rows(n, m)
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}
