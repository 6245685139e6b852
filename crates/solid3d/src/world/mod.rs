//! The world: objects, the response table, and the test for collisions (thesis, chapter 6).
//!
//! It contains no geometry: what two shapes do is the algorithm table's business, which boxes overlap the broad phase's.

mod arena;
mod candidates;
mod casts;
mod clearance;
mod closest;
mod collision;
mod contacts;
mod event;
mod examine;
mod findings;
mod lapsed;
mod motion;
mod near;
mod news;
mod object;
mod options;
mod ordered;
mod pair_map;
mod rays;
mod regions;
mod response;
mod statistics;
mod stirred;
mod test;
mod threads;

use std::fmt;

use glam::{DAffine3, DVec3};

pub use casts::ObjectCast;
pub use closest::{ObjectDistance, ObjectPoint};
pub use collision::{Collision, Contact};
pub use event::{Event, EventKind};
pub use motion::{Motion, When};
pub use near::Near;
pub use object::ObjectId;
pub use options::{Boxes, WorldOptions};
pub use rays::ObjectHit;
pub use response::Response;
pub use statistics::Statistics;
pub use test::TestProgress;

use crate::broad::room::push_word;
use crate::broad::{BroadPhase, PROXY_MAX};
use crate::error::{Error, Result};
use crate::placement;
use crate::shape::Shape;
use crate::working::Working;
use arena::{Arena, slot_of as proxy};
use candidates::{Candidates, PairKey};
use clearance::Clearances;
use findings::Findings;
use object::Object;
use response::ResponseTable;
use stirred::{Staleness, Stirred};
use threads::Workers;

/// How many objects there may be: the slot of each is a proxy, and slot 0 is not used.
const OBJECTS_MAX: usize = PROXY_MAX as usize;

/// Objects in one space, and what is wanted of their collisions.
///
/// A time step, or *frame*, is: place and deform objects, [`test`](World::test) as often as needed, then
/// [`proceed`](World::proceed).
///
/// ```
/// use solid3d::{Response, Shape, World, glam::{DAffine3, DVec3}};
///
/// let mut world = World::new();
/// world.set_default_response(Response::Smart);
/// let floor = world.add(&Shape::cuboid([10.0, 1.0, 10.0])?, DAffine3::IDENTITY)?;
/// let ball = world.add(&Shape::sphere(1.0)?, DAffine3::from_translation(DVec3::Y * 2.0))?;
/// assert!(world.test().is_empty());
/// world.proceed();
///
/// world.set_placement(ball, DAffine3::from_translation(DVec3::Y * 1.4))?;
/// let collisions = world.test();
/// assert_eq!((collisions[0].a, collisions[0].b), (floor, ball));
/// // From the previous frame, in which they were apart: the normal points from the ball to the floor.
/// assert!((collisions[0].normal().unwrap() + DVec3::Y).length() < 1e-5);
/// # Ok::<(), solid3d::Error>(())
/// ```
///
/// A copy made with `clone` does from there on what the world does, to the bit, if it is told the same: a state to go back to, or a branch in which to try
/// something. Ids name the same objects in both. Cost: linear in the objects and pairs; shapes share their geometry.
#[derive(Clone)]
pub struct World {
    /// The slot of each is its proxy in the broad phase.
    objects: Arena,
    /// How many objects were ever added: the creation order.
    added: u64,
    responses: ResponseTable,
    clearances: Clearances,
    broad: Box<dyn BroadPhase>,
    boxes: Boxes,
    /// Of objects that are added.
    motion: Motion,
    caching: bool,
    stirred: Stirred,
    /// Objects whose previous frame differs from the current one.
    displaced: Vec<ObjectId>,
    candidates: Candidates,
    findings: Findings,
    /// Whether something changed since the candidates were brought up to date.
    stale: bool,
    /// Whether the default response did.
    default_changed: bool,
    /// The candidates that a test examines.
    to_examine: Working<Vec<pair_map::Place>>,
    /// What examining them gave, part by part.
    news: Working<[Vec<news::News>; 2]>,
    workers: Working<Workers>,
    statistics: Statistics,
}

impl Default for World {
    fn default() -> Self {
        World::with_options(&WorldOptions::default())
    }
}

