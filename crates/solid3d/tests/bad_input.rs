//! Bad input is refused with an error that names it, and changes nothing; wild input neither panics nor hangs.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use std::time::{Duration, Instant};

use glam::{DAffine3, DMat3, DVec3};
use proptest::prelude::*;
use solid3d::{
    BroadPhaseKind, ComplexShapeBuilder, Error, ObjectId, Response, Shape, World, WorldOptions, glam,
    query::{self, ContactOptions, ImpactOptions, PairCache},
};

/// What no size may be.
const BAD_SIZES: [f64; 9] =
    [0.0, -0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e-310, 9.9e-101, 1.0001e100];

/// What no coordinate may be.
const BAD_COORDINATES: [f64; 5] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0001e100, f64::MAX];

/// Asserts that something was refused, with a message that holds all the words.
#[track_caller]
fn refused<T: std::fmt::Debug>(result: solid3d::Result<T>, words: &[&str]) -> Error {
    let error = result.unwrap_err();
    let message = error.to_string();
    for word in words {
        assert!(message.contains(word), "{message:?} does not say {word:?}");
    }
    error
}

type Maker = fn(f64) -> solid3d::Result<Shape>;

#[test]
fn bad_sizes_are_refused_by_name() {
    let makers: [(&str, Maker); 10] = [
        ("radius", Shape::sphere),
        ("radius", |x| Shape::cone(x, 1.0)),
        ("height", |x| Shape::cone(1.0, x)),
        ("radius", |x| Shape::cylinder(x, 1.0)),
        ("height", |x| Shape::cylinder(1.0, x)),
        ("radius", |x| Shape::capsule(x, 1.0)),
        ("height", |x| Shape::capsule(1.0, x)),
        ("size.x", |x| Shape::cuboid([x, 1.0, 1.0])),
        ("size.y", |x| Shape::cuboid([1.0, x, 1.0])),
        ("size.z", |x| Shape::cuboid([1.0, 1.0, x])),
    ];
    for (name, make) in makers {
        for bad in BAD_SIZES {
            refused(make(bad), &[name, &format!("{bad:?}"), "1e-100", "1e100"]);
        }
        for good in [1e-100, 1e-30, 1e30, 1e100] {
            make(good).unwrap();
        }
    }
}

#[test]
fn bad_vertices_and_indices_are_refused_by_place() {
    let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
    for bad in BAD_COORDINATES {
        for axis in 0..3 {
            let mut vertices = triangle;
            vertices[1][axis] = bad;
            let words = ["vertex 1", "finite", "1e100", &format!("{bad:?}")];
            refused(Shape::mesh(vertices, [[0, 1, 2]]), &words);
            // Also where no triangle uses it.
            refused(Shape::mesh(vertices, [[0, 2, 2]]), &words);
            refused(Shape::convex_hull(&vertices), &words);
            let builder = ComplexShapeBuilder::new(vertices);
            refused(builder.clone().point(0).build(), &words);
            refused(builder.simple_polygon(&[2, 0, 1]).build(), &words);
        }
    }
    refused(Shape::convex_hull(&[]), &["points", "empty", "vertex"]);
    refused(Shape::mesh([], [[0, 0, 0]]), &["vertices", "empty"]);
    refused(Shape::mesh(triangle, []), &["triangles", "empty", "primitive"]);
    refused(ComplexShapeBuilder::new([]).build(), &["vertices", "empty"]);
    refused(ComplexShapeBuilder::new(triangle).build(), &["primitives", "empty"]);
    for bad in [3, 4, u32::MAX] {
        let words = ["primitive 1", &format!("vertex {bad}"), "3 vertices"];
        refused(Shape::mesh(triangle, [[0, 1, 2], [0, bad, 2], [9, 9, 9]]), &words);
        let start = || ComplexShapeBuilder::new(triangle).point(0);
        refused(start().point(bad).build(), &words);
        refused(start().segment([0, bad]).build(), &words);
        refused(start().triangle([0, 1, bad]).build(), &words);
        refused(start().tetrahedron([0, 1, 2, bad]).build(), &words);
        refused(start().polygon(&[0, 1, 2, bad]).point(77).build(), &words);
        refused(start().polyhedron(&[bad]).segment([88, 99]).build(), &words);
    }
    let start = || ComplexShapeBuilder::new(triangle).point(0);
    refused(start().polygon(&[0, 1]).build(), &["primitive 1", "2 vertices", "at least 3"]);
    refused(start().polygon(&[]).build(), &["primitive 1", "0 vertices", "at least 3"]);
    refused(start().polyhedron(&[]).build(), &["primitive 1", "0 vertices", "at least 1"]);
}

