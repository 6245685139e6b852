//! Distances with a bound, and pairs of a world that are nearer than their clearance, against `query::distance` for every pair.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by panicking, and prints its hit rate"
)]

mod common;

use std::collections::HashMap;

use common::{
    Soup, assert_rate, direction, in_cube, placement, random_complex, random_mesh, shape_of, torus,
};
use glam::{DAffine3, DMat3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::{random_shape, seeded};
use solid3d::query::Distance;
use solid3d::{
    Boxes, BroadPhaseKind, Error, Motion, Near, ObjectId, Response, Shape, TestProgress, World, WorldOptions,
    glam, query,
};

/// Decisions nearer than this to a clearance, in rooms of a size of some units, are left to rounding.
const UNDECIDED: f64 = 1e-9;

fn soup(rng: &mut StdRng) -> Soup {
    match rng.random_range(0..3) {
        0 => random_mesh(rng, 60),
        1 => torus(8, 5, 0.4),
        _ => random_complex(rng, 10),
    }
}

fn some_shape(rng: &mut StdRng) -> (Shape, Option<Soup>) {
    if rng.random_range(0..2) == 0 {
        return (shape_of(&random_shape(rng, 1.0)), None);
    }
    let soup = soup(rng);
    match soup.shape().into_solid() {
        Ok(solid) if rng.random_range(0..2) == 0 => (solid, None),
        _ => (soup.shape(), Some(soup)),
    }
}

/// Law: a bound takes those of `distance` that are at most the bound.
#[test]
fn a_bound_takes_the_near_ones() {
    let mut rng = seeded(7001);
    let (mut hits, mut cases, mut apart) = (0, 0, 0);
    for _ in 0..1200 {
        let size = 10f64.powi(rng.random_range(-6..7));
        let (a, b) = (some_shape(&mut rng).0, some_shape(&mut rng).0);
        let convex = a.kind().max(b.kind()) < solid3d::ShapeKind::Mesh;
        let scaled = |at: DAffine3| DAffine3::from_scale(DVec3::splat(size)) * at;
        let (at_a, mut at_b) = (scaled(placement(&mut rng, 1.0)), scaled(placement(&mut rng, 1.0)));
        at_b.translation = at_a.translation + direction(&mut rng) * rng.random_range(0.0..6.0) * size;
        let full = query::distance(&a, &at_a, &b, &at_b).unwrap();
        apart += usize::from(full.distance > 0.0);
        let within = |bound: f64| query::distance_within(&a, &at_a, &b, &at_b, bound).unwrap();
        let d = full.distance;
        let nearer = [0.0, 0.01 * d, 0.5 * d, d * (1.0 - 1e-6) - 1e-9 * size];
        let further = [d * (1.0 + 1e-6) + 1e-9 * size, 2.0 * d + size, f64::INFINITY];
        for bound in nearer.into_iter().filter(|&bound| bound >= 0.0 && bound < d) {
            cases += 1;
            assert_eq!(within(bound), None, "{} {} {at_a:?} {at_b:?} {bound}", a.kind(), b.kind());
        }
        for bound in further {
            (cases, hits) = (cases + 1, hits + 1);
            let found: Distance = within(bound).expect("it is within");
            let error = if convex { 0.0 } else { 1e-11 * (d + size) };
            assert!((found.distance - d).abs() <= error, "{found:?} {full:?}");
            assert!(!convex || found == full);
        }
        if convex {
            // At the bound itself.
            assert_eq!(within(d), Some(full));
            assert!(d == 0.0 || within(d.next_down()).is_none());
        }
        // From the other side.
        let other = query::distance_within(&b, &at_b, &a, &at_a, 0.5 * d).unwrap();
        assert_eq!(other.is_some(), d == 0.0);
    }
    assert!(apart > 600, "{apart}");
    assert_rate("bounds", hits, cases);
}

/// What is no length is refused, and changes nothing.
#[test]
fn bounds_that_are_no_bounds_are_refused() {
    let ball = Shape::sphere(1.0).unwrap();
    let here = DAffine3::IDENTITY;
    for value in [f64::NAN, -1.0, f64::NEG_INFINITY, -f64::MIN_POSITIVE] {
        let error = query::distance_within(&ball, &here, &ball, &here, value).unwrap_err();
        assert!(error.to_string().starts_with("bound is "), "{error}");
    }
    let mut world = World::new();
    let [a, b] = [0, 1].map(|_| world.add(&ball, here).unwrap());
    for value in [f64::NAN, -1.0, f64::INFINITY, 1e101] {
        assert!(matches!(world.set_clearance(value), Err(Error::Clearance { .. })));
        assert!(matches!(world.set_pair_clearance(a, b, value), Err(Error::Clearance { .. })));
    }
    assert!(matches!(world.set_pair_clearance(a, a, 1.0), Err(Error::SameObject { .. })));
    assert_eq!((world.clearance(), world.pair_clearance(a, b)), (0.0, Ok(0.0)));
    world.remove(b).unwrap();
    assert!(matches!(world.set_pair_clearance(a, b, 1.0), Err(Error::UnknownObject { argument: "b", .. })));
    assert!(matches!(world.reset_pair_clearance(b, a), Err(Error::UnknownObject { argument: "a", .. })));
}

struct Thing {
    id: ObjectId,
    shape: Shape,
    soup: Option<Soup>,
    at: DAffine3,
}

/// Worlds that are told the same, with what they were told.
struct Stage {
    worlds: Vec<World>,
    things: Vec<Thing>,
    clearance: f64,
    pairs: HashMap<(ObjectId, ObjectId), f64>,
    ignored: Vec<(ObjectId, ObjectId)>,
    rng: StdRng,
}

fn ordered(a: ObjectId, b: ObjectId) -> (ObjectId, ObjectId) {
    (a.min(b), a.max(b))
}

impl Stage {
    fn new(seed: u64) -> Stage {
        let mut worlds = Vec::new();
        for broad_phase in [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune] {
            for (caching, boxes, motion) in [
                (true, Boxes::Dynamic, Motion::Sampled),
                (false, Boxes::Dynamic, Motion::Sampled),
                (true, Boxes::FixedSize, Motion::Sampled),
                (true, Boxes::Dynamic, Motion::Swept),
            ] {
                let options =
                    WorldOptions { broad_phase, caching, boxes, motion, default_response: Response::Depth };
                worlds.push(World::with_options(&options));
            }
        }
        let rng = seeded(seed);
        Stage { worlds, things: vec![], clearance: 0.0, pairs: HashMap::new(), ignored: vec![], rng }
    }

    fn tell<T>(&mut self, mut what: impl FnMut(&mut World) -> T) -> T {
        let mut answers: Vec<T> = self.worlds.iter_mut().map(&mut what).collect();
        answers.swap_remove(0)
    }

    fn any(&mut self) -> usize {
        self.rng.random_range(0..self.things.len())
    }

    fn add(&mut self) {
        let (shape, soup) = some_shape(&mut self.rng);
        let mut at = placement(&mut self.rng, 1.0);
        at.translation = 3.0 * in_cube(&mut self.rng);
        let id = self.tell(|world| world.add(&shape, at).unwrap());
        self.things.push(Thing { id, shape, soup, at });
    }

    fn change(&mut self) {
        for index in 0..self.things.len() {
            let id = self.things[index].id;
            match self.rng.random_range(0..10) {
                0..4 => {
                    let at = self.things[index].at;
                    let turn = DQuat::from_axis_angle(direction(&mut self.rng), 0.2);
                    let shift = 0.3 * in_cube(&mut self.rng) - 0.02 * at.translation;
                    let matrix3 = DMat3::from_quat(turn) * at.matrix3;
                    let at = DAffine3 { matrix3, translation: at.translation + shift };
                    self.tell(|world| world.set_placement(id, at).unwrap());
                    self.things[index].at = at;
                }
                4 => {
                    let Some(soup) = self.things[index].soup.clone() else { continue };
                    let twist = self.rng.random_range(-0.5..0.5);
                    let wave = |v: &DVec3| DQuat::from_rotation_y(twist * v.length()) * *v;
                    let vertices: Vec<DVec3> = soup.vertices.iter().map(wave).collect();
                    self.tell(|world| world.deform(id, &vertices).unwrap());
                    self.things[index].shape = Soup { vertices, ..soup }.shape();
                }
                _ => {}
            }
        }
        let (i, j) = (self.any(), self.any());
        let (a, b) = (self.things[i].id, self.things[j].id);
        let other = self.clearance * self.rng.random_range(0.0..3.0);
        match self.rng.random_range(0..8) {
            0 => {
                let gone = self.things.remove(i).id;
                self.tell(|world| world.remove(gone).unwrap());
                self.add();
            }
            1 if i != j => {
                self.tell(|world| world.set_pair_clearance(a, b, other).unwrap());
                self.pairs.insert(ordered(a, b), other);
            }
            2 if i != j => {
                self.tell(|world| world.reset_pair_clearance(a, b).unwrap());
                self.pairs.remove(&ordered(a, b));
            }
            3 if i != j => {
                self.tell(|world| world.clear_pair_response(a, b).unwrap());
                self.ignored.push(ordered(a, b));
            }
            4 if i != j => {
                self.tell(|world| world.reset_pair_response(a, b).unwrap());
                self.ignored.retain(|&pair| pair != ordered(a, b));
            }
            5 => {
                let clearance = self.typical_distance() * self.rng.random_range(0.8..1.25);
                self.tell(|world| world.set_clearance(clearance).unwrap());
                self.clearance = clearance;
            }
            _ => {}
        }
    }

    fn pairs(&self) -> impl Iterator<Item = (&Thing, &Thing)> {
        let n = self.things.len();
        let pairs = (0..n).flat_map(move |i| (i + 1..n).map(move |j| (i, j)));
        let pairs = pairs.map(|(i, j)| (&self.things[i], &self.things[j]));
        pairs.filter(|(a, b)| !self.ignored.contains(&ordered(a.id, b.id)))
    }

    /// As a clearance it makes about half of the pairs near.
    fn typical_distance(&self) -> f64 {
        let of =
            |(a, b): (&Thing, &Thing)| query::distance(&a.shape, &a.at, &b.shape, &b.at).unwrap().distance;
        let mut distances: Vec<f64> = self.pairs().map(of).collect();
        distances.sort_by(f64::total_cmp);
        distances[distances.len() / 2]
    }

    /// What every world says, the same to the bit, against every pair; gives how many are near, of how many.
    fn check_near(&mut self, near: &[Near]) -> (usize, usize) {
        let mut found = near.iter().peekable();
        let mut counts = (0, 0);
        for (a, b) in self.pairs() {
            counts.1 += 1;
            let clearance = self.pairs.get(&ordered(a.id, b.id)).copied().unwrap_or(self.clearance);
            let distance = query::distance(&a.shape, &a.at, &b.shape, &b.at).unwrap().distance;
            let near = found.next_if(|near| (near.a, near.b) == (a.id, b.id));
            counts.0 += usize::from(near.is_some());
            let intersects = query::intersects(&a.shape, &a.at, &b.shape, &b.at).unwrap();
            if (distance - clearance).abs() > UNDECIDED || intersects {
                assert_eq!(near.is_some(), intersects || distance < clearance, "{distance} {clearance}");
            }
            let Some(near) = near else { continue };
            if distance > 0.0 {
                assert!((near.distance - distance).abs() < 1e-11, "{near:?} {distance}");
            } else {
                let depth = query::penetration(&a.shape, &a.at, &b.shape, &b.at).unwrap();
                assert_eq!(-near.distance, depth.map_or(0.0, |found| found.depth));
            }
            assert!((near.normal.length() - 1.0).abs() < 1e-12);
            let missed = (near.point_on_a - near.point_on_b).distance(near.normal * near.distance);
            assert!(missed < if near.distance < 0.0 { 1e-3 } else { 1e-9 }, "{near:?}: {missed}");
        }
        assert_eq!(found.next(), None, "it is near, and in its place");
        counts
    }

    fn near(&mut self) -> Vec<Near> {
        let mut answers: Vec<Vec<Near>> = self.worlds.iter_mut().map(World::near).collect();
        for (i, answer) in answers.iter().enumerate() {
            assert_eq!(all_bits(answer), all_bits(&answers[0]), "world {i} differs");
        }
        answers.swap_remove(0)
    }
}

fn all_bits(near: &[Near]) -> Vec<(ObjectId, ObjectId, [u64; 10])> {
    let bits = |near: &Near| {
        let [p, q, n] = [near.point_on_a, near.point_on_b, near.normal].map(|v| v.to_array());
        let numbers = [[near.distance].as_slice(), &p, &q, &n].concat();
        (near.a, near.b, std::array::from_fn(|i| numbers[i].to_bits()))
    };
    near.iter().map(bits).collect()
}

/// Law: near are exactly the pairs that intersect or whose distance is below their clearance; the same bits from every engine; and tests say
/// what they say without any clearance.
#[test]
fn near_is_what_distance_says_of_every_pair() {
    let (mut hits, mut cases, mut negative) = (0, 0, 0);
    for seed in 0..3 {
        let mut stage = Stage::new(7100 + seed);
        for _ in 0..14 {
            stage.add();
        }
        let clearance = stage.typical_distance();
        stage.clearance = clearance;
        stage.tell(|world| world.set_clearance(clearance).unwrap());
        for _ in 0..60 {
            stage.change();
            let mode = stage.rng.random_range(0..4);
            let before = (mode == 0).then(|| stage.near());
            let tested: Vec<_> = stage.worlds.iter_mut().map(World::test).collect();
            let now = |world: usize| tested[world].iter().filter(|c| c.when == solid3d::When::Now);
            for world in 0..tested.len() {
                assert!(now(world).eq(now(0)), "world {world} differs");
            }
            let found: Vec<_> = now(0).map(|c| (c.a, c.b)).collect();
            let intersects =
                |(a, b): &(&Thing, &Thing)| query::intersects(&a.shape, &a.at, &b.shape, &b.at).unwrap();
            let expected: Vec<_> = stage.pairs().filter(intersects).map(|(a, b)| (a.id, b.id)).collect();
            assert_eq!(found, expected);
            // Sometimes several changes come between.
            if mode == 1 {
                continue;
            }
            let near = stage.near();
            assert!(before.is_none_or(|before| all_bits(&before) == all_bits(&near)));
            let (near_pairs, pairs) = stage.check_near(&near);
            (hits, cases) = (hits + near_pairs, cases + pairs);
            negative += near.iter().filter(|near| near.distance < 0.0).count();
            if mode == 2 {
                // In the middle of a test that pauses.
                let (mut progress, mut again) = (TestProgress::default(), Vec::new());
                while let Some(collision) = stage.worlds[0].test_next(&mut progress) {
                    again.push((collision.a, collision.b));
                    assert_eq!(stage.worlds[0].near(), near);
                }
                assert_eq!(again, expected);
            }
            stage.tell(World::proceed);
        }
    }
    assert!(negative > cases / 50, "{negative}");
    assert_rate("near pairs", hits, cases);
}

/// The clearance of a pair holds while others do by default, and no longer than it is set.
#[test]
fn the_clearance_of_a_pair_outlives_the_default() {
    let (mut world, ball) = (World::new(), Shape::sphere(1.0).unwrap());
    let [a, b] = [0.0, 2.75].map(|x| world.add(&ball, DAffine3::from_translation(DVec3::X * x)).unwrap());
    world.set_pair_clearance(a, b, 1.0).unwrap();
    for default in [0.0, 0.5, 0.125, 2.0, 0.25] {
        world.set_clearance(default).unwrap();
        assert_eq!(world.near().len(), 1, "{default}");
    }
    world.reset_pair_clearance(a, b).unwrap();
    assert!(world.near().is_empty());
    world.set_clearance(2.0).unwrap();
    assert_eq!(world.near().len(), 1);
}

/// Law: the greatest clearance of an object counts for its box, whichever was set last.
#[test]
fn a_lesser_clearance_takes_nothing_from_a_greater_one() {
    let ball = Shape::sphere(1.0).unwrap();
    for greater_first in [false, true] {
        let mut world = World::new();
        let [far, middle, near] =
            [6.0, 0.0, -2.5].map(|x| world.add(&ball, DAffine3::from_translation(DVec3::X * x)).unwrap());
        let mut pairs = [(middle, near, 1.0), (middle, far, 4.5)];
        if greater_first {
            pairs.reverse();
        }
        for (a, b, clearance) in pairs {
            world.set_pair_clearance(a, b, clearance).unwrap();
        }
        let found: Vec<_> = world.near().iter().map(|near| (near.a, near.b, near.distance)).collect();
        assert_eq!(found, [(far, middle, 4.0), (middle, near, 0.5)]);
    }
}

/// Law: what touches is near at any clearance, and no distance is a negative zero.
#[test]
fn what_touches_is_near_without_a_clearance() {
    let (mut world, block) = (World::new(), Shape::cuboid([1.0; 3]).unwrap());
    for x in [0.0, 1.0, 2.5] {
        world.add(&block, DAffine3::from_translation(DVec3::X * x)).unwrap();
    }
    for clearance in [0.0, 1e-300, 0.25] {
        world.set_clearance(clearance).unwrap();
        let near = world.near();
        assert_eq!(
            (near.len(), near[0].distance.to_bits(), near[0].normal),
            (1, 0, DVec3::NEG_X),
            "{clearance}"
        );
    }
}

/// Law: far from the origin of the world, or apart by next to nothing, normals are as exact as elsewhere.
#[test]
fn normals_are_exact_wherever_and_however_near() {
    let point = Shape::convex_hull(&[DVec3::ZERO]).unwrap();
    let way = DVec3::new(0.6, 0.0, 0.8);
    for (gap, origin) in [(1.0, DVec3::ZERO), (1e-200, DVec3::ZERO), (1e-6, DVec3::splat(1e8))] {
        let mut world = World::new();
        world.set_clearance(2.0 * gap).unwrap();
        world.add(&point, DAffine3::from_translation(origin)).unwrap();
        // As seen from the first in its own space.
        let other = Shape::convex_hull(&[way * gap]).unwrap();
        world.add(&other, DAffine3::from_translation(origin)).unwrap();
        let near = world.near();
        assert_eq!(near.len(), 1, "{gap}");
        assert!((near[0].normal + way).length() < 1e-12, "{gap}: {}", near[0].normal);
    }
}

/// Law: what is at rest is looked at once.
#[test]
fn near_costs_what_changed() {
    let mut world = World::new();
    world.set_clearance(0.25).unwrap();
    let ball = Shape::sphere(0.5).unwrap();
    let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
    let ids: Vec<_> = (0..100).map(|i| world.add(&ball, at(1.125 * f64::from(i))).unwrap()).collect();
    assert_eq!(world.near().len(), 99);
    assert!(world.near().iter().all(|near| near.distance == 0.125));
    assert_eq!(world.statistics().examined, 99);
    world.set_placement(ids[50], at(1.125 * 50.0 + 0.0625)).unwrap();
    assert_eq!(world.near()[49].distance, 0.1875);
    assert_eq!(world.statistics().examined, 101);
    world.set_pair_clearance(ids[3], ids[4], 0.0625).unwrap();
    assert_eq!(world.near().len(), 98);
    assert_eq!(world.statistics().examined, 102);
    // At just the clearance nothing is nearer: only the one that moved is, to the next.
    world.set_clearance(0.125).unwrap();
    let near: Vec<_> = world.near().iter().map(|near| (near.a, near.distance)).collect();
    assert_eq!(near, [(ids[50], 0.0625)]);
    world.set_clearance(0.1875).unwrap();
    assert_eq!(world.near().len(), 97);
    // Without caching all is looked at each time.
    world.disable_caching();
    for _ in 0..2 {
        let before = world.statistics().examined;
        assert_eq!(world.near().len(), 97);
        assert!(world.statistics().examined - before >= 97);
    }
}

/// Law: near the limits of coordinates, the boxes still overlap.
#[test]
fn far_out_nothing_near_is_lost() {
    for size in [1e-90, 1e-3, 1.0, 1e8, 1e90] {
        for offset in [0.0, 1e3, 1e9] {
            for kind in [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune] {
                let options = WorldOptions { broad_phase: kind, ..WorldOptions::default() };
                let mut world = World::with_options(&options);
                let block = Shape::cuboid(DVec3::splat(size)).unwrap();
                let at =
                    |x: f64| DAffine3::from_translation(DVec3::splat(offset * size) + DVec3::X * x * size);
                let places = [at(0.0), at(1.5)];
                places.iter().for_each(|&at| {
                    world.add(&block, at).unwrap();
                });
                let distance = query::distance(&block, &places[0], &block, &places[1]).unwrap().distance;
                world.set_clearance(distance).unwrap();
                assert_eq!(world.near(), []);
                world.set_clearance(distance.next_up()).unwrap();
                assert_eq!(world.near().len(), 1, "{size} {offset}");
            }
        }
    }
}

/// Law: a bound saves work: what is further apart is not opened to its primitives.
#[test]
fn a_bound_saves_work() {
    let work = |clearance: f64| {
        let mut world = World::new();
        let torus = torus(40, 20, 0.4).shape();
        let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
        let [a, b] = [0.0, 3.0].map(|x| world.add(&torus, at(x)).unwrap());
        // The boxes overlap, whatever the clearance of the pair.
        world.set_clearance(9.0).unwrap();
        world.set_pair_clearance(a, b, clearance).unwrap();
        let near = world.near().len();
        (near, world.statistics().box_tests, world.statistics().primitive_tests)
    };
    let (far, near) = (work(0.5), work(9.0));
    assert_eq!((far.0, near.0), (0, 1));
    assert!(near.2 > 0, "the nearest primitives are tested");
    assert_eq!(far.2, 0, "no primitive is tested that is too far");
    assert!(3 * far.1 < near.1, "{far:?} {near:?}");
}

/// Law: a box that was grown for a pair shrinks when the clearance of all is set, once an object of the pair is gone.
#[test]
fn no_box_is_grown_for_an_object_that_is_gone() {
    let (mut world, ball) = (World::new(), Shape::sphere(1.0).unwrap());
    let [a, gone, _] =
        [0.0, 9.0, 40.0].map(|x| world.add(&ball, DAffine3::from_translation(DVec3::X * x)).unwrap());
    world.set_pair_clearance(a, gone, 100.0).unwrap();
    world.remove(gone).unwrap();
    world.set_clearance(0.5).unwrap();
    assert!(world.test().is_empty());
    assert_eq!(world.statistics().candidates, 0);
}
