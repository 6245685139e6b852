//! The faces of one mesh against each other, as objects of a world.

use std::collections::HashMap;

use glam::{DAffine3, DVec3};
use solid3d::{BroadPhaseKind, ObjectId, Response, Shape, World, WorldOptions};

/// Every pair of faces that share a point but no vertex, where vertices at the same place are the same; the lesser first.
pub(crate) fn intersecting_faces(mesh: &Shape, broad_phase: BroadPhaseKind) -> Vec<(usize, usize)> {
    let (vertices, triangles) = (mesh.vertices().unwrap(), mesh.triangles().unwrap());
    let options = WorldOptions { broad_phase, default_response: Response::Simple, ..WorldOptions::default() };
    let mut world = World::with_options(&options);
    let mut faces: HashMap<ObjectId, usize> = HashMap::new();
    for (face, triangle) in triangles.iter().enumerate() {
        let corners = triangle.map(|i| vertices[i as usize]);
        let shape = Shape::mesh(corners, [[0, 1, 2]]).unwrap();
        faces.insert(world.add(&shape, DAffine3::IDENTITY).unwrap(), face);
    }
    let corners = |face: usize| triangles[face].map(|i| vertices[i as usize]);
    let collisions = world.test();
    let pairs = collisions.iter().map(|collision| (faces[&collision.a], faces[&collision.b]));
    pairs.filter(|&(i, j)| !share_vertex(corners(i), corners(j))).collect()
}

/// Whether two faces have a corner at the same place.
pub(crate) fn share_vertex(a: [DVec3; 3], b: [DVec3; 3]) -> bool {
    a.iter().any(|corner| b.contains(corner))
}