/// Placements that cannot be used, each with words of its error.
fn bad_placements() -> Vec<(DAffine3, Vec<String>)> {
    let mut bad = Vec::new();
    for entry in 0..12 {
        for value in BAD_COORDINATES {
            let mut entries = DAffine3::IDENTITY.to_cols_array();
            entries[entry] = value;
            let words = ["has the entry", &format!("{value:?}"), "1e100"].map(str::to_string).to_vec();
            bad.push((DAffine3::from_cols_array(&entries), words));
        }
    }
    let (x, y) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(-1.0, 0.5, 2.0));
    let singular = [
        DMat3::ZERO,
        DMat3::from_diagonal(DVec3::new(1.0, 0.0, 1.0)),
        DMat3::from_cols(x, y, x + y),
        DMat3::from_cols(x, 2.0 * x, -3.0 * x),
        DMat3::from_cols(x, x, y),
        DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 1e-13)),
        DMat3::from_diagonal(DVec3::new(1.0, 1e-310, 1.0)),
        DMat3::from_diagonal(DVec3::splat(1e-101)),
    ];
    for matrix3 in singular {
        let words = ["is singular", "axes", "direction", "1e-100"].map(str::to_string).to_vec();
        bad.push((DAffine3 { matrix3, translation: DVec3::ONE }, words));
    }
    bad
}

#[test]
fn bad_placements_are_refused_by_queries_on_either_side() {
    // Of balls and bodies placements are looked at before they are checked.
    let shapes = [
        Shape::sphere(1.0),
        Shape::mesh([DVec3::ZERO], [[0; 3]]),
        Shape::capsule(0.5, 1.0),
        Shape::cuboid([1.0, 2.0, 3.0]),
        Shape::cylinder(0.5, 1.0),
        Shape::convex_hull(&[DVec3::ZERO]),
    ]
    .map(Result::unwrap);
    let good = DAffine3::IDENTITY;
    for (bad, words) in bad_placements() {
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        for shape in &shapes {
            let words = [words.as_slice(), &["placement "]].concat();
            refused(query::contains_point(shape, &bad, DVec3::ONE), &words);
            refused(query::closest_point(shape, &bad, DVec3::ONE), &words);
            refused(query::signed_distance(shape, &bad, DVec3::ONE), &words);
        }
        for (a, b) in shapes.iter().flat_map(|a| shapes.iter().map(move |b| (a, b))) {
            for (at_a, at_b, name) in
                [(&bad, &good, "placement_a"), (&good, &bad, "placement_b"), (&bad, &bad, "placement_a")]
            {
                let words = [words.as_slice(), &[name]].concat();
                refused(query::intersects(a, at_a, b, at_b), &words);
                refused(query::common_point(a, at_a, b, at_b), &words);
                refused(query::distance(a, at_a, b, at_b), &words);
                refused(query::distance_within(a, at_a, b, at_b, 1.0), &words);
                refused(query::separating_axis(a, at_a, b, at_b), &words);
                refused(query::penetration(a, at_a, b, at_b), &words);
                refused(query::contacts(a, at_a, b, at_b, &ContactOptions::default()), &words);
                refused(query::cast_shape(a, at_a, DVec3::X, b, at_b, DVec3::ZERO), &words);
                refused(PairCache::new(a, b).intersects(at_a, at_b), &words);
                refused(PairCache::new(a, b).distance(at_a, at_b), &words);
                refused(PairCache::new(a, b).penetration(at_a, at_b), &words);
            }
            for (place, name) in ["from_a", "to_a", "from_b", "to_b"].into_iter().enumerate() {
                let words = [words.as_slice(), &[name]].concat();
                let [from_a, to_a, from_b, to_b] =
                    [0, 1, 2, 3].map(|i| if i == place { &bad } else { &good });
                let options = ImpactOptions::default();
                refused(query::time_of_impact(a, from_a, to_a, b, from_b, to_b, &options), &words);
            }
        }
    }
}

/// A world with a bit of everything in it, and its objects.
fn scene(broad_phase: BroadPhaseKind) -> (World, Vec<ObjectId>) {
    let options = WorldOptions { broad_phase, default_response: Response::Smart, ..Default::default() };
    let mut world = World::with_options(&options);
    let sheet = [DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y];
    let shapes = [
        Shape::sphere(0.6).unwrap(),
        Shape::cuboid(DVec3::ONE).unwrap(),
        Shape::mesh(sheet, [[0, 1, 2], [0, 2, 3]]).unwrap(),
        ComplexShapeBuilder::new(sheet).tetrahedron([0, 1, 2, 3]).build().unwrap(),
    ];
    let at = |i: usize| DAffine3::from_translation(0.3 * i as f64 * DVec3::new(1.0, 0.2, 0.1));
    let ids: Vec<ObjectId> = (0..8).map(|i| world.add(&shapes[i % 4], at(i)).unwrap()).collect();
    world.set_object_response(ids[1], Response::Witness).unwrap();
    world.set_pair_response(ids[0], ids[2], Response::Simple).unwrap();
    (world, ids)
}

