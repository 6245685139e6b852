//! What contacts are given as.

use glam::DVec3;
use smallvec::SmallVec;

/// A part of the surface of a shape. Its number stays with the shape however it moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Feature {
    /// A vertex: by its place in [`Shape::vertices`](crate::Shape::vertices); of a box, of the rims of cones and cylinders and of
    /// the ends of capsules by a number of its own.
    Vertex(u32),
    /// An edge between two vertices, the lesser first.
    Edge(u32, u32),
    /// A face, by a number of its own; of a mesh, the front (0) or back (1) of a triangle.
    Face(u32),
}

impl Feature {
    /// The edge between two vertices, in either order.
    pub(super) fn edge(i: u32, j: u32) -> Feature {
        Feature::Edge(i.min(j), i.max(j))
    }
}

/// A point of contact of two shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// The point of the first shape. Space: world.
    pub point_on_a: DVec3,
    /// The point of the second shape, off the first by the depth along the normal; to within 0.001 of the depth where a region joins
    /// normals, which differ by up to 0.001 rad. Space: world.
    pub point_on_b: DVec3,
    /// How deep the surfaces are in each other here, along the normal; negative for a gap. World units.
    pub depth: f64,
    /// The primitive of each shape; 0 for a convex shape.
    pub primitives: [u32; 2],
    /// The part of each primitive that the point is of. With `primitives` it names the contact from frame to frame.
    pub features: [Feature; 2],
}

/// Contacts of two shapes that have one normal: a region of their surfaces.
#[derive(Clone, Debug, PartialEq)]
pub struct Manifold {
    /// The unit normal, from `b` to `a`. Space: world.
    pub normal: DVec3,
    /// The points, at least one. Corners of the region in which the surfaces face each other. One alone, as a ball always has, takes no memory of its own.
    pub points: SmallVec<[ContactPoint; 1]>,
}

/// Which contacts are wanted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactOptions {
    /// Surfaces that are apart by no more than this are in contact, with a negative depth: what a solver needs to stop them in time. At
    /// least 0; 0 by default. World units.
    pub margin: f64,
    /// The most points of a manifold: the deepest, and those furthest from it and each other. At least one is kept. `None`, which is the
    /// default, for all of them. Cost: the product of how many there are and how many are kept.
    pub max_points: Option<usize>,
}