/// How many objects there are, and the work done, not all that is known of them.
impl fmt::Debug for World {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { objects, statistics, .. } = self;
        let mut world = f.debug_struct("World");
        world.field("objects", &objects.len()).field("statistics", statistics).finish_non_exhaustive()
    }
}

impl World {
    /// An empty world with the default [`WorldOptions`].
    pub fn new() -> Self {
        World::default()
    }

    /// An empty world.
    pub fn with_options(options: &WorldOptions) -> Self {
        World {
            objects: Arena::default(),
            added: 0,
            responses: ResponseTable::new(options.default_response),
            clearances: Clearances::default(),
            broad: options.broad_phase.build(),
            boxes: options.boxes,
            motion: options.motion,
            caching: options.caching,
            stirred: Stirred::default(),
            displaced: Vec::new(),
            candidates: Candidates::default(),
            findings: Findings::default(),
            stale: false,
            default_changed: false,
            to_examine: Working::default(),
            news: Working::default(),
            workers: Working::default(),
            statistics: Statistics::default(),
        }
    }

    /// Adds an object: an instance of a shape at a place. Its previous frame is this one until the next [`proceed`](World::proceed).
    ///
    /// Errors: a placement that is not finite, too large, or singular; more objects than there are numbers for.
    pub fn add(&mut self, shape: &Shape, placement: DAffine3) -> Result<ObjectId> {
        self.add_ranked(shape, placement, 0)
    }

    /// Like [`add`](World::add), with a rank other than 0. Of a pair of objects of different ranks, the one of the lower rank
    /// counts as the one that was created first: it is `a` of the [`Collision`], and its response goes before the other's.
    ///
    /// ```
    /// use solid3d::{Shape, World, glam::DAffine3};
    /// let mut world = World::new();
    /// let ball = Shape::sphere(1.0)?;
    /// let late = world.add_ranked(&ball, DAffine3::IDENTITY, 1)?;
    /// let early = world.add(&ball, DAffine3::IDENTITY)?;
    /// assert_eq!((world.test()[0].a, world.test()[0].b), (early, late));
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn add_ranked(&mut self, shape: &Shape, placement: DAffine3, rank: u8) -> Result<ObjectId> {
        placement::checked("placement", &placement)?;
        if self.objects.len() >= OBJECTS_MAX {
            return Err(Error::TooMany {
                argument: "objects",
                count: self.objects.len() + 1,
                limit: OBJECTS_MAX,
            });
        }
        let object = Object::new(rank, self.added, shape.clone(), placement, self.motion, self.boxes);
        let mut bounds = object.bounds();
        let id = self.objects.insert(object);
        self.clearances.grow([(id, &mut bounds)]);
        self.added += 1;
        self.stale = true;
        self.broad.insert(proxy(id), bounds);
        Ok(id)
    }

    /// Removes an object, with the responses and clearances set for it and for its pairs.
    pub fn remove(&mut self, id: ObjectId) -> Result<()> {
        let object = self.objects.remove(id).ok_or(Error::UnknownObject { argument: "object", id })?;
        self.forget_responses(id, object.pair_responses);
        self.clearances.forget(id);
        let Self { broad, candidates, findings, stirred, .. } = self;
        broad.for_each_pair_of(proxy(id), &mut |pair, _| candidates.end(pair));
        candidates.lapsed.take_of(id, findings);
        broad.remove(proxy(id));
        stirred.vacate(proxy(id));
        self.stale = true;
        Ok(())
    }

    /// Whether an object is in the world.
    pub fn contains(&self, id: ObjectId) -> bool {
        self.objects.contains_key(id)
    }

    /// The objects, in creation order.
    pub fn objects(&self) -> Vec<ObjectId> {
        let mut objects: Vec<_> = self.objects.iter().map(|(id, object)| (object.serial(), id)).collect();
        objects.sort_unstable();
        objects.into_iter().map(|(_, id)| id).collect()
    }

    /// How many objects there are.
    pub fn len(&self) -> usize {
        self.objects.len()
    }

    /// Whether there is no object.
    pub fn is_empty(&self) -> bool {
        self.objects.is_empty()
    }

    /// An object's placement.
    pub fn placement(&self, id: ObjectId) -> Result<DAffine3> {
        Ok(self.object(id)?.placement)
    }