/// What a world answers over some frames, as text, which shows every bit of a number.
fn transcript(world: &mut World, ids: &[ObjectId]) -> String {
    let mut text = format!("{:?}\n", world.objects());
    for frame in 0..4 {
        for (i, &id) in ids.iter().enumerate() {
            let mut at = world.placement(id).unwrap();
            at.translation += 0.07 * DVec3::new(i as f64, 1.0, -1.0);
            world.set_placement(id, at).unwrap();
            if i % 4 == 2 {
                let mut positions = world.shape(id).unwrap().vertices().unwrap().to_vec();
                positions[0].z += 0.1 * f64::from(frame);
                world.deform(id, &positions).unwrap();
            }
        }
        text += &format!("{:?}\n{:?}\n", world.test(), world.statistics());
        world.proceed();
    }
    text
}

#[test]
fn a_refused_call_leaves_the_world_as_an_untouched_twin() {
    for kind in [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune] {
        let (mut world, ids) = scene(kind);
        let (mut twin, _) = scene(kind);
        // Both have once removed an object, and an id of theirs is out of date.
        let ball = Shape::sphere(1.0).unwrap();
        let gone = world.add(&ball, DAffine3::IDENTITY).unwrap();
        assert_eq!(twin.add(&ball, DAffine3::IDENTITY).unwrap(), gone);
        world.remove(gone).unwrap();
        twin.remove(gone).unwrap();
        let mut elsewhere = World::new();
        let foreign = (0..40).map(|_| elsewhere.add(&ball, DAffine3::IDENTITY).unwrap()).last().unwrap();

        assert_eq!(transcript(&mut world, &ids), transcript(&mut twin, &ids));
        for (bad, words) in bad_placements() {
            let mut words: Vec<&str> = words.iter().map(String::as_str).collect();
            words.push("placement ");
            refused(world.add(&ball, bad), &words);
            refused(world.set_placement(ids[3], bad), &words);
        }
        for unknown in [gone, foreign, ObjectId::default()] {
            let name = format!("{unknown:?}");
            let words = [name.as_str(), "not in this world"];
            assert!(!world.contains(unknown));
            let known = ids[0];
            refused(world.remove(unknown), &words);
            refused(world.placement(unknown), &words);
            refused(world.shape(unknown).cloned(), &words);
            refused(world.set_placement(unknown, DAffine3::IDENTITY), &words);
            refused(world.set_shape(unknown, &ball), &words);
            refused(world.deform(unknown, &[DVec3::ZERO]), &words);
            refused(world.set_object_response(unknown, Response::Smart), &words);
            refused(world.clear_object_response(unknown), &words);
            refused(world.reset_object_response(unknown), &words);
            for (a, b, argument) in
                [(unknown, known, "a is"), (known, unknown, "b is"), (unknown, unknown, "a is")]
            {
                let words = [name.as_str(), "not in this world", argument];
                refused(world.set_pair_response(a, b, Response::Smart), &words);
                refused(world.clear_pair_response(a, b), &words);
                refused(world.reset_pair_response(a, b), &words);
                refused(world.response(a, b), &words);
                refused(world.contacts(a, b, &ContactOptions::default()), &words);
                refused(world.time_of_impact(a, b, &ImpactOptions::default()), &words);
            }
        }
        for &id in &ids {
            let name = format!("{id:?}");
            let words = [name.as_str(), "two objects"];
            refused(world.set_pair_response(id, id, Response::Simple), &words);
            refused(world.clear_pair_response(id, id), &words);
            refused(world.reset_pair_response(id, id), &words);
            refused(world.response(id, id), &words);
            refused(world.contacts(id, id, &ContactOptions::default()), &words);
            refused(world.time_of_impact(id, id, &ImpactOptions::default()), &words);
        }
        refused(world.deform(ids[0], &[]), &["sphere", "vertex buffer"]);
        refused(world.deform(ids[1], &[DVec3::ZERO]), &["box", "vertex buffer"]);
        for id in [ids[2], ids[3]] {
            refused(world.deform(id, &[DVec3::ZERO; 3]), &["positions has 3", "4 vertices"]);
            refused(world.deform(id, &[DVec3::ZERO; 5]), &["positions has 5", "4 vertices"]);
            for bad in BAD_COORDINATES {
                let mut positions = [DVec3::ZERO; 4];
                positions[3].z = bad;
                refused(world.deform(id, &positions), &["vertex 3", &format!("{bad:?}")]);
            }
        }
        assert_eq!(world.len(), twin.len());
        assert_eq!(transcript(&mut world, &ids), transcript(&mut twin, &ids));
    }
}

