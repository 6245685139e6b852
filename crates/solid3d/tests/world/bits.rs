//! Collisions as bits.

use glam::DVec3;
use solid3d::query::ContactPoint;
use solid3d::{Collision, Contact, ObjectId, glam};

/// The objects, the kind of contact, the numbers.
pub type Bits = (ObjectId, ObjectId, u8, Vec<u64>);

/// A collision as bits.
pub fn bits(collision: &Collision) -> Bits {
    let of = |points: &[DVec3]| points.iter().flat_map(|p| p.to_array()).map(f64::to_bits).collect();
    let (kind, numbers) = match collision.contact {
        Contact::Simple => (0, Vec::new()),
        Contact::Witness { point, local_a, local_b } => (1, of(&[point, local_a, local_b])),
        Contact::Smart { point_on_a, point_on_b, local_a, local_b, distance, normal } => {
            let distance = DVec3::splat(distance);
            (2, of(&[point_on_a, point_on_b, local_a, local_b, distance, normal]))
        }
        Contact::Curve { point, ref curve } => {
            let points = curve.polylines.iter().flat_map(|polyline| polyline.path());
            (4, of(&std::iter::once(point).chain(points).collect::<Vec<_>>()))
        }
        Contact::Depth { depth, normal, point_on_a, point_on_b } => {
            (3, of(&[DVec3::splat(depth), normal, point_on_a, point_on_b]))
        }
        Contact::Contacts { point, ref manifolds } => {
            let depth = |contact: &ContactPoint| DVec3::splat(contact.depth);
            let contact = |c: &ContactPoint| [c.point_on_a, c.point_on_b, depth(c)];
            let points = manifolds.iter().flat_map(|manifold| manifold.points.iter().flat_map(contact));
            let normals = manifolds.iter().map(|manifold| manifold.normal);
            (5, of(&std::iter::once(point).chain(normals).chain(points).collect::<Vec<_>>()))
        }
        _ => panic!("{collision:?}"),
    };
    (collision.a, collision.b, kind, numbers)
}

pub fn all_bits(collisions: &[Collision]) -> Vec<Bits> {
    collisions.iter().map(bits).collect()
}
