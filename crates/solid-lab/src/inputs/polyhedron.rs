use rand::rngs::StdRng;
use solid3d::Shape;
use solid3d::glam::DVec3;
use solid3d::hull::Hull;

use super::pose::direction;

/// A convex polyhedron with all its corners on a sphere around the origin.
#[derive(Clone, Debug)]
pub struct Polyhedron {
    /// Every one of them a corner.
    pub vertices: Vec<DVec3>,
    /// Its facets and edges.
    pub hull: Hull,
}

impl Polyhedron {
    /// A polyhedron of `n` vertices, at least 4, random on the unit sphere. The origin is inside it.
    pub fn random(rng: &mut StdRng, n: usize) -> Self {
        assert!(n >= 4, "a polyhedron has at least 4 vertices, not {n}");
        loop {
            let vertices: Vec<DVec3> = (0..n).map(|_| direction(rng)).collect();
            let hull = Hull::of(&vertices).expect("there are vertices");
            let polyhedron = Polyhedron { vertices, hull };
            if polyhedron.hull.vertices().len() == n && polyhedron.contains_origin() {
                return polyhedron;
            }
        }
    }

    /// The same with all coordinates multiplied by a positive factor.
    pub fn scaled(&self, factor: f64) -> Self {
        let vertices = self.vertices.iter().map(|v| *v * factor).collect();
        Polyhedron { vertices, hull: self.hull.clone() }
    }

    /// The volume, by tetrahedra from the origin.
    pub fn volume(&self) -> f64 {
        self.facets().map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
    }

    /// The same, for the library.
    pub fn shape(&self) -> Shape {
        Shape::convex_hull(&self.vertices).expect("the vertices are finite")
    }

    /// The triangles of the surface, counter-clockwise seen from outside.
    pub fn facets(&self) -> impl Iterator<Item = [DVec3; 3]> + '_ {
        self.hull.triangles().iter().map(|t| t.map(|i| self.vertices[i as usize]))
    }

    fn contains_origin(&self) -> bool {
        self.facets().all(|[a, b, c]| a.dot(b.cross(c)) > 0.0)
    }
}