/// Distances whose squares overflow, of shapes under placements as wild as they come.
#[test]
fn distances_near_the_limits_are_finite() {
    let spot = Shape::mesh([DVec3::ZERO], [[0; 3]]).unwrap();
    let far = Shape::convex_hull(&[DVec3::Z * -1e60]).unwrap();
    let far_mesh = Shape::mesh([DVec3::Z * -1e60], [[0; 3]]).unwrap();
    let wild = DAffine3 {
        matrix3: DMat3::from_cols(DVec3::Z * -0.6, DVec3::new(0.0, 3e-14, 3e-309), DVec3::X * 1e100),
        translation: DVec3::ZERO,
    };
    for far in [far, far_mesh] {
        let found = query::distance(&spot, &DAffine3::IDENTITY, &far, &wild).unwrap();
        assert!((found.distance / 1e160 - 1.0).abs() < 1e-12, "{found:?}");
        let found = query::distance(&far, &wild, &spot, &DAffine3::IDENTITY).unwrap();
        assert!((found.distance / 1e160 - 1.0).abs() < 1e-12, "{found:?}");
    }
}

/// Any bits, any number that a coordinate may be, or one that tests like.
fn wild() -> impl Strategy<Value = f64> {
    let in_range = |bits: u64| {
        let x = f64::from_bits(bits);
        // The exponents beyond the limit, which are those from 2^332 on, are taken back below it.
        if x.abs() <= 1e100 {
            x
        } else {
            f64::from_bits(bits & !(0x7ff << 52) | (((bits >> 52) % 1355) << 52))
        }
    };
    let usual = [0.0, -0.0, 1.0, -1.0, 0.5, 1e100, -1e100, 1e-100, 5e-324, 1e-310, f64::MIN_POSITIVE];
    prop_oneof![
        1 => any::<u64>().prop_map(f64::from_bits),
        20 => any::<u64>().prop_map(in_range),
        20 => -1.0..1.0,
        10 => prop::sample::select(usual.to_vec()),
    ]
}

/// As [`wild`], but never refused: the shapes and placements that are made of it are those that count.
fn tame() -> impl Strategy<Value = f64> {
    wild().prop_map(|x| if x.abs() <= 1e100 { x } else { 2.0 })
}

fn any_vec3() -> impl Strategy<Value = DVec3> {
    prop_oneof![20 => [tame(), tame(), tame()], 1 => [wild(), wild(), wild()]].prop_map(DVec3::from)
}

fn any_shape() -> impl Strategy<Value = solid3d::Result<Shape>> {
    let vertices = || prop::collection::vec(any_vec3(), 0..12);
    let size = || tame().prop_map(f64::abs);
    let index = || prop_oneof![30 => 0..6u32, 1 => any::<u32>()];
    let triangles = prop::collection::vec([index(), index(), index()], 0..12);
    let primitives = prop::collection::vec(prop::collection::vec(index(), 0..8), 0..8);
    prop_oneof![
        1 => size().prop_map(Shape::sphere),
        1 => [size(), size(), size()].prop_map(Shape::cuboid),
        1 => (size(), size()).prop_map(|(r, h)| Shape::cone(r, h)),
        1 => (size(), size()).prop_map(|(r, h)| Shape::cylinder(r, h)),
        1 => (size(), size()).prop_map(|(r, h)| Shape::capsule(r, h)),
        3 => vertices().prop_map(|points| Shape::convex_hull(&points)),
        4 => (vertices(), triangles).prop_map(|(vertices, triangles)| Shape::mesh(vertices, triangles)),
        4 => (vertices(), primitives).prop_map(|(vertices, primitives)| {
            let builder = ComplexShapeBuilder::new(vertices);
            primitives.iter().fold(builder, |builder, p| builder.polyhedron(p)).build()
        }),
    ]
}

