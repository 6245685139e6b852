//! Meshes with holes, degenerate faces, faces through each other: whatever loads can be queried, and its faces intersect
//! as exact arithmetic says.

use std::path::Path;

use glam::{DAffine3, DVec3};
use solid_oracle::mesh_pairs;
use solid_scene::{LoadOptions, Scene};
use solid3d::{BroadPhaseKind, Shape, query};

use crate::data::{folder, for_each_row};
use crate::faces::{intersecting_faces, share_vertex};
use crate::tally::Tally;

/// Offsets of a copy, relative to the extent: along no axis, from a hair to far apart.
const OFFSETS: [f64; 5] = [0.0, 1e-12, 1e-3, 0.1, 3.0];

/// Faces of the largest mesh whose pairs are all found again by brute force.
const BRUTE_FORCE_MAX: usize = 5000;

#[test]
fn queried() {
    let Some(folder) = folder("bad_meshes") else { return };
    let mut tally = Tally::new("bad_meshes, each against itself moved");
    let mut refused = 0;
    for_each_row(&folder.join("expected.csv"), |row| {
        let file = row.text("file");
        match Scene::load(&[folder.join(file)], &LoadOptions::default()) {
            Ok(scene) => {
                for object in scene.objects() {
                    check_self(&mut tally, file, object.shape());
                }
            }
            Err(error) => {
                refused += 1;
                println!("{file} is refused: {}", error.message);
            }
        }
    });
    println!("bad_meshes: {refused} files refused");
    tally.finish();
}

fn check_self(tally: &mut Tally, file: &str, shape: &Shape) {
    let vertices = shape.vertices().unwrap();
    let low = vertices.iter().copied().reduce(DVec3::min).unwrap();
    let high = vertices.iter().copied().reduce(DVec3::max).unwrap();
    let extent = (high - low).length().max(f64::MIN_POSITIVE);
    let reach = extent + low.abs().max(high.abs()).length();
    for offset in OFFSETS {
        let label = format!("{file}, moved by {offset}");
        let (here, shift) = (DAffine3::IDENTITY, DVec3::new(0.48, 0.64, 0.6) * extent * offset);
        let at = DAffine3::from_translation(shift);
        let hit = query::intersects(shape, &here, shape, &at).unwrap();
        let swapped = query::intersects(shape, &at, shape, &here).unwrap();
        let distance = query::distance(shape, &here, shape, &at).unwrap();
        // What the answer is for certain: on itself, and farther than it extends; else what the distance says.
        let expected = if offset == 0.0 { true } else { offset < 2.0 && distance.distance == 0.0 };
        tally.hit(&label, expected, hit);
        tally.check(hit == swapped, || format!("{label}: another answer when swapped"));
        let apart = distance.point_on_a.distance(distance.point_on_b);
        tally.error(&label, (apart - distance.distance).abs() / reach, 1e-12);
        // It can't be farther than a vertex from its own copy.
        tally.error(&label, (distance.distance - shift.length()).max(0.0) / reach, 1e-12);
        let axis = query::separating_axis(shape, &here, shape, &at).unwrap();
        tally.check(axis.is_none() || !hit, || format!("{label}: an axis separates what intersects"));
    }
}

#[test]
fn faces() {
    let Some(folder) = folder("bad_meshes") else { return };
    let mut tally = Tally::new("bad_meshes, intersecting faces");
    for_each_row(&folder.join("expected.csv"), |row| {
        check_faces(&mut tally, &folder, row.text("file"), || {
            Some((
                row.text("triangles_after_fan").parse().ok()?,
                row.text("exactly_intersecting_pairs").parse().ok()?,
            ))
        })
    });
    tally.finish();
}

fn check_faces(tally: &mut Tally, folder: &Path, file: &str, expected: impl Fn() -> Option<(usize, usize)>) {
    let Some((triangles, pairs)) = expected() else { return };
    let Ok(scene) = Scene::load(&[folder.join(file)], &LoadOptions::default()) else { return };
    let [object] = scene.objects() else {
        println!("{file}: {} objects", scene.objects().len());
        return;
    };
    let shape = object.shape();
    if shape.triangles().map(<[_]>::len) != Some(triangles) {
        println!("{file}: {} primitives, expected {triangles} triangles", shape.primitive_count());
        return;
    }
    // The exact answers leave degenerate faces out.
    let faces = intersecting_faces(shape, BroadPhaseKind::DynamicTree);
    let found = faces.iter().filter(|(i, j)| !degenerate(shape, *i) && !degenerate(shape, *j)).count();
    tally.hit(file, pairs > 0, found > 0);
    tally.check(found == pairs, || format!("{file}: {found} pairs, expected {pairs}"));
    if triangles <= BRUTE_FORCE_MAX {
        let exact = brute_force(shape);
        tally.check(faces == exact, || format!("{file}: {faces:?}, exactly {exact:?}"));
    }
}

/// The pairs of faces again, by brute force in rational numbers, degenerate faces included.
fn brute_force(shape: &Shape) -> Vec<(usize, usize)> {
    let (vertices, triangles) = (shape.vertices().unwrap(), shape.triangles().unwrap());
    let pairs = mesh_pairs(vertices, triangles, vertices, triangles);
    let corners = |face: usize| triangles[face].map(|i| vertices[i as usize]);
    pairs
        .into_iter()
        .map(|(i, j)| (i as usize, j as usize))
        .filter(|&(i, j)| i < j && !share_vertex(corners(i), corners(j)))
        .collect()
}

fn degenerate(shape: &Shape, face: usize) -> bool {
    let [a, b, c] = shape.triangles().unwrap()[face].map(|i| shape.vertices().unwrap()[i as usize]);
    (b - a).cross(c - a) == DVec3::ZERO
}
