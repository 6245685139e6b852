//! The convex hull of a soup, known by its support mapping alone.

use glam::DVec3;
use solid_convex::Support;

use super::complex::Complex;

/// The hull of all primitives of a soup, of which no face is known: its support points are found by the tree. They are the same as by a look at
/// all vertices, the first of those that are as far.
pub(crate) struct SoupHull<'a> {
    soup: &'a Complex,
    center: DVec3,
}

impl<'a> SoupHull<'a> {
    /// `center` is the mean of all corners.
    pub fn new(soup: &'a Complex, center: DVec3) -> Self {
        SoupHull { soup, center }
    }
}

impl Complex {
    /// The point of all primitives that is furthest along a direction. Cost: some nodes of the tree, where few are as far.
    pub fn furthest(&self, direction: DVec3) -> DVec3 {
        let vertices = self.vertices();
        let (mut first, mut furthest, mut best) = (u32::MAX, DVec3::ZERO, f64::NEG_INFINITY);
        self.tree().furthest(direction, &mut best.clone(), &mut |leaf, limit| {
            for &primitive in leaf {
                for &i in self.primitive(primitive) {
                    let point = vertices[i as usize];
                    let height = point.dot(direction);
                    if height > best || (height == best && primitive < first) {
                        (first, furthest, best) = (primitive, point, height);
                    }
                }
            }
            *limit = best;
        });
        furthest
    }
}

impl Support for SoupHull<'_> {
    fn support(&self, direction: DVec3) -> DVec3 {
        self.soup.furthest(direction)
    }

    fn reach(&self) -> DVec3 {
        self.soup.reach()
    }

    fn center(&self) -> DVec3 {
        self.center
    }

    fn is_polytope(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::Rng;
    use solid_oracle::generate::{grid, seeded};

    /// Law: support points, reach and centre are, bit by bit, those of all vertices; of many that are as far, too, and after a deformation. Few
    /// leaves are looked at.
    #[test]
    fn the_tree_finds_the_points_that_all_vertices_give() {
        let mut rng = seeded(91);
        let side = 40;
        for round in 0..6 {
            // A lattice, flat or bent, far from its origin or not; some vertices belong to no primitive.
            let far = if round % 3 == 0 { 1e6 } else { 0.0 };
            let mut vertices: Vec<DVec3> = (0..side * side)
                .map(|i| {
                    let (x, y) = (f64::from(i % side), f64::from(i / side));
                    DVec3::new(x, y, if round % 2 == 0 { 0.0 } else { (x * 0.4).sin() * y }) + far
                })
                .collect();
            vertices.push(DVec3::splat(1e9));
            let mut triangles: Vec<[u32; 3]> = grid(side).into_iter().step_by(2).collect();
            let turn = rng.random_range(0..triangles.len());
            triangles.rotate_left(turn);
            let mut soup = Complex::mesh(vertices.clone(), triangles).unwrap();
            if round == 5 {
                let deformed: Vec<DVec3> = vertices.iter().map(|v| *v * (1.0 + 0.001 * v.x)).collect();
                soup.take_positions(&deformed);
            }
            let (fast, slow) = (soup.hull(), soup.corners());
            assert_eq!((fast.reach(), fast.center()), (slow.reach(), slow.center()));
            let mut leaves = 0;
            for case in 0..600 {
                let mut number = || rng.random_range(-1.0..1.0);
                let direction = match case {
                    0..6 => DVec3::AXES[case % 3] * if case < 3 { 1.0 } else { -1.0 },
                    6 => DVec3::ZERO,
                    _ => DVec3::new(number(), number(), number()) * 10f64.powf(20.0 * number()),
                };
                assert_eq!(fast.support(direction), slow.support(direction), "round {round}: {direction}");
                if case > 6 {
                    let mut best = f64::NEG_INFINITY;
                    soup.tree().furthest(direction, &mut best, &mut |leaf, best| {
                        leaves += 1;
                        let corners = leaf.iter().flat_map(|&i| soup.primitive(i));
                        let heights = corners.map(|&i| soup.vertices()[i as usize].dot(direction));
                        *best = heights.fold(*best, f64::max);
                    });
                }
            }
            println!("round {round}: {} leaves a direction", f64::from(leaves) / 593.0);
            assert!(leaves < 593 * 5);
        }
    }
}
