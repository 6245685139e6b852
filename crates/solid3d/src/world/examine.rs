//! The examination of a pair: a function of its two objects, their response and what is kept of it alone.

use std::sync::Arc;

use glam::DVec3;
use solid_convex::gjk::{Decision, Proof};

use super::arena::Arena;
use super::candidates::Candidate;
use super::news::{News, push_of_part};
use super::object::Object;
use super::pair_map::Place;
use super::response::ResponseTable;
use super::{Contact, ObjectId, Response, Statistics, When};
use crate::pair::swept::{self, Encounter};
use crate::pair::{self, Placed, Relation, Scratch};

/// What examining a candidate gave.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Verdict {
    /// Whether its response is not to ignore it.
    pub matters: bool,
    pub outcome: Outcome,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Outcome {
    #[default]
    Apart,
    /// A collision of which nothing is known but that it is there now.
    Plain,
    /// A collision of which more is known, which stands elsewhere: it is large, and most pairs have none.
    Described,
}

impl Outcome {
    /// What was found, if anything was. What stands elsewhere is the next there.
    pub fn found(self, next_described: impl FnOnce() -> Option<(When, Contact)>) -> Option<(When, Contact)> {
        match self {
            Outcome::Apart => None,
            Outcome::Plain => Some((When::Now, Contact::Simple)),
            Outcome::Described => next_described(),
        }
    }
}

/// What examining a pair depends on, beside the pair.
pub(super) struct Examiner<'a> {
    pub objects: &'a Arena,
    pub responses: &'a ResponseTable,
    pub caching: bool,
}

impl Examiner<'_> {
    /// Examines a candidate, and keeps what is of it alone; the rest is news.
    pub fn renew(
        &self,
        place: Place,
        candidate: &mut Option<Candidate>,
        news: &mut News,
        scratch: &mut Scratch,
    ) {
        let candidate = candidate.as_mut().expect("what waits to be examined is a candidate");
        let &mut Candidate { a, b, ref mut proof, found, .. } = candidate;
        let Verdict { matters, outcome } =
            self.examine(a, b, proof, scratch, &mut news.described, &mut news.work);
        let was_plain = std::mem::replace(&mut candidate.is_plain, outcome == Outcome::Plain);
        news.matter += u64::from(matters);
        news.mattered += u64::from(std::mem::replace(&mut candidate.matters, matters));
        let is_as_it_was = match (found, outcome) {
            (None, outcome) => outcome == Outcome::Apart,
            (Some(_), outcome) => was_plain && outcome == Outcome::Plain,
        };
        if !is_as_it_was {
            let key = self.objects.key(a, b);
            push_of_part(&mut news.changed, (place, key, outcome));
        }
    }

    /// Whether two objects collide, of which `a` comes first; a function of the two and their response alone, whatever proof is tried first,
    /// in place of which that is put which there is now. What more is known of a collision is put into `described`, and the work is added
    /// to that done before.
    pub fn examine(
        &self,
        a: ObjectId,
        b: ObjectId,
        proof: &mut Proof,
        scratch: &mut Scratch,
        described: &mut Vec<(When, Contact)>,
        work: &mut Statistics,
    ) -> Verdict {
        let response = self.responses.of(a, b);
        if response == Response::Ignore {
            *proof = Proof::None;
            return Verdict::default();
        }
        work.examined += 1;
        let (a, b) = (&self.objects[a], &self.objects[b]);
        let has_way = a.has_way() || b.has_way();
        if !self.caching {
            *proof = Proof::None;
        }
        let before = scratch.work();
        let Found { outcome, by_the_same } = if has_way {
            now_or_on_the_way([a, b], response, proof, scratch, described, work)
        } else {
            now([a, b], response, proof, scratch, described)
        };
        let after = scratch.work();
        work.cache_hits += u64::from(by_the_same);
        work.box_tests += after.0 - before.0;
        work.primitive_tests += after.1 - before.1;
        Verdict { matters: true, outcome }
    }
}

/// What examining two objects gave.
struct Found {
    outcome: Outcome,
    /// Whether what was kept showed it.
    by_the_same: bool,
}

