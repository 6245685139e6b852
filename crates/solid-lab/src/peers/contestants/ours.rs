use std::ops::ControlFlow;

use slotmap::SecondaryMap;
use solid3d::broad::{BroadPhase, DynamicTree};
use solid3d::glam::{DAffine3, DVec3};
use solid3d::query::{PairCache, Ray, RayOptions};
use solid3d::{Aabb, Collision, ObjectId, Response, Shape, World, WorldOptions, query};

use super::{AllPairs, Boxes, Coherent, Depths, Library, Primitives, Rays, Simulator};
use crate::inputs::{ICollide, Mesh, Polyhedron, Pose, Primitive};
use crate::peers::Peer;

/// The library.
pub struct Ours;

impl Library for Ours {
    const PEER: Peer = Peer::Ours;
    type Shape = Shape;
    type Pose = DAffine3;
    type Buffers = (Vec<DVec3>, Vec<[u32; 3]>);

    fn pose(pose: &Pose) -> DAffine3 {
        pose.affine()
    }

    fn buffers(mesh: &Mesh) -> Self::Buffers {
        (mesh.vertices.clone(), mesh.triangles.clone())
    }

    fn polyhedron(polyhedron: &Polyhedron) -> Shape {
        polyhedron.shape()
    }

    fn mesh((vertices, triangles): Self::Buffers) -> Shape {
        Shape::mesh(vertices, triangles).expect("the mesh is well formed")
    }

    fn deform(mesh: &mut Shape, (vertices, _): &Self::Buffers) {
        mesh.deform(vertices).expect("the positions are finite");
    }

    fn intersects(a: &Shape, at_a: &DAffine3, b: &Shape, at_b: &DAffine3) -> bool {
        query::intersects(a, at_a, b, at_b).expect("the poses are valid")
    }

    fn distance(a: &Shape, at_a: &DAffine3, b: &Shape, at_b: &DAffine3) -> f64 {
        query::distance(a, at_a, b, at_b).expect("the poses are valid").distance
    }
}

impl Depths for Ours {
    fn depth(a: &Shape, at_a: &DAffine3, b: &Shape, at_b: &DAffine3) -> Option<f64> {
        let found = query::penetration(a, at_a, b, at_b).expect("the poses are valid");
        found.map(|found| found.depth)
    }
}

impl Rays for Ours {
    type Ray = Ray;

    fn ray(origin: DVec3, direction: DVec3) -> Ray {
        Ray::new(origin, direction)
    }

    fn closest(mesh: &Shape, ray: &Ray) -> Option<f64> {
        let hit = query::cast_ray(mesh, &DAffine3::IDENTITY, ray, &RayOptions::default());
        hit.expect("the ray is valid").map(|hit| hit.t)
    }
}

impl Primitives for Ours {
    fn primitive(primitive: Primitive) -> Shape {
        primitive.shape().expect("the sizes are valid")
    }
}

impl Coherent for Ours {
    type Memory = Option<PairCache>;

    fn intersects_again(
        cache: &mut Option<PairCache>,
        a: &Shape,
        at_a: &DAffine3,
        b: &Shape,
        at_b: &DAffine3,
    ) -> bool {
        let cache = cache.get_or_insert_with(|| PairCache::new(a, b));
        cache.intersects(at_a, at_b).expect("the poses are valid")
    }

    fn distance_again(
        cache: &mut Option<PairCache>,
        a: &Shape,
        at_a: &DAffine3,
        b: &Shape,
        at_b: &DAffine3,
    ) -> f64 {
        let cache = cache.get_or_insert_with(|| PairCache::new(a, b));
        cache.distance(at_a, at_b).expect("the poses are valid").distance
    }
}

impl AllPairs for Ours {
    fn pair_count(a: &Shape, at_a: &DAffine3, b: &Shape, at_b: &DAffine3) -> usize {
        let mut count = 0;
        let counted = query::intersecting_primitives(a, at_a, b, at_b, |_, _| {
            count += 1;
            ControlFlow::Continue(())
        });
        counted.expect("the poses are valid");
        count
    }
}

impl Boxes for DynamicTree {
    const PEER: Peer = Peer::Ours;
    type Bounds = Aabb;

    fn bounds(bounds: &Aabb) -> Aabb {
        *bounds
    }

    fn new(boxes: &[Aabb]) -> Self {
        let mut tree = DynamicTree::default();
        boxes.iter().zip(0..).for_each(|(bounds, proxy)| tree.insert(proxy, *bounds));
        tree.flush();
        tree
    }

    fn frame(&mut self, moved: &[(u32, Aabb)]) {
        self.update_many(moved);
        self.flush();
    }

    fn pair_count(&mut self) -> usize {
        let mut count = 0;
        self.for_each_pair(&mut |_, _| count += 1);
        count
    }
}

/// A world, its objects by number, their numbers, and the collisions of the last frame, whose memory is used again.
pub struct Objects {
    world: World,
    ids: Vec<ObjectId>,
    numbers: SecondaryMap<ObjectId, u32>,
    collisions: Vec<Collision>,
}

impl Simulator for Ours {
    type World = Objects;

    fn world(simulation: &ICollide) -> Objects {
        let options = WorldOptions { default_response: Response::Simple, ..WorldOptions::default() };
        let mut world = World::with_options(&options);
        let shapes: Vec<Shape> = simulation.shapes.iter().map(Polyhedron::shape).collect();
        let ids: Vec<ObjectId> = simulation
            .poses()
            .iter()
            .zip(shapes.iter().cycle())
            .map(|(pose, shape)| world.add(shape, pose.affine()).expect("the poses are valid"))
            .collect();
        let numbers = ids.iter().copied().zip(0..).collect();
        Objects { world, ids, numbers, collisions: Vec::new() }
    }

    fn frame(objects: &mut Objects, poses: &[DAffine3]) -> Vec<(u32, u32)> {
        let Objects { world, ids, numbers, collisions } = objects;
        for (id, pose) in ids.iter().zip(poses) {
            world.set_placement(*id, *pose).expect("the poses are valid");
        }
        world.test_into(collisions);
        world.proceed();
        collisions.iter().map(|collision| (numbers[collision.a], numbers[collision.b])).collect()
    }
}

impl Objects {
    /// The world itself.
    pub fn world(&self) -> &World {
        &self.world
    }
}
