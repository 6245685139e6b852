use solid3d::glam::DVec3;

use super::parry::bounding_volume::Aabb;
use super::parry::math::{Pose, Rotation, Vector};
use super::parry::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};
use super::parry::query::details::intersection_test_support_map_support_map_with_params as meet_along;
use super::parry::query::gjk::VoronoiSimplex;
use super::parry::query::{self, Ray};
use super::parry::shape::{Ball, Capsule, ConvexPolyhedron, Cuboid, Shape, TriMesh};
use super::{PEER, Real, double, real};
use crate::inputs::{self, ICollide, Mesh, Polyhedron, Primitive};
use crate::peers::Peer;
use crate::peers::contestants::{Boxes, Coherent, Depths, Library, Primitives, Rays, Simulator};

/// parry's shapes and queries.
pub struct Parry;

/// A point or a direction in its numbers.
pub fn vector(v: DVec3) -> Vector {
    Vector::new(real(v.x), real(v.y), real(v.z))
}

fn aabb(bounds: &solid3d::Aabb) -> Aabb {
    Aabb::new(vector(bounds.min), vector(bounds.max))
}

fn convex(polyhedron: &Polyhedron) -> ConvexPolyhedron {
    let points = polyhedron.vertices.iter().copied().map(vector).collect();
    let triangles = polyhedron.hull.triangles();
    ConvexPolyhedron::from_convex_mesh(points, triangles).expect("the hull is closed and convex")
}

impl Library for Parry {
    const PEER: Peer = PEER;
    type Shape = Box<dyn Shape>;
    type Pose = Pose;
    type Buffers = (Vec<Vector>, Vec<[u32; 3]>);

    fn pose(pose: &inputs::Pose) -> Pose {
        let [x, y, z, w] = pose.rotation.to_array().map(real);
        Pose::from_parts(vector(pose.translation), Rotation::from_xyzw(x, y, z, w).normalize())
    }

    fn buffers(mesh: &Mesh) -> Self::Buffers {
        (mesh.vertices.iter().copied().map(vector).collect(), mesh.triangles.clone())
    }

    fn polyhedron(polyhedron: &Polyhedron) -> Box<dyn Shape> {
        Box::new(convex(polyhedron))
    }

    fn mesh((vertices, triangles): Self::Buffers) -> Box<dyn Shape> {
        Box::new(TriMesh::new(vertices, triangles).expect("the mesh is well formed"))
    }

    fn deform(mesh: &mut Box<dyn Shape>, (vertices, _): &Self::Buffers) {
        mesh.as_trimesh_mut().expect("only meshes are deformed").set_vertices(vertices);
    }

    fn intersects(a: &Box<dyn Shape>, at_a: &Pose, b: &Box<dyn Shape>, at_b: &Pose) -> bool {
        query::intersection_test(at_a, &**a, at_b, &**b).expect("the pair is supported").intersecting
    }

    fn distance(a: &Box<dyn Shape>, at_a: &Pose, b: &Box<dyn Shape>, at_b: &Pose) -> f64 {
        double(query::distance(at_a, &**a, at_b, &**b).expect("the pair is supported").distance)
    }
}

impl Depths for Parry {
    fn depth(a: &Box<dyn Shape>, at_a: &Pose, b: &Box<dyn Shape>, at_b: &Pose) -> Option<f64> {
        let contact = query::contact(at_a, &**a, at_b, &**b, 0.0).expect("the pair is supported");
        contact.map(|contact| double(-contact.dist))
    }
}

impl Primitives for Parry {
    fn primitive(primitive: Primitive) -> Box<dyn Shape> {
        match primitive {
            Primitive::Sphere(radius) => Box::new(Ball::new(real(radius))),
            Primitive::Cuboid(size) => Box::new(Cuboid::new(vector(size / 2.0))),
            Primitive::Capsule(radius, height) => Box::new(Capsule::new_y(real(height / 2.0), real(radius))),
        }
    }
}

impl Coherent for Parry {
    /// The direction in which its search ended.
    type Memory = Option<Vector>;

    fn intersects_again(
        direction: &mut Option<Vector>,
        a: &Box<dyn Shape>,
        at_a: &Pose,
        b: &Box<dyn Shape>,
        at_b: &Pose,
    ) -> bool {
        let (Some(a), Some(b)) = (a.as_support_map(), b.as_support_map()) else {
            unreachable!("memory is kept for polyhedra only")
        };
        let b_in_a = at_a.inv_mul(at_b);
        let (meet, last) = meet_along(&b_in_a, a, b, &mut VoronoiSimplex::new(), *direction);
        *direction = Some(last);
        meet
    }
}

