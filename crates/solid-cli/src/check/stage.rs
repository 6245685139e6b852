//! The scene in a world, moved from frame to frame.

use std::collections::HashMap;

use anyhow::{Result, anyhow};
use solid_scene::{ObjectPose, Pose, Scene};
use solid3d::{Collision, Contact, Near, ObjectId, Shape, Statistics, World};

use super::motion::Motion;
use crate::record::{Depth, Hit, Pass};
use crate::words;

/// A world with the objects of a scene.
pub struct Stage<'a> {
    scene: &'a Scene,
    motion: Motion<'a>,
    world: World,
    /// The ids of the objects, which are added in the scene's order.
    ids: Vec<ObjectId>,
    places: HashMap<ObjectId, usize>,
    /// The pose of the world.
    shown: Pose,
    /// The pose that motion wrote last.
    wanted: Pose,
}

impl<'a> Stage<'a> {
    /// The scene at the first frame, at a time in seconds, its objects with these shapes.
    pub fn new(scene: &'a Scene, shapes: &[Shape], mut motion: Motion<'a>, time: f64) -> Result<Self> {
        let mut wanted = Pose::default();
        motion.pose(0, time, &mut wanted);
        let mut stage = Stage {
            scene,
            motion,
            world: World::new(),
            ids: Vec::new(),
            places: HashMap::new(),
            shown: wanted.clone(),
            wanted,
        };
        for (object, shape) in shapes.iter().enumerate() {
            let added = stage.add(object, shape);
            let id = added.map_err(|error| stage.refusal(object, time, &error))?;
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

    /// Brings the world to a frame; they come in order.
    pub fn show(&mut self, frame: u64, time: f64) -> Result<()> {
        self.motion.pose(frame, time, &mut self.wanted);
        for object in 0..self.ids.len() {
            self.update(object).map_err(|error| self.refusal(object, time, &error))?;
        }
        Ok(())
    }

    /// What is nearer than its clearance in the frame, in the scene's order.
    pub fn near(&mut self, passes: &mut Vec<Pass>) {
        let near = self.world.near();
        passes.clear();
        passes.extend(near.iter().map(|near| self.pass(near)));
    }

    /// The collisions of the frame, in the scene's order. Ends the frame.
    pub fn test(&mut self, hits: &mut Vec<Hit>) {
        let collisions = self.world.test();
        self.world.proceed();
        hits.clear();
        hits.extend(collisions.iter().map(|collision| self.hit(collision)));
    }

    /// The work done so far.
    pub fn statistics(&self) -> Statistics {
        self.world.statistics()
    }

    fn add(&mut self, object: usize, shape: &Shape) -> solid3d::Result<ObjectId> {
        let ObjectPose { placement, positions } = &self.wanted.objects[object];
        let id = self.world.add(shape, *placement)?;
        if !positions.is_empty() {
            self.world.deform(id, positions)?;
        }
        Ok(id)
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

    fn hit(&self, collision: &Collision) -> Hit {
        let [a, b] = [collision.a, collision.b].map(|id| self.places[&id]);
        let depth = match collision.contact {
            Contact::Depth { depth, point_on_a, point_on_b, .. } => {
                Some(Depth { depth, points: [point_on_a, point_on_b] })
            }
            _ => None,
        };
        let curve = collision.curve().cloned();
        Hit { a, b, point: collision.point(), normal: collision.normal(), curve, depth }
    }

    fn pass(&self, near: &Near) -> Pass {
        let [a, b] = [near.a, near.b].map(|id| self.places[&id]);
        let &Near { distance, point_on_a, point_on_b, normal, .. } = near;
        Pass { a, b, distance, points: [point_on_a, point_on_b], normal }
    }

    /// In words, that an object can't be as it is wanted.
    fn refusal(&self, object: usize, time: f64, error: &solid3d::Error) -> anyhow::Error {
        let (place, name) = (self.motion.place(object), self.scene.objects()[object].name());
        anyhow!("{place}: object {name:?} at {} s: {error}", words::seconds(time))
    }
}
