//! A point that two triangles have in common which are known to meet.
//!
//! Where an edge of one passes through the other, the point is on the edge, parted by the heights of its ends, and in the
//! other, by the volumes over its edges (the determinants of the exact test, here rounded). Both are computed as points of
//! their triangle; only if they come out together is the answer given. Nearly coplanar and degenerate triangles are left to
//! GJK.

use glam::DVec3;

use super::triangle_triangle::Triangle;

/// How far apart the two points may be, squared, in the common frame, where the size of the data is from 1 to 2.
const APART_MAX_SQUARED: f64 = 1e-26;

/// The weights of the corners of each triangle that give a common point; the triangles must meet.
pub(super) fn crossing_point(x: &Triangle, y: &Triangle) -> Option<[[f64; 3]; 2]> {
    let through_y = (0..3).find_map(|i| through(x, i, y));
    through_y.or_else(|| (0..3).find_map(|i| through(y, i, x)).map(|[of_y, of_x]| [of_x, of_y]))
}

/// Where an edge passes through the face of the other.
fn through(edges: &Triangle, i: usize, face: &Triangle) -> Option<[[f64; 3]; 2]> {
    let j = (i + 1) % 3;
    let (p, q) = (edges[i], edges[j]);
    let normal = (face[1] - face[0]).cross(face[2] - face[0]);
    let (above, below) = (normal.dot(p - face[0]), normal.dot(q - face[0]));
    if above * below >= 0.0 {
        return None;
    }
    let along = above / (above - below);
    let mut on_edge = [0.0; 3];
    (on_edge[i], on_edge[j]) = (1.0 - along, along);
    let [a, b, c] = face.map(|corner| corner - p);
    let edge = q - p;
    let volumes = [edge.dot(b.cross(c)), edge.dot(c.cross(a)), edge.dot(a.cross(b))];
    let inside = volumes.iter().all(|&v| v >= 0.0) || volumes.iter().all(|&v| v <= 0.0);
    let sum: f64 = volumes.iter().sum();
    if !inside || sum == 0.0 {
        return None;
    }
    let on_face = volumes.map(|volume| volume / sum);
    let apart = weighted(edges, &on_edge) - weighted(face, &on_face);
    (apart.length_squared() <= APART_MAX_SQUARED).then_some([on_edge, on_face])
}

/// The point of a triangle that has these weights.
pub(super) fn weighted(corners: &Triangle, weights: &[f64; 3]) -> DVec3 {
    corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair::triangle_triangle::intersect;
    use rand::Rng;
    use solid_oracle::generate::seeded;
    use solid_oracle::triangle_distance;

    #[test]
    fn the_point_lies_on_both_triangles() {
        let seed = 40;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let (cases, mut hits, mut given) = (20_000, 0, 0);
        for case in 0..cases {
            // Some are slivers, some nearly coplanar.
            let flat = [1.0, 1e-3, 1e-9][case % 3];
            let mut point = || {
                let [x, y, z] = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
                DVec3::new(x, y, z * flat)
            };
            let (x, y) = ([point(), point(), point()], [point(), point(), point()]);
            // Brought together.
            let shift = 0.1 * (x[0] + x[1] + x[2] - y[0] - y[1] - y[2]);
            let y = y.map(|corner| corner + shift);
            if !intersect(&x, &y) {
                continue;
            }
            hits += 1;
            if let Some([of_x, of_y]) = crossing_point(&x, &y) {
                given += 1;
                for (triangle, weights) in [(&x, of_x), (&y, of_y)] {
                    assert!(weights.iter().all(|&w| w >= 0.0), "{weights:?}");
                    assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
                    let at = weighted(triangle, &weights);
                    for other in [&x, &y] {
                        let off = triangle_distance(other, &[at; 3]);
                        assert!(off < 2e-13, "case {case}: off by {off:e}: {x:?} {y:?}");
                    }
                }
            }
        }
        println!("{hits} of {cases} hit; a point is given for {given}");
        assert!((0.3..=0.7).contains(&(f64::from(hits) / cases as f64)));
        assert!(given * 10 > hits * 9);
    }
}
