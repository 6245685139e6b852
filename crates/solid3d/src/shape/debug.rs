//! What a shape is, in a line.

use std::fmt;

use super::{Geometry, Shape};

/// The measures of a simple shape; of others how large they are, not their numbers.
///
/// ```
/// use solid3d::{Shape, glam::DVec3};
/// assert_eq!(format!("{:?}", Shape::sphere(2.0)?), "Sphere { radius: 2.0 }");
/// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// assert_eq!(format!("{:?}", Shape::convex_hull(&corners)?), "ConvexHull { vertices: 3, .. }");
/// let mesh = Shape::mesh(corners, vec![[0, 1, 2]; 100])?;
/// assert_eq!(format!("{mesh:?}"), "Mesh { primitives: 100, vertices: 3, is_solid: false, .. }");
/// # Ok::<(), solid3d::Error>(())
/// ```
impl fmt::Debug for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.geometry {
            Geometry::Sphere(sphere) => sphere.fmt(f),
            Geometry::Cuboid(cuboid) => cuboid.fmt(f),
            Geometry::Cone(cone) => cone.fmt(f),
            Geometry::Cylinder(cylinder) => cylinder.fmt(f),
            Geometry::Capsule(capsule) => capsule.fmt(f),
            Geometry::Polytope(hull) => {
                f.debug_struct("ConvexHull").field("vertices", &hull.points().len()).finish_non_exhaustive()
            }
            Geometry::Complex(complex) => f
                .debug_struct(if complex.is_mesh() { "Mesh" } else { "Complex" })
                .field("primitives", &complex.primitive_count())
                .field("vertices", &complex.vertices().len())
                .field("is_solid", &complex.is_solid())
                .finish_non_exhaustive(),
        }
    }
}
