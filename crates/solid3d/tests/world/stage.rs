//! Worlds in lock step, with what happens to them.

use glam::{DAffine3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::{random_shape, seeded};
use solid3d::{Collision, Event, EventKind, Motion, ObjectId, Response, Shape, When, World, glam};

use super::bits::all_bits;
use super::common::{
    Soup, direction, in_cube, placement, random_complex, random_mesh, shape_of, stretch, torus,
};
use super::model::{Model, Thing};

/// Worlds that are told the same, and the model of them.
pub struct Stage {
    pub worlds: Vec<World>,
    /// They test the way from the previous frame, too.
    pub swept: Vec<World>,
    pub model: Model,
    /// Every object that ever was, in creation order.
    pub created: Vec<ObjectId>,
    /// What collided when the last frame ended.
    pub collided: Vec<(ObjectId, ObjectId)>,
    pub rng: StdRng,
    /// The side of the cube that the objects are in.
    pub room: f64,
}

pub const RESPONSES: [Response; 7] = [
    Response::Ignore,
    Response::Simple,
    Response::Witness,
    Response::Smart,
    Response::Depth,
    Response::Curve,
    Response::Contacts,
];

impl Stage {
    pub fn new(worlds: Vec<World>, seed: u64, room: f64) -> Stage {
        println!("seed {seed}");
        Stage {
            worlds,
            swept: Vec::new(),
            model: Model::default(),
            created: vec![],
            collided: vec![],
            rng: seeded(seed),
            room,
        }
    }

    /// Tells every world the same and returns what the first said; they all say the same.
    pub fn tell<T: PartialEq + std::fmt::Debug>(&mut self, mut what: impl FnMut(&mut World) -> T) -> T {
        let worlds = self.worlds.iter_mut().chain(&mut self.swept);
        let mut answers: Vec<T> = worlds.map(&mut what).collect();
        assert!(answers.iter().all(|answer| *answer == answers[0]), "{answers:?}");
        answers.swap_remove(0)
    }

    pub fn random_place(&mut self) -> DAffine3 {
        let mut at = placement(&mut self.rng, 1.0);
        at.translation = 0.5 * self.room * in_cube(&mut self.rng);
        at
    }

    pub fn random_thing(&mut self) -> (Shape, Option<Soup>) {
        let soup = match self.rng.random_range(0..6) {
            0 => {
                let count = self.rng.random_range(20..120);
                random_mesh(&mut self.rng, count)
            }
            1 => torus(8, 5, 0.4),
            2 => {
                let count = self.rng.random_range(1..12);
                random_complex(&mut self.rng, count)
            }
            _ => return (shape_of(&random_shape(&mut self.rng, 1.0)), None),
        };
        (soup.shape(), Some(soup))
    }

    pub fn add(&mut self) {
        let at = self.random_place();
        // A third are instances of a shape that is there already.
        let (shape, soup) = match self.rng.random_range(0..3) {
            0 if !self.model.things.is_empty() => {
                let thing = self.any();
                (self.model.things[thing].shape.clone(), self.model.things[thing].soup.clone())
            }
            _ => self.random_thing(),
        };
        let id = self.tell(|world| world.add(&shape, at).unwrap());
        self.created.push(id);
        let before = (shape.clone(), at);
        self.model.things.push(Thing { id, shape, placement: at, before, soup, size: stretch(&at) });
    }

    pub fn any(&mut self) -> usize {
        self.rng.random_range(0..self.model.things.len())
    }

    pub fn remove(&mut self, index: usize) {
        let id = self.model.things.remove(index).id;
        self.tell(|world| world.remove(id).unwrap());
        self.model.objects.remove(&id);
        self.model.pairs.retain(|&(a, b), _| a != id && b != id);
    }

    pub fn place(&mut self, index: usize, at: DAffine3) {
        let id = self.model.things[index].id;
        self.tell(|world| world.set_placement(id, at).unwrap());
        self.model.things[index].placement = at;
        self.model.things[index].size = self.model.things[index].size.max(stretch(&at));
    }

    /// A step: small, or sometimes to anywhere.
    pub fn step(&mut self, index: usize) {
        if self.rng.random_range(0..60) == 0 {
            let at = self.random_place();
            return self.place(index, at);
        }
        let at = self.model.things[index].placement;
        let turn = DQuat::from_axis_angle(direction(&mut self.rng), 0.05 * self.rng.random::<f64>());
        let shift = 0.1 * in_cube(&mut self.rng) - 0.01 * at.translation;
        let matrix3 = glam::DMat3::from_quat(turn) * at.matrix3;
        self.place(index, DAffine3 { matrix3, translation: at.translation + shift });
    }

    pub fn deform(&mut self, index: usize) {
        let Some(soup) = self.model.things[index].soup.clone() else { return };
        let twist = if self.rng.random_range(0..10) == 0 { 9.0 } else { self.rng.random_range(-0.5..0.5) };
        let wave = |v: &DVec3| DQuat::from_rotation_y(twist * v.length()) * *v;
        let positions: Vec<DVec3> = soup.vertices.iter().map(wave).collect();
        let id = self.model.things[index].id;
        self.tell(|world| world.deform(id, &positions).unwrap());
        // The model builds its shape anew.
        self.model.things[index].shape = Soup { vertices: positions, ..soup }.shape();
    }

    pub fn set_shape(&mut self, index: usize) {
        let (shape, soup) = self.random_thing();
        let id = self.model.things[index].id;
        self.tell(|world| world.set_shape(id, &shape).unwrap());
        (self.model.things[index].shape, self.model.things[index].soup) = (shape, soup);
    }

    pub fn change_responses(&mut self) {
        let response = RESPONSES[self.rng.random_range(0..RESPONSES.len())];
        let (i, j) = (self.any(), self.any());
        let (a, b) = (self.model.things[i].id, self.model.things[j].id);
        let pair = (a.min(b), a.max(b));
        match self.rng.random_range(0..10) {
            0 => {
                self.tell(|world| world.set_default_response(response));
                self.model.default = Some(response);
            }
            1 => {
                self.tell(|world| world.clear_object_response(a).unwrap());
                self.model.objects.insert(a, Response::Ignore);
            }
            2 | 3 => {
                self.tell(|world| world.set_object_response(a, response).unwrap());
                self.model.objects.insert(a, response);
            }
            4 | 5 => {
                self.tell(|world| world.reset_object_response(a).unwrap());
                self.model.objects.remove(&a);
            }
            6 if a != b => {
                self.tell(|world| world.clear_pair_response(a, b).unwrap());
                self.model.pairs.insert(pair, Response::Ignore);
            }
            7 if a != b => {
                self.tell(|world| world.set_pair_response(a, b, response).unwrap());
                self.model.pairs.insert(pair, response);
            }
            _ if a != b => {
                self.tell(|world| world.reset_pair_response(a, b).unwrap());
                self.model.pairs.remove(&pair);
            }
            _ => {}
        }
        if a != b {
            let (first, second) = (i.min(j), i.max(j));
            let expected = self.model.response(&self.model.things[first], &self.model.things[second]);
            assert_eq!(self.tell(|world| world.response(a, b).unwrap()), expected);
            assert_eq!(self.tell(|world| world.response(b, a).unwrap()), expected);
        }
    }

    /// The events, against the collisions of this test and of the last before the frame ended; returns their numbers.
    pub fn check_events(&mut self, found: &[Collision]) -> [usize; 3] {
        let events = self.tell(|world| world.events().collect::<Vec<Event>>());
        let collides: Vec<_> = found.iter().map(|c| (c.a, c.b)).collect();
        let mut pairs: Vec<_> = self.collided.iter().chain(&collides).copied().collect();
        let place = |id| self.created.iter().position(|&other| other == id);
        pairs.sort_by_key(|&(a, b)| (place(a), place(b)));
        pairs.dedup();
        let expected = pairs.into_iter().map(|(a, b)| {
            let kind = match (self.collided.contains(&(a, b)), collides.contains(&(a, b))) {
                (false, _) => EventKind::Began,
                (true, true) => EventKind::Persists,
                (true, false) => EventKind::Ended,
            };
            Event { a, b, kind }
        });
        assert_eq!(events, expected.collect::<Vec<Event>>());
        [EventKind::Began, EventKind::Persists, EventKind::Ended]
            .map(|kind| events.iter().filter(|event| event.kind == kind).count())
    }

    pub fn proceed(&mut self) {
        self.tell(World::proceed);
        self.collided = self.worlds[0].collisions().map(|c| (c.a, c.b)).collect();
        for thing in &mut self.model.things {
            thing.before = (thing.shape.clone(), thing.placement);
        }
    }

    /// One frame's changes.
    pub fn change(&mut self) {
        let count = self.model.things.len();
        if count < 20 || (count < 60 && self.rng.random_range(0..8) == 0) {
            self.add();
        }
        if count > 20 && self.rng.random_range(0..8) == 0 {
            let index = self.any();
            self.remove(index);
        }
        for index in 0..self.model.things.len() {
            match self.rng.random_range(0..100) {
                0..60 => self.step(index),
                60..70 => self.deform(index),
                70 => self.set_shape(index),
                71..73 => {
                    self.step(index);
                    self.deform(index);
                    self.deform(index);
                }
                _ => {}
            }
        }
        if self.rng.random_range(0..3) == 0 {
            self.change_responses();
        }
        if self.rng.random_range(0..40) == 0 {
            // Back to the default that shows most.
            self.tell(|world| world.set_default_response(Response::Smart));
            self.model.default = Some(Response::Smart);
        }
    }

    /// Tests every world; all say the same, to the bit.
    pub fn test(&mut self) -> Vec<Collision> {
        let mut answers: Vec<Vec<Collision>> = self.worlds.iter_mut().map(World::test).collect();
        let first = all_bits(&answers[0]);
        for (i, answer) in answers.iter().enumerate() {
            assert_eq!(all_bits(answer), first, "world {i} differs");
        }
        answers.swap_remove(0)
    }

    /// Tests every swept world; all say the same, to the bit, and of the collisions of now the same as the others, which said
    /// `now`. Returns the collisions on the way.
    pub fn test_swept(&mut self, now: &[Collision]) -> Vec<Collision> {
        let mut answers: Vec<Vec<Collision>> = self.swept.iter_mut().map(World::test).collect();
        let whens = |answer: &[Collision]| answer.iter().map(|c| c.when).collect::<Vec<When>>();
        for (i, answer) in answers.iter().enumerate() {
            assert_eq!(whens(answer), whens(&answers[0]), "swept world {i} differs");
            assert_eq!(all_bits(answer), all_bits(&answers[0]), "swept world {i} differs");
        }
        let found = answers.swap_remove(0);
        let (found, on_the_way): (Vec<Collision>, _) =
            found.into_iter().partition(|collision| collision.when == When::Now);
        assert_eq!(all_bits(&found), all_bits(now));
        on_the_way
    }

    /// Another motion for one object, in the swept worlds.
    pub fn set_motion(&mut self) {
        let index = self.any();
        let id = self.model.things[index].id;
        let motion = if self.rng.random_range(0..3) == 0 { Motion::Sampled } else { Motion::Swept };
        for world in &mut self.swept {
            world.set_motion(id, motion).unwrap();
            assert_eq!(world.motion(id).unwrap(), motion);
        }
    }

    /// Compares the collisions with the model; returns how many there are.
    pub fn check(&self, collisions: &[Collision]) -> usize {
        let expected = self.model.collisions();
        let ids = |&(i, j): &(usize, usize)| (self.model.things[i].id, self.model.things[j].id);
        let expected: Vec<(ObjectId, ObjectId)> = expected.iter().map(ids).collect();
        let found: Vec<(ObjectId, ObjectId)> = collisions.iter().map(|c| (c.a, c.b)).collect();
        assert_eq!(found, expected);
        collisions.iter().for_each(|collision| self.model.check(collision));
        found.len()
    }
}
