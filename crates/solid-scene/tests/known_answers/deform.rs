//! A fox that runs into a bunny: every vertex of both moves in every frame.

use std::path::Path;

use glam::{DAffine3, DVec3};
use solid3d::{BroadPhaseKind, Contact, Response, Shape, World, WorldOptions, query};

use crate::data::{folder, for_each_row, json};
use crate::tally::Tally;

/// The error of the distance relative to itself: the recorded ones have all digits.
const DISTANCE_ERROR: f64 = 1e-12;

#[test]
fn fox_vs_bunny() {
    let Some(folder) = folder("deform") else { return };
    let facts = json(&folder.join("fox_vs_bunny.json"));
    let count = |name: &str| usize::try_from(facts[name].as_u64().unwrap()).unwrap();
    let a = Baked::read(&folder, "A", count("vertsA"));
    let b = Baked::read(&folder, "B", count("vertsB"));
    assert_eq!((a.frames.len(), b.frames.len()), (count("frames"), count("frames")));
    assert_eq!((a.triangles.len(), b.triangles.len()), (count("trisA"), count("trisB")));

    let mut deformed = [a.mesh(0), b.mesh(0)];
    let mut worlds = [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune].map(|broad_phase| {
        let options =
            WorldOptions { broad_phase, default_response: Response::Smart, ..WorldOptions::default() };
        let mut world = World::with_options(&options);
        let ids = [&a, &b].map(|baked| world.add(&baked.mesh(0), DAffine3::IDENTITY).unwrap());
        (world, ids)
    });
    let mut tally = Tally::new("fox_vs_bunny");
    let mut collided = false;
    for_each_row(&folder.join("fox_vs_bunny.csv"), |row| {
        let frame: usize = row.number("frame").unwrap();
        let (label, collide, distance) =
            (format!("frame {frame}"), row.flag("collide"), row.real("distance"));
        for (shape, baked) in deformed.iter_mut().zip([&a, &b]) {
            shape.deform(&baked.frames[frame]).unwrap();
        }
        // A mesh that was deformed is as good as one built anew.
        let fresh = [a.mesh(frame), b.mesh(frame)];
        tally.hit(&label, collide, intersects(&deformed));
        tally.hit(&label, collide, intersects(&fresh));
        for meshes in [&deformed, &fresh] {
            tally.error(&label, (distance_of(meshes) - distance).abs() / distance.max(1.0), DISTANCE_ERROR);
        }
        for (world, ids) in &mut worlds {
            for (id, baked) in ids.iter().zip([&a, &b]) {
                world.deform(*id, &baked.frames[frame]).unwrap();
            }
            let collisions = world.test();
            world.proceed();
            tally.check(collisions.len() == usize::from(collide), || {
                format!("{label}: {} collisions", collisions.len())
            });
            // Smart response has closest points where the frame before was free. Where it was not, others may meet now than did there.
            for collision in &collisions {
                let apart = matches!(collision.contact, Contact::Smart { distance, .. } if distance > 0.0);
                tally.check(apart || collided, || format!("{label}: {:?}", collision.contact));
            }
        }
        collided = collide;
    });
    tally.finish();
}

/// Vertex positions of every frame.
struct Baked {
    frames: Vec<Vec<DVec3>>,
    triangles: Vec<[u32; 3]>,
}

impl Baked {
    fn read(folder: &Path, body: &str, vertices: usize) -> Self {
        let words = |name: &str| words(&folder.join(format!("fox_vs_bunny_{body}{name}")));
        let positions: Vec<DVec3> = words(".f32.bin")
            .chunks_exact(3)
            .map(|xyz| DVec3::from_array([0, 1, 2].map(|i| f64::from(f32::from_bits(xyz[i])))))
            .collect();
        let triangles = words("_tris.u32.bin").chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
        Baked { frames: positions.chunks_exact(vertices).map(<[DVec3]>::to_vec).collect(), triangles }
    }

    fn mesh(&self, frame: usize) -> Shape {
        Shape::mesh(self.frames[frame].clone(), self.triangles.clone()).unwrap()
    }
}

/// Little-endian words of 32 bits.
fn words(path: &Path) -> Vec<u32> {
    let bytes = std::fs::read(path).unwrap();
    bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
}

fn intersects([a, b]: &[Shape; 2]) -> bool {
    query::intersects(a, &DAffine3::IDENTITY, b, &DAffine3::IDENTITY).unwrap()
}

fn distance_of([a, b]: &[Shape; 2]) -> f64 {
    query::distance(a, &DAffine3::IDENTITY, b, &DAffine3::IDENTITY).unwrap().distance
}
