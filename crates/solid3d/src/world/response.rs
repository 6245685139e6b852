//! The response table: which pairs matter, and what is wanted of them (thesis, sections 6.2 and B.4).

use std::collections::HashMap;

use slotmap::SecondaryMap;

use super::stirred::Staleness;
use super::{ObjectId, World};
use crate::error::{Error, Result};

/// What is wanted of the collisions of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Response {
    /// Nothing: the pair is not tested.
    Ignore,
    /// That it collides.
    Simple,
    /// A point that both objects have in common.
    Witness,
    /// The closest points of the previous frame, and their direction: an approximation of the contact (thesis,
    /// section 2.3). Of what intersected there already, the deepest points, and the shortest way out.
    Smart,
    /// The line segments in which the surfaces meet, joined into polylines (thesis, section 6.5): of meshes, complex shapes,
    /// boxes and convex hulls. Other kinds give a common point. Costs more than the others: all pairs of primitives are
    /// examined, not only up to the first that meets.
    Curve,
    /// How deep they are in each other as they are now, the shortest way out, and the deepest points
    /// ([`query::penetration`](crate::query::penetration)).
    Depth,
    /// All points of contact as they are now, with normals, depths, and the parts of the shapes that they are of, which stay the same
    /// from frame to frame ([`query::contacts`](crate::query::contacts)): what a simulation resolves collisions with. Of surfaces all
    /// pairs of primitives are examined, as for curves.
    Contacts,
}

/// Responses by default, per object and per pair.
#[derive(Clone, Debug)]
pub(super) struct ResponseTable {
    default: Response,
    objects: SecondaryMap<ObjectId, Response>,
    /// The lesser id first. Ids never come back, so pairs of objects that are gone do no harm until they are dropped.
    pairs: HashMap<(ObjectId, ObjectId), Response>,
    /// No fewer than the pairs of objects that are gone, and at most twice as many.
    forgotten: usize,
    /// Whether any response that was ever set depends on the previous frame.
    looks_back: bool,
}

impl ResponseTable {
    pub fn new(default: Response) -> Self {
        ResponseTable {
            default,
            objects: SecondaryMap::new(),
            pairs: HashMap::new(),
            forgotten: 0,
            looks_back: default == Response::Smart,
        }
    }

    /// Whether a response may depend on the previous frame.
    pub fn looks_back(&self) -> bool {
        self.looks_back
    }

    /// Notes that a response is set.
    fn note(&mut self, response: Response) {
        self.looks_back |= response == Response::Smart;
    }

    /// The response for a pair, of which `first` comes first.
    #[inline]
    pub fn of(&self, first: ObjectId, second: ObjectId) -> Response {
        if self.objects.is_empty() && self.pairs.is_empty() {
            return self.default;
        }
        self.looked_up(first, second)
    }

    fn looked_up(&self, first: ObjectId, second: ObjectId) -> Response {
        let pair = if self.pairs.is_empty() { None } else { self.pairs.get(&ordered(first, second)) };
        let object = || self.objects.get(first).or_else(|| self.objects.get(second));
        pair.or_else(object).copied().unwrap_or(self.default)
    }

    /// Drops the pairs with an object that is gone; gives those that stay.
    fn retain_pairs(
        &mut self,
        is_there: impl Fn(ObjectId) -> bool,
    ) -> impl Iterator<Item = (ObjectId, ObjectId)> {
        self.pairs.retain(|&(a, b), _| is_there(a) && is_there(b));
        self.forgotten = 0;
        self.give_back();
        self.pairs.keys().copied()
    }

    /// Gives memory back when nothing is left in it.
    fn give_back(&mut self) {
        if self.pairs.is_empty() {
            self.pairs.shrink_to_fit();
        }
    }

    #[cfg(test)]
    pub fn pair_count(&self) -> usize {
        self.pairs.len()
    }
}

fn ordered(a: ObjectId, b: ObjectId) -> (ObjectId, ObjectId) {
    (a.min(b), a.max(b))
}

