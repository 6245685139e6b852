//! The test: every candidate pair is examined, in creation order.

use solid_convex::gjk::Proof;

use super::candidates::{Candidate, PairKey};
use super::examine::Examiner;
use super::news::{News, Notes};
use super::pair_map::Place;
use super::threads::{BATCH, BATCH_ALONE, Items, Workers};
use super::{Collision, ObjectId, Response, World};
use crate::error::Result;
use crate::threads::{between, both, in_pool};

/// How far a test has come that is made collision by collision: see [`World::test_next`].
#[derive(Clone, Copy, Debug, Default)]
pub struct TestProgress {
    /// The pair examined last.
    last: Option<PairKey>,
}

/// # Tests
impl World {
    /// Finds every collision, at the current placements, and of objects with [`Motion::Swept`](super::Motion::Swept) also on the
    /// way from the previous ones. In the order in which the objects were created: by the first object
    /// of a pair, then by the second.
    ///
    /// Pairs are examined when their response is not [`Response::Ignore`], their boxes overlap, and something about them changed
    /// since they last were: the cost follows what changed, but for the copy of the result. With the feature `rayon` on
    /// the threads of the current pool; the results are the same bits for any number of threads, with and without caching, and
    /// for either broad phase. Memory: some 550 bytes for each pair whose boxes overlap, of which 160 are of the result.
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
        let mut collisions = Vec::new();
        self.test_into(&mut collisions);
        collisions
    }

    /// Like [`test`](World::test), but puts the collisions into a vector, in place of what was there: a caller that keeps it, in a
    /// world in which as much happens as before, makes tests that allocate nothing. Only [`Response::Curve`] and
    /// [`Response::Contacts`] do, for each pair that they describe anew: such results own their memory. [`collisions`](World::collisions) are then
    /// also there to be looked at without a copy.
    ///
    /// ```
    /// use solid3d::{Shape, World, glam::DAffine3};
    /// let mut world = World::new();
    /// let ball = Shape::sphere(1.0)?;
    /// let [a, b] = [0, 1].map(|_| world.add(&ball, DAffine3::IDENTITY).unwrap());
    /// let mut collisions = Vec::new();
    /// for frame in 0..3 {
    ///     world.test_into(&mut collisions);
    ///     assert_eq!((collisions.len(), collisions[0].a, collisions[0].b), (1, a, b));
    ///     world.proceed();
    /// }
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn test_into(&mut self, collisions: &mut Vec<Collision>) {
        in_pool(Workers::is_worth_entering(self.work_ahead()), || {
            self.begin_test();
            self.statistics.collisions += self.findings.len() as u64;
            self.findings.copy_to(collisions);
        });
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
            None => self.begin_test(),
            Some(_) => self.statistics.candidates += self.examine_changed(),
        }
        let (key, collision) = self.findings.beyond(progress.last)?;
        progress.last = Some(key);
        self.statistics.collisions += 1;
        Some(collision.clone())
    }

    /// Whether two objects collide, and how, as [`test`](World::test) would report them; `None` also when their response is
    /// [`Response::Ignore`]. Nothing is cached.
    pub fn test_pair(&mut self, a: ObjectId, b: ObjectId) -> Result<Option<Collision>> {
        if self.response(a, b)? == Response::Ignore {
            return Ok(None);
        }
        let (a, b) = self.objects.in_order(a, b);
        let mut described = Vec::new();
        let Self { objects, responses, caching, workers, statistics, .. } = self;
        let examiner = Examiner { objects, responses, caching: *caching };
        let verdict = examiner.examine(a, b, &mut Proof::None, workers.own(), &mut described, statistics);
        let found = verdict.outcome.found(|| described.pop());
        statistics.candidates += 1;
        statistics.collisions += u64::from(found.is_some());
        Ok(found.map(|(when, contact)| Collision { a, b, when, contact }))
    }

    /// Brings the findings up to date, and counts the candidates.
    fn begin_test(&mut self) {
        if !self.caching {
            self.candidates.enqueue_all();
        }
        self.examine_changed();
        self.statistics.candidates += self.candidates.count;
    }

    /// Examines the candidates about which something changed; gives how many.
    fn examine_changed(&mut self) -> u64 {
        self.refresh();
        self.candidates.lapsed.take_all(&mut self.findings);
        let before = self.statistics.examined;
        let mut places = std::mem::take(&mut self.to_examine);
        let shares = Workers::share(self.statistics.units_for(self.candidates.waiting_max()));
        between(shares, || self.candidates.take_queue(&mut places));
        let units = self.statistics.units_for(places.len());
        in_pool(Workers::is_worth_entering(units), || self.examine_all(&mut places));
        self.to_examine = places;
        self.statistics.examined - before
    }

    /// Examines candidates, and keeps what that gave.
    fn examine_all(&mut self, places: &mut [Place]) {
        let share = Workers::share(self.statistics.units_for(places.len()));
        // Taken out, so that a panic leaves nothing in it.
        let [mut news, mut earlier_news] = std::mem::take(&mut *self.news);
        let Self { objects, responses, caching, candidates, findings, workers, statistics, .. } = self;
        let examiner = Examiner { objects, responses, caching: *caching };
        let (values, count) = candidates.values_and_count_mut();
        let mut notes = Notes { findings, count, statistics };
        let mut examine = |items: Items<Option<Candidate>>, news: &mut Vec<News>| {
            workers.each(
                share,
                items,
                news,
                |_, candidate| {
                    objects.prefetch(candidate.iter().flat_map(|candidate| [candidate.a, candidate.b]))
                },
                |place, candidate, news, scratch| examiner.renew(place, candidate, news, scratch),
            );
        };
        if share {
            places.sort_unstable();
            // What some gave is kept while the next are examined.
            let (mut earlier, mut rest) = Items { first: 0, values, places }.split_at(0);
            while !rest.places.is_empty() {
                let (mut batch, later) = rest.split_at(BATCH);
                both(
                    true,
                    || notes.keep(earlier, &mut earlier_news),
                    || examine(batch.reborrow(), &mut news),
                );
                std::mem::swap(&mut news, &mut earlier_news);
                (earlier, rest) = (batch, later);
            }
            notes.keep(earlier, &mut earlier_news);
        } else {
            for places in places.chunks(BATCH_ALONE) {
                let mut part = Items { first: 0, values: &mut *values, places };
                examine(part.reborrow(), &mut news);
                notes.keep(part, &mut news);
            }
        }
        *self.news = [news, earlier_news];
    }
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DVec3};

    use super::*;
    use crate::{BroadPhaseKind, Shape, Statistics, WorldOptions};

    /// Balls in a row, each touching the next.
    fn row(count: usize) -> (World, Vec<ObjectId>) {
        let options = WorldOptions { broad_phase: BroadPhaseKind::DynamicTree, ..WorldOptions::default() };
        let mut world = World::with_options(&options);
        let ball = Shape::sphere(0.5).unwrap();
        let at = |i: usize| DAffine3::from_translation(DVec3::X * 0.9 * i as f64);
        let ids = (0..count).map(|i| world.add(&ball, at(i)).unwrap()).collect();
        (world, ids)
    }

    /// Of hulls that collide, what showed it last shows it again, where no more is asked; with the same collisions as without.
    #[test]
    fn a_collision_of_hulls_is_shown_by_the_same_vertices() {
        let hull = Shape::convex_hull(&[DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE]).unwrap();
        for (response, hits) in [(Response::Simple, 9), (Response::Witness, 0)] {
            let options = WorldOptions { default_response: response, ..WorldOptions::default() };
            let worlds = [true, false].map(|caching| {
                let mut world = World::with_options(&options);
                if !caching {
                    world.disable_caching();
                }
                let at = |x: f64| DAffine3 {
                    translation: DVec3::new(x, 0.13, 0.07),
                    ..DAffine3::from_rotation_y(0.3)
                };
                let still = world.add(&hull, DAffine3::IDENTITY).unwrap();
                let moving = world.add(&hull, at(0.2)).unwrap();
                for frame in 0..10 {
                    world.set_placement(moving, at(0.2 + 0.001 * f64::from(frame))).unwrap();
                    assert!(matches!(&world.test()[..], [found] if found.a == still && found.b == moving));
                    world.proceed();
                }
                world.statistics().cache_hits
            });
            assert_eq!(worlds, [hits, 0], "{response:?}");
        }
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
            // What is examined between collisions counts, too.
            let Statistics { candidates, examined, collisions, .. } = world.statistics();
            assert_eq!((candidates, collisions), (examined, hits as u64));
            (candidates, world.broad.counters().node_visits - before.node_visits)
        };
        let ((few, few_visits), (many, many_visits)) = (work(500), work(4000));
        assert!(many <= 9 * few, "{few} candidates for 500 balls, {many} for 4000");
        assert!(
            many_visits <= 20 * few_visits,
            "{few_visits} node visits for 500 balls, {many_visits} for 4000"
        );
    }

    /// Law: as a crowd disperses, it is as if it had never been: in what is found, and in how many candidates a pass goes over.
    #[test]
    fn a_crowd_that_disperses_leaves_nothing_behind() {
        const COUNT: usize = 120;
        let ball = Shape::sphere(0.5).unwrap();
        let at = |i: usize| DAffine3::from_translation(DVec3::X * 0.9 * i as f64);
        for kind in [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune] {
            let options = WorldOptions { broad_phase: kind, ..WorldOptions::default() };
            // The first so many in a row, the others in one place.
            let in_row = |gone: usize| {
                let mut world = World::with_options(&options);
                let place = |i| if i < gone { at(i) } else { DAffine3::IDENTITY };
                let ids: Vec<_> = (0..COUNT).map(|i| world.add(&ball, place(i)).unwrap()).collect();
                (world, ids)
            };
            let found = |world: &mut World, ids: &[ObjectId]| {
                let name = |id| ids.iter().position(|&other| other == id).unwrap();
                let collisions: Vec<_> = world.test().iter().map(|it| (name(it.a), name(it.b))).collect();
                let near: Vec<_> =
                    world.near().iter().map(|it| (name(it.a), name(it.b), it.distance)).collect();
                (collisions, near)
            };
            let (mut world, ids) = in_row(0);
            assert_eq!(world.test().len(), COUNT * (COUNT - 1) / 2);
            for (i, &id) in ids.iter().enumerate() {
                world.set_placement(id, at(i)).unwrap();
                world.test();
                if i % 10 == 9 {
                    let (mut fresh, fresh_ids) = in_row(i + 1);
                    assert_eq!(found(&mut world, &ids), found(&mut fresh, &fresh_ids), "{kind:?}, {i}");
                }
            }
            let places = world.candidates.values_and_count_mut().0.len();
            assert!(places < 2000, "{kind:?}: {places} places");
        }
    }

    /// A frame of movers, each next to one ball at rest, in a world of others at rest that collide in twos: what it cost.
    fn frame_of_movers(movers: usize, resting: usize) -> (Statistics, u64) {
        let mut world = World::new();
        let ball = Shape::sphere(0.5).unwrap();
        let place = |i: usize, row: f64| DVec3::new(3.0 * (i % 300) as f64, 3.0 * (i / 300) as f64, row);
        let at = |point: DVec3| DAffine3::from_translation(point);
        let ids: Vec<_> = (0..movers).map(|i| world.add(&ball, at(place(i, 0.0))).unwrap()).collect();
        for i in 0..movers {
            world.add(&ball, at(place(i, 1.1))).unwrap();
        }
        for i in 0..resting / 2 {
            world.add(&ball, at(place(i, 5.0))).unwrap();
            world.add(&ball, at(place(i, 5.9))).unwrap();
        }
        let mut last = (Statistics::default(), 0);
        for frame in 0..20 {
            let before = (world.statistics(), world.broad.counters());
            for (i, &id) in ids.iter().enumerate() {
                world.set_placement(id, at(place(i, if frame % 2 == 0 { 0.05 } else { 0.15 }))).unwrap();
            }
            let collisions = world.test();
            assert_eq!(collisions.len(), resting / 2 + if frame % 2 == 0 { 0 } else { movers });
            world.proceed();
            let (work, broad) = (world.statistics(), world.broad.counters());
            let frame_work = Statistics {
                candidates: work.candidates - before.0.candidates,
                examined: work.examined - before.0.examined,
                primitive_tests: work.primitive_tests - before.0.primitive_tests,
                ..Statistics::default()
            };
            last = (
                frame_work,
                broad.node_visits + broad.reinsertions - before.1.node_visits - before.1.reinsertions,
            );
        }
        last
    }

    /// Law: the cost of a frame follows what moved.
    #[test]
    fn a_thousand_movers_among_many_cost_what_a_thousand_cost() {
        /// Nodes that a mover visits, and its place anew: a little more than the levels of the tree, six of eight children each.
        const VISITS_MAX: u64 = 8;
        let (movers, resting) = (1000, 100_000);
        let (alone, visits_alone) = frame_of_movers(movers, 0);
        let (among, visits_among) = frame_of_movers(movers, resting);
        assert_eq!((alone.examined, among.examined), (movers as u64, movers as u64));
        assert_eq!(alone.primitive_tests, among.primitive_tests);
        assert_eq!(among.candidates, alone.candidates + resting as u64 / 2);
        assert!(
            // Among many each mover goes down from the root; alone, the tree against itself finds the pairs of all at once.
            visits_among <= VISITS_MAX * movers as u64,
            "{visits_alone} visits alone, {visits_among} among many"
        );
    }

    /// What is at rest is examined once: also when placed anew where it is, and when the frame ends.
    #[test]
    fn what_is_at_rest_is_not_examined_again() {
        let (mut world, ids) = row(100);
        world.set_default_response(Response::Smart);
        world.test();
        assert_eq!(world.statistics().examined, 99);
        for frame in 2..10 {
            world.proceed();
            for &id in &ids {
                world.set_placement(id, world.placement(id).unwrap()).unwrap();
            }
            assert_eq!(world.test().len(), 99);
            assert_eq!((world.statistics().examined, world.statistics().candidates), (99, 99 * frame));
        }
        // One that moved is examined with its neighbours; and once more when where it was is where it is.
        let moved = world.placement(ids[50]).unwrap() * DAffine3::from_translation(DVec3::Y * 0.1);
        world.set_placement(ids[50], moved).unwrap();
        for examined in [101, 103, 103] {
            world.test();
            assert_eq!(world.statistics().examined, examined);
            world.proceed();
        }
        // Responses concern those that they are set for.
        world.set_pair_response(ids[3], ids[4], Response::Simple).unwrap();
        world.set_pair_response(ids[3], ids[90], Response::Simple).unwrap();
        world.test();
        assert_eq!(world.statistics().examined, 104);
        world.set_object_response(ids[7], Response::Witness).unwrap();
        world.test();
        assert_eq!(world.statistics().examined, 106);
        world.disable_caching();
        world.test();
        assert_eq!(world.statistics().examined, 106 + 99);
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
