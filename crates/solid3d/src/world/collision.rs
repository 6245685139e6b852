//! What a test finds.

use std::sync::Arc;

use glam::DVec3;
use solid_convex::Witness;

use super::{ObjectId, Response, When};
use crate::pair::{
    self, Approach, ContactOptions, ContactPoint, IntersectionCurve, Manifold, Placed, Scratch,
};

/// Two objects that collide.
#[derive(Clone, Debug, PartialEq)]
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

impl Collision {
    /// Becomes a copy of another. Of most nothing more is known than that they are: then little is moved.
    #[inline]
    pub(super) fn take_from(&mut self, other: &Collision) {
        if let (Contact::Simple, Contact::Simple) = (&self.contact, &other.contact) {
            (self.a, self.b, self.when) = (other.a, other.b, other.when);
        } else {
            self.clone_from(other);
        }
    }
}

/// What is known of a collision, by the response of the pair. Cheap to clone.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
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
    /// How the objects came together since the previous frame ([`Response::Smart`]).
    ///
    /// Of convex objects it is said of the objects, of meshes and complex shapes of one pair of primitives among all that intersect now:
    /// the pair that was nearest in the previous frame. What was apart there has its closest points; what
    /// intersected there already (because it was not resolved, or nothing was since it was added) has the points of each that were deepest in
    /// the other, as [`query::penetration`](crate::query::penetration) gives them, of the deepest pair of primitives. What is a primitive is
    /// said there, too.
    /// The whole objects are looked at when one got another shape, when a solid contains the other, and [on the way](When::OnTheWay).
    Smart {
        /// The point of `a`. Space: world, where it was in the previous frame.
        point_on_a: DVec3,
        /// The point of `b`. Space: world, where it was in the previous frame.
        point_on_b: DVec3,
        /// `point_on_a`. Space: local to `a`.
        local_a: DVec3,
        /// `point_on_b`. Space: local to `b`.
        local_b: DVec3,
        /// How far the points were apart; negative for what intersected there already: less the depth. World units.
        distance: f64,
        /// The unit vector along which `a` was off `b`, from `point_on_b` to `point_on_a`; or, where they intersected already, would
        /// have left it soonest, from `point_on_a` to `point_on_b`. An approximation of the normal of the contact. Where many directions are
        /// as good, as for balls in one place, it is one of them. Space: world.
        normal: DVec3,
    },
    /// Where the surfaces meet ([`Response::Curve`]).
    Curve {
        /// The first point of the curve; a common point, also of two ways, when the curve is empty. Space: world.
        point: DVec3,
        /// The curve, as [`query::intersection_curve`](crate::query::intersection_curve) gives it. Empty when one of the
        /// shapes is round (sphere, cone, cylinder, capsule), when a solid contains the other object, or on the way.
        curve: Arc<IntersectionCurve>,
    },
    /// How deep the objects are in each other ([`Response::Depth`]), as [`query::penetration`](crate::query::penetration) gives it.
    ///
    /// Of objects that collided [on the way](When::OnTheWay) and are apart now, the depth is 0, the points are the closest now, and
    /// the normal is the direction between these.
    Depth {
        /// The length of the shortest translation that leaves them touching, at least 0. World units.
        depth: f64,
        /// The unit vector along which `a` is to move by the depth, from `b` to `a`. Space: world.
        normal: DVec3,
        /// The point of `a` that is deepest in `b`. Space: world.
        point_on_a: DVec3,
        /// The point of `b` that is deepest in `a`. Space: world.
        point_on_b: DVec3,
    },
    /// All points of contact ([`Response::Contacts`]).
    Contacts {
        /// The middle of the points of the deepest contact; a common point, also of two ways, when there is no contact. Space: world.
        point: DVec3,
        /// The contacts, as [`query::contacts`](crate::query::contacts) gives them, with no margin. Empty
        /// [on the way](When::OnTheWay).
        manifolds: Arc<[Manifold]>,
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

    /// How two objects came together, from as they were to as they are.
    pub(super) fn smart(now: [Placed; 2], before: [Placed; 2], scratch: &mut Scratch) -> Contact {
        let Approach { points, distance, normal } = pair::approach(now, before, scratch);
        let [point_on_a, point_on_b] = [(before[0], points.on_a), (before[1], points.on_b)]
            .map(|(placed, point)| placed.placement.transform_point3(point));
        Contact::Smart {
            point_on_a,
            point_on_b,
            local_a: points.on_a,
            local_b: points.on_b,
            distance,
            normal,
        }
    }

    /// How deep two objects are in each other as they are.
    pub(super) fn depth(a: Placed, b: Placed, scratch: &mut Scratch) -> Contact {
        let Approach { points, distance, normal } = pair::overlap(a, b, scratch);
        let point_on_a = a.placement.transform_point3(points.on_a);
        let point_on_b = b.placement.transform_point3(points.on_b);
        Contact::Depth { depth: distance.abs(), normal, point_on_a, point_on_b }
    }

    /// Where the surfaces of two objects meet that intersect.
    pub(super) fn curve(a: Placed, b: Placed, scratch: &mut Scratch) -> Contact {
        // What has no facets has no curve.
        let curve = pair::intersection_curve(a, b, scratch).unwrap_or_default();
        let point = curve.first_point().unwrap_or_else(|| common_point(a, b, scratch));
        Contact::Curve { point, curve: Arc::new(curve) }
    }

    /// The contacts of two objects that intersect.
    pub(super) fn contacts(a: Placed, b: Placed, scratch: &mut Scratch) -> Contact {
        let manifolds: Arc<[Manifold]> = match pair::quick_contact(a, b) {
            Some(contact) => Arc::new([contact]),
            None => pair::contacts_closely(a, b, &ContactOptions::default(), scratch).into(),
        };
        let point = match deepest(&manifolds) {
            Some((_, contact)) => 0.5 * contact.point_on_a + 0.5 * contact.point_on_b,
            None => common_point(a, b, scratch),
        };
        Contact::Contacts { point, manifolds }
    }
}

