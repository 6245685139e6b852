//! Two rigid meshes: A at the origin, B anywhere; half of the rows touch up to 1e-2 to 1e-7. The truth is CGAL's exact
//! predicates, and three libraries for the distance.

use std::path::Path;

use glam::{DAffine3, DMat3, DQuat, DVec3, EulerRot};
use solid3d::{BroadPhaseKind, ComplexShapeBuilder, ObjectId, Shape, World, WorldOptions, query};

use crate::data::{Row, folder, for_each_row, json, model};
use crate::tally::Tally;

/// The error of a distance relative to the size of the pair.
const DISTANCE_ERROR: f64 = 1e-12;

/// Every so many rows the closest points and the common point are examined as well.
const POINTS_EVERY: usize = 8;

#[test]
fn bunny_torus() {
    check_all("bunny_torus");
}

#[test]
fn fcl_env_rob() {
    check_all("fcl_env_rob");
}

#[test]
fn ship_ship() {
    check_all("ship_ship");
}

#[test]
fn teapot_teapot() {
    check_all("teapot_teapot");
}

#[test]
fn torus_torus() {
    check_all("torus_torus");
}

fn check_all(name: &str) {
    let Some(folder) = folder("rigid") else { return };
    let facts = json(&folder.join(format!("{name}.json")));
    let shape = |mesh: &str, triangles: &str| {
        let shape = model(facts[mesh].as_str().unwrap()).unwrap();
        assert_eq!(shape.primitive_count() as u64, facts[triangles].as_u64().unwrap());
        shape
    };
    let pair = Pair { a: shape("meshA", "trisA"), b: shape("meshB", "trisB") };
    let size = facts["radius_sum"].as_f64().unwrap();
    let variants = variants(&pair, size);
    check_agreed(&pair, size, &folder.join(format!("{name}.csv")));
    for variant in &variants {
        check_variant(variant, name, &folder.join(format!("{name}.csv")));
    }
    let disputed = folder.join(format!("{name}.disputed.csv"));
    if disputed.exists() {
        check_disputed(&pair, size, &disputed);
    }
}

struct Pair {
    a: Shape,
    b: Shape,
}

impl Pair {
    fn intersects(&self, at: &DAffine3) -> bool {
        query::intersects(&self.a, &DAffine3::IDENTITY, &self.b, at).unwrap()
    }

    fn distance(&self, at: &DAffine3) -> query::Distance {
        query::distance(&self.a, &DAffine3::IDENTITY, &self.b, at).unwrap()
    }
}

/// Rows on which all tools agree.
fn check_agreed(pair: &Pair, size: f64, path: &Path) {
    let mut tally = Tally::new(path.file_name().unwrap().to_string_lossy());
    let mut worlds = Worlds::new(pair);
    let mut count = 0;
    for_each_row(path, |row| {
        let (at, label, collide) = (row.placement(""), label(&row), row.flag("collide"));
        tally.hit(&label, collide, pair.intersects(&at));
        let found = pair.distance(&at);
        tally.error(&label, (found.distance - row.real("distance")).abs() / size, DISTANCE_ERROR);
        tally.check(collide == (found.distance == 0.0), || format!("{label}: distance {}", found.distance));
        worlds.check(&mut tally, &label, &at, collide);
        if count % POINTS_EVERY == 0 {
            check_points(&mut tally, &label, pair, &at, size);
        }
        count += 1;
    });
    tally.finish_representative();
}

/// Rows on which a tool contradicts CGAL: all of them nearly touch.
fn check_disputed(pair: &Pair, size: f64, path: &Path) {
    let mut tally = Tally::new(path.file_name().unwrap().to_string_lossy());
    let mut worlds = Worlds::new(pair);
    for_each_row(path, |row| {
        let (at, label, collide) = (row.placement(""), label(&row), row.flag("cgal_exact_collide"));
        tally.hit(&label, collide, pair.intersects(&at));
        worlds.check(&mut tally, &label, &at, collide);
        let found = pair.distance(&at).distance;
        // Where the two that give a distance do not agree with each other, neither is a reference.
        let (fcl, parry) = (row.real("fcl_distance"), row.real("parry_distance"));
        let spread = (fcl - parry).abs() / size;
        tally.error(&label, (found - parry).abs() / size, DISTANCE_ERROR + spread);
    });
    tally.finish();
}

fn label(row: &Row) -> String {
    format!("row {} ({})", row.text("id"), row.text("kind"))
}

