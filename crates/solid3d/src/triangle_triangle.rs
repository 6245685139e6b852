//! Whether two triangles share a point: exactly, for their corners as they are.
//!
//! Triangles are closed, and may be degenerate: a segment, a point. Two triangles meet if and only if an edge of one
//! meets the other; every decision is the sign of a determinant, which `robust` computes exactly (Shewchuk, *Adaptive
//! precision floating-point arithmetic*, 1997). Coplanar triangles, which the thesis ignores (section 6.5), are decided
//! in the plane.

use glam::{DVec2, DVec3};
use solid_convex::simd::each;

use crate::exact::{self, flatten, orient2d, orient3d, plain, segments_meet, segments_meet_in_space};

/// Three corners.
pub(crate) type Triangle = [DVec3; 3];

/// Whether two triangles share a point. Worth asking when their boxes do.
pub(crate) fn intersect(x: &Triangle, y: &Triangle) -> bool {
    let [x, y] = [&each(*x, plain), &each(*y, plain)];
    if are_level(x, y) && (has_parting_edge(x, y) || has_parting_edge(y, x)) {
        return false;
    }
    let (x_flat, y_flat) = (collinear(x), collinear(y));
    let y_sides = each(*x, |p| orient3d(y[0], y[1], y[2], p));
    if !y_flat && same_strict_side(y_sides) {
        return false;
    }
    let x_sides = each(*y, |p| orient3d(x[0], x[1], x[2], p));
    if !x_flat && same_strict_side(x_sides) {
        return false;
    }
    let edge_meets = |edges_of: &Triangle, sides: [f64; 3], other: &Triangle, other_flat: bool| {
        EDGES.iter().any(|&[i, j]| {
            let (p, q) = (&edges_of[i], &edges_of[j]);
            if other_flat {
                EDGES.iter().any(|&[k, l]| segments_meet_in_space(*p, *q, other[k], other[l]))
            } else {
                segment_meets_triangle(p, q, sides[i], sides[j], other)
            }
        })
    };
    edge_meets(x, y_sides, y, y_flat) || edge_meets(y, x_sides, x, x_flat)
}

/// Whether two triangles lie in one plane, about. Of these an exact sign of three dimensions takes long, and is rarely what parts them.
fn are_level(x: &Triangle, [p, q, r]: &Triangle) -> bool {
    /// Relative to the unit of the data: some rounding errors.
    const LEVEL: f64 = 1e-14;
    let normal = (*q - *p).cross(*r - *p);
    let most = LEVEL * normal.abs().max_element();
    x.iter().all(|&corner| normal.dot(corner - *p).abs() <= most)
}

/// Whether an edge of a triangle parts it from another, seen along the axis from which it looks the largest.
fn has_parting_edge(x: &Triangle, y: &Triangle) -> bool {
    let normal = (x[1] - x[0]).cross(x[2] - x[0]);
    let [x, y] =
        [x, y].map(|triangle| each(*triangle, |corner| flatten(normal.abs().max_position(), corner)));
    EDGES.iter().zip([2, 0, 1]).any(|(&[i, j], third)| {
        let side = |point: DVec2| orient2d(x[i], x[j], point);
        let sides = each(y, side);
        same_strict_side(sides) && !exact::same_strict_side(sides[0], side(x[third]))
    })
}

const EDGES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

fn same_strict_side(sides: [f64; 3]) -> bool {
    sides.iter().all(|&side| side > 0.0) || sides.iter().all(|&side| side < 0.0)
}

/// The triangle is not degenerate; `p_side` and `q_side` are the orientations of the ends to its plane.
fn segment_meets_triangle(p: &DVec3, q: &DVec3, p_side: f64, q_side: f64, triangle: &Triangle) -> bool {
    if p_side == 0.0 && q_side == 0.0 {
        // Coplanar sets meet if and only if they do in all three projections, as segments do.
        return (0..3).all(|k| {
            segment_meets_triangle_2d(flatten(k, *p), flatten(k, *q), triangle.map(|c| flatten(k, c)))
        });
    }
    if same_strict_side([p_side, q_side, p_side]) {
        return false;
    }
    let turns = each(EDGES, |[i, j]| orient3d(*p, *q, triangle[i], triangle[j]));
    turns.iter().all(|&turn| turn >= 0.0) || turns.iter().all(|&turn| turn <= 0.0)
}

fn segment_meets_triangle_2d(p: DVec2, q: DVec2, triangle: [DVec2; 3]) -> bool {
    EDGES.iter().any(|&[i, j]| segments_meet(p, q, triangle[i], triangle[j])) || contains_2d(triangle, p)
}

