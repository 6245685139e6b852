//! The test: every candidate pair is examined, in creation order.

use std::sync::Arc;

use glam::DVec3;

use super::candidates::{Candidate, PairKey};
use super::object::Object;
use super::{Collision, Contact, ObjectId, Response, Statistics, When, World};
use crate::error::Result;
use crate::pair::swept::{self, Encounter, Moving};
use crate::pair::{self, Relation, Scratch};

/// How far a test has come that is made collision by collision: see [`World::test_next`].
#[derive(Clone, Copy, Debug, Default)]
pub struct TestProgress {
    /// The pair examined last.
    last: Option<PairKey>,
}

/// What examining a candidate gave.
struct Examined {
    found: Option<(When, Contact)>,
    axis: Option<DVec3>,
    work: Statistics,
}

/// # Tests
impl World {
    /// Finds every collision, at the current placements, and of objects with [`Motion::Swept`](super::Motion::Swept) also on the
    /// way from the previous ones. In the order in which the objects were created: by the first object
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
        let mut candidates = std::mem::take(&mut self.candidates);
        let found = self.examine_all(&mut candidates);
        self.candidates = candidates;
        let mut collisions = Vec::new();
        for (of_chunk, work) in found {
            collisions.extend(of_chunk);
            self.statistics += work;
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
        let mut progress = TestProgress::default();
        let mut count = 0;
        while let Some(collision) = self.test_next(&mut progress) {
            count += 1;
            respond(self, &collision);
        }
        count
    }

    /// The next collision of a test that pauses after each, for callers that cannot lend the world to a closure as
    /// [`test_with`](World::test_with) does, and otherwise the same. `None` at the end.
    ///
    /// ```
    /// use solid3d::{Shape, TestProgress, World, glam::DAffine3};
    /// let mut world = World::new();
    /// let ball = Shape::sphere(1.0)?;
    /// let (a, b) = (world.add(&ball, DAffine3::IDENTITY)?, world.add(&ball, DAffine3::IDENTITY)?);
    /// let mut progress = TestProgress::default();
    /// let collision = world.test_next(&mut progress).unwrap();
    /// assert_eq!((collision.a, collision.b), (a, b));
    /// assert_eq!(world.test_next(&mut progress), None);
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn test_next(&mut self, progress: &mut TestProgress) -> Option<Collision> {
        match progress.last {
            None => self.refresh(),
            Some(last) => self.refresh_beyond(last),
        }
        let mut scratch = std::mem::take(&mut self.scratch);
        let mut collision = None;
        while let Some(candidate) = self.next_candidate(progress.last).filter(|_| collision.is_none()) {
            progress.last = Some(candidate.key);
            if self.is_candidate(&candidate) {
                let examined = self.examine(&candidate, &mut scratch);
                self.cache_axis(candidate.key, examined.axis);
                self.statistics += examined.work;
                collision = candidate.collision(examined.found);
            }
        }
        self.scratch = scratch;
        collision
    }

    /// Whether two objects collide, and how, as [`test`](World::test) would report them; `None` also when their response is
    /// [`Response::Ignore`]. Nothing is cached.
    pub fn test_pair(&mut self, a: ObjectId, b: ObjectId) -> Result<Option<Collision>> {
        if self.response(a, b)? == Response::Ignore {
            return Ok(None);
        }
        let mut scratch = std::mem::take(&mut self.scratch);
        let candidate = self.candidate_of(a, b);
        let examined = self.examine(&candidate, &mut scratch);
        self.scratch = scratch;
        self.statistics += examined.work;
        Ok(candidate.collision(examined.found))
    }

    /// Examines candidates, chunk by chunk: what collides, in their order, and the work. Notes the axes that separate the others.
    #[cfg(not(feature = "rayon"))]
    fn examine_all(&mut self, candidates: &mut [Candidate]) -> Vec<(Vec<Collision>, Statistics)> {
        let mut scratch = std::mem::take(&mut self.scratch);
        let found = self.examine_chunk(candidates, &mut scratch);
        self.scratch = scratch;
        vec![found]
    }

    #[cfg(feature = "rayon")]
    fn examine_all(&mut self, candidates: &mut [Candidate]) -> Vec<(Vec<Collision>, Statistics)> {
        use rayon::prelude::*;
        /// Fewer pairs than this are not worth waking a thread.
        const CHUNK: usize = 16;
        let chunks = candidates.par_chunks_mut(CHUNK);
        chunks.map_init(Scratch::default, |scratch, chunk| self.examine_chunk(chunk, scratch)).collect()
    }

    fn examine_chunk(
        &self,
        candidates: &mut [Candidate],
        scratch: &mut Scratch,
    ) -> (Vec<Collision>, Statistics) {
        let (mut collisions, mut work) = (Vec::new(), Statistics::default());
        for candidate in candidates {
            let examined = self.examine(candidate, scratch);
            candidate.axis = examined.axis;
            work += examined.work;
            collisions.extend(candidate.collision(examined.found));
        }
        (collisions, work)
    }