/// The common point and the closest points lie on both surfaces.
fn check_points(tally: &mut Tally, label: &str, pair: &Pair, at: &DAffine3, size: f64) {
    let off = |shape: &Shape, place: &DAffine3, point: DVec3| {
        let point = Shape::convex_hull(&[point]).unwrap();
        query::distance(shape, place, &point, &DAffine3::IDENTITY).unwrap().distance / size
    };
    let here = DAffine3::IDENTITY;
    let closest = pair.distance(at);
    let apart = closest.point_on_a.distance(closest.point_on_b);
    tally.error(label, (apart - closest.distance).abs() / size, DISTANCE_ERROR);
    tally.error(label, off(&pair.a, &here, closest.point_on_a), DISTANCE_ERROR);
    tally.error(label, off(&pair.b, at, closest.point_on_b), DISTANCE_ERROR);
    if let Some(point) = query::common_point(&pair.a, &here, &pair.b, at).unwrap() {
        tally.error(label, off(&pair.a, &here, point).max(off(&pair.b, at, point)), DISTANCE_ERROR);
    }
}

/// A world for each broad phase, with B moving from row to row.
struct Worlds(Vec<(World, [ObjectId; 2])>);

impl Worlds {
    fn new(pair: &Pair) -> Self {
        let kinds = [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune];
        Worlds(kinds.map(|broad_phase| world(pair, broad_phase)).into())
    }

    fn place_a(&mut self, at: &DAffine3) {
        for (world, [a, _]) in &mut self.0 {
            world.set_placement(*a, *at).unwrap();
        }
    }

    fn check(&mut self, tally: &mut Tally, label: &str, at: &DAffine3, collide: bool) {
        for (world, [_, b]) in &mut self.0 {
            world.set_placement(*b, *at).unwrap();
            let found = world.test().len();
            world.proceed();
            tally.check(found == usize::from(collide), || format!("{label}: {found} collisions in a world"));
        }
    }
}

fn world(pair: &Pair, broad_phase: BroadPhaseKind) -> (World, [ObjectId; 2]) {
    let mut world = World::with_options(&WorldOptions { broad_phase, ..WorldOptions::default() });
    let ids = [&pair.a, &pair.b].map(|shape| world.add(shape, DAffine3::IDENTITY).unwrap());
    (world, ids)
}

/// The same pair said differently: the answers are the same.
struct Variant {
    what: &'static str,
    pair: Pair,
    /// Applied to both.
    map: DAffine3,
}

/// Every so many rows the variants are asked.
const VARIANTS_EVERY: usize = 10;

fn variants(pair: &Pair, size: f64) -> Vec<Variant> {
    let turn = DQuat::from_euler(EulerRot::XYZ, 0.3, -1.1, 2.0);
    let far = DVec3::new(-3e3, 1e3, 2e3) * size;
    let sheared =
        DMat3::from_cols(DVec3::new(2.0, 0.5, 0.0), DVec3::new(0.1, 0.3, -0.7), DVec3::new(1.0, 0.0, 1.0));
    let turned =
        |scale: f64| DAffine3::from_scale_rotation_translation(DVec3::splat(scale), turn, far * scale);
    let mirrored = DAffine3::from_scale_rotation_translation(DVec3::new(-1.0, 1.0, 1.0), turn, DVec3::ZERO);
    let same = || Pair { a: pair.a.clone(), b: pair.b.clone() };
    let swapped = Pair { a: as_polygons(&pair.a), b: as_polygons(&pair.b) };
    vec![
        Variant { what: "far away", pair: same(), map: turned(1.0) },
        Variant { what: "tiny", pair: same(), map: turned(1e-30) },
        Variant { what: "huge", pair: same(), map: turned(1e30) },
        Variant { what: "mirrored", pair: same(), map: mirrored },
        Variant { what: "sheared", pair: same(), map: DAffine3::from_mat3(sheared) },
        Variant { what: "as polygons, sheared", pair: swapped, map: DAffine3::from_mat3(sheared) },
    ]
}

/// A mesh as a complex shape of polygons with four corners, one of them twice: for these GJK decides.
fn as_polygons(mesh: &Shape) -> Shape {
    let builder = ComplexShapeBuilder::new(mesh.vertices().unwrap());
    let triangles = mesh.triangles().unwrap().iter();
    triangles.fold(builder, |builder, &[i, j, k]| builder.polygon(&[i, j, k, i])).build().unwrap()
}

fn check_variant(variant: &Variant, name: &str, path: &Path) {
    let Variant { what, pair: Pair { a, b }, map } = variant;
    let mut tally = Tally::new(format!("{name}, {what}"));
    let mut worlds = Worlds::new(&variant.pair);
    let mut count = 0;
    for_each_row(path, |row| {
        count += 1;
        if count % VARIANTS_EVERY != 0 {
            return;
        }
        let (label, collide) = (label(&row), row.flag("collide"));
        let at = *map * row.placement("");
        tally.hit(&label, collide, query::intersects(a, map, b, &at).unwrap());
        let swapped = query::intersects(b, &at, a, map).unwrap();
        tally.check(swapped == collide, || format!("{label}: {swapped} when swapped"));
        let distance = query::distance(b, &at, a, map).unwrap().distance;
        tally.check((distance == 0.0) == collide, || format!("{label}: distance {distance:e}"));
        worlds.place_a(map);
        worlds.check(&mut tally, &label, &at, collide);
    });
    tally.finish();
}