fn any_placement() -> impl Strategy<Value = DAffine3> {
    let columns = || (any_vec3(), any_vec3(), any_vec3(), any_vec3());
    prop_oneof![
        2 => columns().prop_map(|(x, y, z, at)| DAffine3::from_cols(x, y, z, at)),
        2 => (any_vec3(), any_vec3()).prop_map(|(scale, at)| {
            DAffine3 { matrix3: DMat3::from_diagonal(scale), translation: at }
        }),
        1 => any_vec3().prop_map(DAffine3::from_translation),
        1 => Just(DAffine3::IDENTITY),
    ]
}

/// How far the vertices reach from their origin; 0 for shapes without, whose answers do not depend on the order.
fn size_of(shape: &Shape, at: &DAffine3) -> f64 {
    let vertices = shape.vertices().unwrap_or_default();
    vertices.iter().map(|&v| (at.matrix3 * v).length()).fold(0.0, f64::max)
}

/// Nothing takes longer than this, even on a busy machine.
const TIME_MAX: Duration = Duration::from_secs(5);

proptest! {
    #![proptest_config(ProptestConfig { cases: 60_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn wild_shapes_and_placements_neither_panic_nor_hang(
        a in any_shape(),
        b in any_shape(),
        at_a in any_placement(),
        at_b in any_placement(),
    ) {
        let start = Instant::now();
        if let (Ok(a), Ok(b)) = (a, b) {
            let placed = query::intersects(&a, &at_a, &a, &at_a).is_ok() && query::intersects(&b, &at_b, &b, &at_b).is_ok();
            let met = query::intersects(&a, &at_a, &b, &at_b);
            prop_assert_eq!(met.is_ok(), placed);
            let closest = query::distance(&a, &at_a, &b, &at_b);
            prop_assert_eq!(closest.is_ok(), placed);
            let axis = query::separating_axis(&a, &at_a, &b, &at_b);
            let point = query::common_point(&a, &at_a, &b, &at_b);
            if let (Ok(met), Ok(closest), Ok(axis), Ok(point)) = (met, closest, axis, point) {
                prop_assert_eq!(point.is_some(), met);
                prop_assert!(point.is_none_or(|p| p.is_finite()), "{:?}", point);
                prop_assert!(closest.distance >= 0.0 && closest.distance.is_finite(), "{:?}", closest);
                prop_assert!(closest.point_on_a.is_finite() && closest.point_on_b.is_finite(), "{:?}", closest);
                prop_assert!(axis.is_none_or(|v| (v.length() - 1.0).abs() < 1e-9), "{:?}", axis);
                prop_assert!(!(met && axis.is_some()), "they meet, and {:?} parts them", axis);
                let swapped = query::intersects(&b, &at_b, &a, &at_a).unwrap();
                let size = size_of(&a, &at_a) + size_of(&b, &at_b) + at_a.translation.distance(at_b.translation);
                prop_assert!(swapped == met || closest.distance <= 1e-12 * size, "swapped: {}", swapped);
                for kind in [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune] {
                    let options = WorldOptions { broad_phase: kind, ..WorldOptions::default() };
                    let mut world = World::with_options(&options);
                    let id = world.add(&a, at_a).unwrap();
                    world.add(&b, at_b).unwrap();
                    prop_assert_eq!(!world.test().is_empty(), met, "{:?}", kind);
                    world.set_placement(id, at_b).unwrap();
                    world.set_default_response(Response::Smart);
                    world.test();
                }
            }
        }
        prop_assert!(start.elapsed() < TIME_MAX, "{:?}", start.elapsed());
    }

    #[test]
    fn wild_deformations_neither_panic_nor_hang(
        first in prop::collection::vec(any_vec3(), 6),
        second in prop::collection::vec(any_vec3(), 5..7),
        third in prop::collection::vec(any_vec3(), 6),
        at in any_placement(),
    ) {
        let triangles = [[0, 1, 2], [2, 3, 4], [3, 4, 5], [0, 0, 5]];
        if let Ok(mut shape) = Shape::mesh(first, triangles) {
            for positions in [&second, &third] {
                let before = shape.vertices().unwrap().to_vec();
                match shape.deform(positions) {
                    Ok(()) => prop_assert_eq!(shape.vertices().unwrap(), &positions[..]),
                    Err(_) => prop_assert_eq!(shape.vertices().unwrap(), &before[..]),
                }
                let fresh = Shape::mesh(shape.vertices().unwrap(), triangles).unwrap();
                let ball = Shape::sphere(1.0).unwrap();
                if let Ok(met) = query::intersects(&shape, &at, &ball, &DAffine3::IDENTITY) {
                    prop_assert_eq!(query::intersects(&fresh, &at, &ball, &DAffine3::IDENTITY), Ok(met));
                }
            }
        }
    }
}
