use glam::{DVec3, dvec3};

use super::side::side;
use super::{Triangle, triangles_intersect, triangles_of};
use crate::exact::ExactVec3;

/// How far outside of the mesh segments end, relative to its extent and to the distance of the point.
const FAR: f64 = 3.0;

/// So many ends are tried: one that is in the plane of an edge and the point would not do.
const ENDS: usize = 100;

/// How often a closed mesh winds around a point: positive where its triangles run counterclockwise seen from outside; `None`
/// on the surface. Exact, by brute force: the crossings of a segment to a point outside, which passes no edge.
///
/// ```
/// use glam::DVec3;
/// use solid_oracle::winding_number;
/// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// assert_eq!(winding_number(&corners, &faces, DVec3::splat(0.1)), Some(1));
/// assert_eq!(winding_number(&corners, &faces, DVec3::splat(0.5)), Some(0));
/// assert_eq!(winding_number(&corners, &faces, DVec3::splat(0.0)), None);
/// ```
///
/// # Panics
/// When an index is not that of a vertex, or the mesh is not closed and no segment is found.
pub fn winding_number(vertices: &[DVec3], triangles: &[[u32; 3]], point: DVec3) -> Option<i32> {
    let triangles: Vec<Triangle> = triangles_of(vertices, triangles).into_iter().map(|(t, _)| t).collect();
    let on_surface = |t: &Triangle| {
        let (least, greatest) = (t[0].min(t[1]).min(t[2]), t[0].max(t[1]).max(t[2]));
        let in_box = least.cmple(point).all() && point.cmple(greatest).all();
        in_box && triangles_intersect(t, &[point; 3])
    };
    if triangles.iter().any(on_surface) {
        return None;
    }
    let reach = vertices.iter().map(|v| (*v - point).abs().max_element()).fold(1e-30, f64::max);
    (0..ENDS)
        .find_map(|i| {
            // Points on a sphere, by the golden ratio.
            let (turn, height) = (2.399963229728653 * i as f64, 1.0 - (2 * i + 1) as f64 / ENDS as f64);
            let radius = (1.0 - height * height).sqrt();
            let end = point + FAR * reach * dvec3(radius * turn.cos(), radius * turn.sin(), height);
            triangles.iter().map(|t| crossing(t, point, end)).sum::<Option<i32>>()
        })
        .map(Some)
        .expect("one of the segments passes no edge")
}

/// How the segment from p to q crosses a triangle that p is not on: 1 from its back to its front. `None` when it passes an edge.
fn crossing(t: &Triangle, p: DVec3, q: DVec3) -> Option<i32> {
    let (side_p, side_q) = (exact_side(t[0], t[1], t[2], p), exact_side(t[0], t[1], t[2], q));
    if side_p * side_q > 0 {
        return Some(0);
    }
    let turns = [[0, 1], [1, 2], [2, 0]].map(|[i, j]| exact_side(p, q, t[i], t[j]));
    if turns.contains(&1) && turns.contains(&-1) {
        return Some(0);
    }
    if turns.contains(&0) || side_p == 0 || side_q == 0 {
        return degenerate(t).then_some(0);
    }
    Some(side_q)
}

fn degenerate(t: &Triangle) -> bool {
    let [a, b, c] = t.map(ExactVec3::from_f64);
    (&b - &a).cross(&(&c - &a)).is_zero()
}

/// The side of the plane (a, b, c) that p lies on: 1 for the one from which they run counterclockwise, -1 for the other, 0 on the plane.
fn exact_side(a: DVec3, b: DVec3, c: DVec3, p: DVec3) -> i32 {
    match side(a, b, c, p) {
        Some(clockwise) => {
            if clockwise {
                -1
            } else {
                1
            }
        }
        None => {
            let [a, b, c, p] = [a, b, c, p].map(ExactVec3::from_f64);
            -(&a - &p).dot(&(&b - &p).cross(&(&c - &p))).sign()
        }
    }
}
