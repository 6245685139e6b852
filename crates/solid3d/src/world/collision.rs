//! What a test finds.

use glam::DVec3;

use solid_convex::{Closest, Witness};

use super::{ObjectId, Response, When};
use crate::pair::{self, Placed, Scratch};

/// Two objects that collide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collision {
    /// The object that was created first.
    pub a: ObjectId,
    /// The other.
    pub b: ObjectId,
    /// Whether they collide as they are now.
    pub when: When,
    /// What the pair's response asked for.
    pub contact: Contact,
}

/// What is known of a collision, by the response of the pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Contact {
    /// Nothing more ([`Response::Simple`]).
    Simple,
    /// A common point ([`Response::Witness`]).
    ///
    /// Of objects that collided [on the way](When::OnTheWay), a common point of the volumes that they swept; `local_a` and
    /// `local_b` are then that point as seen from where they are now, and need not belong to them.
    Witness {
        /// The point. Space: world.
        point: DVec3,
        /// The same as a point of `a`. Space: local to `a`.
        local_a: DVec3,
        /// The same as a point of `b`. Space: local to `b`.
        local_b: DVec3,
    },
    /// The closest points of the previous frame ([`Response::Smart`]).
    Smart {
        /// The point of `a` that was closest to `b`. Space: world, where it was in the previous frame.
        point_on_a: DVec3,
        /// The point of `b` that was closest to `a`. Space: world, where it was in the previous frame.
        point_on_b: DVec3,
        /// `point_on_a`. Space: local to `a`.
        local_a: DVec3,
        /// `point_on_b`. Space: local to `b`.
        local_b: DVec3,
        /// The unit vector from `point_on_b` to `point_on_a`: an approximation of the normal of the contact. Space: world.
        /// `None` when the objects collided in the previous frame already, or were both added since: there is no direction
        /// then, and the points are a common point.
        normal: Option<DVec3>,
    },
}

impl Contact {
    /// A common point of two objects as they are.
    pub(super) fn witness(a: Placed, b: Placed, witness: &Witness) -> Contact {
        let point = pair::midpoint(a, b, witness);
        Contact::Witness { point, local_a: witness.on_a, local_b: witness.on_b }
    }

    /// A common point of the ways of two objects.
    pub(super) fn witness_on_the_way(a: Placed, b: Placed, point: DVec3) -> Contact {
        Contact::Witness { point, local_a: pair::to_local(a, point), local_b: pair::to_local(b, point) }
    }

    /// The closest points of two objects as they were.
    pub(super) fn smart(a: Placed, b: Placed, scratch: &mut Scratch) -> Contact {
        let Closest { distance, points } = pair::closest(a, b, scratch);
        let point_on_a = a.placement.transform_point3(points.on_a);
        let point_on_b = b.placement.transform_point3(points.on_b);
        let normal = if distance > 0.0 { (point_on_a - point_on_b).try_normalize() } else { None };
        Contact::Smart { point_on_a, point_on_b, local_a: points.on_a, local_b: points.on_b, normal }
    }
}

impl Collision {
    /// Where: the common point of a witness, the middle of the closest points of smart response; in the world.
    pub fn point(&self) -> Option<DVec3> {
        match self.contact {
            Contact::Simple => None,
            Contact::Witness { point, .. } => Some(point),
            Contact::Smart { point_on_a, point_on_b, .. } => Some(0.5 * point_on_a + 0.5 * point_on_b),
        }
    }

    /// The approximate normal of the contact, a unit vector from `b` to `a`: of smart response, where there is one.
    pub fn normal(&self) -> Option<DVec3> {
        match self.contact {
            Contact::Smart { normal, .. } => normal,
            Contact::Simple | Contact::Witness { .. } => None,
        }
    }

    /// The response that the collision was found for.
    pub fn response(&self) -> Response {
        match self.contact {
            Contact::Simple => Response::Simple,
            Contact::Witness { .. } => Response::Witness,
            Contact::Smart { .. } => Response::Smart,
        }
    }
}
