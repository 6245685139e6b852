//! The radius of a shape.

use glam::DVec3;
use solid_convex::Support;

use super::{Geometry, Shape};
use crate::placement::length;

impl Shape {
    /// The radius of the smallest ball about the local origin that contains the shape, up to rounding. Cost: linear in the
    /// vertices.
    pub(crate) fn radius(&self) -> f64 {
        match &self.geometry {
            Geometry::Sphere(sphere) => sphere.radius(),
            Geometry::Cuboid(cuboid) => furthest([cuboid.reach()]),
            Geometry::Cone(cone) => rim(cone.radius(), cone.height()),
            Geometry::Cylinder(cylinder) => rim(cylinder.radius(), cylinder.height()),
            Geometry::Capsule(capsule) => capsule.radius() + capsule.half_height(),
            Geometry::Polytope(hull) => hull.polytope().farthest(),
            Geometry::Complex(complex) => {
                furthest(complex.indices().iter().map(|&index| complex.vertices()[index as usize]))
            }
        }
    }
}

/// The distance of the base's rim; no other point of a cone or a cylinder is further, for the apex is as far along the axis.
fn rim(radius: f64, height: f64) -> f64 {
    length(DVec3::new(radius, 0.5 * height, 0.0))
}

/// The distance of the furthest point.
fn furthest(points: impl IntoIterator<Item = DVec3>) -> f64 {
    points.into_iter().map(length).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ComplexShapeBuilder, Result};

    #[test]
    fn the_radius_of_each_kind() -> Result<()> {
        let corners = [DVec3::new(1.0, 2.0, 2.0), DVec3::X, DVec3::Y, DVec3::new(9.0, 0.0, 0.0)];
        let square = [(0.0, 0.0), (1.0, 0.0), (4.0, 3.0), (0.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        let expected = [
            (Shape::sphere(2.0)?, 2.0),
            (Shape::cuboid([2.0, 4.0, 4.0])?, 3.0),
            (Shape::cone(3.0, 8.0)?, 5.0),
            (Shape::cylinder(3.0, 8.0)?, 5.0),
            (Shape::capsule(1.0, 4.0)?, 3.0),
            (Shape::convex_hull(&corners[..3])?, 3.0),
            (Shape::mesh(corners, [[0, 1, 2]])?, 3.0), // no primitive names the fourth vertex
            (ComplexShapeBuilder::new(square).simple_polygon(&[0, 1, 2, 3]).build()?, 5.0),
        ];
        for (shape, radius) in expected {
            assert!((shape.radius() - radius).abs() < 1e-15, "{}: {}", shape.kind(), shape.radius());
        }
        Ok(())
    }
}