/// Whether a point lies in a triangle's interior; `false` for a degenerate triangle, whose edges are all there is.
fn contains_2d(triangle: [DVec2; 3], p: DVec2) -> bool {
    let turns = each(EDGES, |[i, j]| orient2d(triangle[i], triangle[j], p));
    same_strict_side(turns)
}

fn collinear(t: &Triangle) -> bool {
    (0..3).all(|k| orient2d(flatten(k, t[0]), flatten(k, t[1]), flatten(k, t[2])) == 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::Rng;
    use rand::rngs::StdRng;
    use solid_oracle::generate::seeded;
    use solid_oracle::triangles_intersect;

    fn lattice_triangle(rng: &mut StdRng, end: i32) -> Triangle {
        let mut corner = || DVec3::from_array(std::array::from_fn(|_| f64::from(rng.random_range(0..=end))));
        [corner(), corner(), corner()]
    }

    /// Compares with the oracle in both orders and for every order of the corners; returns the answer.
    fn check(x: &Triangle, y: &Triangle) -> bool {
        let expected = triangles_intersect(x, y);
        for [i, j, k] in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
            let turned = [x[i], x[j], x[k]];
            assert_eq!(intersect(&turned, y), expected, "{turned:?} {y:?}");
            assert_eq!(intersect(y, &turned), expected, "{y:?} {turned:?}");
        }
        expected
    }

    /// On a lattice of 27 points, coplanar, touching and degenerate triangles abound.
    #[test]
    fn lattice_triangles_agree_with_the_oracle() {
        let seed = 20;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let (cases, mut hits) = (60_000, 0);
        for _ in 0..cases {
            let (x, y) = (lattice_triangle(&mut rng, 2), lattice_triangle(&mut rng, 2));
            hits += i32::from(check(&x, &y));
        }
        println!("{hits} of {cases} hit");
        assert!((0.3..=0.7).contains(&(f64::from(hits) / f64::from(cases))));
    }

    /// The same in one plane, also a slanted one; no other test sees so many coplanar pairs. Those that do not meet are parted by an edge.
    #[test]
    fn coplanar_triangles_agree_with_the_oracle() {
        let seed = 21;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let (cases, mut hits) = (30_000, 0);
        for case in 0..cases {
            let plane = [
                [DVec3::X, DVec3::Y],
                [DVec3::Y, DVec3::Z],
                [DVec3::new(1.0, 2.0, 0.0), DVec3::new(0.0, 1.0, 3.0)],
            ];
            let [u, v] = plane[case as usize % 3];
            let lift = |t: Triangle| t.map(|p| p.x * u + p.y * v);
            let (x, y) =
                (lattice_triangle(&mut rng, 5), lattice_triangle(&mut rng, 5).map(|p| p + 2.0 * DVec3::X));
            let [x, y] = [lift(x), lift(y)];
            let meet = check(&x, &y);
            let are_wide = !collinear(&x) && !collinear(&y);
            assert!(
                meet || !are_wide
                    || are_level(&x, &y) && (has_parting_edge(&x, &y) || has_parting_edge(&y, &x)),
                "{x:?} {y:?}"
            );
            hits += i32::from(meet);
        }
        println!("{hits} of {cases} hit");
        assert!((0.3..=0.7).contains(&(f64::from(hits) / f64::from(cases))));
    }

    /// One unit in the last place decides.
    #[test]
    fn neighbours_of_touching_corners_are_told_apart() {
        let t = [DVec3::new(0.1, 0.7, 0.3), DVec3::new(0.9, 0.2, 0.4), DVec3::new(0.3, 0.1, 0.8)];
        let mut hits = 0;
        for k in 0..4000 {
            let weight = f64::from(k) / 4000.0;
            let near = t[0].lerp(t[1], weight).lerp(t[2], 0.3);
            let away = near + DVec3::new(0.7, 0.6, 0.9) * if k % 2 == 0 { 1.0 } else { -1.0 };
            hits += i32::from(check(&t, &[near, away, away + 0.1 * DVec3::X]));
        }
        println!("{hits} of 4000 hit");
        assert!((1200..=2800).contains(&hits));
    }

    /// Law: what is below 2^-300 counts as zero, and nothing else does.
    #[test]
    fn the_least_gap_parts() {
        let floor = [DVec3::ZERO, DVec3::X, DVec3::Y];
        for (gap, meet) in [(1e-85, false), (2f64.powi(-300), false), (2f64.powi(-301), true), (-1e-85, true)]
        {
            let above = [DVec3::new(0.2, 0.2, gap), DVec3::ONE, DVec3::new(1.0, 0.0, 1.0)];
            assert_eq!([intersect(&floor, &above), intersect(&above, &floor)], [meet; 2], "{gap:e}");
        }
    }
}
