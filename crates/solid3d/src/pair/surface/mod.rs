//! The point of the surface of a shape that is nearest to a point, on whichever side of it.
//!
//! A signed distance is a distance outside and a penetration depth inside, both of which the table has: of a convex body the way out is
//! the shortest translation of the point that leaves the two touching. Bodies that stay what they are have a closed
//! form ([`nearest_on_surface`](super::nearest_on_surface)). A solid mesh
//! is its surface, on which the nearest triangle is looked for, with the side that the winding number gives.

mod solid;

use glam::{DAffine3, DVec3};
use solid_convex::gjk::TOUCHING_ERROR;

use super::reach::{image_reach, reach};
use super::{Placed, Scratch, closest, penetration};
use crate::placement::direction;
use crate::shape::{Class, ShapeKind};

/// How far a point is from the surface of a shape, and where that is nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignedDistance {
    /// The distance to the surface: negative inside a solid. World units.
    pub distance: f64,
    /// The nearest point of the surface. Space: world.
    pub point: DVec3,
    /// The unit vector out of the shape, across the surface there: the point that was asked about is at `point + normal * distance`.
    /// Space: world.
    pub normal: DVec3,
}

/// How near to a surface the way from its nearest point is no longer a normal: rounding then has half of its digits, or more.
/// Relative to the size of the data.
const NEAR: f64 = 4.0 * TOUCHING_ERROR;

/// The point of the surface of `shape` nearest to `point`, a shape of one point; of a body that has a closed form, where that says nothing.
pub(crate) fn surface_point(shape: Placed, point: Placed, scratch: &mut Scratch) -> SignedDistance {
    match (shape.shape.class(), point.shape.class()) {
        (Class::Complex(mesh), Class::Convex(one)) if mesh.is_solid() => {
            solid::surface_point((mesh, shape.placement), (one, point.placement), scratch)
        }
        _ => of_union(shape, point, scratch),
    }
}

/// Of a convex shape, or a union of such.
fn of_union(shape: Placed, point: Placed, scratch: &mut Scratch) -> SignedDistance {
    if let Some(found) = penetration(point, shape, scratch) {
        let on_surface = shape.placement.transform_point3(found.points.on_b);
        // A surface has no inside, whatever rounding makes of its thickness; and 0 is not -0.
        let has_inside = shape.shape.kind() != ShapeKind::Mesh && found.depth > 0.0;
        let distance = if has_inside { -found.depth } else { 0.0 };
        return SignedDistance { distance, point: on_surface, normal: found.direction };
    }
    let closest = closest(shape, point, scratch);
    // Not from points of the world, whose rounding is that of their coordinates.
    let offset = point.placement.translation - shape.placement.translation;
    let way = offset - shape.placement.matrix3 * closest.points.on_a;
    let on_surface = shape.placement.transform_point3(closest.points.on_a);
    let normal = if closest.distance > NEAR * (placed_reach(shape) + offset.abs().max_element()) {
        away(way)
    } else {
        let foot = DAffine3::from_translation(on_surface);
        let touching = penetration(Placed { placement: &foot, ..point }, shape, scratch);
        let normal = touching.map_or_else(|| away(way), |found| found.direction);
        // What is flat has two sides.
        if normal.dot(way) < 0.0 { -normal } else { normal }
    };
    SignedDistance { distance: closest.distance, point: on_surface, normal }
}

/// The direction of a vector; of zero any.
fn away(v: DVec3) -> DVec3 {
    direction(v).unwrap_or(DVec3::X)
}

/// How far a shape reaches from its origin in the world.
fn placed_reach(shape: Placed) -> f64 {
    image_reach(&shape.placement.matrix3, reach(shape.shape)).max_element()
}