    /// An object's shape.
    pub fn shape(&self, id: ObjectId) -> Result<&Shape> {
        Ok(&self.object(id)?.shape)
    }

    /// Places an object: any affine map that is finite and not singular.
    pub fn set_placement(&mut self, id: ObjectId, placement: DAffine3) -> Result<()> {
        placement::checked("placement", &placement)?;
        let object = self.object_mut(id)?;
        // To the bit, for the sign of a zero may show in an answer.
        if !placement::is_same(&object.placement, &placement) {
            let was_displaced = object.displaced;
            object.set_placement(placement);
            self.touch(id, was_displaced);
        }
        Ok(())
    }

    /// Gives an object another shape. Smart response still sees the old one in the previous frame.
    ///
    /// This is how one deformed shape reaches several objects: [`Shape::deform`] a clone, then set it for each.
    pub fn set_shape(&mut self, id: ObjectId, shape: &Shape) -> Result<()> {
        let boxes = self.boxes;
        let object = self.object_mut(id)?;
        let was_displaced = object.displaced;
        object.set_shape(shape, boxes);
        self.touch(id, was_displaced);
        Ok(())
    }

    /// Deforms an object whose shape is a mesh or a complex shape: gives its vertices new positions, in local space. Other
    /// objects of the same shape stay as they are. Smart response still sees the old positions in the previous frame.
    ///
    /// Cost and errors: those of [`Shape::deform`].
    pub fn deform(&mut self, id: ObjectId, positions: &[DVec3]) -> Result<()> {
        let object = self.object_mut(id)?;
        let was_displaced = object.displaced;
        object.deform(positions)?;
        self.touch(id, was_displaced);
        Ok(())
    }

    /// Ends the frame: what is now becomes the previous frame, of smart response, of [`Motion::Swept`] and of
    /// [events](World::events). Cost: follows what moved.
    pub fn proceed(&mut self) {
        let mut displaced = std::mem::take(&mut self.displaced);
        for id in displaced.drain(..) {
            self.end_frame_of(id);
        }
        self.displaced = displaced;
        self.findings.proceed();
    }

    /// Ends the frame for one object alone: its previous frame is then as it is now. [Events](World::events) are still told against the last
    /// [`proceed`](World::proceed).
    pub fn proceed_object(&mut self, id: ObjectId) -> Result<()> {
        self.object(id)?;
        // It stays in `displaced` for a while, where a second entry or none to do is harmless.
        self.end_frame_of(id);
        Ok(())
    }

    /// Ends the frame of an object that is in the world; else nothing.
    #[inline]
    fn end_frame_of(&mut self, id: ObjectId) {
        let Some(object) = self.objects.get_mut(id) else { return };
        let had_way = object.has_way();
        object.proceed();
        if had_way {
            self.stir(id, Staleness::Bounds);
        } else if self.responses.looks_back() {
            self.stir(id, Staleness::Previous);
        }
    }

    /// Lets tests use what earlier tests found out about a pair: its separating axis, the vertices by which two hulls had a common point, and
    /// all of it while nothing about the pair changed. On by default. Answers are the same with and without, to the bit.
    pub fn enable_caching(&mut self) {
        self.caching = true;
    }

    /// Makes each test start from nothing; see [`enable_caching`](World::enable_caching).
    pub fn disable_caching(&mut self) {
        self.caching = false;
        self.candidates.forget_proofs();
    }

    /// The work done since the world was made.
    pub fn statistics(&self) -> Statistics {
        self.statistics
    }

    fn object(&self, id: ObjectId) -> Result<&Object> {
        self.objects.get(id).ok_or(Error::UnknownObject { argument: "object", id })
    }

    fn object_mut(&mut self, id: ObjectId) -> Result<&mut Object> {
        self.objects.get_mut(id).ok_or(Error::UnknownObject { argument: "object", id })
    }

    /// Notes that an object in the world is not where the broad phase and the previous frame have it.
    #[inline]
    fn touch(&mut self, id: ObjectId, was_displaced: bool) {
        if !was_displaced {
            if self.displaced.len() > 2 * self.objects.len() {
                self.forget_settled();
            }
            push_word(&mut self.displaced, id);
        }
        self.stir(id, Staleness::Bounds);
    }

