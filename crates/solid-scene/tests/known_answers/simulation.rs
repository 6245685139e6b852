//! Frames of two simulations: which faces of a mesh intersect, exactly; and the bodies that the mesh consists of as objects.

use std::collections::BTreeSet;

use glam::DAffine3;
use solid3d::{BroadPhaseKind, Shape, World, WorldOptions};

use crate::data::{folder, for_each_row, mesh};
use crate::faces::intersecting_faces;
use crate::tally::Tally;

#[test]
fn static_faces() {
    let Some(folder) = folder("ccd/scalable") else { return };
    let mut tally = Tally::new("static_ff");
    for_each_row(&folder.join("static_ff.csv"), |row| {
        let label = format!("{} {}", row.text("scene"), row.text("frame"));
        let mesh = mesh(&folder.join(row.text("scene")).join(row.text("frame")));
        let found = intersecting_faces(&mesh, BroadPhaseKind::DynamicTree);
        let swept = intersecting_faces(&mesh, BroadPhaseKind::SweepAndPrune);
        tally.check(found == swept, || format!("{label}: the broad phases disagree"));
        let expected: usize = row.number("n_intersecting_pairs").unwrap();
        tally.hit(&label, expected > 0, !found.is_empty());
        tally.check(found.len() == expected, || {
            format!("{label}: {} pairs, expected {expected}", found.len())
        });
        check_bodies(&mut tally, &label, &mesh, &found);
    });
    tally.finish();
}

/// Two bodies collide when faces of theirs do.
fn check_bodies(tally: &mut Tally, label: &str, mesh: &Shape, faces: &[(usize, usize)]) {
    let triangles = mesh.triangles().unwrap();
    let body = bodies(mesh.vertices().unwrap().len(), triangles);
    let expected: BTreeSet<_> = faces
        .iter()
        .map(|&(i, j)| (body[triangles[i][0] as usize], body[triangles[j][0] as usize]))
        .filter(|(x, y)| x != y)
        .map(|(x, y)| (x.min(y), x.max(y)))
        .collect();
    let names: BTreeSet<usize> = triangles.iter().map(|t| body[t[0] as usize]).collect();
    let mut world = World::with_options(&WorldOptions::default());
    let mut ids = Vec::new();
    for &name in &names {
        let own: Vec<_> = triangles.iter().copied().filter(|t| body[t[0] as usize] == name).collect();
        let shape = Shape::mesh(mesh.vertices().unwrap(), own).unwrap();
        ids.push((world.add(&shape, DAffine3::IDENTITY).unwrap(), name));
    }
    let name_of = |id| ids.iter().find(|(other, _)| *other == id).unwrap().1;
    let found: BTreeSet<_> =
        world.test().iter().map(|collision| (name_of(collision.a), name_of(collision.b))).collect();
    println!(
        "{label}: {} faces, {} intersecting pairs, {} bodies, {} colliding",
        triangles.len(),
        faces.len(),
        names.len(),
        found.len()
    );
    tally.check(found == expected, || format!("{label}: bodies {found:?}, expected {expected:?}"));
}

/// For each vertex the least vertex that edges connect it with.
fn bodies(vertices: usize, triangles: &[[u32; 3]]) -> Vec<usize> {
    let mut parent: Vec<usize> = (0..vertices).collect();
    let root = |parent: &[usize], mut i: usize| {
        while parent[i] != i {
            i = parent[i];
        }
        i
    };
    for &[a, b, c] in triangles {
        let roots = [a, b, c].map(|i| root(&parent, i as usize));
        let least = roots[0].min(roots[1]).min(roots[2]);
        for i in roots {
            parent[i] = least;
        }
    }
    (0..vertices).map(|i| root(&parent, i)).collect()
}