impl Rays for Parry {
    type Ray = Ray;

    fn ray(origin: DVec3, direction: DVec3) -> Ray {
        Ray::new(vector(origin), vector(direction))
    }

    fn closest(mesh: &Box<dyn Shape>, ray: &Ray) -> Option<f64> {
        mesh.cast_local_ray(ray, Real::MAX, false).map(double)
    }
}

/// parry's tree over moving boxes, used as rapier does: leaves of what moved, a refit, a step of its incremental optimisation,
/// then the pairs of which at least one box changed. The pairs that did not change are not kept by it; keeping them is not timed.
pub struct Swarm {
    tree: Bvh,
    workspace: BvhWorkspace,
}

impl Boxes for Swarm {
    const PEER: Peer = PEER;
    type Bounds = Aabb;

    fn bounds(bounds: &solid3d::Aabb) -> Aabb {
        aabb(bounds)
    }

    fn new(boxes: &[Aabb]) -> Self {
        Swarm { tree: Bvh::from_leaves(BvhBuildStrategy::Binned, boxes), workspace: BvhWorkspace::default() }
    }

    fn frame(&mut self, moved: &[(u32, Aabb)]) {
        for (index, bounds) in moved {
            let _ = self.tree.insert_or_update_partially(*bounds, *index, 0.0);
        }
        self.tree.refit(&mut self.workspace);
        self.tree.optimize_incremental(&mut self.workspace);
        let mut count = 0;
        self.tree.traverse_bvtt_single_tree::<true>(&mut self.workspace, &mut |_, _| count += 1);
        std::hint::black_box(count);
    }

    fn pair_count(&mut self) -> usize {
        let mut count = 0;
        self.tree.traverse_bvtt_single_tree::<false>(&mut self.workspace, &mut |_, _| count += 1);
        count
    }
}

/// parry's tree over boxes that all move, so that all pairs are new.
pub struct Crowd {
    tree: Bvh,
    workspace: BvhWorkspace,
}

impl Crowd {
    /// Of the boxes in the order of their numbers.
    pub fn new(boxes: impl Iterator<Item = Aabb>) -> Self {
        let boxes: Vec<Aabb> = boxes.collect();
        Crowd { tree: Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes), workspace: BvhWorkspace::default() }
    }

    /// Calls `found` with the numbers of each pair of boxes that overlap, after all moved.
    pub fn frame(&mut self, boxes: impl Iterator<Item = Aabb>, mut found: impl FnMut(u32, u32)) {
        for (i, bounds) in (0..).zip(boxes) {
            let _ = self.tree.insert_or_update_partially(bounds, i, 0.0);
        }
        self.tree.refit(&mut self.workspace);
        self.tree.optimize_incremental(&mut self.workspace);
        self.tree.traverse_bvtt_single_tree::<false>(&mut self.workspace, &mut found);
    }
}

/// Shapes, and a test of each pair of which the boxes overlap.
pub struct Objects {
    shapes: Vec<ConvexPolyhedron>,
    crowd: Crowd,
}

/// The boxes of shapes that are used in turns.
fn bounds_of<'s>(shapes: &'s [ConvexPolyhedron], poses: &'s [Pose]) -> impl Iterator<Item = Aabb> + 's {
    poses.iter().zip(shapes.iter().cycle()).map(|(pose, shape)| shape.compute_aabb(pose))
}

impl Simulator for Parry {
    type World = Objects;

    fn world(simulation: &ICollide) -> Objects {
        let shapes: Vec<ConvexPolyhedron> = simulation.shapes.iter().map(convex).collect();
        let poses: Vec<Pose> = simulation.poses().iter().map(Self::pose).collect();
        let crowd = Crowd::new(bounds_of(&shapes, &poses));
        Objects { shapes, crowd }
    }

    fn frame(Objects { shapes, crowd }: &mut Objects, poses: &[Pose]) -> Vec<(u32, u32)> {
        let mut pairs = Vec::new();
        crowd.frame(bounds_of(shapes, poses), |i, j| {
            let [a, b] = [i, j].map(|i| &shapes[i as usize % shapes.len()]);
            let [at_a, at_b] = [i, j].map(|i| &poses[i as usize]);
            if query::intersection_test(at_a, a, at_b, b).expect("the pair is supported").intersecting {
                pairs.push((i.min(j), i.max(j)));
            }
        });
        pairs
    }
}
