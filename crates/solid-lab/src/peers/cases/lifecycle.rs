//! From making a mesh to deforming it, and what it takes to keep.

use solid3d::glam::{DAffine3, DVec3};
use solid3d::{Shape, World};

use super::with_commas;
use crate::inputs::Mesh;
use crate::peers::bench::{Entry, Unit};
use crate::peers::contestants::parry::{double, single};
use crate::peers::contestants::{Library, Ours, Thesis, bytes_of, each};
use crate::peers::{Bench, Kind, Peer};

/// Bytes a triangle of a mesh with everything in it, at most.
const MESH_BYTES_MAX: f64 = 70.0;

/// Bytes an object of a world beyond its shape, at most.
const OBJECT_BYTES_MAX: f64 = 300.0;

/// The mesh and the world whose memory is measured.
const MESH_TRIANGLES: usize = 100_000;
const WORLD_OBJECTS: usize = 100_000;

/// Races on three sizes; then memory.
pub fn measure(bench: &mut Bench) {
    for triangles in [5_000, 100_000, 1_000_000] {
        if triangles == 1_000_000 && !bench.effort.large() {
            continue;
        }
        let torus = Mesh::torus(bench.effort.size(triangles));
        let operations = torus.triangles.len();
        let text = with_commas(triangles);
        let entries = each!(build: Ours, Thesis, double::Parry, single::Parry; (&torus));
        bench.race(&format!("build of {text} triangles, a triangle"), operations, Unit::Nano, entries);
        let entries = each!(refit: Ours, Thesis, double::Parry, single::Parry; (&torus));
        bench.race(&format!("refit of {text} triangles, a triangle"), 2 * operations, Unit::Nano, entries);
    }
    mesh_memory(bench);
    world_memory(bench);
}

/// A copy of the buffers is part of it, for all alike.
fn build<L: Library>(torus: &Mesh) -> Entry {
    let buffers = L::buffers(torus);
    Entry::new(L::PEER, move || {
        std::hint::black_box(L::mesh(buffers.clone()));
        1
    })
}

/// There and back.
fn refit<L: Library>(torus: &Mesh) -> Entry {
    let mut mesh = L::mesh(L::buffers(torus));
    let positions = [0.0, 0.5].map(|t| L::buffers(&Mesh { vertices: torus.deformed(t), ..torus.clone() }));
    Entry::new(L::PEER, move || {
        positions.iter().for_each(|buffers| L::deform(&mut mesh, buffers));
        2
    })
}

fn mesh_memory(bench: &mut Bench) {
    let torus = Mesh::torus(bench.effort.size(MESH_TRIANGLES));
    let mut figures = each!(mesh_bytes: Ours, Thesis, double::Parry, single::Parry; (&torus));
    figures.push((Peer::Limit, MESH_BYTES_MAX));
    bench.figures("memory of a mesh, a triangle", Kind::Memory, "bytes", &figures);
}

/// Vertices and indices included.
fn mesh_bytes<L: Library>(torus: &Mesh) -> (Peer, f64) {
    let (mesh, bytes) = bytes_of(|| L::mesh(L::buffers(torus)));
    drop(mesh);
    (L::PEER, bytes as f64 / torus.triangles.len() as f64)
}

/// Objects of one shape on a grid, far enough from each other that no boxes overlap, after a test.
fn world_memory(bench: &mut Bench) {
    let side = bench.effort.size(WORLD_OBJECTS).isqrt();
    let ball = Shape::sphere(1.0).expect("the radius is valid");
    let (world, bytes) = bytes_of(|| {
        let mut world = World::new();
        for i in 0..side * side {
            let at = DVec3::new((i % side) as f64, (i / side) as f64, 0.0) * 5.0;
            world.add(&ball, DAffine3::from_translation(at)).expect("the placement is valid");
        }
        world.test();
        world.proceed();
        world
    });
    let figures = [(Peer::Ours, bytes as f64 / world.len() as f64), (Peer::Limit, OBJECT_BYTES_MAX)];
    bench.figures("memory of a world, an object", Kind::Memory, "bytes", &figures);
}
