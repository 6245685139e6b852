use glam::DVec3;

use super::side::side;
use super::{Triangle, triangles_of};
use crate::exact::hulls_intersect_exact;

/// Whether two closed triangles share a point: exact, coplanar and degenerate triangles included.
///
/// A floating-point filter decides pairs in general position; the rest goes to the exact linear program.
///
/// ```
/// use glam::{DVec3, dvec3};
/// use solid_oracle::triangles_intersect;
/// let t = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// let shifted = |d| t.map(|p| p + d);
/// assert!(triangles_intersect(&t, &shifted(DVec3::X)));
/// assert!(!triangles_intersect(&t, &shifted(dvec3(0.0, 0.0, 1e-300))));
/// ```
pub fn triangles_intersect(t1: &[DVec3; 3], t2: &[DVec3; 3]) -> bool {
    filtered(t1, t2).unwrap_or_else(|| hulls_intersect_exact(t1, t2))
}

/// All pairs of indices of triangles that intersect, in ascending order: brute force behind a test of their boxes.
///
/// # Panics
/// When an index is not that of a vertex.
pub fn mesh_pairs(
    vertices_a: &[DVec3],
    triangles_a: &[[u32; 3]],
    vertices_b: &[DVec3],
    triangles_b: &[[u32; 3]],
) -> Vec<(u32, u32)> {
    let (a, b) = (triangles_of(vertices_a, triangles_a), triangles_of(vertices_b, triangles_b));
    let mut pairs = Vec::new();
    for (i, (s, bounds_s)) in a.iter().enumerate() {
        for (j, (t, bounds_t)) in b.iter().enumerate() {
            if bounds_s.touches(bounds_t) && triangles_intersect(s, t) {
                pairs.push((i as u32, j as u32));
            }
        }
    }
    pairs
}

/// Two triangles in general position meet where an edge of one meets the other.
fn filtered(t1: &Triangle, t2: &Triangle) -> Option<bool> {
    let mut certain = true;
    for (t, edges) in [(t1, t2), (t2, t1)] {
        let sides = edges.map(|p| side(t[0], t[1], t[2], p));
        if sides[0].is_some() && sides[0] == sides[1] && sides[1] == sides[2] {
            return Some(false);
        }
        for i in 0..3 {
            let j = (i + 1) % 3;
            match edge_hits(edges[i], edges[j], sides[i], sides[j], t) {
                Some(true) => return Some(true),
                Some(false) => {}
                None => certain = false,
            }
        }
    }
    certain.then_some(false)
}

/// Whether the segment pq, its ends on the given sides of the plane of `t`, meets `t`.
fn edge_hits(p: DVec3, q: DVec3, side_p: Option<bool>, side_q: Option<bool>, t: &Triangle) -> Option<bool> {
    if side_p? == side_q? {
        return Some(false);
    }
    let turns = [0, 1, 2].map(|i| side(p, q, t[i], t[(i + 1) % 3]));
    if turns.contains(&Some(true)) && turns.contains(&Some(false)) {
        return Some(false);
    }
    turns.iter().all(Option::is_some).then_some(true)
}

#[cfg(test)]
mod tests {
    use glam::dvec3;
    use rand::Rng;

    use super::*;
    use crate::generate::seeded;

    /// Law: the filter agrees with the exact program wherever it dares to decide.
    #[test]
    fn filter_agrees_with_the_exact_program() {
        let seed = 11;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let (mut hits, mut decided) = (0, 0);
        let cases = 5000;
        for case in 0..cases {
            // Half of the cases live on a coarse grid, where coplanar, touching and degenerate triangles abound.
            let grid = case % 2 == 0;
            let mut point = || {
                let p = dvec3(rng.random(), rng.random(), rng.random());
                if grid { (p * 3.0).floor() } else { p }
            };
            let mut triangle = || [point(), point(), point()];
            let (s, t) = (triangle(), triangle());
            let exact = hulls_intersect_exact(&s, &t);
            hits += usize::from(exact);
            decided += usize::from(filtered(&s, &t).is_some());
            assert_eq!(triangles_intersect(&s, &t), exact, "{s:?} {t:?}");
            assert_eq!(triangles_intersect(&t, &s), exact, "{s:?} {t:?}");
        }
        println!("hits {hits}, decided by the filter {decided}, of {cases}");
        assert!((0.3..=0.7).contains(&(f64::from(hits as u32) / f64::from(cases))));
    }

    #[test]
    fn contained_coplanar_and_degenerate_triangles_intersect() {
        let t = [DVec3::ZERO, dvec3(4.0, 0.0, 0.0), dvec3(0.0, 4.0, 0.0)];
        let inner = [dvec3(1.0, 1.0, 0.0), dvec3(1.5, 1.0, 0.0), dvec3(1.0, 1.5, 0.0)];
        assert!(triangles_intersect(&t, &inner));
        assert!(triangles_intersect(&t, &[dvec3(1.0, 1.0, 0.0); 3]));
        assert!(!triangles_intersect(&t, &[dvec3(2.0, 2.0 + 1e-15, 0.0); 3]));
        let crossing = [dvec3(1.0, 1.0, -1.0), dvec3(1.0, 1.0, 1.0), dvec3(1.0, 1.0, 1.0)];
        assert!(triangles_intersect(&t, &crossing));
    }

    #[test]
    fn pairs_of_meshes_are_listed_in_order() {
        let a = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let triangles = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
        let b = a.map(|p| p + 0.25);
        let pairs = mesh_pairs(&a, &triangles, &b, &triangles);
        assert_eq!(pairs, [(3, 0), (3, 1), (3, 2)]);
    }
}
