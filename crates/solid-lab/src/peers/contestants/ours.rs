use solid3d::broad::{BroadPhase, DynamicTree};
use solid3d::convex::{Outcome, Polytope, gjk};
use solid3d::glam::{DAffine3, DVec3};
use solid3d::query::{Ray, RayOptions};
use solid3d::{Aabb, ObjectId, Response, Shape, World, WorldOptions, query};

use super::{AllPairs, Boxes, Coherent, Depths, Library, Primitives, Rays, Simulator};
use crate::inputs::{ICollide, Mesh, Polyhedron, Pose, Primitive};
use crate::peers::Peer;

/// The library.
pub struct Ours;

/// A shape, and for a polyhedron what the algorithms on convex shapes take, since a pair's cache is not to be had of shapes.
pub struct Body {
    shape: Shape,
    polytope: Option<Polytope>,
}

impl Library for Ours {
    const PEER: Peer = Peer::Ours;
    type Shape = Body;
    type Pose = DAffine3;
    type Buffers = (Vec<DVec3>, Vec<[u32; 3]>);

    fn pose(pose: &Pose) -> DAffine3 {
        pose.affine()
    }

    fn buffers(mesh: &Mesh) -> Self::Buffers {
        (mesh.vertices.clone(), mesh.triangles.clone())
    }

    fn polyhedron(polyhedron: &Polyhedron) -> Body {
        Body { shape: polyhedron.shape(), polytope: Polytope::new(polyhedron.vertices.clone()) }
    }

    fn mesh((vertices, triangles): Self::Buffers) -> Body {
        Body { shape: Shape::mesh(vertices, triangles).expect("the mesh is well formed"), polytope: None }
    }

    fn deform(mesh: &mut Body, (vertices, _): &Self::Buffers) {
        mesh.shape.deform(vertices).expect("the positions are finite");
    }

    fn intersects(a: &Body, at_a: &DAffine3, b: &Body, at_b: &DAffine3) -> bool {
        query::intersects(&a.shape, at_a, &b.shape, at_b).expect("the poses are valid")
    }

    fn distance(a: &Body, at_a: &DAffine3, b: &Body, at_b: &DAffine3) -> f64 {
        query::distance(&a.shape, at_a, &b.shape, at_b).expect("the poses are valid").distance
    }
}

impl Depths for Ours {
    fn depth(a: &Body, at_a: &DAffine3, b: &Body, at_b: &DAffine3) -> Option<f64> {
        let found = query::penetration(&a.shape, at_a, &b.shape, at_b).expect("the poses are valid");
        found.map(|found| found.depth)
    }
}

impl Rays for Ours {
    type Ray = Ray;

    fn ray(origin: DVec3, direction: DVec3) -> Ray {
        Ray::new(origin, direction)
    }

    fn closest(mesh: &Body, ray: &Ray) -> Option<f64> {
        let hit = query::cast_ray(&mesh.shape, &DAffine3::IDENTITY, ray, &RayOptions::default());
        hit.expect("the ray is valid").map(|hit| hit.t)
    }
}

impl Primitives for Ours {
    fn primitive(primitive: Primitive) -> Body {
        Body { shape: primitive.shape().expect("the sizes are valid"), polytope: None }
    }
}

impl Coherent for Ours {
    /// The separating axis.
    type Memory = DVec3;

    fn intersects_again(axis: &mut DVec3, a: &Body, at_a: &DAffine3, b: &Body, at_b: &DAffine3) -> bool {
        let (Some(a), Some(b)) = (&a.polytope, &b.polytope) else {
            unreachable!("memory is kept for polyhedra only")
        };
        if gjk::separates(*axis, a, at_a, b, at_b) {
            return false;
        }
        let outcome = gjk::intersection(a, at_a, b, at_b);
        *axis = if let Outcome::Separated { axis } = outcome { axis } else { DVec3::ZERO };
        *axis == DVec3::ZERO
    }
}

impl AllPairs for Ours {
    fn pair_count(a: &Body, at_a: &DAffine3, b: &Body, at_b: &DAffine3) -> usize {
        let curve = query::intersection_curve(&a.shape, at_a, &b.shape, at_b).expect("meshes have facets");
        curve.segments().count()
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
        moved.iter().for_each(|(proxy, bounds)| self.update(*proxy, *bounds));
        self.flush();
    }

    fn pair_count(&mut self) -> usize {
        let mut count = 0;
        self.for_each_pair(&mut |_, _| count += 1);
        count
    }
}

/// A world, its objects by number, and their numbers.
pub struct Objects {
    world: World,
    ids: Vec<ObjectId>,
    numbers: std::collections::HashMap<ObjectId, u32>,
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
        Objects { world, ids, numbers }
    }

    fn frame(Objects { world, ids, numbers }: &mut Objects, poses: &[DAffine3]) -> Vec<(u32, u32)> {
        for (id, pose) in ids.iter().zip(poses) {
            world.set_placement(*id, *pose).expect("the poses are valid");
        }
        let found = world.test();
        world.proceed();
        found.iter().map(|collision| (numbers[&collision.a], numbers[&collision.b])).collect()
    }
}

impl Objects {
    /// The world itself.
    pub fn world(&self) -> &World {
        &self.world
    }
}
