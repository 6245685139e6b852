//! Where two shapes are in contact.

use glam::DAffine3;

use super::{placed, unchecked};
use crate::error::{Result, at_least_zero};
use crate::pair::{self, ContactOptions, Manifold, Scratch};
use crate::shape::Shape;

/// All contacts of two placed shapes: regions in which their surfaces are in each other, or nearer than a margin, each with a normal
/// and its points. Empty when they do not intersect and are nowhere nearer than the margin.
///
/// - **Convex shapes** have one region, whose normal is that of their [`penetration`](super::penetration()), or of their closest
///   points. Its points are the corners of what their supporting faces have in common: all of them, also of faces with many
///   sides. A circle counts as 16 corners; an edge or the side of a cylinder on a face gives two points; two edges that
///   cross give one. Both points lie on the surfaces, of curved ones as near to them as the bounds of the depth to each other. The
///   greatest depth is the penetration depth, up to 1e-6 of it and 1e-9 of the size of the data.
/// - **Meshes and complex shapes** have a region for each part of the surface that is connected and has one normal there,
///   up to 0.001 radians. An edge or a corner inside the surface gives no normals of its own unless the surface is convex there: a
///   flat floor has only its own normal, however it is divided, and only the corners of the whole region. Wherever surfaces meet there is a contact: where no
///   primitive of a place tells one, it is that across an edge beside it, or of the primitive that is deepest; but none that leads into a solid.
/// - **A closed convex mesh** counts as the body that it bounds. What is inside one that is not solid, and does not collide with it, is
///   near its triangles.
/// - **Of more than a million pairs of primitives** of two meshes or complex shapes that meet, or are nearer than the margin, as where one lies in its own
///   place many times over, the one contact of the [`penetration`](super::penetration()), or of the closest points, which name no
///   primitives but the first, is told: all would take a gigabyte.
/// - **In a [solid](Shape::into_solid) mesh** that is not convex, normals point out of it. What is wholly inside has the
///   one contact of its [`penetration`](super::penetration()).
///
/// Regions, and points, are in an order of their own that is the same for the same input. Features and primitives of a
/// point stay the same while the same parts of the shapes are in contact.
///
/// Cost: that of the [`penetration`](super::penetration()), and some hundred nanoseconds for faces of four sides, more in proportion for faces of more; for a
/// convex hull, or a convex piece of a complex shape, also of finding its faces, once; for meshes for each pair of primitives whose boxes are as near,
/// where of a face of many sides a triangle looks at those near it, and O(n) once after each deformation; of a closed convex mesh
/// O(n log n), a microsecond or two for each triangle.
///
/// ```
/// use solid3d::{Shape, glam::{DAffine3, DVec3}, query::{self, ContactOptions}};
/// let block = Shape::cuboid([1.0, 1.0, 1.0])?;
/// let floor = Shape::mesh(
///     [[-9.0, 0.0, -9.0], [9.0, 0.0, -9.0], [9.0, 0.0, 9.0], [-9.0, 0.0, 9.0]].map(DVec3::from),
///     [[0, 2, 1], [0, 3, 2]],
/// )?;
/// let at = DAffine3::from_translation(DVec3::new(0.0, 0.49, 0.0));
/// let contacts = query::contacts(&block, &at, &floor, &DAffine3::IDENTITY, &ContactOptions::default())?;
/// assert_eq!((contacts.len(), contacts[0].points.len()), (1, 4)); // on both triangles: one region, the corners of the block
/// assert_eq!(contacts[0].normal, DVec3::Y);
/// assert!(contacts[0].points.iter().all(|point| (point.depth - 0.01).abs() < 1e-12));
///
/// let error = query::contacts(&block, &at, &block, &at, &ContactOptions { margin: -1.0, ..Default::default() });
/// assert_eq!(error.unwrap_err().to_string(), "margin is -1.0; it must be at least 0");
/// # Ok::<(), solid3d::Error>(())
/// ```
pub fn contacts(
    a: &Shape,
    placement_a: &DAffine3,
    b: &Shape,
    placement_b: &DAffine3,
    options: &ContactOptions,
) -> Result<Vec<Manifold>> {
    let options = options.checked()?;
    let (on_a, on_b) = (unchecked(a, placement_a), unchecked(b, placement_b));
    if let Some(contact) = pair::quick_contact(on_a, on_b) {
        return Ok(vec![contact]);
    }
    let (a, b) = (placed("placement_a", a, placement_a)?, placed("placement_b", b, placement_b)?);
    Ok(Scratch::with(|scratch| pair::contacts_closely(a, b, options, scratch)))
}

impl ContactOptions {
    /// The options when they can be used.
    fn checked(&self) -> Result<&ContactOptions> {
        at_least_zero("margin", self.margin)?;
        Ok(self)
    }
}
