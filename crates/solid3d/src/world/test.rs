//! The test: every candidate pair is examined, in creation order.

use glam::DVec3;

use super::candidates::{Candidate, PairKey};
use super::{Collision, Contact, Response, Statistics, World};
use crate::pair::{self, Relation, Scratch};

/// What examining a candidate gave.
struct Examined {
    contact: Option<Contact>,
    axis: Option<DVec3>,
    work: Statistics,
}

/// # Tests
impl World {
    /// Finds every collision, at the current placements. In the order in which the objects were created: by the first object
    /// of a pair, then by the second.
    ///
    /// Pairs are examined when their response is not [`Response::Ignore`] and their boxes overlap. With the feature `rayon` on
    /// the threads of the current pool; the results are the same bits for any number of threads, with and without caching, and
    /// for either broad phase.
    ///
    /// ```
    /// use solid3d::{Shape, World, glam::{DAffine3, DVec3}};
    /// let mut world = World::new();
    /// let block = Shape::cuboid([1.0, 1.0, 1.0])?;
    /// let left = world.add(&block, DAffine3::IDENTITY)?;
    /// let right = world.add(&block, DAffine3::from_translation(DVec3::X))?;
    /// let collisions = world.test();
    /// assert_eq!((collisions[0].a, collisions[0].b), (left, right));
    /// assert_eq!(collisions[0].point().unwrap().x, 0.5);
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn test(&mut self) -> Vec<Collision> {
        self.refresh();
        let mut collisions = Vec::new();
        let examined = self.examine_all();
        for (candidate, examined) in self.candidates.iter_mut().zip(examined) {
            candidate.axis = examined.axis;
            self.statistics += examined.work;
            if let Some(contact) = examined.contact {
                collisions.push(Collision { a: candidate.a, b: candidate.b, contact });
            }
        }
        collisions
    }

    /// Like [`test`](World::test), but calls `respond` with each collision as it is found, and lets it change the world: move,
    /// deform, add and remove objects, change responses, even test. Returns the number of collisions.
    ///
    /// Pairs come in the same order, and each at most once, examined as the world is when its turn comes: a pair that comes
    /// later than the current one sees the change, a pair that came earlier does not come again.
    ///
    /// ```
    /// use solid3d::{Shape, World, glam::{DAffine3, DVec3}};
    /// let mut world = World::new();
    /// let ball = Shape::sphere(1.0)?;
    /// for _ in 0..3 {
    ///     world.add(&ball, DAffine3::IDENTITY)?;
    /// }
    /// // Throwing the second of each pair far away leaves nothing for the third pair.
    /// let count = world.test_with(|world, collision| {
    ///     let away = DAffine3::from_translation(DVec3::X * 10.0 * world.statistics().collisions as f64);
    ///     world.set_placement(collision.b, away).unwrap();
    /// });
    /// assert_eq!(count, 2);
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn test_with(&mut self, mut respond: impl FnMut(&mut World, &Collision)) -> usize {
        let mut count = 0;
        let mut last: Option<PairKey> = None;
        loop {
            self.refresh();
            let next = self.candidates.partition_point(|candidate| Some(candidate.key) <= last);
            let Some(collision) = self.next_collision(next, &mut last) else {
                return count;
            };
            count += 1;
            respond(self, &collision);
        }
    }

    /// Examines candidates from the `next` on until one collides; `last` becomes the key of the last examined.
    fn next_collision(&mut self, next: usize, last: &mut Option<PairKey>) -> Option<Collision> {
        let mut scratch = std::mem::take(&mut self.scratch);
        let mut collision = None;
        for i in next..self.candidates.len() {
            let candidate = self.candidates[i];
            let examined = self.examine(&candidate, &mut scratch);
            self.candidates[i].axis = examined.axis;
            self.statistics += examined.work;
            *last = Some(candidate.key);
            if let Some(contact) = examined.contact {
                collision = Some(Collision { a: candidate.a, b: candidate.b, contact });
                break;
            }
        }
        self.scratch = scratch;
        collision
    }

    #[cfg(not(feature = "rayon"))]
    fn examine_all(&mut self) -> Vec<Examined> {
        let mut scratch = std::mem::take(&mut self.scratch);
        let examined =
            self.candidates.iter().map(|candidate| self.examine(candidate, &mut scratch)).collect();
        self.scratch = scratch;
        examined
    }

    #[cfg(feature = "rayon")]
    fn examine_all(&mut self) -> Vec<Examined> {
        use rayon::prelude::*;
        /// Fewer pairs than this are not worth waking a thread.
        const PAIRS_PER_TASK: usize = 16;
        let candidates = self.candidates.par_iter().with_min_len(PAIRS_PER_TASK);
        candidates.map_init(Scratch::default, |scratch, candidate| self.examine(candidate, scratch)).collect()
    }

    /// Whether a candidate collides; a function of the two objects alone.
    fn examine(&self, candidate: &Candidate, scratch: &mut Scratch) -> Examined {
        let mut work = Statistics { candidates: 1, ..Statistics::default() };
        let (a, b) = (&self.objects[candidate.a], &self.objects[candidate.b]);
        let cached = candidate.axis.filter(|_| self.caching);
        if let Some(axis) = cached.filter(|&axis| pair::still_separated(axis, a.placed(), b.placed())) {
            work.cache_hits = 1;
            return Examined { contact: None, axis: Some(axis), work };
        }
        let before = scratch.work();
        let (contact, axis) = match pair::intersection(a.placed(), b.placed(), scratch) {
            Relation::Separated { axis } => (None, axis.filter(|_| self.caching)),
            Relation::Common(witness) => {
                work.collisions = 1;
                let contact = match self.responses.of(candidate.a, candidate.b) {
                    Response::Ignore | Response::Simple => Contact::Simple,
                    Response::Witness => Contact::witness(a.placed(), b.placed(), &witness),
                    Response::Smart => Contact::smart(a.previously_placed(), b.previously_placed(), scratch),
                    Response::Curve => Contact::curve(a.placed(), b.placed(), &witness, scratch),
                };
                (Some(contact), None)
            }
        };
        let after = scratch.work();
        (work.box_tests, work.primitive_tests) = (after.0 - before.0, after.1 - before.1);
        Examined { contact, axis, work }
    }
}