    /// Whether a candidate collides; a function of the two objects alone.
    fn examine(&self, candidate: &Candidate, scratch: &mut Scratch) -> Examined {
        let mut work = Statistics { candidates: 1, ..Statistics::default() };
        let (a, b) = (&self.objects[candidate.a], &self.objects[candidate.b]);
        let way = (a.has_way() || b.has_way()).then(|| [a.moving(), b.moving()]);
        let still_separated = |&axis: &DVec3| match &way {
            None => pair::still_separated(axis, a.placed(), b.placed()),
            Some([a, b]) => swept::still_separated(axis, a, b),
        };
        let cached = candidate.axis.filter(|_| self.caching);
        if let Some(axis) = cached.filter(still_separated) {
            work.cache_hits = 1;
            return Examined { found: None, axis: Some(axis), work };
        }
        let before = scratch.work();
        let response = self.responses.of(candidate.a, candidate.b);
        let (found, axis) = match (pair::intersection(a.placed(), b.placed(), scratch), &way) {
            (Relation::Common(witness), _) => {
                let contact = match response {
                    Response::Ignore | Response::Simple => Contact::Simple,
                    Response::Witness => Contact::witness(a.placed(), b.placed(), &witness),
                    Response::Smart => smart([a, b], scratch),
                    Response::Curve => Contact::curve(a.placed(), b.placed(), &witness, scratch),
                };
                (Some((When::Now, contact)), None)
            }
            (Relation::Separated { axis }, None) => (None, axis),
            (Relation::Separated { .. }, Some(way)) => {
                work.sweeps = 1;
                on_the_way([a, b], way, response, scratch)
            }
        };
        work.collisions = u64::from(found.is_some());
        let after = scratch.work();
        (work.box_tests, work.primitive_tests) = (after.0 - before.0, after.1 - before.1);
        Examined { found, axis: axis.filter(|_| self.caching), work }
    }
}

/// Whether two objects that are apart now collided on the way; else an axis, when one separates them all the way.
fn on_the_way(
    [a, b]: [&Object; 2],
    [way_a, way_b]: &[Moving; 2],
    response: Response,
    scratch: &mut Scratch,
) -> (Option<(When, Contact)>, Option<DVec3>) {
    let point = match swept::encounter(way_a, way_b, scratch) {
        Encounter::None { axis } => return (None, axis),
        Encounter::At(point) => point,
    };
    let contact = match response {
        Response::Ignore | Response::Simple => Contact::Simple,
        Response::Witness => Contact::witness_on_the_way(a.placed(), b.placed(), point),
        Response::Smart => smart([a, b], scratch),
        // As they are now, the surfaces do not meet.
        Response::Curve => Contact::Curve { point, curve: Arc::default() },
    };
    (Some((When::OnTheWay, contact)), None)
}

fn smart([a, b]: [&Object; 2], scratch: &mut Scratch) -> Contact {
    let now = [a.placed(), b.placed()];
    Contact::smart(now, [a.previously_placed(), b.previously_placed()], scratch)
}

impl Candidate {
    fn collision(&self, found: Option<(When, Contact)>) -> Option<Collision> {
        found.map(|(when, contact)| Collision { a: self.a, b: self.b, when, contact })
    }
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;

    use super::*;
    use crate::{BroadPhaseKind, Shape, WorldOptions};

    /// Balls in a row, each touching the next.
    fn row(count: usize) -> (World, Vec<ObjectId>) {
        let options = WorldOptions { broad_phase: BroadPhaseKind::DynamicTree, ..WorldOptions::default() };
        let mut world = World::with_options(&options);
        let ball = Shape::sphere(0.5).unwrap();
        let at = |i: usize| DAffine3::from_translation(DVec3::X * 0.9 * i as f64);
        let ids = (0..count).map(|i| world.add(&ball, at(i)).unwrap()).collect();
        (world, ids)
    }

    /// What a response costs that moves one object follows the pairs of that object, not all pairs.
    #[test]
    fn a_move_in_a_response_costs_what_moved() {
        let work = |count: usize| {
            let (mut world, _) = row(count);
            let before = world.broad.counters();
            let hits = world.test_with(|world, collision| {
                let placement = world.placement(collision.b).unwrap();
                world.set_placement(collision.b, placement * DAffine3::from_rotation_y(0.1)).unwrap();
            });
            assert_eq!(hits, count - 1);
            (world.statistics().candidates, world.broad.counters().node_visits - before.node_visits)
        };
        let ((few, few_visits), (many, many_visits)) = (work(500), work(4000));
        assert!(many <= 9 * few, "{few} candidates for 500 balls, {many} for 4000");
        assert!(
            many_visits <= 20 * few_visits,
            "{few_visits} node visits for 500 balls, {many_visits} for 4000"
        );
    }

    #[test]
    fn what_comes_into_the_way_during_a_test_is_found() {
        for kind in [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune] {
            let mut world =
                World::with_options(&WorldOptions { broad_phase: kind, ..WorldOptions::default() });
            let ball = Shape::sphere(0.5).unwrap();
            let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
            let ids: Vec<_> = [0.0, 0.5, 10.0, 20.0].map(|x| world.add(&ball, at(x)).unwrap()).into();
            let mut found = Vec::new();
            world.test_with(|world, collision| {
                found.push((collision.a, collision.b));
                if found.len() == 1 {
                    // The third comes to the first and the second, the second goes, a fifth comes to the fourth.
                    world.set_placement(ids[2], at(0.1)).unwrap();
                    world.remove(ids[1]).unwrap();
                    world.add(&ball, at(20.5)).unwrap();
                }
            });
            let fifth = world.objects()[3];
            assert_eq!(found, [(ids[0], ids[1]), (ids[0], ids[2]), (ids[3], fifth)], "{kind:?}");
        }
    }
}
