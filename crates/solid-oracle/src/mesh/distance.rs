use glam::DVec3;

use super::{triangles_intersect, triangles_of};
use crate::double_double::{DoubleDouble, Vec3};
use crate::search::closest_on_affine_hull;

/// The Euclidean distance of two closed triangles, degenerate ones included; zero exactly when they share a point.
///
/// Brute force over vertex-face and edge-edge pairs in double-double arithmetic: off by an ulp or so.
pub fn triangle_distance(t1: &[DVec3; 3], t2: &[DVec3; 3]) -> f64 {
    if triangles_intersect(t1, t2) {
        return 0.0;
    }
    let (s, t) = (t1.map(Vec3::from_f64), t2.map(Vec3::from_f64));
    let vertex_face = s
        .iter()
        .map(|&p| point_distance_squared(p, &t))
        .chain(t.iter().map(|&p| point_distance_squared(p, &s)))
        .fold(DoubleDouble::new(f64::INFINITY), lesser);
    let edge = |t: &[Vec3; 3], i: usize| (t[i], t[(i + 1) % 3]);
    (0..9)
        .filter_map(|k| line_distance_squared(edge(&s, k / 3), edge(&t, k % 3)))
        .fold(vertex_face, lesser)
        .sqrt()
        .to_f64()
}

/// The least distance of any two triangles of two meshes, infinite when one has none: brute force, skipping pairs
/// whose boxes are farther apart than the best pair so far.
///
/// # Panics
/// When an index is not that of a vertex.
pub fn mesh_distance(
    vertices_a: &[DVec3],
    triangles_a: &[[u32; 3]],
    vertices_b: &[DVec3],
    triangles_b: &[[u32; 3]],
) -> f64 {
    let (a, b) = (triangles_of(vertices_a, triangles_a), triangles_of(vertices_b, triangles_b));
    let mut least = f64::INFINITY;
    for (s, bounds_s) in &a {
        for (t, bounds_t) in &b {
            // The distance of the boxes is rounded: do not let its last digits skip the best pair.
            if bounds_s.distance(bounds_t) * (1.0 - 1e-14) < least {
                least = least.min(triangle_distance(s, t));
            }
        }
    }
    least
}

fn lesser(a: DoubleDouble, b: DoubleDouble) -> DoubleDouble {
    if b < a { b } else { a }
}

/// Over the corners, the edges and the face of the triangle, wherever the foot of the perpendicular lies inside.
fn point_distance_squared(p: Vec3, triangle: &[Vec3; 3]) -> DoubleDouble {
    let [a, b, c] = triangle.map(|corner| corner - p);
    let features: [&[Vec3]; 7] = [&[a], &[b], &[c], &[a, b], &[b, c], &[c, a], &[a, b, c]];
    features
        .iter()
        .filter_map(|feature| closest_on_affine_hull(feature))
        .map(|(v, _)| v.length_squared())
        .fold(DoubleDouble::new(f64::INFINITY), lesser)
}

/// The squared distance of two lines, where their closest points lie inside both segments.
fn line_distance_squared((p, p_end): (Vec3, Vec3), (q, q_end): (Vec3, Vec3)) -> Option<DoubleDouble> {
    let (d, e, r) = (p_end - p, q_end - q, q - p);
    let normal = d.cross(e);
    let length_squared = normal.length_squared();
    if length_squared.is_zero() {
        return None;
    }
    let along_d = r.cross(e).dot(normal);
    let along_e = r.cross(d).dot(normal);
    let inside = |t: DoubleDouble| !t.is_negative() && t <= length_squared;
    let across = r.dot(normal);
    (inside(along_d) && inside(along_e)).then(|| across * across / length_squared)
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, dvec3};
    use rand::Rng;

    use super::*;
    use crate::generate::seeded;
    use crate::mesh::Triangle;
    use crate::{Convex, distance_bounds};

    #[test]
    fn closed_forms_hold() {
        let t: Triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
        assert_eq!(triangle_distance(&t, &t.map(|p| p + 2.0 * DVec3::Z)), 2.0);
        assert_eq!(triangle_distance(&t, &t.map(|p| p + 3.0 * DVec3::X)), 2.0);
        assert_eq!(triangle_distance(&t, &t), 0.0);
        let edge_above = [dvec3(0.2, -1.0, 0.5), dvec3(0.2, 1.0, 0.5), dvec3(0.2, 0.0, 9.0)];
        assert_eq!(triangle_distance(&t, &edge_above), 0.5);
        assert_eq!(triangle_distance(&[DVec3::ZERO; 3], &[dvec3(3.0, 4.0, 0.0); 3]), 5.0);
    }

    /// Law: brute force over features agrees with the certified distance of the hulls.
    #[test]
    fn triangle_distance_lies_in_the_certified_interval() {
        let seed = 12;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let cases = 600;
        let mut hits = 0;
        for _ in 0..cases {
            let shift = DVec3::X * rng.random_range(-0.8..0.8);
            let mut point = |shift: DVec3| dvec3(rng.random(), rng.random(), rng.random()) + shift;
            let s = [point(DVec3::ZERO), point(DVec3::ZERO), point(DVec3::ZERO)];
            let t = [point(shift), point(shift), point(shift)];
            let distance = triangle_distance(&s, &t);
            let hull = |t: Triangle| Convex::Hull { points: t.to_vec() };
            let (low, high) = distance_bounds(&hull(s), &DAffine3::IDENTITY, &hull(t), &DAffine3::IDENTITY);
            assert!(low * (1.0 - 1e-15) <= distance && distance <= high * (1.0 + 1e-15), "{s:?} {t:?}");
            assert!(high - low <= 1e-9 * high, "{low} {high}");
            hits += u32::from(distance == 0.0);
        }
        println!("hits {hits} of {cases}");
    }

    #[test]
    fn mesh_distance_is_the_least_over_pairs() {
        let a = [DVec3::ZERO, DVec3::X, DVec3::Y, 7.0 * DVec3::Z];
        let b = a.map(|p| p + dvec3(0.0, 0.0, -1.5));
        let triangles = [[0, 1, 2], [0, 1, 3]];
        assert_eq!(mesh_distance(&a, &triangles[..1], &b, &triangles[..1]), 1.5);
        assert_eq!(mesh_distance(&a, &triangles, &b, &triangles), 0.0);
        assert_eq!(mesh_distance(&a, &triangles, &b, &[]), f64::INFINITY);
    }
}