/// # Responses
///
/// The response for a pair is the one set for the pair, else the one set for the object of the two that was created first,
/// else the one set for the other, else the default. *Clear* sets [`Response::Ignore`], which overrides what is below; *reset*
/// falls back to it.
///
/// ```
/// use solid3d::{Response, Shape, World, glam::DAffine3};
/// let mut world = World::new();
/// let shape = Shape::sphere(1.0)?;
/// let (a, b) = (world.add(&shape, DAffine3::IDENTITY)?, world.add(&shape, DAffine3::IDENTITY)?);
/// world.set_object_response(a, Response::Simple)?;
/// world.clear_pair_response(a, b)?;
/// assert_eq!(world.response(a, b)?, Response::Ignore);
/// world.reset_pair_response(a, b)?;
/// assert_eq!(world.response(a, b)?, Response::Simple);
/// world.reset_object_response(a)?;
/// assert_eq!(world.response(a, b)?, Response::Witness);
/// assert_eq!(world.default_response(), Response::Witness);
/// world.clear_default_response();
/// assert_eq!(world.default_response(), Response::Ignore);
/// # Ok::<(), solid3d::Error>(())
/// ```
impl World {
    /// Sets the response for pairs that have none of their own.
    pub fn set_default_response(&mut self, response: Response) {
        self.responses.note(response);
        if std::mem::replace(&mut self.responses.default, response) != response {
            (self.stale, self.default_changed) = (true, true);
        }
    }

    /// The response for pairs that have none of their own.
    pub fn default_response(&self) -> Response {
        self.responses.default
    }

    /// Makes pairs without a response of their own be ignored.
    pub fn clear_default_response(&mut self) {
        self.set_default_response(Response::Ignore);
    }

    /// Sets the response for all pairs with an object, except those with a response of their own.
    pub fn set_object_response(&mut self, id: ObjectId, response: Response) -> Result<()> {
        self.object(id)?;
        self.responses.note(response);
        self.responses.objects.insert(id, response);
        self.stir(id, Staleness::Pairs);
        Ok(())
    }

    /// Makes all pairs with an object be ignored, except those with a response of their own.
    pub fn clear_object_response(&mut self, id: ObjectId) -> Result<()> {
        self.set_object_response(id, Response::Ignore)
    }

    /// Drops the response set for an object.
    pub fn reset_object_response(&mut self, id: ObjectId) -> Result<()> {
        self.object(id)?;
        self.responses.objects.remove(id);
        self.stir(id, Staleness::Pairs);
        Ok(())
    }

    /// Sets the response for a pair, in whichever order.
    pub fn set_pair_response(&mut self, a: ObjectId, b: ObjectId, response: Response) -> Result<()> {
        self.check_pair(a, b)?;
        self.responses.note(response);
        if self.responses.pairs.insert(ordered(a, b), response).is_none() {
            self.objects[a].pair_responses += 1;
            self.objects[b].pair_responses += 1;
        }
        self.stir_pair(a, b);
        Ok(())
    }

    /// Makes a pair be ignored.
    pub fn clear_pair_response(&mut self, a: ObjectId, b: ObjectId) -> Result<()> {
        self.set_pair_response(a, b, Response::Ignore)
    }

    /// Drops the response set for a pair.
    pub fn reset_pair_response(&mut self, a: ObjectId, b: ObjectId) -> Result<()> {
        self.check_pair(a, b)?;
        if self.responses.pairs.remove(&ordered(a, b)).is_some() {
            self.objects[a].pair_responses -= 1;
            self.objects[b].pair_responses -= 1;
            self.responses.give_back();
        }
        self.stir_pair(a, b);
        Ok(())
    }

    /// The response that holds for a pair.
    pub fn response(&self, a: ObjectId, b: ObjectId) -> Result<Response> {
        self.check_pair(a, b)?;
        let (first, second) = self.objects.in_order(a, b);
        Ok(self.responses.of(first, second))
    }

    /// Has a pair examined again, if its boxes overlap.
    pub(super) fn stir_pair(&mut self, a: ObjectId, b: ObjectId) {
        if let Some(pair) = self.broad.pair(super::proxy(a), super::proxy(b)) {
            self.candidates.enqueue(pair);
        }
    }

    /// Drops what was set for an object that is gone, and for its pairs: at the latest when they are half of all pairs. So the
    /// cost is constant on average, also for one that had a response with every other.
    pub(super) fn forget_responses(&mut self, id: ObjectId, pairs: u32) {
        self.responses.objects.remove(id);
        self.responses.forgotten += pairs as usize;
        if 2 * self.responses.forgotten <= self.responses.pairs.len() || pairs == 0 {
            return;
        }
        let Self { responses, objects, .. } = self;
        // Some of what was counted is of objects that were gone before.
        objects.values_mut().for_each(|object| object.pair_responses = 0);
        let staying: Vec<_> = responses.retain_pairs(|id| objects.contains_key(id)).collect();
        for id in staying.into_iter().flat_map(|(a, b)| [a, b]) {
            objects[id].pair_responses += 1;
        }
    }

    pub(super) fn check_pair(&self, a: ObjectId, b: ObjectId) -> Result<()> {
        for (argument, id) in [("a", a), ("b", b)] {
            if !self.contains(id) {
                return Err(Error::UnknownObject { argument, id });
            }
        }
        if a == b { Err(Error::SameObject { id: a }) } else { Ok(()) }
    }
}
