use solid3d::Aabb;
use solid3d::glam::DVec3;

use super::plane::{Plane, Side, cut_polygon};

/// A convex region of space, bounded: what the planes above a node leave. Its faces are convex polygons, in no particular sense.
#[derive(Clone, Debug)]
pub struct Cell {
    faces: Vec<Vec<DVec3>>,
}

/// The parts of a cell.
pub struct Parts {
    pub below: Option<Cell>,
    pub above: Option<Cell>,
}

impl Cell {
    pub fn of_box(bounds: &Aabb) -> Cell {
        let Aabb { min, max } = *bounds;
        let corner = |k: u8| {
            DVec3::from_array([0, 1, 2].map(|axis| if k >> axis & 1 == 0 { min[axis] } else { max[axis] }))
        };
        let faces: [[u8; 4]; 6] =
            [[0, 2, 6, 4], [1, 3, 7, 5], [0, 1, 5, 4], [2, 3, 7, 6], [0, 1, 3, 2], [4, 5, 7, 6]];
        Cell { faces: faces.iter().map(|face| face.map(corner).to_vec()).collect() }
    }

    /// Cuts it, if more than the tolerance is on both sides.
    pub fn cut(self, plane: &Plane, tolerance: f64) -> Parts {
        let heights = self.faces.iter().flatten().map(|p| plane.height(*p));
        match Side::of_heights(heights, tolerance) {
            Side::Below => Parts { below: Some(self), above: None },
            Side::Above => Parts { below: None, above: Some(self) },
            // Thinner than the tolerance.
            Side::On => Parts { below: None, above: None },
            Side::Both => {
                let [below, above] = self.halves(plane, tolerance);
                Parts { below: Some(below), above: Some(above) }
            }
        }
    }

    fn halves(self, plane: &Plane, tolerance: f64) -> [Cell; 2] {
        let mut halves = [const { Vec::new() }; 2];
        let mut lid = Vec::new();
        for face in self.faces {
            let [below, above, on] = cut_polygon(&face, plane, tolerance);
            lid.extend(on);
            for (half, part) in halves.iter_mut().zip([below, above]) {
                if part.len() > 2 {
                    half.push(part);
                }
            }
        }
        let lid = around(lid, plane);
        halves.map(|mut faces| {
            if lid.len() > 2 {
                faces.push(lid.clone());
            }
            Cell { faces }
        })
    }
}

/// The corners of a convex polygon in order, each once.
fn around(points: Vec<DVec3>, plane: &Plane) -> Vec<DVec3> {
    let center = points.iter().sum::<DVec3>() / points.len() as f64;
    let (u, v) = plane.normal.any_orthonormal_pair();
    let mut turned: Vec<(f64, DVec3)> =
        points.into_iter().map(|p| ((p - center).dot(v).atan2((p - center).dot(u)), p)).collect();
    turned.sort_by(|x, y| x.0.total_cmp(&y.0));
    turned.dedup_by(|x, y| x.1 == y.1);
    turned.into_iter().map(|(_, p)| p).collect()
}
