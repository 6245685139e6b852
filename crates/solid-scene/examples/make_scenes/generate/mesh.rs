//! Meshes put together from boxes and cylinders.

use std::f64::consts::TAU;

use glam::{DAffine3, DVec3};

/// Sides of a cylinder.
const SIDES: u16 = 16;

/// A surface of triangles.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    pub vertices: Vec<DVec3>,
    pub triangles: Vec<[u16; 3]>,
}

impl Mesh {
    /// A box by its full size and its centre.
    pub fn cuboid(size: [f64; 3], centre: [f64; 3]) -> Mesh {
        let corner = |i: u8| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2 & 1));
        let vertices = (0..8).map(|i| DVec3::from(centre) + DVec3::from(size) * (corner(i) - 0.5)).collect();
        let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        Mesh { vertices, triangles }
    }

    /// A cylinder along y, by its radius, its height and the centre of its foot.
    pub fn cylinder(radius: f64, height: f64, foot: [f64; 3]) -> Mesh {
        let mut vertices = Vec::new();
        for y in [0.0, height] {
            vertices.extend((0..SIDES).map(|i| {
                let (sin, cos) = (TAU * f64::from(i) / f64::from(SIDES)).sin_cos();
                DVec3::from(foot) + DVec3::new(radius * cos, y, -radius * sin)
            }));
        }
        let mut triangles = Vec::new();
        for i in 0..SIDES {
            let j = (i + 1) % SIDES;
            triangles.extend([[i, j, SIDES + j], [i, SIDES + j, SIDES + i]]);
        }
        for i in 1..SIDES - 1 {
            triangles.extend([[0, i + 1, i], [SIDES, SIDES + i, SIDES + i + 1]]);
        }
        Mesh { vertices, triangles }
    }

    /// Both.
    pub fn and(mut self, other: Mesh) -> Mesh {
        let first = self.vertices.len() as u16;
        self.vertices.extend(other.vertices);
        self.triangles.extend(other.triangles.iter().map(|triangle| triangle.map(|i| first + i)));
        self
    }

    /// Moved.
    pub fn placed(mut self, placement: DAffine3) -> Mesh {
        self.vertices.iter_mut().for_each(|v| *v = placement.transform_point3(*v));
        self
    }

    /// A grid over the square from -1 to 1, in the plane y = 0: rows along z, each along x.
    pub fn grid(cells: u16) -> Mesh {
        let at = |i: u16| 2.0 * f64::from(i) / f64::from(cells) - 1.0;
        let mut mesh = Mesh::default();
        for j in 0..=cells {
            mesh.vertices.extend((0..=cells).map(|i| DVec3::new(at(i), 0.0, at(j))));
        }
        for j in 0..cells {
            for i in 0..cells {
                let a = j * (cells + 1) + i;
                let [b, c, d] = [a + 1, a + cells + 1, a + cells + 2];
                // Diagonals alternate, so that no direction is stiffer than another.
                let split = if (i + j) % 2 == 0 { [[a, c, d], [a, d, b]] } else { [[a, c, b], [b, c, d]] };
                mesh.triangles.extend(split);
            }
        }
        mesh
    }
}
