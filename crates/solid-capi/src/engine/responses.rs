//! The client's responses, by reference: they may be there before the objects are.
//!
//! Which response a pair has is decided here, and again by the world's own table, which holds the kinds of the responses of
//! the objects that there are.

use solid3d::{ObjectId, Response};

use super::Engine;
use crate::abi::ResponseFunction;
use crate::fault::{Code, Fault, Result};
use crate::reference::{ByReference, Reference, References};

/// A function of the client's, and what it wants to be told. The engine only keeps it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Callback {
    pub function: ResponseFunction,
    pub client_data: Reference,
    /// Not [`Response::Ignore`].
    pub kind: Response,
}

/// What is defined: a callback, or that there is none.
type Definition = Option<Callback>;

/// The responses that are defined.
#[derive(Debug, Default)]
pub(super) struct Responses {
    default: Definition,
    objects: ByReference<Reference, Definition>,
    /// The lesser reference first.
    pairs: ByReference<(Reference, Reference), Definition>,
    /// The references with which a reference has a pair response.
    partners: ByReference<Reference, References>,
}

impl Responses {
    /// The response for a pair, in the order of the callback.
    pub fn of(&self, object1: Reference, object2: Reference) -> Definition {
        let pair = self.pairs.get(&ordered(object1, object2));
        let object = || self.objects.get(&object1).or_else(|| self.objects.get(&object2));
        pair.or_else(object).copied().unwrap_or(self.default)
    }

    /// Drops what was defined for an object and for its pairs.
    pub fn forget(&mut self, object: Reference) {
        self.objects.remove(&object);
        for partner in self.partners.remove(&object).unwrap_or_default() {
            self.pairs.remove(&ordered(object, partner));
            self.part(partner, object);
        }
        self.shrink();
    }

    fn part(&mut self, object: Reference, partner: Reference) {
        if let Some(partners) = self.partners.get_mut(&object) {
            partners.remove(&partner);
            if partners.is_empty() {
                self.partners.remove(&object);
            }
        }
    }

    /// Gives memory back when nothing is left.
    fn shrink(&mut self) {
        if self.objects.is_empty() {
            self.objects.shrink_to_fit();
        }
        if self.pairs.is_empty() {
            self.pairs.shrink_to_fit();
            self.partners.shrink_to_fit();
        }
    }
}

impl Engine {
    pub fn set_default_response(&mut self, response: Definition) {
        self.responses.default = response;
        self.world.set_default_response(kind(response));
    }

    pub fn set_object_response(&mut self, object: Reference, response: Definition) -> Result<()> {
        self.responses.objects.insert(object, response);
        match self.objects.get(&object) {
            Some(object) => Ok(self.world.set_object_response(object.id, kind(response))?),
            None => Ok(()),
        }
    }

    pub fn reset_object_response(&mut self, object: Reference) -> Result<()> {
        self.responses.objects.remove(&object);
        self.responses.shrink();
        match self.objects.get(&object) {
            Some(object) => Ok(self.world.reset_object_response(object.id)?),
            None => Ok(()),
        }
    }

    pub fn set_pair_response(&mut self, a: Reference, b: Reference, response: Definition) -> Result<()> {
        check_pair(a, b)?;
        self.responses.pairs.insert(ordered(a, b), response);
        self.responses.partners.entry(a).or_default().insert(b);
        self.responses.partners.entry(b).or_default().insert(a);
        match (self.objects.get(&a), self.objects.get(&b)) {
            (Some(a), Some(b)) => Ok(self.world.set_pair_response(a.id, b.id, kind(response))?),
            _ => Ok(()),
        }
    }

    pub fn reset_pair_response(&mut self, a: Reference, b: Reference) -> Result<()> {
        check_pair(a, b)?;
        if self.responses.pairs.remove(&ordered(a, b)).is_some() {
            self.responses.part(a, b);
            self.responses.part(b, a);
            self.responses.shrink();
        }
        match (self.objects.get(&a), self.objects.get(&b)) {
            (Some(a), Some(b)) => Ok(self.world.reset_pair_response(a.id, b.id)?),
            _ => Ok(()),
        }
    }

    /// Tells the world what was defined for an object before it was there.
    pub(super) fn apply_responses_of(&mut self, object: Reference, id: ObjectId) -> Result<()> {
        if let Some(&response) = self.responses.objects.get(&object) {
            self.world.set_object_response(id, kind(response))?;
        }
        for &partner in self.responses.partners.get(&object).into_iter().flatten() {
            let pair = self.responses.pairs.get(&ordered(object, partner));
            if let (Some(partner), Some(&response)) = (self.objects.get(&partner), pair) {
                self.world.set_pair_response(id, partner.id, kind(response))?;
            }
        }
        Ok(())
    }
}

fn kind(response: Definition) -> Response {
    response.map_or(Response::Ignore, |callback| callback.kind)
}

fn ordered(a: Reference, b: Reference) -> (Reference, Reference) {
    (a.min(b), a.max(b))
}

pub(super) fn check_pair(a: Reference, b: Reference) -> Result<()> {
    if a == b {
        return Err(Fault::new(Code::Object, format!("object1 and object2 are both {a}; a pair needs two")));
    }
    Ok(())
}