    /// Forgets which of the displaced were removed, or ended their frame alone, where most are: without `proceed` nothing else would.
    #[cold]
    #[inline(never)]
    fn forget_settled(&mut self) {
        let Self { displaced, objects, .. } = self;
        displaced.sort_unstable();
        displaced.dedup();
        displaced.retain(|&id| objects.get(id).is_some_and(|object| object.displaced));
    }

    /// Notes what of an object in the world is out of date.
    #[inline]
    fn stir(&mut self, id: ObjectId, what: Staleness) {
        self.stirred.stir(proxy(id), what);
        self.stale = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Objects that come and go must not leave something behind in those that stay.
    #[test]
    fn a_removed_object_leaves_no_partner() -> Result<()> {
        let (mut world, ball) = (World::new(), Shape::sphere(1.0)?);
        let stays = world.add(&ball, DAffine3::IDENTITY)?;
        for _ in 0..10 {
            let goes = world.add(&ball, DAffine3::IDENTITY)?;
            world.set_pair_response(stays, goes, Response::Simple)?;
            assert_eq!((world.objects[stays].pair_responses, world.responses.pair_count()), (1, 1));
            world.remove(goes)?;
            assert_eq!((world.objects[stays].pair_responses, world.responses.pair_count()), (0, 0));
        }
        Ok(())
    }

    /// The same with many at a time: what is left behind is a share of what is there, and what is stirred holds each once.
    #[test]
    fn what_removed_objects_leave_is_bounded() -> Result<()> {
        let (mut world, ball) = (World::new(), Shape::sphere(1.0)?);
        let hub = world.add(&ball, DAffine3::IDENTITY)?;
        let spokes: Vec<_> = (1..=1000)
            .map(|i| world.add(&ball, DAffine3::from_translation(DVec3::X * 3.0 * f64::from(i))).unwrap())
            .collect();
        for &spoke in &spokes {
            world.set_pair_response(hub, spoke, Response::Simple)?;
        }
        for (removed, &spoke) in (1..).zip(&spokes) {
            world.remove(spoke)?;
            assert!(world.responses.pair_count() <= 2 * (spokes.len() - removed));
        }
        assert_eq!(world.objects[hub].pair_responses, 0);
        for _ in 0..100 {
            world.set_placement(hub, DAffine3::from_translation(DVec3::Y))?;
            world.proceed();
            world.set_placement(hub, DAffine3::IDENTITY)?;
        }
        assert_eq!(world.stirred.sorted().map(<[_]>::len), [1, 0]);
        Ok(())
    }

    /// The same of frames that end object by object, and of pairs that come and go while nobody tests.
    #[test]
    fn what_frames_leave_that_are_not_tested_as_a_whole_is_bounded() -> Result<()> {
        let (mut world, ball) = (World::new(), Shape::sphere(1.0)?);
        let ids = [0.0, 1.0].map(|x| world.add(&ball, DAffine3::from_translation(DVec3::X * x)).unwrap());
        for step in 0..1000 {
            for id in ids {
                let at = DVec3::X * if id == ids[0] { f64::from(step % 2) * 9.0 } else { 1.0 };
                world
                    .set_placement(id, DAffine3::from_translation(at + DVec3::Y * 1e-6 * f64::from(step)))?;
                world.proceed_object(id)?;
            }
            assert_eq!(world.near().len(), if step % 2 == 0 { 1 } else { 0 });
            assert!(world.displaced.len() <= 2 * ids.len() + 1, "{} displaced", world.displaced.len());
            assert!(world.candidates.queued() <= 1, "{} queued", world.candidates.queued());
        }
        // What is not written down any more is examined all the same.
        world.set_placement(ids[0], DAffine3::IDENTITY)?;
        assert_eq!((world.test().len(), world.statistics().examined), (1, 501));
        Ok(())
    }

    /// Law: to forget which objects ended their frames alone keeps those that did not.
    #[test]
    fn what_did_not_end_its_frame_alone_ends_it_with_the_others() -> Result<()> {
        let (mut world, ball) = (World::new(), Shape::sphere(1.0)?);
        world.set_default_response(Response::Smart);
        let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
        let [resting, moved, busy] = [0.0, 3.0, 9.0].map(|x| world.add(&ball, at(x)).unwrap());
        world.set_placement(moved, at(1.5))?;
        for step in 0..100 {
            world.set_placement(busy, at(9.0 + f64::from(step % 2)))?;
            world.proceed_object(busy)?;
        }
        // The balls were 1 apart, and are 0.5 in each other.
        for expected in [1.0, -0.5] {
            let found = world.test();
            assert_eq!((found[0].a, found[0].b), (resting, moved));
            assert!(matches!(found[0].contact, Contact::Smart { distance, .. } if distance == expected));
            world.proceed();
        }
        Ok(())
    }

    /// What an object and a candidate take, beyond the shape: counted in bytes, so that a field more does not pass unseen.
    #[test]
    fn objects_and_candidates_are_small() {
        let shape = size_of::<Shape>();
        assert!(size_of::<Object>() <= shape + 136, "{} bytes", size_of::<Object>() - shape);
        assert!(size_of::<Option<candidates::Candidate>>() <= 64);
    }

    /// One pair alone is reported as the test of all would.
    #[test]
    fn a_pair_alone_is_as_in_a_test() -> Result<()> {
        let (mut world, ball) = (World::new(), Shape::sphere(1.0)?);
        let late = world.add_ranked(&ball, DAffine3::IDENTITY, 1)?;
        let early = world.add(&ball, DAffine3::from_translation(DVec3::X))?;
        let far = world.add(&ball, DAffine3::from_translation(DVec3::Y * 9.0))?;
        let all = world.test();
        assert_eq!(all.len(), 1);
        assert_eq!(world.test_pair(late, early)?, Some(all[0].clone()));
        assert_eq!(world.test_pair(early, late)?, Some(all[0].clone()));
        assert_eq!(world.test_pair(early, far)?, None);
        world.clear_pair_response(early, late)?;
        assert_eq!(world.test_pair(early, late)?, None);
        // Each was a candidate but the last; the one far away did not collide.
        let Statistics { candidates, examined, collisions, .. } = world.statistics();
        assert_eq!((candidates, examined, collisions), (4, 4, 3));
        Ok(())
    }

    /// A response that comes to depend on the previous frame sees that frames end, whichever way it was set.
    #[test]
    fn responses_that_come_to_look_back_see_frames_end() -> Result<()> {
        for way in 0..4 {
            let default_response = if way == 3 { Response::Smart } else { Response::Witness };
            let mut world =
                World::with_options(&WorldOptions { default_response, ..WorldOptions::default() });
            let ball = Shape::sphere(1.0)?;
            let at = |y: f64| DAffine3::from_translation(DVec3::Y * y);
            let ids = [world.add(&ball, at(0.0))?, world.add(&ball, at(3.0))?];
            world.proceed();
            world.set_placement(ids[1], at(1.5))?;
            assert_eq!(world.test().len(), 1);
            match way {
                0 => world.set_default_response(Response::Smart),
                1 => world.set_object_response(ids[0], Response::Smart)?,
                3 => {}
                _ => world.set_pair_response(ids[0], ids[1], Response::Smart)?,
            }
            // The balls were 1 apart, and are 0.5 in each other.
            for expected in [1.0, -0.5] {
                let Contact::Smart { distance, .. } = world.test()[0].contact else {
                    panic!("smart response")
                };
                assert_eq!(distance, expected);
                world.proceed();
            }
        }
        Ok(())
    }

    /// Ending the frame for one object leaves the previous frame of the other.
    #[test]
    fn a_frame_ends_for_one_object_alone() -> Result<()> {
        let (mut world, ball) = (World::new(), Shape::sphere(1.0)?);
        world.set_default_response(Response::Smart);
        let a = world.add(&ball, DAffine3::IDENTITY)?;
        let b = world.add(&ball, DAffine3::IDENTITY)?;
        world.set_placement(b, DAffine3::from_translation(DVec3::Y * 3.0))?;
        world.proceed_object(b)?;
        world.set_placement(a, DAffine3::from_translation(DVec3::Y * 2.0))?;
        let normal = world.test()[0].normal();
        assert!(normal.is_some_and(|normal| (normal + DVec3::Y).length() < 1e-9), "{normal:?}");
        world.proceed();
        let Contact::Smart { distance, .. } = world.test()[0].contact else { panic!("smart response") };
        assert_eq!(distance, -1.0, "they are in each other now");
        Ok(())
    }
}
