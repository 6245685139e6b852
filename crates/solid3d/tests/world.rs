//! Long animations: worlds in lock step agree to the bit, and with a model that tests every pair.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by panicking, and prints its seed"
)]

mod common;

use std::collections::HashMap;

use common::{
    Soup, assert_rate, direction, in_cube, placement, random_complex, random_mesh, shape_of, stretch, torus,
    try_shape_of,
};
use glam::{DAffine3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::Convex;
use solid_oracle::generate::{Regime, random_pair, random_shape, seeded};
use solid3d::query::{ContactOptions, ContactPoint};
use solid3d::{
    Boxes, BroadPhaseKind, Collision, Contact, Error, Event, EventKind, Motion, ObjectId, Response, Shape,
    Statistics, When, World, WorldOptions, glam, query,
};

/// What the model knows of an object: all of it, now and in the previous frame.
#[derive(Clone)]
struct Thing {
    id: ObjectId,
    shape: Shape,
    placement: DAffine3,
    before: (Shape, DAffine3),
    /// What the vertices are deformations of.
    soup: Option<Soup>,
    /// How far it reaches from its origin, about.
    size: f64,
}

/// A straightforward world: no candidates, no caches, no boxes.
#[derive(Clone, Default)]
struct Model {
    /// In creation order.
    things: Vec<Thing>,
    default: Option<Response>,
    objects: HashMap<ObjectId, Response>,
    pairs: HashMap<(ObjectId, ObjectId), Response>,
}

impl Model {
    fn response(&self, first: &Thing, second: &Thing) -> Response {
        let (a, b) = (first.id, second.id);
        if let Some(response) = self.pairs.get(&(a, b)).or_else(|| self.pairs.get(&(b, a))) {
            return *response;
        }
        let of_object = self.objects.get(&a).or_else(|| self.objects.get(&b));
        of_object.copied().or(self.default).unwrap_or(Response::Witness)
    }

    fn collide(&self, i: usize, j: usize) -> bool {
        let (a, b) = (&self.things[i], &self.things[j]);
        self.response(a, b) != Response::Ignore
            && query::intersects(&a.shape, &a.placement, &b.shape, &b.placement).unwrap()
    }

    /// Every pair that collides, in creation order.
    fn collisions(&self) -> Vec<(usize, usize)> {
        let n = self.things.len();
        let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
        pairs.filter(|&(i, j)| self.collide(i, j)).collect()
    }

    fn index(&self, id: ObjectId) -> Option<usize> {
        self.things.iter().position(|thing| thing.id == id)
    }

    /// Checks a collision's contact.
    fn check(&self, collision: &Collision) {
        let (a, b) = (self.index(collision.a).unwrap(), self.index(collision.b).unwrap());
        assert!(a < b, "the object created first comes first");
        let (a, b) = (&self.things[a], &self.things[b]);
        assert_eq!(collision.response(), self.response(a, b));
        let size = a.size + b.size + (a.placement.translation - b.placement.translation).length();
        match collision.contact {
            Contact::Simple => {}
            Contact::Witness { point, local_a, local_b } => {
                let spot = Shape::convex_hull(&[point]).unwrap();
                for (thing, local) in [(a, local_a), (b, local_b)] {
                    let off =
                        query::distance(&thing.shape, &thing.placement, &spot, &DAffine3::IDENTITY).unwrap();
                    assert!(off.distance <= 1e-9 * size, "the witness is off by {}", off.distance);
                    let off = thing.placement.transform_point3(local).distance(point);
                    assert!(off <= 1e-9 * size, "the local witness is off by {off}");
                }
            }
            Contact::Smart { point_on_a, point_on_b, local_a, local_b, distance, normal } => {
                let ((shape_a, at_a), (shape_b, at_b)) = (&a.before, &b.before);
                let size = a.size + b.size + (at_a.translation - at_b.translation).length();
                let then = query::distance(shape_a, at_a, shape_b, at_b).unwrap();
                // Of soups, the pair of primitives that meet now need not be the nearest of all.
                let soups = [shape_a, shape_b].iter().any(|shape| shape.primitive_count() > 1);
                let least = then.distance - 1e-9 * size;
                assert!(distance.max(0.0) >= least, "{distance} for {}", then.distance);
                assert!(soups || distance <= then.distance + 1e-9 * size, "{distance} for {}", then.distance);
                assert!(at_a.transform_point3(local_a).distance(point_on_a) <= 1e-12 * size);
                assert!(at_b.transform_point3(local_b).distance(point_on_b) <= 1e-12 * size);
                for (shape, at, point) in [(shape_a, at_a, point_on_a), (shape_b, at_b, point_on_b)] {
                    let spot = Shape::convex_hull(&[point]).unwrap();
                    let off = query::distance(shape, at, &spot, &DAffine3::IDENTITY).unwrap().distance;
                    let curved = if distance < 0.0 { 1e-6 } else { 1e-9 };
                    assert!(off <= curved * size, "a point is off by {off}");
                }
                assert!((normal.length() - 1.0).abs() < 1e-12);
                let missed = (point_on_a - point_on_b).distance(normal * distance);
                let error = if distance < 0.0 { 1e-3 } else { 1e-9 };
                assert!(missed <= error * size, "the normal points elsewhere, {missed:e} off for {distance}");
            }
            Contact::Curve { point, ref curve } => {
                match query::intersection_curve(&a.shape, &a.placement, &b.shape, &b.placement) {
                    Ok(expected) => assert_eq!(**curve, expected),
                    Err(error) => assert!(matches!(error, Error::NoFacets { .. }) && curve.is_empty()),
                }
                let spot = Shape::convex_hull(&[point]).unwrap();
                for thing in [a, b] {
                    let off =
                        query::distance(&thing.shape, &thing.placement, &spot, &DAffine3::IDENTITY).unwrap();
                    assert!(off.distance <= 1e-9 * size, "the point is off by {}", off.distance);
                }
            }
            Contact::Depth { depth, normal, point_on_a, point_on_b } => {
                let expected = query::penetration(&a.shape, &a.placement, &b.shape, &b.placement).unwrap();
                match expected {
                    Some(found) => {
                        assert_eq!((depth, normal), (found.depth, found.normal));
                        assert_eq!((point_on_a, point_on_b), (found.point_on_a, found.point_on_b));
                    }
                    None => assert_eq!(depth, 0.0),
                }
            }
            Contact::Contacts { point, ref manifolds } => {
                let options = ContactOptions::default();
                let expected = query::contacts(&a.shape, &a.placement, &b.shape, &b.placement, &options);
                assert_eq!(**manifolds, expected.unwrap()[..]);
                let all = || manifolds.iter().flat_map(|manifold| &manifold.points);
                let greatest = all().map(|contact| contact.depth).reduce(f64::max);
                assert_eq!(collision.depth(), greatest);
                let middle = |contact: &ContactPoint| 0.5 * contact.point_on_a + 0.5 * contact.point_on_b;
                let deepest = all().find(|contact| Some(contact.depth) == greatest);
                assert!(deepest.is_none_or(|contact| middle(contact) == point));
            }
            _ => panic!("{collision:?}"),
        }
    }
}

/// The objects, the kind of contact, the numbers.
type Bits = (ObjectId, ObjectId, u8, Vec<u64>);

/// A collision as bits.
fn bits(collision: &Collision) -> Bits {
    let of = |points: &[DVec3]| points.iter().flat_map(|p| p.to_array()).map(f64::to_bits).collect();
    let (kind, numbers) = match collision.contact {
        Contact::Simple => (0, Vec::new()),
        Contact::Witness { point, local_a, local_b } => (1, of(&[point, local_a, local_b])),
        Contact::Smart { point_on_a, point_on_b, local_a, local_b, distance, normal } => {
            let distance = DVec3::splat(distance);
            (2, of(&[point_on_a, point_on_b, local_a, local_b, distance, normal]))
        }
        Contact::Curve { point, ref curve } => {
            let points = curve.polylines.iter().flat_map(|polyline| polyline.path());
            (4, of(&std::iter::once(point).chain(points).collect::<Vec<_>>()))
        }
        Contact::Depth { depth, normal, point_on_a, point_on_b } => {
            (3, of(&[DVec3::splat(depth), normal, point_on_a, point_on_b]))
        }
        Contact::Contacts { point, ref manifolds } => {
            let depth = |contact: &ContactPoint| DVec3::splat(contact.depth);
            let contact = |c: &ContactPoint| [c.point_on_a, c.point_on_b, depth(c)];
            let points = manifolds.iter().flat_map(|manifold| manifold.points.iter().flat_map(contact));
            let normals = manifolds.iter().map(|manifold| manifold.normal);
            (5, of(&std::iter::once(point).chain(normals).chain(points).collect::<Vec<_>>()))
        }
        _ => panic!("{collision:?}"),
    };
    (collision.a, collision.b, kind, numbers)
}

fn all_bits(collisions: &[Collision]) -> Vec<Bits> {
    collisions.iter().map(bits).collect()
}

/// Worlds that are told the same, and the model of them.
struct Stage {
    worlds: Vec<World>,
    /// They test the way from the previous frame, too.
    swept: Vec<World>,
    model: Model,
    /// Every object that ever was, in creation order.
    created: Vec<ObjectId>,
    /// What collided when the last frame ended.
    collided: Vec<(ObjectId, ObjectId)>,
    rng: StdRng,
    /// The side of the cube that the objects are in.
    room: f64,
}

const RESPONSES: [Response; 7] = [
    Response::Ignore,
    Response::Simple,
    Response::Witness,
    Response::Smart,
    Response::Depth,
    Response::Curve,
    Response::Contacts,
];

fn world(broad_phase: BroadPhaseKind, caching: bool) -> World {
    World::with_options(&WorldOptions { broad_phase, caching, ..WorldOptions::default() })
}

fn world_of_boxes(broad_phase: BroadPhaseKind, boxes: Boxes) -> World {
    World::with_options(&WorldOptions { broad_phase, boxes, ..WorldOptions::default() })
}

fn swept_world(broad_phase: BroadPhaseKind, caching: bool, boxes: Boxes) -> World {
    let motion = Motion::Swept;
    World::with_options(&WorldOptions { broad_phase, caching, boxes, motion, ..WorldOptions::default() })
}

impl Stage {
    fn new(worlds: Vec<World>, seed: u64, room: f64) -> Stage {
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
    fn tell<T: PartialEq + std::fmt::Debug>(&mut self, mut what: impl FnMut(&mut World) -> T) -> T {
        let worlds = self.worlds.iter_mut().chain(&mut self.swept);
        let mut answers: Vec<T> = worlds.map(&mut what).collect();
        assert!(answers.iter().all(|answer| *answer == answers[0]), "{answers:?}");
        answers.swap_remove(0)
    }

    fn random_place(&mut self) -> DAffine3 {
        let mut at = placement(&mut self.rng, 1.0);
        at.translation = 0.5 * self.room * in_cube(&mut self.rng);
        at
    }

    fn random_thing(&mut self) -> (Shape, Option<Soup>) {
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

    fn add(&mut self) {
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

    fn any(&mut self) -> usize {
        self.rng.random_range(0..self.model.things.len())
    }

    fn remove(&mut self, index: usize) {
        let id = self.model.things.remove(index).id;
        self.tell(|world| world.remove(id).unwrap());
        self.model.objects.remove(&id);
        self.model.pairs.retain(|&(a, b), _| a != id && b != id);
    }

    fn place(&mut self, index: usize, at: DAffine3) {
        let id = self.model.things[index].id;
        self.tell(|world| world.set_placement(id, at).unwrap());
        self.model.things[index].placement = at;
        self.model.things[index].size = self.model.things[index].size.max(stretch(&at));
    }

    /// A step: small, or sometimes to anywhere.
    fn step(&mut self, index: usize) {
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

    fn deform(&mut self, index: usize) {
        let Some(soup) = self.model.things[index].soup.clone() else { return };
        let twist = if self.rng.random_range(0..10) == 0 { 9.0 } else { self.rng.random_range(-0.5..0.5) };
        let wave = |v: &DVec3| DQuat::from_rotation_y(twist * v.length()) * *v;
        let positions: Vec<DVec3> = soup.vertices.iter().map(wave).collect();
        let id = self.model.things[index].id;
        self.tell(|world| world.deform(id, &positions).unwrap());
        // The model builds its shape anew.
        self.model.things[index].shape = Soup { vertices: positions, ..soup }.shape();
    }

    fn set_shape(&mut self, index: usize) {
        let (shape, soup) = self.random_thing();
        let id = self.model.things[index].id;
        self.tell(|world| world.set_shape(id, &shape).unwrap());
        (self.model.things[index].shape, self.model.things[index].soup) = (shape, soup);
    }

    fn change_responses(&mut self) {
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
    fn check_events(&mut self, found: &[Collision]) -> [usize; 3] {
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

    fn proceed(&mut self) {
        self.tell(World::proceed);
        self.collided = self.worlds[0].collisions().map(|c| (c.a, c.b)).collect();
        for thing in &mut self.model.things {
            thing.before = (thing.shape.clone(), thing.placement);
        }
    }

    /// One frame's changes.
    fn change(&mut self) {
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
    fn test(&mut self) -> Vec<Collision> {
        let mut answers: Vec<Vec<Collision>> = self.worlds.iter_mut().map(World::test).collect();
        let first = all_bits(&answers[0]);
        for (i, answer) in answers.iter().enumerate() {
            assert_eq!(all_bits(answer), first, "world {i} differs");
        }
        answers.swap_remove(0)
    }

    /// Tests every swept world; all say the same, to the bit, and of the collisions of now the same as the others, which said
    /// `now`. Returns the collisions on the way.
    fn test_swept(&mut self, now: &[Collision]) -> Vec<Collision> {
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
    fn set_motion(&mut self) {
        let index = self.any();
        let id = self.model.things[index].id;
        let motion = if self.rng.random_range(0..3) == 0 { Motion::Sampled } else { Motion::Swept };
        for world in &mut self.swept {
            world.set_motion(id, motion).unwrap();
            assert_eq!(world.motion(id).unwrap(), motion);
        }
    }

    /// Compares the collisions with the model; returns how many there are.
    fn check(&self, collisions: &[Collision]) -> usize {
        let expected = self.model.collisions();
        let ids = |&(i, j): &(usize, usize)| (self.model.things[i].id, self.model.things[j].id);
        let expected: Vec<(ObjectId, ObjectId)> = expected.iter().map(ids).collect();
        let found: Vec<(ObjectId, ObjectId)> = collisions.iter().map(|c| (c.a, c.b)).collect();
        assert_eq!(found, expected);
        collisions.iter().for_each(|collision| self.model.check(collision));
        found.len()
    }
}

#[test]
fn worlds_in_lock_step_agree_to_the_bit_and_with_the_model() {
    let kinds = [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune];
    for seed in 100..108 {
        let mut worlds: Vec<World> =
            kinds.iter().flat_map(|&kind| [true, false].map(|caching| world(kind, caching))).collect();
        worlds.push(world(BroadPhaseKind::DynamicTree, true));
        worlds.extend(kinds.map(|kind| world_of_boxes(kind, Boxes::FixedSize)));
        let mut stage = Stage::new(worlds, seed, 9.0);
        // They take most of the time.
        let with_swept = seed % 4 == 0;
        stage.swept = vec![
            swept_world(BroadPhaseKind::DynamicTree, true, Boxes::Dynamic),
            swept_world(BroadPhaseKind::DynamicTree, false, Boxes::Dynamic),
            swept_world(BroadPhaseKind::SweepAndPrune, true, Boxes::Dynamic),
            swept_world(BroadPhaseKind::DynamicTree, true, Boxes::FixedSize),
        ];
        stage.swept.truncate(if with_swept { 4 } else { 0 });
        let mut on_the_way = 0;
        for _ in 0..30 {
            stage.add();
        }
        let (mut busy, mut pairs, mut collisions, mut events) = (0, 0, 0, [0; 3]);
        let mut contacts = HashMap::<u8, u32>::new();
        let frames = 600;
        for _ in 0..frames {
            stage.change();
            match stage.rng.random_range(0..4) {
                0 => stage.worlds[4].enable_caching(),
                1 => stage.worlds[4].disable_caching(),
                _ => {}
            }
            let found = stage.test();
            let count = stage.check(&found);
            if !with_swept {
                // The swept worlds have others.
                let counts = stage.check_events(&found);
                events = std::array::from_fn(|i| events[i] + counts[i]);
            }
            if with_swept {
                if stage.rng.random_range(0..4) == 0 {
                    stage.set_motion();
                }
                on_the_way += stage.test_swept(&found).len();
            }
            for collision in &found {
                *contacts.entry(bits(collision).2).or_default() += 1;
            }
            busy += usize::from(count > 0);
            collisions += count;
            pairs += stage.model.things.len() * (stage.model.things.len() - 1) / 2;
            if stage.rng.random_range(0..5) > 0 {
                stage.proceed();
            }
            let objects: Vec<ObjectId> = stage.model.things.iter().map(|thing| thing.id).collect();
            assert_eq!(stage.tell(|world| world.objects()), objects);
        }
        println!(
            "{collisions} collisions of {pairs} pairs, in {busy} of {frames} frames; kinds {contacts:?}; \
             {on_the_way} on the way"
        );
        assert!(with_swept || events.iter().all(|&count| count > frames / 10), "{events:?}");
        assert!(busy > frames / 3, "most frames have collisions");
        assert!((0..6).all(|kind| contacts.contains_key(&kind)), "every kind of contact comes up");
        let work: Vec<Statistics> = stage.worlds.iter().map(World::statistics).collect();
        assert_eq!(work[0], work[2], "the engines give the same candidates");
        assert_eq!(work[1], work[3]);
        assert_eq!(work[0].candidates, work[1].candidates);
        assert_eq!(work[0].collisions, work[1].collisions);
        assert_eq!(work[1].cache_hits, 0);
        assert!(work[0].cache_hits > 0 && work[0].primitive_tests < work[1].primitive_tests, "{work:?}");
        assert_eq!(work[5], work[6]);
        assert!(work[5].candidates > work[0].candidates && work[5].collisions == work[0].collisions);
        assert!(work.iter().all(|work| work.sweeps == 0));
        if !with_swept {
            continue;
        }
        let swept: Vec<Statistics> = stage.swept.iter().map(World::statistics).collect();
        assert_eq!(swept[0], swept[2]);
        assert_eq!(swept[0].candidates, swept[1].candidates);
        assert!(swept[3].candidates > swept[0].candidates && swept[0].candidates > work[0].candidates);
        assert!(swept[0].cache_hits > 0 && swept[0].sweeps < swept[1].sweeps, "{swept:?}");
        assert!(on_the_way > frames / 4);
        for swept in swept {
            assert_eq!(swept.collisions, work[0].collisions + on_the_way as u64);
        }
    }
}

/// Runs an animation in one world, as bits of all that it found and the work it did.
fn animation(seed: u64, frames: usize, world: World) -> (Vec<Vec<Bits>>, Statistics) {
    let mut stage = Stage::new(vec![world], seed, 9.0);
    for _ in 0..50 {
        stage.add();
    }
    let mut found = Vec::new();
    for _ in 0..frames {
        stage.change();
        found.push(all_bits(&stage.test()));
        if stage.rng.random_range(0..5) > 0 {
            stage.proceed();
        }
    }
    (found, stage.worlds[0].statistics())
}

#[test]
fn the_same_calls_give_the_same_bits_and_the_same_work() {
    let sampled = || world(BroadPhaseKind::DynamicTree, true);
    let swept = || swept_world(BroadPhaseKind::DynamicTree, true, Boxes::FixedSize);
    let makers: [&dyn Fn() -> World; 2] = [&sampled, &swept];
    for make in makers {
        let first = animation(200, 300, make());
        let second = animation(200, 300, make());
        assert_eq!(first.1, second.1);
        assert!(first.0 == second.0, "results differ");
        assert!(first.1.cache_hits > 0 && first.1.collisions > 0);
    }
}

#[cfg(feature = "rayon")]
#[test]
fn the_number_of_threads_changes_no_bit_and_no_count() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| animation(201, 300, swept_world(BroadPhaseKind::DynamicTree, true, Boxes::Dynamic)))
    };
    let one = run(1);
    assert!(one.1.collisions > 100);
    for threads in [2, 3, 8] {
        let many = run(threads);
        assert_eq!(one.1, many.1, "{threads} threads");
        assert!(one.0 == many.0, "results differ with {threads} threads");
    }
}

/// Law: in a coherent scene of convex shapes the cache answers most of what is apart.
#[test]
fn caching_saves_primitive_tests_in_a_coherent_scene() {
    let run = |caching: bool| {
        let mut rng = seeded(300);
        let mut world = world(BroadPhaseKind::DynamicTree, caching);
        let mut things = Vec::new();
        for _ in 0..60 {
            let shape = shape_of(&random_shape(&mut rng, 1.0));
            let mut at = placement(&mut rng, 1.0);
            at.translation = 4.0 * in_cube(&mut rng);
            things.push((world.add(&shape, at).unwrap(), at, 0.01 * in_cube(&mut rng)));
        }
        let mut found = Vec::new();
        for _ in 0..200 {
            for (id, at, velocity) in &mut things {
                at.translation += *velocity;
                world.set_placement(*id, *at).unwrap();
            }
            found.push(all_bits(&world.test()));
            world.proceed();
        }
        (found, world.statistics())
    };
    let ((with, saved), (without, spent)) = (run(true), run(false));
    assert!(with == without);
    assert_eq!((saved.candidates, saved.collisions), (spent.candidates, spent.collisions));
    println!("{saved:?} {spent:?}");
    assert_eq!(saved.primitive_tests + saved.cache_hits, spent.primitive_tests);
    let apart = saved.candidates - saved.collisions;
    assert!(10 * saved.cache_hits > 8 * apart, "{} of {apart}", saved.cache_hits);
}

/// What a callback does to world and model, by a seed of its own: the same for both.
fn disturb(rng: &mut StdRng, world: &mut World, model: &mut Model, collision: &Collision, budget: &mut u32) {
    if *budget == 0 {
        return;
    }
    *budget -= 1;
    let other = model.things[rng.random_range(0..model.things.len())].id;
    let id = [collision.a, collision.b, other][rng.random_range(0..3)];
    let index = model.index(id);
    match (rng.random_range(0..8), index) {
        (0..3, Some(index)) => {
            let mut at = placement(rng, 1.0);
            at.translation = 0.7 * in_cube(rng);
            world.set_placement(id, at).unwrap();
            model.things[index].placement = at;
        }
        (3, Some(index)) if model.things.len() > 4 => {
            world.remove(id).unwrap();
            model.things.remove(index);
            model.objects.remove(&id);
            model.pairs.retain(|&(a, b), _| a != id && b != id);
        }
        (4, _) => {
            let shape = shape_of(&random_shape(rng, 1.0));
            let mut at = placement(rng, 1.0);
            at.translation = 0.7 * in_cube(rng);
            let id = world.add(&shape, at).unwrap();
            let before = (shape.clone(), at);
            model.things.push(Thing { id, shape, placement: at, before, soup: None, size: stretch(&at) });
        }
        (5, Some(_)) => {
            let response = RESPONSES[rng.random_range(1..5)];
            world.set_object_response(id, response).unwrap();
            model.objects.insert(id, response);
        }
        (6, Some(index)) => {
            let shape = torus(5, 4, 0.4).shape();
            world.set_shape(id, &shape).unwrap();
            model.things[index].shape = shape;
        }
        (7, _) => {
            world.proceed();
            for thing in &mut model.things {
                thing.before = (thing.shape.clone(), thing.placement);
            }
        }
        _ => {}
    }
}

/// The documented order: the least pair beyond the last one that collides as the world is now.
fn next_of(
    model: &Model,
    serials: &HashMap<ObjectId, usize>,
    last: Option<(usize, usize)>,
) -> Option<(usize, usize)> {
    let key = |(i, j): (usize, usize)| (serials[&model.things[i].id], serials[&model.things[j].id]);
    let n = model.things.len();
    let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
    pairs.filter(|&pair| last.is_none_or(|last| key(pair) > last)).find(|&(i, j)| model.collide(i, j))
}

#[test]
fn callbacks_that_change_the_world_see_each_pair_once_in_the_documented_order() {
    let seed = 400;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (mut calls, mut pairs_seen, rounds) = (0, 0, 150);
    for round in 0..rounds {
        let kind = if round % 2 == 0 { BroadPhaseKind::DynamicTree } else { BroadPhaseKind::SweepAndPrune };
        let mut stage = Stage::new(vec![world(kind, round % 3 != 0)], rng.random(), 1.4);
        for _ in 0..10 {
            stage.add();
        }
        let mut world = stage.worlds.pop().unwrap();
        let mut model = stage.model;
        let mut serials = HashMap::<ObjectId, usize>::new();
        for frame in 0..4 {
            let mut number = |model: &Model| {
                for thing in &model.things {
                    let next = serials.len();
                    serials.entry(thing.id).or_insert(next);
                }
                serials.clone()
            };
            let mut budget = 25;
            let mut last = None;
            let n = model.things.len();
            pairs_seen += n * (n - 1) / 2;
            let mut seen = Vec::new();
            let count = world.test_with(|world, collision| {
                let now = number(&model);
                let (i, j) = next_of(&model, &now, last).expect("the model sees the collision too");
                assert_eq!(
                    (model.things[i].id, model.things[j].id),
                    (collision.a, collision.b),
                    "frame {frame}"
                );
                model.check(collision);
                last = Some((now[&collision.a], now[&collision.b]));
                seen.push(last);
                if rng.random_range(0..4) == 0 {
                    // A nested test sees the world as it is.
                    let found: Vec<_> = world.test().iter().map(|c| (c.a, c.b)).collect();
                    let expected: Vec<_> = model
                        .collisions()
                        .iter()
                        .map(|&(i, j)| (model.things[i].id, model.things[j].id))
                        .collect();
                    assert_eq!(found, expected);
                }
                if rng.random_range(0..4) == 0 {
                    let mut nested = 0;
                    let expected = model.collisions().len();
                    let count = world.test_with(|_, _| nested += 1);
                    assert_eq!((count, nested), (expected, expected));
                }
                disturb(&mut rng, world, &mut model, collision, &mut budget);
            });
            assert_eq!(count, seen.len());
            let now = number(&model);
            assert_eq!(next_of(&model, &now, last), None, "a collision was left out");
            let mut once = seen.clone();
            once.dedup();
            assert_eq!(once.len(), seen.len());
            calls += count;
            world.proceed();
            model.things.iter_mut().for_each(|thing| thing.before = (thing.shape.clone(), thing.placement));
        }
    }
    assert_rate("pairs in callbacks", calls, pairs_seen);
}

/// A removed object takes its responses along, also when its slot is used again.
#[test]
fn responses_of_removed_objects_do_not_come_back() {
    let mut world = World::new();
    let ball = Shape::sphere(1.0).unwrap();
    let a = world.add(&ball, DAffine3::IDENTITY).unwrap();
    for _ in 0..1000 {
        let b = world.add(&ball, DAffine3::IDENTITY).unwrap();
        assert_eq!(world.response(a, b).unwrap(), Response::Witness);
        world.set_pair_response(a, b, Response::Smart).unwrap();
        world.set_object_response(b, Response::Simple).unwrap();
        assert_eq!(world.test()[0].response(), Response::Smart);
        world.remove(b).unwrap();
        assert!(world.test().is_empty());
        assert!(world.response(a, b).is_err());
    }
}

/// At the limit of precision, at any size ratio and far from the origin, boxes and caches must not decide otherwise than
/// the narrow phase does.
#[test]
fn boxes_and_caches_lose_no_touch() {
    let seed = 500;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let regimes = [
        Regime::NearTouching { relative_gap: 1e-9 },
        Regime::NearTouching { relative_gap: 1e-12 },
        Regime::NearTouching { relative_gap: 1e-14 },
        Regime::NearTouching { relative_gap: 0.0 },
        Regime::SizeRatio,
        Regime::FarFromOrigin,
        Regime::Flat,
        Regime::Sliver,
    ];
    let (cases, mut hits, mut tests) = (3000, 0, 0);
    for case in 0..cases {
        let pair = random_pair(&mut rng, regimes[case % regimes.len()]);
        let shape = |convex: &Convex| match convex {
            // Some hulls as complex shapes: of one polyhedron.
            Convex::Hull { points } if case % 3 == 0 => {
                let primitives = vec![(0..points.len() as u32).collect()];
                Ok(Soup { vertices: points.clone(), primitives, is_mesh: false }.shape())
            }
            convex => try_shape_of(convex),
        };
        let (Ok(shape_a), Ok(shape_b)) = (shape(&pair.a), shape(&pair.b)) else { continue };
        let shapes = [shape_a, shape_b];
        let mut worlds =
            [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune, BroadPhaseKind::DynamicTree]
                .map(|kind| world(kind, true));
        worlds[2].disable_caching();
        let ids = worlds
            .each_mut()
            .map(|world| [world.add(&shapes[0], pair.pa).unwrap(), world.add(&shapes[1], pair.pb).unwrap()]);
        let toward = (pair.pa.translation - pair.pb.translation).normalize_or(DVec3::X);
        // Towards each other and back, by steps below, at and above the error.
        for step in [0.0, 1e-3, -1e-3, 1e-13, -1e-13, 1e-12, -1e-12, 3e-12, -3e-12, 1e-9, -1e-9, 0.1, -0.3] {
            let at_b = DAffine3 { translation: pair.pb.translation + toward * step * pair.size, ..pair.pb };
            let expected = query::intersects(&shapes[0], &pair.pa, &shapes[1], &at_b).unwrap();
            let found: Vec<_> = worlds
                .iter_mut()
                .zip(&ids)
                .map(|(world, ids)| {
                    world.set_placement(ids[1], at_b).unwrap();
                    all_bits(&world.test())
                })
                .collect();
            assert_eq!(!found[0].is_empty(), expected, "case {case}, step {step:e}: {pair:?}");
            assert!(found[1] == found[0] && found[2] == found[0], "case {case}, step {step:e}: {pair:?}");
            hits += usize::from(expected);
            tests += 1;
        }
    }
    assert_rate("near touching", hits, tests);
}

/// Within a frame the last test counts; what comes and goes between two ends of frames is no event.
#[test]
fn events_are_those_between_two_ends_of_frames() {
    let mut world = World::new();
    let ball = Shape::sphere(1.0).unwrap();
    let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
    let ids = [0.0, 1.0, 10.0, 20.0].map(|x| world.add(&ball, at(x)).unwrap());
    let events = |world: &World| world.events().map(|e| (e.a, e.b, e.kind)).collect::<Vec<_>>();
    assert_eq!(events(&world), []);
    world.test();
    assert_eq!(events(&world), [(ids[0], ids[1], EventKind::Began)]);
    world.test();
    assert_eq!(events(&world), [(ids[0], ids[1], EventKind::Began)]);
    world.proceed();
    assert_eq!(events(&world), [(ids[0], ids[1], EventKind::Persists)]);
    // Apart, then together again; another pair together, then apart.
    world.set_placement(ids[1], at(5.0)).unwrap();
    world.set_placement(ids[3], at(11.0)).unwrap();
    world.test();
    let both = [(ids[0], ids[1], EventKind::Ended), (ids[2], ids[3], EventKind::Began)];
    assert_eq!(events(&world), both);
    world.set_placement(ids[1], at(1.5)).unwrap();
    world.set_placement(ids[3], at(20.0)).unwrap();
    world.test();
    assert_eq!(events(&world), [(ids[0], ids[1], EventKind::Persists)]);
    // Removed, and ignored.
    world.remove(ids[1]).unwrap();
    assert_eq!(events(&world), [(ids[0], ids[1], EventKind::Ended)]);
    assert_eq!(world.collisions().count(), 0);
    world.proceed();
    assert_eq!(events(&world), []);
    world.set_placement(ids[3], at(11.0)).unwrap();
    world.test();
    world.proceed();
    world.clear_default_response();
    world.test();
    assert_eq!(events(&world), [(ids[2], ids[3], EventKind::Ended)]);
    world.set_default_response(Response::Simple);
    // A new object in the slot of the removed one is another.
    let new = world.add(&ball, at(0.5)).unwrap();
    world.test();
    assert_eq!(events(&world), [(ids[0], new, EventKind::Began), (ids[2], ids[3], EventKind::Persists)]);
}

/// Only a test changes what the last test found: to ask how near objects are, or about one pair, does not, though the boxes of the
/// pair have come apart.
#[test]
fn questions_between_tests_are_no_events() {
    let ball = Shape::sphere(1.0).unwrap();
    let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
    for boxes in [Boxes::Dynamic, Boxes::FixedSize] {
        let mut world = World::with_options(&WorldOptions { boxes, ..WorldOptions::default() });
        let [a, b, c] = [0.0, 1.0, -1.5].map(|x| world.add(&ball, at(x)).unwrap());
        let kinds = |world: &World| world.events().map(|event| (event.b, event.kind)).collect::<Vec<_>>();
        let apart = |world: &mut World| {
            assert_eq!(world.test().len(), 2);
            world.proceed();
            world.set_placement(b, at(10.0)).unwrap();
            world.set_placement(c, at(-10.0)).unwrap();
            assert_eq!((world.near(), world.test_pair(a, b).unwrap()), (vec![], None));
            assert_eq!(kinds(world), [(b, EventKind::Persists), (c, EventKind::Persists)]);
            assert_eq!(world.collisions().count(), 2);
        };
        // Together again.
        apart(&mut world);
        world.set_placement(b, at(1.0)).unwrap();
        world.set_placement(c, at(-1.5)).unwrap();
        world.test();
        assert_eq!(kinds(&world), [(b, EventKind::Persists), (c, EventKind::Persists)]);
        // One stays away, another is removed.
        apart(&mut world);
        world.remove(c).unwrap();
        assert_eq!(kinds(&world), [(b, EventKind::Persists), (c, EventKind::Ended)]);
        assert_eq!(world.collisions().map(|collision| collision.b).collect::<Vec<_>>(), [b]);
        world.proceed();
        world.test();
        assert_eq!(kinds(&world), [(b, EventKind::Ended)]);
    }
}
