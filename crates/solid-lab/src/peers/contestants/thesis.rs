use std::collections::HashMap;

use solid3d::Aabb;
use solid3d::convex::Support;
use solid3d::glam::{DAffine3, DVec3};

use super::{AllPairs, Boxes, Coherent, Library, Simulator};
use crate::comparators::broad::{BroadTest, LinkedSweep};
use crate::comparators::convex::{ConvexTest, IsaGjk, Memory, Pair, Polytope, Rules, distance};
use crate::comparators::tree::{self, AlignedBox, Sat, Traversal, Tree, Triangle};
use crate::inputs::{ICollide, Mesh, Polyhedron, Pose};
use crate::peers::Peer;

/// The thesis's design: GJK with Johnson's sub-algorithm, binary AABB trees tested by "SAT lite", incremental sweep and prune.
pub struct Thesis;

/// What the thesis knows.
pub enum Body {
    /// By its support mapping.
    Convex(Polytope),
    /// Triangles under a tree.
    Mesh(Box<Soup>),
}

/// A mesh: its tree, and what a refit reads and writes.
pub struct Soup {
    tree: Tree<AlignedBox>,
    corners: Vec<[u32; 3]>,
    scratch: Vec<Triangle>,
}

/// The tolerance of a distance that the library has.
const DISTANCE_TOLERANCE: f64 = 1e-12;

impl Body {
    fn convex(&self) -> &Polytope {
        match self {
            Body::Convex(polytope) => polytope,
            Body::Mesh(_) => unreachable!("polyhedra are asked of polyhedra only"),
        }
    }
}

fn pair<'a>(a: &'a Body, placement_a: &'a DAffine3, b: &'a Body, placement_b: &'a DAffine3) -> Pair<'a> {
    Pair { a: a.convex(), placement_a, b: b.convex(), placement_b }
}

impl Library for Thesis {
    const PEER: Peer = Peer::Thesis;
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
        Body::Convex(Polytope::hull_of(&polyhedron.vertices).expect("there are vertices"))
    }

    fn mesh((vertices, corners): Self::Buffers) -> Body {
        let triangles = corners.iter().map(|t| t.map(|i| vertices[i as usize])).collect();
        Body::Mesh(Box::new(Soup { tree: Tree::build(triangles, ()), corners, scratch: Vec::new() }))
    }

    fn deform(mesh: &mut Body, (vertices, _): &Self::Buffers) {
        if let Body::Mesh(soup) = mesh {
            let Soup { tree, corners, scratch } = &mut **soup;
            scratch.clear();
            scratch.extend(corners.iter().map(|t| t.map(|i| vertices[i as usize])));
            tree.refit(scratch);
        }
    }

    fn intersects(a: &Body, at_a: &DAffine3, b: &Body, at_b: &DAffine3) -> bool {
        match (a, b) {
            (Body::Mesh(a), Body::Mesh(b)) => {
                Traversal::new(Sat::Lite).intersects(&a.tree, &b.tree, &(at_a.inverse() * *at_b))
            }
            _ => {
                // The origins are inside; the centres of the vertices would have to be computed first.
                let mut fresh = Memory { axis: at_a.translation - at_b.translation, ..Memory::default() };
                IsaGjk::default().intersects(&pair(a, at_a, b, at_b), &mut fresh)
            }
        }
    }

    fn distance(a: &Body, at_a: &DAffine3, b: &Body, at_b: &DAffine3) -> f64 {
        match (a, b) {
            (Body::Mesh(a), Body::Mesh(b)) => {
                let b_to_a = at_a.inverse() * *at_b;
                tree::distance(&a.tree, &b.tree, &b_to_a, &mut tree::Counters::default())
            }
            _ => distance(&pair(a, at_a, b, at_b), &Rules::thesis(DISTANCE_TOLERANCE)).distance,
        }
    }
}

impl Coherent for Thesis {
    type Memory = Memory;

    fn intersects_again(memory: &mut Memory, a: &Body, at_a: &DAffine3, b: &Body, at_b: &DAffine3) -> bool {
        IsaGjk::default().intersects(&pair(a, at_a, b, at_b), memory)
    }
}