/// What two objects do as they are.
fn now(
    [a, b]: [&Object; 2],
    response: Response,
    proof: &mut Proof,
    scratch: &mut Scratch,
    described: &mut Vec<(When, Contact)>,
) -> Found {
    let (placed_a, placed_b) = (a.placed(), b.placed());
    if response == Response::Witness {
        return with_witness(placed_a, placed_b, proof, scratch, described);
    }
    let Decision { intersect, by_the_same } = pair::decide(placed_a, placed_b, proof, scratch);
    if !intersect {
        return Found { outcome: Outcome::Apart, by_the_same };
    }
    let contact = match response {
        Response::Ignore | Response::Simple | Response::Witness => {
            return Found { outcome: Outcome::Plain, by_the_same };
        }
        Response::Smart => smart([a, b], scratch),
        Response::Curve => Contact::curve(placed_a, placed_b, scratch),
        Response::Depth => Contact::depth(placed_a, placed_b, scratch),
        Response::Contacts => Contact::contacts(placed_a, placed_b, scratch),
    };
    Found { outcome: describe(When::Now, contact, described), by_the_same }
}

/// The same where a common point is wanted, which shows that they intersect.
fn with_witness(
    a: Placed,
    b: Placed,
    proof: &mut Proof,
    scratch: &mut Scratch,
    described: &mut Vec<(When, Contact)>,
) -> Found {
    if let Proof::Apart(axis) = proof
        && pair::still_separated(axis, a, b)
    {
        return Found { outcome: Outcome::Apart, by_the_same: true };
    }
    let (outcome, axis) = match pair::intersection(a, b, scratch) {
        Relation::Separated { axis } => (Outcome::Apart, axis),
        Relation::Common(witness) => (describe(When::Now, Contact::witness(a, b, &witness), described), None),
    };
    *proof = axis.into();
    Found { outcome, by_the_same: false }
}

fn describe(when: When, contact: Contact, described: &mut Vec<(When, Contact)>) -> Outcome {
    push_of_part(described, (when, contact));
    Outcome::Described
}

/// What two objects do as they are; of those that are apart, what they did on the way. The proof is one for all the way.
fn now_or_on_the_way(
    objects: [&Object; 2],
    response: Response,
    proof: &mut Proof,
    scratch: &mut Scratch,
    described: &mut Vec<(When, Contact)>,
    work: &mut Statistics,
) -> Found {
    let [a, b] = objects.map(Object::moving);
    if let Proof::Apart(axis) = proof
        && swept::still_separated(axis, &a, &b)
    {
        return Found { outcome: Outcome::Apart, by_the_same: true };
    }
    let found = now(objects, response, proof, scratch, described);
    if found.outcome != Outcome::Apart {
        return found;
    }
    work.sweeps += 1;
    let outcome = match swept::encounter(&a, &b, scratch) {
        Encounter::None { axis } => {
            *proof = axis.into();
            Outcome::Apart
        }
        Encounter::At(point) => {
            *proof = Proof::None;
            on_the_way(objects, point, response, scratch, described)
        }
    };
    Found { outcome, by_the_same: false }
}

/// A collision at a point on the way of two objects that are apart now.
fn on_the_way(
    [a, b]: [&Object; 2],
    point: DVec3,
    response: Response,
    scratch: &mut Scratch,
    described: &mut Vec<(When, Contact)>,
) -> Outcome {
    let contact = match response {
        Response::Ignore | Response::Simple => Contact::Simple,
        Response::Witness => Contact::witness_on_the_way(a.placed(), b.placed(), point),
        Response::Smart => smart([a, b], scratch),
        // As they are now, the surfaces do not meet.
        Response::Curve => Contact::Curve { point, curve: Arc::default() },
        Response::Depth => Contact::depth(a.placed(), b.placed(), scratch),
        Response::Contacts => Contact::Contacts { point, manifolds: Arc::default() },
    };
    describe(When::OnTheWay, contact, described)
}

fn smart([a, b]: [&Object; 2], scratch: &mut Scratch) -> Contact {
    let now = [a.placed(), b.placed()];
    Contact::smart(now, [a.previously_placed(), b.previously_placed()], scratch)
}
