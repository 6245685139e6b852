//! The contestants, behind the traits of what they can do.
//!
//! Inputs are brought into each library's own types before anything is timed.

mod memory;
mod ours;
pub mod parry;
mod thesis;

pub use memory::bytes_of;
pub use ours::Ours;
pub use thesis::Thesis;

use solid3d::Aabb;
use solid3d::glam::DVec3;

use super::Peer;
use crate::inputs::{ICollide, Mesh, Polyhedron, Pose, Primitive};

/// Calls a function once for each type of contestant: `each!(f: Ours, Thesis; (arguments))`.
macro_rules! each {
    ($f:ident : $($library:ty),+ ; $arguments:tt) => {
        vec![$($f::<$library> $arguments),+]
    };
}
pub(super) use each;

/// What can place two shapes and ask whether they meet, and how far apart they are.
pub trait Library: 'static {
    /// Whose it is.
    const PEER: Peer;
    /// A shape of any kind.
    type Shape: 'static;
    /// Where a shape is.
    type Pose: Copy + 'static;
    /// Positions and triangles, not yet a mesh.
    type Buffers: Clone + 'static;

    /// A pose in the library's numbers.
    fn pose(pose: &Pose) -> Self::Pose;
    /// Buffers in the library's numbers.
    fn buffers(mesh: &Mesh) -> Self::Buffers;
    /// A convex polyhedron.
    fn polyhedron(polyhedron: &Polyhedron) -> Self::Shape;
    /// A mesh with everything that queries need.
    fn mesh(buffers: Self::Buffers) -> Self::Shape;
    /// Moves the vertices of a mesh to the positions in the buffers.
    fn deform(mesh: &mut Self::Shape, buffers: &Self::Buffers);
    /// Whether two shapes of one class, polyhedra or meshes, meet.
    fn intersects(a: &Self::Shape, at_a: &Self::Pose, b: &Self::Shape, at_b: &Self::Pose) -> bool;
    /// How far apart they are; 0 when they meet.
    fn distance(a: &Self::Shape, at_a: &Self::Pose, b: &Self::Shape, at_b: &Self::Pose) -> f64;
}

/// What says how deep two polyhedra are in each other.
pub trait Depths: Library {
    /// How deep; `None` when they do not meet.
    fn depth(a: &Self::Shape, at_a: &Self::Pose, b: &Self::Shape, at_b: &Self::Pose) -> Option<f64>;
}

/// What knows primitives too, and every class against every other.
pub trait Primitives: Library {
    /// A primitive.
    fn primitive(primitive: Primitive) -> Self::Shape;
}

/// What remembers something about a pair of polyhedra from frame to frame.
pub trait Coherent: Library {
    /// What it remembers; at first nothing.
    type Memory: Default + 'static;

    /// Whether they meet, as in [`Library::intersects`].
    fn intersects_again(
        memory: &mut Self::Memory,
        a: &Self::Shape,
        at_a: &Self::Pose,
        b: &Self::Shape,
        at_b: &Self::Pose,
    ) -> bool;

    /// How far apart they are, as in [`Library::distance`]. Without a memory of its own, it is that.
    fn distance_again(
        _: &mut Self::Memory,
        a: &Self::Shape,
        at_a: &Self::Pose,
        b: &Self::Shape,
        at_b: &Self::Pose,
    ) -> f64 {
        Self::distance(a, at_a, b, at_b)
    }
}

/// What finds all pairs of triangles of two meshes that meet.
pub trait AllPairs: Library {
    /// How many.
    fn pair_count(a: &Self::Shape, at_a: &Self::Pose, b: &Self::Shape, at_b: &Self::Pose) -> usize;
}

/// What casts rays.
pub trait Rays: Library {
    /// A ray, or what it takes to cast one.
    type Ray: 'static;

    /// From a point along a unit vector.
    fn ray(origin: DVec3, direction: DVec3) -> Self::Ray;
    /// How far along the ray the surface of a mesh is.
    fn closest(mesh: &Self::Shape, ray: &Self::Ray) -> Option<f64>;
}

/// What keeps the overlapping pairs of moving boxes.
pub trait Boxes: 'static {
    /// Whose it is.
    const PEER: Peer;
    /// A box in the library's numbers.
    type Bounds: Copy + 'static;

    /// A box in the library's numbers.
    fn bounds(bounds: &Aabb) -> Self::Bounds;
    /// Over boxes numbered from 0.
    fn new(boxes: &[Self::Bounds]) -> Self;
    /// Moves some, and brings the pairs up to date.
    fn frame(&mut self, moved: &[(u32, Self::Bounds)]);
    /// How many pairs overlap.
    fn pair_count(&mut self) -> usize;
}

/// What simulates many polyhedra.
pub trait Simulator: Library {
    /// The objects and all that is kept of them.
    type World: 'static;

    /// The objects of the simulation where they are.
    fn world(simulation: &ICollide) -> Self::World;
    /// Moves all and finds the pairs that collide.
    fn frame(world: &mut Self::World, poses: &[Self::Pose]) -> Vec<(u32, u32)>;
}
