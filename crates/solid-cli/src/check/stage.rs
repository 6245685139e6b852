//! The scene in a world, moved from frame to frame.

use std::collections::{HashMap, HashSet};

use anyhow::{Result, anyhow};
use solid_scene::{Pose, Scene};
use solid3d::convex::MAGNITUDE_MAX;
use solid3d::glam::{DAffine3, DVec3};
use solid3d::query::{self, ImpactOptions, Path, RayOptions};
use solid3d::{Aabb, Collision, Contact, Near, ObjectId, Shape, Statistics, When, World, WorldOptions};

use super::motion::Motion;
use super::presence::{Presence, Presences};
use crate::rays::NamedRay;
use crate::record::{Depth, Hit, Pass, Sighting};
use crate::{scene, words};

/// How small an object is made that is to wait in the world until it is there for the first time: next to nothing, so that it
/// overlaps little, but far from where numbers end.
const SPECK: f64 = 1e-9;

/// A world with the objects of a scene.
///
/// An object whose placement the library refuses because it is flat is absent, if its motion allows that. It waits in the world
/// where it was last, so that rules and the order of the scene stay as they are; what is found of it is passed over.
pub struct Stage<'a> {
    scene: &'a Scene,
    motion: Motion<'a>,
    world: World,
    /// The ids of the objects, which are added in the scene's order.
    ids: Vec<ObjectId>,
    places: HashMap<ObjectId, usize>,
    /// The pose of the world.
    shown: Pose,
    presences: Presences,
    /// The pose that motion wrote last.
    wanted: Pose,
    /// Whether the world is tested between frames, too.
    tested: solid3d::Motion,
    /// The times of the previous frame and of the one shown, in seconds.
    times: [f64; 2],
}

impl<'a> Stage<'a> {
    /// The scene at the first frame, at a time in seconds, its objects with these shapes, and tested as said.
    pub fn new(
        scene: &'a Scene,
        shapes: &[Shape],
        mut motion: Motion<'a>,
        tested: solid3d::Motion,
        time: f64,
    ) -> Result<Self> {
        let mut wanted = Pose::default();
        motion.pose(0, time, &mut wanted);
        let mut stage = Stage {
            scene,
            motion,
            world: World::with_options(&WorldOptions { motion: tested, ..WorldOptions::default() }),
            ids: Vec::new(),
            places: HashMap::new(),
            shown: wanted.clone(),
            presences: Presences::new(shapes.len()),
            wanted,
            tested,
            times: [time; 2],
        };
        for (object, shape) in shapes.iter().enumerate() {
            let id = stage.add(object, shape, time)?;
            stage.places.insert(id, object);
            stage.ids.push(id);
        }
        // The first frame is its own previous frame.
        stage.world.proceed();
        Ok(stage)
    }

    /// The world and the ids of its objects, to set responses.
    pub fn world(&mut self) -> (&mut World, &[ObjectId]) {
        (&mut self.world, &self.ids)
    }

    /// How many objects there are.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// The boxes around them, in the scene's order.
    pub fn bounds(&self) -> impl Iterator<Item = Aabb> {
        let bounds = |id: ObjectId| query::bounds(self.world.shape(id)?, &self.world.placement(id)?);
        self.ids
            .iter()
            .map(move |&id| bounds(id).expect("it is in the world, where only good placements are"))
    }

    /// Brings the world to a frame; they come in order.
    pub fn show(&mut self, frame: u64, time: f64) -> Result<()> {
        self.motion.pose(frame, time, &mut self.wanted);
        self.times = [self.times[1], time];
        (0..self.ids.len()).try_for_each(|object| self.show_object(object, time))
    }

    /// Which objects were absent in some frame so far, in words, a line each.
    pub fn absences(&self) -> impl Iterator<Item = String> {
        self.presences.absences().map(|(object, time)| scene::absence(self.scene, object, time))
    }

