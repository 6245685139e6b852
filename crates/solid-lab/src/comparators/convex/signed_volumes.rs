use solid3d::glam::DVec3;

use super::gjk_distance::{ITERATIONS_MAX, ORIGIN};
use super::{ConvexTest, Counters, Memory, Pair};

/// ISA-GJK with signed volumes in place of Johnson's sub-algorithm: which face of the simplex is closest is told by signs of areas
/// and volumes, one dimension after the other.
///
/// Source: Montanari, Petrinic and Barbieri, *Improving the GJK algorithm for faster and more reliable distance queries between
/// convex objects*, 2017.
#[derive(Clone, Copy, Debug, Default)]
pub struct SignedVolumes {
    counters: Counters,
}

impl ConvexTest for SignedVolumes {
    fn name(&self) -> &'static str {
        "ISA-GJK, signed volumes"
    }

    fn intersects(&mut self, pair: &Pair, memory: &mut Memory) -> bool {
        self.counters.tests += 1;
        let v = &mut memory.axis;
        if *v == DVec3::ZERO {
            *v = pair.center();
        }
        let mut simplex: Vec<DVec3> = Vec::with_capacity(4);
        for _ in 0..ITERATIONS_MAX {
            self.counters.iterations += 1;
            let w = pair.support_against(*v).w;
            if v.dot(w) > 0.0 {
                return false;
            }
            if simplex.contains(&w) {
                break;
            }
            simplex.push(w);
            let size = simplex.iter().map(|y| y.length_squared()).fold(0.0, f64::max);
            let face = closest(&simplex);
            let closest = face.point(&simplex);
            if face.len == 4 || closest.length_squared() <= ORIGIN * ORIGIN * size {
                return true;
            }
            simplex = face.members().map(|i| simplex[i]).collect();
            *v = closest;
        }
        self.counters.gave_up += 1;
        false
    }

    fn counters(&self) -> Counters {
        self.counters
    }
}

/// Some points of a simplex with positive weights that add up to one.
#[derive(Clone, Copy, Debug, Default)]
struct Face {
    len: usize,
    points: [usize; 4],
    weights: [f64; 4],
}

impl Face {
    fn new<const N: usize>(points: [usize; N], weights: [f64; N]) -> Self {
        let mut face = Face { len: N, ..Face::default() };
        face.points[..N].copy_from_slice(&points);
        face.weights[..N].copy_from_slice(&weights);
        face
    }

    fn members(&self) -> impl Iterator<Item = usize> + '_ {
        self.points[..self.len].iter().copied()
    }

    fn point(&self, y: &[DVec3]) -> DVec3 {
        (0..self.len).map(|i| y[self.points[i]] * self.weights[i]).sum()
    }
}

/// The face of the simplex that has the point closest to the origin inside.
fn closest(y: &[DVec3]) -> Face {
    match y.len() {
        1 => Face::new([0], [1.0]),
        2 => on_segment(y, [0, 1]),
        3 => on_triangle(y, [0, 1, 2]),
        _ => in_tetrahedron(y),
    }
}

/// S1D: along the coordinate in which the segment is longest, the projection of the origin is compared with the ends.
fn on_segment(y: &[DVec3], [i, j]: [usize; 2]) -> Face {
    let (p, q) = (y[i], y[j]);
    let edge = q - p;
    let projected = p - edge * (p.dot(edge) / edge.length_squared());
    let axis = edge.abs().max_position();
    let (whole, from_p, to_q) = (edge[axis], projected[axis] - p[axis], q[axis] - projected[axis]);
    if whole * from_p <= 0.0 {
        Face::new([i], [1.0])
    } else if whole * to_q <= 0.0 {
        Face::new([j], [1.0])
    } else {
        Face::new([i, j], [to_q / whole, from_p / whole])
    }
}

/// S2D: in the coordinate plane in which the triangle is largest, areas with the projection of the origin in place of a corner.
fn on_triangle(y: &[DVec3], corners: [usize; 3]) -> Face {
    let [p, q, r] = corners.map(|i| y[i]);
    let n = (q - p).cross(r - p);
    let projected = n * (p.dot(n) / n.length_squared());
    let axis = n.abs().max_position();
    let area = |a: DVec3, b: DVec3, c: DVec3| (b - a).cross(c - a)[axis];
    let whole = n[axis];
    let parts = [area(projected, q, r), area(p, projected, r), area(p, q, projected)];
    if parts.iter().all(|part| part * whole > 0.0) {
        return Face::new(corners, parts.map(|part| part / whole));
    }
    // Beyond an edge for each part of the other sign; all of them when the triangle is none.
    let [i, j, k] = corners;
    nearest(y, parts.map(|part| part * whole), [[j, k], [i, k], [i, j]], on_segment)
}

/// S3D: volumes with the origin in place of a corner.
fn in_tetrahedron(y: &[DVec3]) -> Face {
    let volume = |a: DVec3, b: DVec3, c: DVec3| a.dot(b.cross(c));
    let [p, q, r, s] = [y[0], y[1], y[2], y[3]];
    let parts = [volume(q, r, s), -volume(p, r, s), volume(p, q, s), -volume(p, q, r)];
    let whole: f64 = parts.iter().sum();
    if parts.iter().all(|part| part * whole > 0.0) {
        return Face::new([0, 1, 2, 3], parts.map(|part| part / whole));
    }
    nearest(y, parts.map(|part| part * whole), [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]], on_triangle)
}

/// Of the faces that the origin is beyond, the one with the closest point.
fn nearest<const N: usize, const M: usize>(
    y: &[DVec3],
    signs: [f64; N],
    faces: [[usize; M]; N],
    solve: fn(&[DVec3], [usize; M]) -> Face,
) -> Face {
    let beyond = (0..N).filter(|&i| signs[i].is_nan() || signs[i] <= 0.0);
    let solved = beyond.map(|i| solve(y, faces[i]));
    solved
        .min_by(|f, g| f.point(y).length_squared().total_cmp(&g.point(y).length_squared()))
        .expect("the origin is beyond some face")
}
