//! Long animations: worlds in lock step agree to the bit, and with a model that tests every pair.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by panicking, and prints its seed"
)]

mod bits;
#[path = "../common/mod.rs"]
mod common;
mod model;
mod stage;

use std::collections::HashMap;
use std::sync::Arc;

use bits::{Bits, all_bits, bits};
use common::{Soup, assert_rate, in_cube, placement, shape_of, stretch, torus, try_shape_of};
use glam::{DAffine3, DVec3};
use model::{Model, Thing};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::Convex;
use solid_oracle::generate::{Regime, random_pair, random_shape, seeded};
use solid3d::{
    Boxes, BroadPhaseKind, Collision, Contact, EventKind, Motion, ObjectId, Response, Shape, Statistics,
    World, WorldOptions, glam, query,
};
use stage::{RESPONSES, Stage};

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

/// Law: a copy of a world, taken at any time, does what the world does; what is done to another copy changes neither.
#[test]
fn a_copy_does_what_the_world_does() {
    for kind in [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune] {
        let original = swept_world(kind, true, Boxes::Dynamic);
        let mut stage = Stage::new(vec![original.clone(), original], 205, 9.0);
        for _ in 0..50 {
            stage.add();
        }
        let maybe_copy = |stage: &mut Stage| {
            if stage.rng.random_range(0..4) > 0 {
                return;
            }
            let copy = stage.worlds[0].clone();
            let mut other = std::mem::replace(&mut stage.worlds[1], copy);
            stage.worlds.swap(0, 1);
            for id in other.objects() {
                other.set_placement(id, DAffine3::IDENTITY).unwrap();
                other.test();
                other.remove(id).unwrap();
            }
        };
        for _ in 0..120 {
            maybe_copy(&mut stage);
            stage.change();
            maybe_copy(&mut stage);
            stage.tell(|world| (all_bits(&world.test()), world.events().collect::<Vec<_>>()));
            maybe_copy(&mut stage);
            stage.proceed();
            stage.tell(|world| world.statistics());
        }
        assert!(stage.worlds[0].statistics().collisions > 200);
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

/// The same of so many pairs that what is found of some is kept while others are examined; events too.
#[cfg(feature = "rayon")]
#[test]
fn nor_does_it_where_pairs_are_many() {
    const FRAMES: u64 = 5;
    let run = |threads: usize| {
        let mut rng = seeded(203);
        let mut world = world(BroadPhaseKind::DynamicTree, true);
        let mut crowd = |_| {
            let (shape, mut at) = (shape_of(&random_shape(&mut rng, 1.0)), placement(&mut rng, 1.0));
            at.translation = in_cube(&mut rng);
            (world.add(&shape, at).unwrap(), at)
        };
        let crowd: Vec<_> = (0..240).map(&mut crowd).collect();
        for (k, &(id, _)) in crowd.iter().enumerate() {
            world.set_object_response(id, RESPONSES[k % RESPONSES.len()]).unwrap();
        }
        let mut found = Vec::new();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        for _ in 0..FRAMES {
            for &(id, mut at) in &crowd {
                at.translation += 0.5 * in_cube(&mut rng);
                world.set_placement(id, at).unwrap();
            }
            found.push((all_bits(&pool.install(|| world.test())), world.events().collect::<Vec<_>>()));
            world.proceed();
        }
        (found, world.statistics())
    };
    let one = run(1);
    println!("{:?}", one.1);
    // In each frame more than twice as many as are examined at a time.
    assert!(one.1.candidates > FRAMES * 8192 && 10 * one.1.collisions < 9 * one.1.candidates);
    for threads in [2, 3] {
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

/// Law: an object is where it was placed last, to the bit: signs of zeros too.
#[test]
fn a_placement_is_kept_to_the_bit() {
    let mut world = World::new();
    let id = world.add(&Shape::sphere(1.0).unwrap(), DAffine3::IDENTITY).unwrap();
    for zero in [-0.0, 0.0, -0.0] {
        let at = DAffine3 { translation: DVec3::splat(zero), ..DAffine3::IDENTITY };
        world.set_placement(id, at).unwrap();
        assert_eq!(world.placement(id).unwrap().translation.x.to_bits(), f64::to_bits(zero));
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

/// Law: a world keeps nothing of a collision that is no more.
#[test]
fn what_parts_leaves_nothing_of_its_collision() {
    let block = Shape::cuboid([1.0; 3]).unwrap();
    for response in [Response::Curve, Response::Contacts] {
        let mut world =
            World::with_options(&WorldOptions { default_response: response, ..WorldOptions::default() });
        let [_, upper] =
            [0.0, 0.75].map(|y| world.add(&block, DAffine3::from_translation(DVec3::Y * y)).unwrap());
        let mut found = world.test();
        world.set_placement(upper, DAffine3::from_translation(DVec3::Y * 9.0)).unwrap();
        assert!(world.test().is_empty());
        let owners = match found.remove(0).contact {
            Contact::Curve { curve, .. } => Arc::strong_count(&curve),
            Contact::Contacts { manifolds, .. } => Arc::strong_count(&manifolds),
            other => panic!("{other:?}"),
        };
        assert_eq!(owners, 1, "{response:?}");
    }
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