    /// What is nearer than its clearance in the frame, in the scene's order.
    pub fn near(&mut self, passes: &mut Vec<Pass>) {
        let near = self.world.near();
        passes.clear();
        passes.extend(near.iter().map(|near| self.pass(near)).filter(|pass| self.are_there(pass.a, pass.b)));
    }

    /// The collisions of the frame, in the scene's order. Ends the frame.
    pub fn test(&mut self, hits: &mut Vec<Hit>) {
        let collisions = self.world.test();
        hits.clear();
        hits.extend(collisions.iter().filter_map(|collision| {
            let hit = self.hit(collision);
            if !self.are_there(hit.a, hit.b) {
                return None;
            }
            match self.tested {
                solid3d::Motion::Sampled => Some(hit),
                solid3d::Motion::Swept => self.timed(hit, collision),
            }
        }));
        self.world.proceed();
    }

    /// What rays meet in the frame: of each object the first point.
    pub fn cast(&self, rays: &[NamedRay], sightings: &mut Vec<Sighting>) {
        sightings.clear();
        let mut met = HashSet::new();
        for (place, NamedRay { ray, .. }) in rays.iter().enumerate() {
            let is_there = |id| self.is_there(self.places[&id]);
            let hits = self.world.cast_ray_all(ray, &RayOptions::default(), is_there);
            met.clear();
            let length = ray.direction.length();
            let hits = hits.expect("the ray was checked when it was read").into_iter();
            sightings.extend(hits.filter(|found| met.insert(found.object)).map(|found| Sighting {
                ray: place,
                object: self.places[&found.object],
                primitive: found.hit.surface.map(|surface| surface.primitive),
                distance: found.hit.t * length,
                point: found.hit.point,
                normal: found.hit.surface.map(|surface| surface.normal),
            }));
        }
    }

    /// The work done so far.
    pub fn statistics(&self) -> Statistics {
        self.world.statistics()
    }

    /// Adds an object as it is in the first frame, at a time in seconds; if it is absent there, as a speck.
    fn add(&mut self, object: usize, shape: &Shape, time: f64) -> Result<ObjectId> {
        let placement = self.wanted.objects[object].placement;
        let mut added = self.add_at(object, shape, placement);
        if self.is_absence(object, &added) {
            self.presences.hide(object, time);
            let speck = speck(object, shape, placement.translation);
            self.shown.objects[object].placement = speck;
            added = self.add_at(object, shape, speck);
        }
        added.map_err(|error| self.refusal(object, time, &error))
    }

    fn add_at(&mut self, object: usize, shape: &Shape, placement: DAffine3) -> solid3d::Result<ObjectId> {
        let positions = &self.wanted.objects[object].positions;
        let id = self.world.add(shape, placement)?;
        if !positions.is_empty() {
            self.world.deform(id, positions)?;
        }
        Ok(id)
    }

    /// Brings an object to the frame at a time, if it is there. What is new there is as in the first frame: its own previous one.
    fn show_object(&mut self, object: usize, time: f64) -> Result<()> {
        let updated = self.update(object);
        if self.is_absence(object, &updated) {
            self.presences.hide(object, time);
            return Ok(());
        }
        updated.map_err(|error| self.refusal(object, time, &error))?;
        self.presences.show(object);
        if self.presences.of(object) == Presence::New {
            self.world.proceed_object(self.ids[object])?;
        }
        Ok(())
    }

    /// Moves and deforms an object, if it is to be elsewhere or otherwise.
    fn update(&mut self, object: usize) -> solid3d::Result<()> {
        let (id, wanted, shown) =
            (self.ids[object], &self.wanted.objects[object], &mut self.shown.objects[object]);
        if wanted.placement != shown.placement {
            self.world.set_placement(id, wanted.placement)?;
            shown.placement = wanted.placement;
        }
        if wanted.positions != shown.positions {
            self.world.deform(id, &wanted.positions)?;
            shown.positions.clone_from(&wanted.positions);
        }
        Ok(())
    }

