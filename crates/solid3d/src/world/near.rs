//! Which pairs are nearer to each other than they should be.

use glam::DVec3;

use super::arena::Arena;
use super::candidates::Candidate;
use super::clearance::Clearances;
use super::pair_map::Place;
use super::response::ResponseTable;
use super::threads::{Items, PART, Workers};
use super::{ObjectId, Response, Statistics, World};
use crate::pair::{self, Approach, Scratch};
use crate::threads::in_pool;

/// Two objects that are nearer to each other than their clearance, as they are now: see [`World::near`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Near {
    /// The object that was created first.
    pub a: ObjectId,
    /// The other.
    pub b: ObjectId,
    /// How far they are apart; of objects that intersect, less the depth: at most 0. World units.
    pub distance: f64,
    /// The point of `a` that is closest to `b`, or deepest in it. Space: world.
    pub point_on_a: DVec3,
    /// The point of `b` that is closest to `a`, or deepest in it. Space: world.
    pub point_on_b: DVec3,
    /// The unit vector from `b` to `a`: from `point_on_b` to `point_on_a`; of objects that intersect, the direction in which `a` leaves
    /// `b` soonest. Space: world.
    pub normal: DVec3,
}

/// What the last search for near pairs said of a candidate.
#[derive(Clone, Copy, Debug)]
pub(super) enum Nearness {
    Far,
    Near(Near),
}

impl World {
    /// Every pair that is nearer than its [clearance](World::set_clearance), and every pair that intersects, where the objects are now, with
    /// their closest or deepest points. In the order of the results of a [`test`](World::test); without pairs whose response is
    /// [`Response::Ignore`].
    ///
    /// Exactly the pairs for which [`query::intersects`](crate::query::intersects) is true, or
    /// [`query::distance_within`](crate::query::distance_within) their clearance finds a distance that is less than it. The distance
    /// is that, which is [`query::distance`](crate::query::distance) but for its last bits, and where that is 0, less
    /// the depth of [`query::penetration`](crate::query::penetration). This is apart from [`test`](World::test): what is near but
    /// apart is no collision, has no event, and may be asked for before or after a test, or not at all.
    ///
    /// Cost: pairs are looked at when their boxes, grown for the clearance, overlap, and something about them changed since the
    /// last time; the rest follows the number of such pairs. With the feature `rayon` on the threads of the current pool; the
    /// results are the same bits for any number of threads, with and without caching, and for either broad phase.
    ///
    /// ```
    /// use solid3d::{Shape, World, glam::{DAffine3, DVec3}};
    /// let mut world = World::new();
    /// world.set_clearance(0.05)?;
    /// let block = Shape::cuboid([1.0, 1.0, 1.0])?;
    /// let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
    /// let [a, b, c] = [0.0, 1.03125, 4.0].map(|x| world.add(&block, at(x)).unwrap());
    /// let near = world.near();
    /// assert_eq!((near.len(), near[0].a, near[0].b, near[0].distance), (1, a, b, 0.03125));
    /// assert_eq!((near[0].point_on_a.x, near[0].point_on_b.x, near[0].normal), (0.5, 0.53125, -DVec3::X));
    /// assert!(world.test().is_empty());
    ///
    /// world.set_placement(c, at(1.78125))?;
    /// let near = world.near();
    /// assert_eq!((near[1].a, near[1].b, near[1].distance), (b, c, -0.25));
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn near(&mut self) -> Vec<Near> {
        in_pool(Workers::is_worth_entering(self.work_ahead()), || self.look_at_changed());
        let mut near: Vec<Near> = self.candidates.near().copied().collect();
        // Each key waits for the memory of two objects.
        near.sort_by_cached_key(|near| self.objects.key(near.a, near.b));
        near
    }

    /// Looks at the candidates about which something changed.
    fn look_at_changed(&mut self) {
        self.refresh();
        if !self.caching {
            self.candidates.forget_nearness();
        }
        let mut places = std::mem::take(&mut self.to_examine);
        self.candidates.take_unknown(&mut places);
        let units = self.statistics.units_for(places.len());
        in_pool(Workers::is_worth_entering(units), || self.look_at_all(&places));
        self.to_examine = places;
    }

    /// Looks at candidates, and keeps what that gave.
    fn look_at_all(&mut self, places: &[Place]) {
        let share = Workers::share(self.statistics.units_for(places.len()));
        let Self { objects, responses, clearances, candidates, workers, .. } = self;
        let looker = Looker { objects, responses, clearances };
        let (candidates, nearness) = candidates.with_nearness_mut();
        let mut works = Vec::new();
        for batch in places.chunks(Workers::batch(share)) {
            let candidate =
                |place| candidates[place as usize].as_ref().expect("what is looked at is a candidate");
            let prefetch =
                |place: Place, _: &Nearness| objects.prefetch([candidate(place).a, candidate(place).b]);
            let items = Items { first: 0, values: &mut *nearness, places: batch };
            workers.each(share, items, &mut works, prefetch, |place, nearness, work, scratch| {
                *nearness = looker.look_at(candidate(place), work, scratch);
            });
            for work in works.iter_mut().take(batch.len().div_ceil(PART)) {
                self.statistics += std::mem::take(work);
            }
        }
    }
}

/// What the nearness of a pair depends on, beside the pair.
struct Looker<'a> {
    objects: &'a Arena,
    responses: &'a ResponseTable,
    clearances: &'a Clearances,
}

impl Looker<'_> {
    /// How near the objects of a candidate are to each other; a function of the two, their response and their clearance alone.
    fn look_at(
        &self,
        &Candidate { a, b, .. }: &Candidate,
        work: &mut Statistics,
        scratch: &mut Scratch,
    ) -> Nearness {
        if self.responses.of(a, b) == Response::Ignore {
            return Nearness::Far;
        }
        let before = scratch.work();
        let near = self.nearness(a, b, scratch);
        let after = scratch.work();
        work.examined += 1;
        work.box_tests += after.0 - before.0;
        work.primitive_tests += after.1 - before.1;
        near.map_or(Nearness::Far, Nearness::Near)
    }

    fn nearness(&self, a: ObjectId, b: ObjectId, scratch: &mut Scratch) -> Option<Near> {
        let clearance = self.clearances.of(a, b);
        let [of_a, of_b] = [a, b].map(|id| self.objects[id].placed());
        let found = match pair::proximity(of_a, of_b, clearance, scratch) {
            Some(found) if found.distance < clearance => found,
            // At a clearance below the error of the distance, or of none.
            _ if pair::intersects(of_a, of_b, scratch) => pair::overlap(of_a, of_b, scratch),
            _ => return None,
        };
        let Approach { points, distance, normal } = found;
        Some(Near {
            a,
            b,
            // No negative zero.
            distance: distance + 0.0,
            point_on_a: of_a.placement.transform_point3(points.on_a),
            point_on_b: of_b.placement.transform_point3(points.on_b),
            normal,
        })
    }
}
