//! Two polygons, not necessarily convex, as the thesis has the tests: rounded, coplanar polygons apart (section 3.2). The library's
//! are `solid3d::polygon`, which they are judged by.

mod sorted;
mod straightforward;
#[cfg(test)]
mod tests;

use solid3d::glam::DVec3;
pub use sorted::Sorted;
pub use straightforward::straightforward;

/// A polygon with its plane, the points x with `normal . x + offset = 0`.
#[derive(Clone, Debug)]
pub struct FlatPolygon {
    vertices: Vec<DVec3>,
    normal: DVec3,
    offset: f64,
}

impl FlatPolygon {
    /// A polygon by its chain, the plane by Newell's method (section 2.1.1).
    pub fn new(vertices: Vec<DVec3>) -> Self {
        let next = |i: usize| vertices[(i + 1) % vertices.len()];
        let normal: DVec3 = vertices.iter().enumerate().map(|(i, p)| p.cross(next(i))).sum();
        let mean = vertices.iter().sum::<DVec3>() / vertices.len() as f64;
        FlatPolygon { normal, offset: -normal.dot(mean), vertices }
    }

    /// The chain.
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    fn side(&self, p: DVec3) -> f64 {
        self.normal.dot(p) + self.offset
    }

    /// The points in which the edges of `other` cross the plane.
    fn crossings<'a>(&'a self, other: &'a FlatPolygon) -> impl Iterator<Item = DVec3> + 'a {
        let mut from = *other.vertices.last().expect("a polygon has vertices");
        let mut alpha = self.side(from);
        other.vertices.iter().filter_map(move |&to| {
            let beta = self.side(to);
            // A vertex in the plane counts as above it, for both of its edges.
            let crossing =
                ((alpha < 0.0) != (beta < 0.0)).then(|| from + (to - from) * (alpha / (alpha - beta)));
            (from, alpha) = (to, beta);
            crossing
        })
    }
}

/// The coordinate axis closest to a direction.
fn closest_axis(v: DVec3) -> usize {
    v.abs().max_position()
}