impl AllPairs for Thesis {
    fn pair_count(a: &Body, at_a: &DAffine3, b: &Body, at_b: &DAffine3) -> usize {
        match (a, b) {
            (Body::Mesh(a), Body::Mesh(b)) => {
                Traversal::new(Sat::Lite).pairs(&a.tree, &b.tree, &(at_a.inverse() * *at_b)).len()
            }
            _ => unreachable!("triangles are asked of meshes only"),
        }
    }
}

impl Thesis {
    /// How many boxes the walk over two meshes to the first hit tests, and how many triangles.
    pub fn work(a: &Body, at_a: &DAffine3, b: &Body, at_b: &DAffine3) -> [u64; 2] {
        let (Body::Mesh(a), Body::Mesh(b)) = (a, b) else { unreachable!("trees are asked of meshes only") };
        let mut traversal = Traversal::new(Sat::Lite);
        traversal.intersects(&a.tree, &b.tree, &(at_a.inverse() * *at_b));
        [traversal.counters.box_tests, traversal.counters.triangle_tests]
    }
}

impl Boxes for LinkedSweep {
    const PEER: Peer = Peer::Thesis;
    type Bounds = Aabb;

    fn bounds(bounds: &Aabb) -> Aabb {
        *bounds
    }

    fn new(boxes: &[Aabb]) -> Self {
        LinkedSweep::new(boxes)
    }

    fn frame(&mut self, moved: &[(u32, Aabb)]) {
        self.update(moved);
    }

    fn pair_count(&mut self) -> usize {
        self.pairs().len()
    }
}

/// As SOLID: a sweep and prune, and an axis for each pair whose boxes overlap.
pub struct Objects {
    shapes: Vec<Polytope>,
    sweep: LinkedSweep,
    memory: HashMap<(u32, u32), (Memory, u64)>,
    frame: u64,
}

impl Simulator for Thesis {
    type World = Objects;

    fn world(simulation: &ICollide) -> Objects {
        let shapes: Vec<Polytope> = simulation
            .shapes
            .iter()
            .map(|shape| Polytope::hull_of(&shape.vertices).expect("there are vertices"))
            .collect();
        let poses = simulation.poses();
        let boxes: Vec<Aabb> = poses
            .iter()
            .zip(shapes.iter().cycle())
            .map(|(pose, shape)| enclosing(shape, &pose.affine()))
            .collect();
        Objects { shapes, sweep: LinkedSweep::new(&boxes), memory: HashMap::new(), frame: 0 }
    }

    fn frame(objects: &mut Objects, poses: &[DAffine3]) -> Vec<(u32, u32)> {
        let Objects { shapes, sweep, memory, frame } = objects;
        *frame += 1;
        let moved: Vec<(u32, Aabb)> = (0..)
            .zip(poses.iter().zip(shapes.iter().cycle()))
            .map(|(i, (pose, shape))| (i, enclosing(shape, pose)))
            .collect();
        sweep.update(&moved);
        let mut pairs = sweep.pairs();
        pairs.retain(|&(i, j)| {
            let [a, b] = [i, j].map(|i| &shapes[i as usize % shapes.len()]);
            let [placement_a, placement_b] = [i, j].map(|i| &poses[i as usize]);
            let (axis, seen) = memory.entry((i, j)).or_default();
            *seen = *frame;
            IsaGjk::default().intersects(&Pair { a, placement_a, b, placement_b }, axis)
        });
        memory.retain(|_, (_, seen)| *seen == *frame);
        pairs
    }
}

/// The box of a placed shape, by its support mapping (thesis, section 6.3.4).
fn enclosing(shape: &Polytope, placement: &DAffine3) -> Aabb {
    let reach = |direction: DVec3| {
        let local = placement.matrix3.mul_transpose_vec3(direction);
        placement.transform_point3(shape.support(local)).dot(direction)
    };
    let [min, max] =
        [-1.0, 1.0].map(|sign| DVec3::from_array(DVec3::AXES.map(|axis| sign * reach(sign * axis))));
    Aabb::new(min, max)
}
