//! A point and a placed shape.

use std::f64::consts::TAU;
use std::sync::LazyLock;

use glam::{DAffine3, DVec3};

use super::{Distance, distance, intersects, placed, unchecked};
use crate::error::{Error, Result, bounded};
use crate::pair::{self, ClosestPoint, Placed};
use crate::shape::{Shape, ShapeKind};
use crate::solid_angle::half_solid_angle;

/// Whether a point is in a placed shape: in a convex shape or a solid mesh, or on the surface of a mesh or a complex shape.
/// Right beyond 1e-12 of the size of the data; of solid meshes beyond the rounding of their placed corners, some 1e-15 of it.
///
/// ```
/// use solid3d::{Shape, query, glam::{DAffine3, DVec3}};
/// let (ball, here) = (Shape::sphere(1.0)?, DAffine3::IDENTITY);
/// assert!(query::contains_point(&ball, &here, DVec3::X)?);
/// assert!(!query::contains_point(&ball, &here, DVec3::X * 1.001)?);
/// # Ok::<(), solid3d::Error>(())
/// ```
pub fn contains_point(shape: &Shape, placement: &DAffine3, point: DVec3) -> Result<bool> {
    if let Some(answer) = pair::contains(unchecked(shape, placement), point) {
        return Ok(answer);
    }
    let Placed { shape, placement } = placed("placement", shape, placement)?;
    let (of_point, at) = as_shape(point)?;
    intersects(shape, placement, of_point, &at)
}

/// The point of a placed shape that is closest to a point, and their distance: of solids 0 inside, where the point itself is the
/// closest; [`signed_distance`](super::signed_distance) is that to the surface. Cost and error are those of [`distance`](distance()).
///
/// ```
/// use solid3d::{Shape, query, glam::{DAffine3, DVec3}};
/// let block = Shape::cuboid([2.0, 2.0, 2.0])?;
/// let closest = query::closest_point(&block, &DAffine3::IDENTITY, DVec3::new(4.0, 5.0, 0.5))?;
/// assert_eq!((closest.distance, closest.point), (5.0, DVec3::new(1.0, 1.0, 0.5)));
/// # Ok::<(), solid3d::Error>(())
/// ```
pub fn closest_point(shape: &Shape, placement: &DAffine3, point: DVec3) -> Result<ClosestPoint> {
    pair::closest_to(unchecked(shape, placement), point, || at_length(shape, placement, point))
}

/// The same, of whatever has no closed form.
#[inline(never)]
fn at_length(shape: &Shape, placement: &DAffine3, point: DVec3) -> Result<ClosestPoint> {
    let Placed { shape, placement } = placed("placement", shape, placement)?;
    let (of_point, at) = as_shape(point)?;
    let Distance { distance, point_on_a, .. } = distance(shape, placement, of_point, &at)?;
    // What is inside is itself the closest, whatever its coordinates lose on the way to local space and back.
    Ok(ClosestPoint { point: if distance == 0.0 { point } else { point_on_a }, distance })
}

/// How often a mesh winds around a point: the generalised winding number. Of a closed mesh, solid or not, it is a whole number up to the
/// error, 1 inside when its triangles show their front outside, -1 when they show their back; of a mesh with holes, overlaps or faces that
/// are turned the wrong way it is near 1 well inside and near 0 well outside, so that above 0.5 is a good guess for inside. On the surface
/// it jumps, and is some value between.
///
/// The sum of the solid angles of all triangles over that of a sphere (Jacobson, Kavan and Sorkine-Hornung, *Robust
/// Inside-Outside Segmentation using Generalized Winding Numbers*, 2013), each by the formula of Van Oosterom and Strackee, 1983. A
/// mirroring placement does not turn the mesh inside out. The error is some 1e-16 for each triangle; next to an edge, nearer than a part d of
/// its length, that over d. A shape that is not a mesh is an [`Error::NotAMesh`]. Cost: linear.
///
/// ```
/// use solid3d::{Shape, query, glam::{DAffine3, DVec3}};
/// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let closed = Shape::mesh(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let open = Shape::mesh(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2]])?;
/// let here = DAffine3::IDENTITY;
/// let of = |mesh: &Shape, x: f64| query::winding_number(mesh, &here, DVec3::splat(x));
/// assert!((of(&closed, 0.2)? - 1.0).abs() < 1e-12 && of(&closed, 2.0)?.abs() < 1e-12);
/// assert!(of(&open, 0.1)? > 0.5 && of(&open, 2.0)?.abs() < 0.1);
/// # Ok::<(), solid3d::Error>(())
/// ```
pub fn winding_number(mesh: &Shape, placement: &DAffine3, point: DVec3) -> Result<f64> {
    let placed = placed("placement", mesh, placement)?;
    bounded("point", point)?;
    let (Some(vertices), Some(triangles), ShapeKind::Mesh) = (mesh.vertices(), mesh.triangles(), mesh.kind())
    else {
        return Err(Error::NotAMesh { kind: mesh.kind() });
    };
    let seen = |i: u32| placed.placement.transform_point3(vertices[i as usize]) - point;
    let halves: f64 = triangles.iter().map(|t| half_solid_angle(t.map(seen))).sum();
    Ok(halves / TAU * placed.placement.matrix3.determinant().signum())
}

/// The origin as a shape.
static ORIGIN: LazyLock<Shape> =
    LazyLock::new(|| Shape::convex_hull(&[DVec3::ZERO]).expect("a point has a hull"));

/// A point as a shape, which is placed.
pub(super) fn as_shape(point: DVec3) -> Result<(&'static Shape, DAffine3)> {
    bounded("point", point)?;
    Ok((&ORIGIN, DAffine3::from_translation(point)))
}