/// A point that two objects have in common, of the world.
fn common_point(a: Placed, b: Placed, scratch: &mut Scratch) -> DVec3 {
    pair::midpoint(a, b, &pair::closest(a, b, scratch).points)
}

/// The deepest contact, and the manifold that it is of; of equal ones the first.
fn deepest(manifolds: &[Manifold]) -> Option<(&Manifold, &ContactPoint)> {
    let all =
        manifolds.iter().flat_map(|manifold| manifold.points.iter().map(move |point| (manifold, point)));
    all.reduce(|best, next| if next.1.depth > best.1.depth { next } else { best })
}

impl Collision {
    /// Where: the common point of a witness, the middle of the closest points of smart response, or of the deepest points or the
    /// deepest contact, the first point of a curve; in the world.
    pub fn point(&self) -> Option<DVec3> {
        match self.contact {
            Contact::Simple => None,
            Contact::Witness { point, .. }
            | Contact::Curve { point, .. }
            | Contact::Contacts { point, .. } => Some(point),
            Contact::Smart { point_on_a, point_on_b, .. } | Contact::Depth { point_on_a, point_on_b, .. } => {
                Some(0.5 * point_on_a + 0.5 * point_on_b)
            }
        }
    }

    /// The approximate normal of the contact, a unit vector from `b` to `a`: of smart response, of depth, and of the deepest contact.
    pub fn normal(&self) -> Option<DVec3> {
        match self.contact {
            Contact::Smart { normal, .. } | Contact::Depth { normal, .. } => Some(normal),
            Contact::Contacts { ref manifolds, .. } => {
                deepest(manifolds).map(|(manifold, _)| manifold.normal)
            }
            Contact::Simple | Contact::Witness { .. } | Contact::Curve { .. } => None,
        }
    }

    /// How deep the objects are in each other, if the response asked for it ([`Response::Depth`]), or the depth of the deepest contact
    /// ([`Response::Contacts`]). World units.
    ///
    /// ```
    /// use solid3d::{Response, Shape, World, glam::{DAffine3, DVec3}};
    /// let mut world = World::new();
    /// world.set_default_response(Response::Depth);
    /// let block = Shape::cuboid([2.0, 2.0, 2.0])?;
    /// world.add(&block, DAffine3::IDENTITY)?;
    /// world.add(&block, DAffine3::from_translation(DVec3::Y * 1.75))?;
    /// let collisions = world.test();
    /// assert_eq!((collisions[0].depth(), collisions[0].normal()), (Some(0.25), Some(-DVec3::Y)));
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn depth(&self) -> Option<f64> {
        match self.contact {
            Contact::Depth { depth, .. } => Some(depth),
            Contact::Contacts { ref manifolds, .. } => deepest(manifolds).map(|(_, point)| point.depth),
            _ => None,
        }
    }

    /// All points of contact, if the response asked for them. Shared, to keep without copying.
    ///
    /// ```
    /// use solid3d::{Response, Shape, World, glam::{DAffine3, DVec3}};
    /// let mut world = World::new();
    /// world.set_default_response(Response::Contacts);
    /// let block = Shape::cuboid([2.0, 2.0, 2.0])?;
    /// world.add(&block, DAffine3::IDENTITY)?;
    /// let above = |z: f64| DAffine3::from_translation(DVec3::new(0.5, 1.75, z));
    /// let upper = world.add(&block, above(0.25))?;
    /// let names = |world: &mut World| {
    ///     let collisions = world.test();
    ///     let manifolds = collisions[0].manifolds().unwrap();
    ///     assert_eq!((manifolds.len(), manifolds[0].normal), (1, DVec3::NEG_Y));
    ///     manifolds[0].points.iter().map(|point| (point.primitives, point.features)).collect::<Vec<_>>()
    /// };
    /// let before = names(&mut world);
    /// world.set_placement(upper, above(0.375))?;
    /// assert_eq!((before.len(), &before), (4, &names(&mut world))); // they persist
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn manifolds(&self) -> Option<&Arc<[Manifold]>> {
        match &self.contact {
            Contact::Contacts { manifolds, .. } => Some(manifolds),
            _ => None,
        }
    }

    /// Where the surfaces meet, if the response asked for it. Shared, to keep without copying.
    ///
    /// ```
    /// use solid3d::{Response, Shape, World, glam::{DAffine3, DVec3}};
    /// let mut world = World::new();
    /// world.set_default_response(Response::Curve);
    /// let block = Shape::cuboid([2.0, 2.0, 2.0])?;
    /// world.add(&block, DAffine3::IDENTITY)?;
    /// world.add(&block, DAffine3::from_translation(DVec3::ONE))?;
    /// let collisions = world.test();
    /// assert_eq!(collisions[0].curve().unwrap().length(), 6.0); // around the corner, from face to face
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn curve(&self) -> Option<&Arc<IntersectionCurve>> {
        match &self.contact {
            Contact::Curve { curve, .. } => Some(curve),
            _ => None,
        }
    }

    /// The response that the collision was found for.
    pub fn response(&self) -> Response {
        match self.contact {
            Contact::Simple => Response::Simple,
            Contact::Witness { .. } => Response::Witness,
            Contact::Smart { .. } => Response::Smart,
            Contact::Curve { .. } => Response::Curve,
            Contact::Depth { .. } => Response::Depth,
            Contact::Contacts { .. } => Response::Contacts,
        }
    }
}
