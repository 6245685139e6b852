//! Bodies in exact contact: the pieces of a broken wall in place, and the shapes of Erleben (2018) on a grid, whose faces,
//! edges and corners meet without overlap. The truth is rational arithmetic on the same positions.

use std::collections::BTreeSet;

use glam::{DAffine3, DMat3, DVec3};
use solid_oracle::{Convex, Verdict, mesh_distance, mesh_pairs, verdict};
use solid3d::{BroadPhaseKind, ObjectId, Shape, World, WorldOptions, query};

use crate::data::{folder, mesh};
use crate::tally::Tally;

/// The error of a distance relative to the size of the pair.
const DISTANCE_ERROR: f64 = 1e-12;

/// A mesh at a place, with the positions in the world that the exact answers are for.
struct Body {
    name: String,
    shape: Shape,
    at: DAffine3,
    world: Vec<DVec3>,
}

impl Body {
    fn new(name: &str, shape: &Shape, at: DAffine3) -> Self {
        let world = shape.vertices().unwrap().iter().map(|&v| at.transform_point3(v)).collect();
        Body { name: name.to_owned(), shape: shape.clone(), at, world }
    }

    fn triangles(&self) -> &[[u32; 3]] {
        self.shape.triangles().unwrap()
    }

    fn hull(&self) -> Body {
        let shape = Shape::convex_hull(self.shape.vertices().unwrap()).unwrap();
        Body { name: format!("hull of {}", self.name), shape, at: self.at, world: self.world.clone() }
    }

    fn exact_hull(&self) -> Convex {
        Convex::Hull { points: self.world.clone() }
    }

    fn reach(&self) -> f64 {
        self.world.iter().map(|v| v.length()).fold(0.0, f64::max)
    }
}

/// Whether the surfaces share a point, exactly.
fn surfaces_meet(a: &Body, b: &Body) -> bool {
    !mesh_pairs(&a.world, a.triangles(), &b.world, b.triangles()).is_empty()
}

/// Whether the convex hulls share a point, exactly.
fn hulls_meet(a: &Body, b: &Body) -> bool {
    let here = DAffine3::IDENTITY;
    matches!(verdict(&a.exact_hull(), &here, &b.exact_hull(), &here), Verdict::Intersecting { .. })
}

fn intersects(a: &Body, b: &Body) -> bool {
    query::intersects(&a.shape, &a.at, &b.shape, &b.at).unwrap()
}

fn distance(a: &Body, b: &Body) -> f64 {
    query::distance(&a.shape, &a.at, &b.shape, &b.at).unwrap().distance
}

/// Compares two bodies, as surfaces and as hulls, in both orders.
fn check(tally: &mut Tally, a: &Body, b: &Body) -> [bool; 2] {
    let label = format!("{} and {}", a.name, b.name);
    let (size, met) = (a.reach() + b.reach(), surfaces_meet(a, b));
    tally.hit(&label, met, intersects(a, b));
    tally.hit(&label, met, intersects(b, a));
    let found = distance(a, b);
    let exact = mesh_distance(&a.world, a.triangles(), &b.world, b.triangles());
    // Meshes are decided exactly, but distances are GJK's: within its error they may be 0 where surfaces do not meet.
    let close = exact <= DISTANCE_ERROR * size;
    tally.check(met == (found == 0.0) || close, || format!("{label}: {met}, but a distance of {found:e}"));
    tally.error(&label, (found - exact).abs() / size, DISTANCE_ERROR);
    let (hull_a, hull_b, hulls_met) = (a.hull(), b.hull(), hulls_meet(a, b));
    for (x, y) in [(&hull_a, &hull_b), (&hull_b, &hull_a), (a, &hull_b), (&hull_a, b)] {
        // GJK may take a gap within its error for a touch, but never the reverse.
        let (found, gap) = (intersects(x, y), distance(x, y));
        let both_hulls = x.shape.triangles().is_none() && y.shape.triangles().is_none();
        tally.check(found || !met, || format!("{label}: hulls of what meets are apart"));
        tally.check(!both_hulls || found || !hulls_met, || format!("{label}: hulls that meet are apart"));
        tally.check(hulls_met || !found || gap <= DISTANCE_ERROR * size, || {
            format!("{label}: hulls {gap:e} apart")
        });
        tally.check(found == (gap == 0.0), || format!("{label}: {found}, but a distance of {gap:e}"));
    }
    [met, hulls_met]
}

#[test]
fn fracture_wall() {
    let Some(folder) = folder("models/fracture_wall") else { return };
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "obj"));
    files.sort();
    let pieces: Vec<Body> = files
        .iter()
        .map(|file| Body::new(&file.file_stem().unwrap().to_string_lossy(), &mesh(file), DAffine3::IDENTITY))
        .collect();
    let mut tally = Tally::new("fracture wall");
    let mut met = BTreeSet::new();
    let mut hulls = 0;
    for (j, b) in pieces.iter().enumerate() {
        for (i, a) in pieces[..j].iter().enumerate() {
            let [surfaces_met, hulls_met] = check(&mut tally, a, b);
            hulls += usize::from(hulls_met);
            if surfaces_met {
                met.insert((i, j));
            }
        }
    }
    for broad_phase in [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune] {
        let mut world = World::with_options(&WorldOptions { broad_phase, ..WorldOptions::default() });
        let ids: Vec<ObjectId> = pieces.iter().map(|p| world.add(&p.shape, p.at).unwrap()).collect();
        let index = |id| ids.iter().position(|other| *other == id).unwrap();
        let found: BTreeSet<_> = world.test().iter().map(|c| (index(c.a), index(c.b))).collect();
        tally.check(found == met, || format!("{broad_phase:?}: {:?}", found.symmetric_difference(&met)));
    }
    println!(
        "fracture wall: {} pieces, {} pairs of surfaces meet, {hulls} of hulls",
        pieces.len(),
        met.len()
    );
    tally.finish();
}

/// Offsets on a grid, where coordinates of the two models coincide.
const GRID: [f64; 4] = [-1.5, -0.5, 1.0, 2.0];

/// Along y they are also moved off the grid by this: apart, or into each other.
const HAIRS: [f64; 4] = [0.0, 2e-15, 1e-13, -1e-9];

#[test]
fn erleben() {
    let Some(folder) = folder("models/erleben") else { return };
    let names = ["cliff", "crack", "hole", "internal_edges", "spike", "wedge"];
    let models = names.map(|name| (name, mesh(&folder.join(name).with_extension("obj"))));
    // Turned by nothing, by a quarter turn, upside down: exactly.
    let turns = [
        DMat3::IDENTITY,
        DMat3::from_cols(DVec3::Z, DVec3::X, DVec3::Y),
        DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0)),
    ];
    let mut tally = Tally::new("Erleben's shapes");
    for (name_a, model_a) in &models {
        let a = Body::new(name_a, model_a, DAffine3::IDENTITY);
        for (name_b, model_b) in &models {
            for (turn, offset) in turns.iter().flat_map(|turn| grid().map(move |offset| (turn, offset))) {
                let at = DAffine3 { matrix3: *turn, translation: offset };
                let b = Body::new(&format!("{name_b} turned by {turn}, moved by {offset}"), model_b, at);
                check(&mut tally, &a, &b);
            }
        }
    }
    tally.finish();
}

fn grid() -> impl Iterator<Item = DVec3> {
    let heights = || GRID.into_iter().flat_map(|y| HAIRS.map(|hair| y + hair));
    GRID.into_iter().flat_map(move |x| heights().flat_map(move |y| GRID.map(|z| DVec3::new(x, y, z))))
}
