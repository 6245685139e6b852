//! A shape as a surface of facets.

use glam::DVec3;
use solid_convex::Cuboid;

use super::{Complex, Geometry, Shape};
use crate::hull::Hull;
use crate::threads::alone;

/// A shape's surface: facets under a tree.
pub(crate) enum Surface<'a> {
    /// A mesh or complex shape is its own.
    Own(&'a Complex),
    /// That of a convex hull, which is one primitive and keeps it.
    OfHull(&'a Complex),
    /// That of a box, which is one primitive.
    OfBox(Box<Complex>),
}

impl Surface<'_> {
    pub fn complex(&self) -> &Complex {
        match self {
            Surface::Own(complex) | Surface::OfHull(complex) => complex,
            Surface::OfBox(complex) => complex,
        }
    }

    /// The shape's primitive that a primitive of the surface belongs to.
    pub fn primitive(&self, primitive: u32) -> u32 {
        match self {
            Surface::Own(complex) => complex.owner(primitive),
            Surface::OfHull(_) | Surface::OfBox(_) => 0,
        }
    }
}

impl Shape {
    /// The surface; `None` for a shape that is round. Cost: nothing for a mesh or complex shape, O(n log n) at the first call for a convex hull.
    pub(crate) fn surface(&self) -> Option<Surface<'_>> {
        match &self.geometry {
            Geometry::Complex(complex) => Some(Surface::Own(complex)),
            Geometry::Polytope(hulled) => Some(Surface::OfHull(hulled.surface())),
            Geometry::Cuboid(cuboid) => Some(Surface::OfBox(Box::new(of_hull(corners_of(cuboid))))),
            Geometry::Sphere(_) | Geometry::Cone(_) | Geometry::Cylinder(_) | Geometry::Capsule(_) => None,
        }
    }
}

/// The surface of the hull of points, which are good for a shape.
pub(super) fn of_hull(points: Vec<DVec3>) -> Complex {
    let facets = hull_facets(&points);
    // A world asks this of pairs that it tests on several threads.
    alone(|| Complex::mesh(points, facets)).expect("what is good for a hull is good for a mesh")
}

/// The facets of a primitive, as indices into the vertices: its own triangle, or the surface of its hull. Segments and points
/// are degenerate triangles.
pub(crate) fn boundary(complex: &Complex, primitive: u32) -> Vec<[u32; 3]> {
    match *complex.primitive(primitive) {
        [i, j, k] => vec![[i, j, k]],
        [i, j] => vec![[i, j, j]],
        [i] => vec![[i; 3]],
        ref corners => {
            let facets = complex.hull_of(primitive).surface().triangles().expect("a surface is a mesh");
            facets.iter().map(|facet| facet.map(|i| corners[i as usize])).collect()
        }
    }
}

/// The surface of the hull of points. A flat hull has each triangle once.
fn hull_facets(points: &[DVec3]) -> Vec<[u32; 3]> {
    let Some(hull) = Hull::of(points) else {
        return Vec::new();
    };
    let mut facets = match *hull.vertices() {
        [i] => vec![[i; 3]],
        [i, j] => vec![[i, j, j]],
        _ => hull.triangles().to_vec(),
    };
    if hull.dimension() == 2 {
        facets.iter_mut().for_each(|facet| facet.sort_unstable());
        facets.sort_unstable();
        facets.dedup();
    }
    facets
}

fn corners_of(cuboid: &Cuboid) -> Vec<DVec3> {
    let half = 0.5 * cuboid.size();
    let sign = |i: u32, axis: u32| if i >> axis & 1 == 0 { -1.0 } else { 1.0 };
    (0..8).map(|i| half * DVec3::new(sign(i, 0), sign(i, 1), sign(i, 2))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hulls_of_every_dimension_have_facets() {
        let [x, y, z] = DVec3::AXES;
        for (points, count) in [
            (vec![x], 1),
            (vec![x, 2.0 * x, 3.0 * x], 1),
            (vec![DVec3::ZERO, x, y, x + y], 2),
            (vec![DVec3::ZERO, 2.0 * x, 2.0 * x + y, x + 2.0 * y, y], 3),
            (vec![DVec3::ZERO, x, y, z, 0.1 * DVec3::ONE], 4),
        ] {
            assert_eq!(hull_facets(&points).len(), count, "{points:?}");
        }
    }

    #[test]
    fn round_shapes_have_no_surface_of_facets() {
        assert!(Shape::sphere(1.0).unwrap().surface().is_none());
        let cuboid = Shape::cuboid([1.0, 2.0, 3.0]).unwrap();
        let surface = cuboid.surface().unwrap();
        assert_eq!((surface.complex().primitive_count(), surface.primitive(11)), (12, 0));
        assert_eq!(surface.complex().bounds().max, DVec3::new(0.5, 1.0, 1.5));
    }

    /// The second question finds what the first made, and it counts as the shape's memory.
    #[test]
    fn a_hull_keeps_its_surface() {
        let corner = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let hull = Shape::convex_hull(&corner).unwrap();
        let before = hull.memory();
        let [first, second] = [hull.surface().unwrap(), hull.surface().unwrap()];
        assert!(std::ptr::eq(first.complex(), second.complex()) && hull.memory() > before);
    }
}
