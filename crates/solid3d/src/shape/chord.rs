//! Lines through shapes that have a closed form for it.

use solid_convex::{Chord, Line};

use super::{Geometry, Shape};

impl Shape {
    /// The part of a line, in local space, that is in the shape; `None` for a kind without a closed form, or where that does not tell.
    #[inline(always)]
    pub(crate) fn chord(&self, line: &Line) -> Option<Option<Chord>> {
        match &self.geometry {
            Geometry::Sphere(shape) => Some(shape.chord(line)),
            Geometry::Cuboid(shape) => Some(shape.chord(line)),
            Geometry::Cone(shape) => Some(shape.chord(line)),
            Geometry::Cylinder(shape) => Some(shape.chord(line)),
            Geometry::Capsule(shape) => Some(shape.chord(line)),
            Geometry::Polytope(shape) => shape.polytope().chord(line),
            Geometry::Complex(_) => None,
        }
    }
}
