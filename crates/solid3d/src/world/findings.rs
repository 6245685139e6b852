//! What the last test found, in order, and what changed since the last frame ended.

use solid_convex::simd::prefetch;

use super::ordered::Ordered;
use super::{Collision, Contact, Event, EventKind, ObjectId, PairKey, When};
use crate::threads::for_each_part;

/// A collision in the findings.
pub(super) type FindingId = u32;

#[derive(Clone, Debug)]
struct Finding {
    key: PairKey,
    /// The frame in which it began; of what began again before a frame ended some earlier one.
    since: u64,
    collision: Collision,
}

/// The collisions, kept from test to test: what is told is what changed.
#[derive(Clone, Debug, Default)]
pub(super) struct Findings {
    order: Ordered<FindingId>,
    findings: Vec<Finding>,
    /// Places in `findings` that are free.
    unused: Vec<FindingId>,
    /// How many frames ended.
    frame: u64,
    /// Pairs that do not collide and did when the last frame ended.
    ended: Ordered<(ObjectId, ObjectId)>,
}

impl Findings {
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Adds a collision of a pair that had none.
    pub fn add(&mut self, key: PairKey, collision: Collision) -> FindingId {
        let since = match self.ended.remove(key) {
            None => self.frame,
            Some(_) => self.frame - 1,
        };
        let finding = Finding { key, since, collision };
        let id = match self.unused.pop() {
            Some(id) => {
                self.findings[id as usize] = finding;
                id
            }
            None => {
                self.findings.push(finding);
                self.findings.len() as FindingId - 1
            }
        };
        self.order.insert(key, id);
        id
    }

    /// The same pair collides in another way.
    pub fn replace(&mut self, id: FindingId, when: When, contact: Contact) {
        let collision = &mut self.findings[id as usize].collision;
        (collision.when, collision.contact) = (when, contact);
    }

    pub fn collision(&self, id: FindingId) -> &Collision {
        &self.findings[id as usize].collision
    }

    /// Takes out a collision that is no more.
    pub fn remove(&mut self, id: FindingId) {
        let Finding { key, since, collision } = &mut self.findings[id as usize];
        // What a curve or contacts hold is not kept in an unused place.
        collision.contact = Contact::Simple;
        self.order.remove(*key);
        if *since < self.frame {
            self.ended.insert(*key, (collision.a, collision.b));
        }
        self.unused.push(id);
    }

    /// The collisions, in order.
    pub fn iter(&self) -> impl Iterator<Item = &Collision> {
        self.order.iter().map(|(_, id)| self.collision(id))
    }

    /// Puts the collisions into a vector, in order, in place of what was there.
    pub fn copy_to(&self, collisions: &mut Vec<Collision>) {
        /// So many, of some 50 ns each, are worth another thread.
        const MANY: usize = 1 << 10;
        /// No more parts than this: each finds its first collision by a walk along the blocks.
        const PARTS_MAX: usize = 64;
        /// So many before they are copied collisions are asked for, which stand anywhere in memory.
        const AHEAD: usize = 16;
        let plain = || Collision {
            a: ObjectId::default(),
            b: ObjectId::default(),
            when: When::Now,
            contact: Contact::Simple,
        };
        collisions.resize_with(self.len(), plain);
        let part_len = self.len().div_ceil(PARTS_MAX).max(MANY / 4);
        for_each_part(collisions, part_len, MANY, |i, part| {
            let mut later = self.order.iter_from(i * part_len).skip(AHEAD);
            for (to, (_, id)) in part.iter_mut().zip(self.order.iter_from(i * part_len)) {
                later.next().into_iter().for_each(|(_, id)| prefetch(self.collision(id)));
                to.take_from(self.collision(id));
            }
        });
    }

    /// The first collision beyond a pair.
    pub fn beyond(&self, last: Option<PairKey>) -> Option<(PairKey, &Collision)> {
        self.order.beyond(last).map(|(key, id)| (key, self.collision(id)))
    }

    /// Ends the frame.
    pub fn proceed(&mut self) {
        self.frame += 1;
        self.ended.clear();
    }

    /// What became of every pair that collides or did when the last frame ended.
    pub fn events(&self) -> impl Iterator<Item = Event> {
        let colliding = self.order.iter().map(|(key, id)| {
            let Finding { since, collision: Collision { a, b, .. }, .. } = self.findings[id as usize];
            let kind = if since == self.frame { EventKind::Began } else { EventKind::Persists };
            (key, Event { a, b, kind })
        });
        let ended = self.ended.iter().map(|(key, (a, b))| (key, Event { a, b, kind: EventKind::Ended }));
        merged(colliding, ended).map(|(_, event)| event)
    }
}

/// Two sequences in ascending order as one.
fn merged<T>(
    first: impl Iterator<Item = (PairKey, T)>,
    second: impl Iterator<Item = (PairKey, T)>,
) -> impl Iterator<Item = (PairKey, T)> {
    let (mut first, mut second) = (first.peekable(), second.peekable());
    std::iter::from_fn(move || match (first.peek(), second.peek()) {
        (Some((one, _)), Some((other, _))) if one > other => second.next(),
        (None, _) => second.next(),
        _ => first.next(),
    })
}
