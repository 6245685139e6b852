//! A world that tests every pair, to compare with.

use std::collections::HashMap;

use glam::DAffine3;
use solid3d::query::{ContactOptions, ContactPoint};
use solid3d::{Collision, Contact, Error, ObjectId, Response, Shape, glam, query};

use super::common::Soup;

/// What the model knows of an object: all of it, now and in the previous frame.
#[derive(Clone)]
pub struct Thing {
    pub id: ObjectId,
    pub shape: Shape,
    pub placement: DAffine3,
    pub before: (Shape, DAffine3),
    /// What the vertices are deformations of.
    pub soup: Option<Soup>,
    /// How far it reaches from its origin, about.
    pub size: f64,
}

/// A straightforward world: no candidates, no caches, no boxes.
#[derive(Clone, Default)]
pub struct Model {
    /// In creation order.
    pub things: Vec<Thing>,
    pub default: Option<Response>,
    pub objects: HashMap<ObjectId, Response>,
    pub pairs: HashMap<(ObjectId, ObjectId), Response>,
}

impl Model {
    pub fn response(&self, first: &Thing, second: &Thing) -> Response {
        let (a, b) = (first.id, second.id);
        if let Some(response) = self.pairs.get(&(a, b)).or_else(|| self.pairs.get(&(b, a))) {
            return *response;
        }
        let of_object = self.objects.get(&a).or_else(|| self.objects.get(&b));
        of_object.copied().or(self.default).unwrap_or(Response::Witness)
    }

    pub fn collide(&self, i: usize, j: usize) -> bool {
        let (a, b) = (&self.things[i], &self.things[j]);
        self.response(a, b) != Response::Ignore
            && query::intersects(&a.shape, &a.placement, &b.shape, &b.placement).unwrap()
    }

    /// Every pair that collides, in creation order.
    pub fn collisions(&self) -> Vec<(usize, usize)> {
        let n = self.things.len();
        let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
        pairs.filter(|&(i, j)| self.collide(i, j)).collect()
    }

    pub fn index(&self, id: ObjectId) -> Option<usize> {
        self.things.iter().position(|thing| thing.id == id)
    }

    /// Checks a collision's contact.
    pub fn check(&self, collision: &Collision) {
        let (a, b) = (self.index(collision.a).unwrap(), self.index(collision.b).unwrap());
        assert!(a < b, "the object created first comes first");
        let (a, b) = (&self.things[a], &self.things[b]);
        assert_eq!(collision.response(), self.response(a, b));
        let size = a.size + b.size + (a.placement.translation - b.placement.translation).length();
        match collision.contact {
            Contact::Simple => {}
            Contact::Witness { point, local_a, local_b } => {
                let spot = Shape::convex_hull(&[point]).unwrap();
                for (thing, local) in [(a, local_a), (b, local_b)] {
                    let off =
                        query::distance(&thing.shape, &thing.placement, &spot, &DAffine3::IDENTITY).unwrap();
                    assert!(off.distance <= 1e-9 * size, "the witness is off by {}", off.distance);
                    let off = thing.placement.transform_point3(local).distance(point);
                    assert!(off <= 1e-9 * size, "the local witness is off by {off}");
                }
            }
            Contact::Smart { point_on_a, point_on_b, local_a, local_b, distance, normal } => {
                let ((shape_a, at_a), (shape_b, at_b)) = (&a.before, &b.before);
                let size = a.size + b.size + (at_a.translation - at_b.translation).length();
                let then = query::distance(shape_a, at_a, shape_b, at_b).unwrap();
                // Of soups, the pair of primitives that meet now need not be the nearest of all.
                let soups = [shape_a, shape_b].iter().any(|shape| shape.primitive_count() > 1);
                let least = then.distance - 1e-9 * size;
                assert!(distance.max(0.0) >= least, "{distance} for {}", then.distance);
                assert!(soups || distance <= then.distance + 1e-9 * size, "{distance} for {}", then.distance);
                assert!(at_a.transform_point3(local_a).distance(point_on_a) <= 1e-12 * size);
                assert!(at_b.transform_point3(local_b).distance(point_on_b) <= 1e-12 * size);
                for (shape, at, point) in [(shape_a, at_a, point_on_a), (shape_b, at_b, point_on_b)] {
                    let spot = Shape::convex_hull(&[point]).unwrap();
                    let off = query::distance(shape, at, &spot, &DAffine3::IDENTITY).unwrap().distance;
                    let curved = if distance < 0.0 { 1e-6 } else { 1e-9 };
                    assert!(off <= curved * size, "a point is off by {off}");
                }
                assert!((normal.length() - 1.0).abs() < 1e-12);
                let missed = (point_on_a - point_on_b).distance(normal * distance);
                let error = if distance < 0.0 { 1e-3 } else { 1e-9 };
                assert!(missed <= error * size, "the normal points elsewhere, {missed:e} off for {distance}");
            }
            Contact::Curve { point, ref curve } => {
                match query::intersection_curve(&a.shape, &a.placement, &b.shape, &b.placement) {
                    Ok(expected) => assert_eq!(**curve, expected),
                    Err(error) => assert!(matches!(error, Error::NoFacets { .. }) && curve.is_empty()),
                }
                let spot = Shape::convex_hull(&[point]).unwrap();
                for thing in [a, b] {
                    let off =
                        query::distance(&thing.shape, &thing.placement, &spot, &DAffine3::IDENTITY).unwrap();
                    assert!(off.distance <= 1e-9 * size, "the point is off by {}", off.distance);
                }
            }
            Contact::Depth { depth, normal, point_on_a, point_on_b } => {
                let expected = query::penetration(&a.shape, &a.placement, &b.shape, &b.placement).unwrap();
                match expected {
                    Some(found) => {
                        assert_eq!((depth, normal), (found.depth, found.normal));
                        assert_eq!((point_on_a, point_on_b), (found.point_on_a, found.point_on_b));
                    }
                    None => assert_eq!(depth, 0.0),
                }
            }
            Contact::Contacts { point, ref manifolds } => {
                let options = ContactOptions::default();
                let expected = query::contacts(&a.shape, &a.placement, &b.shape, &b.placement, &options);
                assert_eq!(**manifolds, expected.unwrap()[..]);
                let all = || manifolds.iter().flat_map(|manifold| &manifold.points);
                let greatest = all().map(|contact| contact.depth).reduce(f64::max);
                assert_eq!(collision.depth(), greatest);
                let middle = |contact: &ContactPoint| 0.5 * contact.point_on_a + 0.5 * contact.point_on_b;
                let deepest = all().find(|contact| Some(contact.depth) == greatest);
                assert!(deepest.is_none_or(|contact| middle(contact) == point));
            }
            _ => panic!("{collision:?}"),
        }
    }
}