    /// Whether the world refused an object because it is absent.
    fn is_absence<T>(&self, object: usize, answer: &solid3d::Result<T>) -> bool {
        self.motion.may_hide(object) && matches!(answer, Err(solid3d::Error::SingularPlacement { .. }))
    }

    fn is_there(&self, object: usize) -> bool {
        self.presences.of(object) != Presence::Absent
    }

    fn are_there(&self, a: usize, b: usize) -> bool {
        self.is_there(a) && self.is_there(b)
    }

    fn hit(&self, collision: &Collision) -> Hit {
        let [a, b] = [collision.a, collision.b].map(|id| self.places[&id]);
        let (point, normal, curve) = (collision.point(), collision.normal(), collision.curve().cloned());
        let (depth, contacts) = (depth(collision), collision.manifolds().cloned());
        Hit { a, b, point, normal, curve, depth, contacts, contact_time: None }
    }

    fn pass(&self, near: &Near) -> Pass {
        let [a, b] = [near.a, near.b].map(|id| self.places[&id]);
        let &Near { distance, point_on_a, point_on_b, normal, .. } = near;
        Pass { a, b, distance, points: [point_on_a, point_on_b], normal }
    }

    /// The same with the time of the first contact since the previous frame; `None` for a pair that only seemed to meet on the
    /// way: what the world tests encloses the way of what turns or deforms. What is new has no way, and meets others at the frame.
    fn timed(&self, hit: Hit, collision: &Collision) -> Option<Hit> {
        let [previous, now] = self.times;
        if [hit.a, hit.b].map(|object| self.presences.of(object)).contains(&Presence::New) {
            return (collision.when == When::Now).then_some(Hit { contact_time: Some(now), ..hit });
        }
        let options = ImpactOptions { path: Path::Straight, ..ImpactOptions::default() };
        let impact = self.world.time_of_impact(collision.a, collision.b, &options);
        let impact = impact.expect("the world said that they collide, and the options are in range");
        match (collision.when, impact) {
            (When::OnTheWay, None) => None,
            // Touching counts now, by less than the error of the time of impact.
            (When::Now, None) => Some(Hit { contact_time: Some(now), ..hit }),
            (when, Some(impact)) => {
                let point = if when == When::Now { hit.point } else { hit.point.map(|_| impact.point) };
                let time = previous + impact.time * (now - previous);
                Some(Hit { point, contact_time: Some(time), ..hit })
            }
        }
    }

    /// In words, that an object can't be as it is wanted.
    fn refusal(&self, object: usize, time: f64, error: &solid3d::Error) -> anyhow::Error {
        let (place, name) = (self.motion.place(object), words::quoted(self.scene.objects()[object].name()));
        anyhow!("{place}: object {name} at {} s: {error}", words::seconds(time))
    }
}

/// Where an object waits that is to be at a point: as a speck beside it. Of many that are to be there each has room of its own
/// size, or the boxes of all pairs would overlap.
fn speck(object: usize, shape: &Shape, point: DVec3) -> DAffine3 {
    let bounds = query::bounds(shape, &DAffine3::IDENTITY).expect("the placement is good");
    let size = 2.0 * bounds.min.abs().max(bounds.max.abs()).max_element();
    let beside = (point + DVec3::X * size * object as f64).min(DVec3::splat(MAGNITUDE_MAX));
    DAffine3 { translation: beside, ..DAffine3::from_scale(DVec3::splat(SPECK)) }
}

/// How deep the objects of a collision are in each other, with the deepest points, if its response tells.
fn depth(collision: &Collision) -> Option<Depth> {
    let depth = collision.depth()?;
    let points = match &collision.contact {
        Contact::Depth { point_on_a, point_on_b, .. } => [*point_on_a, *point_on_b],
        Contact::Contacts { manifolds, .. } => {
            let mut contacts = manifolds.iter().flat_map(|manifold| &manifold.points);
            let deepest = contacts.find(|contact| contact.depth == depth)?;
            [deepest.point_on_a, deepest.point_on_b]
        }
        _ => return None,
    };
    Some(Depth { depth, points })
}
