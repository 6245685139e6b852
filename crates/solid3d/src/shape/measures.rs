//! What simple shapes measure.

use solid_convex::{Capsule, Cone, Cuboid, Cylinder, Sphere};

use super::{Geometry, Shape};

/// # Measures
///
/// A shape as the kind that it is, with the measures that it was made with; `None` when it is of another. Convex hulls, meshes and
/// complex shapes have [`vertices`](Shape::vertices).
///
/// ```
/// use solid3d::{Shape, glam::DVec3};
/// let block = Shape::cuboid([1.0, 2.0, 3.0])?;
/// assert_eq!(block.as_cuboid().unwrap().size(), DVec3::new(1.0, 2.0, 3.0));
/// assert_eq!(block.as_sphere(), None);
/// let cone = Shape::cone(0.5, 2.0)?;
/// assert_eq!(cone.as_cone().map(|cone| (cone.radius(), cone.height())), Some((0.5, 2.0)));
/// # Ok::<(), solid3d::Error>(())
/// ```
impl Shape {
    /// As a ball.
    pub fn as_sphere(&self) -> Option<&Sphere> {
        match &self.geometry {
            Geometry::Sphere(sphere) => Some(sphere),
            _ => None,
        }
    }

    /// As a box.
    pub fn as_cuboid(&self) -> Option<&Cuboid> {
        match &self.geometry {
            Geometry::Cuboid(cuboid) => Some(cuboid),
            _ => None,
        }
    }

    /// As a cone.
    pub fn as_cone(&self) -> Option<&Cone> {
        match &self.geometry {
            Geometry::Cone(cone) => Some(cone),
            _ => None,
        }
    }

    /// As a cylinder.
    pub fn as_cylinder(&self) -> Option<&Cylinder> {
        match &self.geometry {
            Geometry::Cylinder(cylinder) => Some(cylinder),
            _ => None,
        }
    }

    /// As a capsule.
    pub fn as_capsule(&self) -> Option<&Capsule> {
        match &self.geometry {
            Geometry::Capsule(capsule) => Some(capsule),
            _ => None,
        }
    }
}
