//! What can be wrong with what the caller gave.

use glam::DVec3;
use solid_convex::{MAGNITUDE_MAX, MAGNITUDE_MIN, SizeError};

use crate::polygon::PolygonError;
use crate::shape::OpenEdges;
use crate::world::ObjectId;

/// Bad input. The message names the argument, its value and its limit; nothing was changed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A radius, height or size is out of range.
    #[error(transparent)]
    Size(#[from] SizeError),
    /// A polygon that is not flat or not simple.
    #[error("primitive {primitive}: {error}")]
    Polygon {
        /// The primitive's place, in the order in which they were given.
        primitive: usize,
        /// What is wrong with it. Vertices and edges are told by their places around it.
        error: PolygonError,
    },
    /// A shape without any vertex.
    #[error("{argument} is empty; a shape needs at least one vertex")]
    NoVertices {
        /// The argument's name.
        argument: &'static str,
    },
    /// A shape without any primitive: no triangle in a mesh, nothing in a complex shape.
    #[error("{argument} is empty; a shape needs at least one primitive")]
    NoPrimitives {
        /// The argument's name.
        argument: &'static str,
    },
    /// A vertex is not finite, or too far out.
    #[error(
        "vertex {index} is {}; each coordinate must be finite and at most {MAGNITUDE_MAX:e} in magnitude",
        coordinates(value)
    )]
    Vertex {
        /// Its place in the buffer.
        index: usize,
        /// Its position.
        value: DVec3,
    },
    /// A primitive names a vertex that is not there.
    #[error("primitive {primitive} names vertex {index}, but {}", there_are_vertices(*vertices))]
    VertexIndex {
        /// The primitive's place, in the order in which they were given.
        primitive: usize,
        /// The index.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A primitive has too few vertices.
    #[error("primitive {primitive} has {}; it needs at least {least}", counted_vertices(*count))]
    PrimitiveSize {
        /// The primitive's place, in the order in which they were given.
        primitive: usize,
        /// How many vertices it has.
        count: usize,
        /// How many it needs.
        least: usize,
    },
    /// More vertices, primitives, indices or objects than there are numbers for.
    #[error("{argument} has {count} elements; the limit is {limit}")]
    TooMany {
        /// The argument's name.
        argument: &'static str,
        /// How many it has.
        count: usize,
        /// How many it may have.
        limit: usize,
    },
    /// A deformation with another number of vertices than the shape has.
    #[error(
        "positions has {}, but the shape has {}",
        counted(*count, "element", "elements"),
        counted_vertices(*expected)
    )]
    PositionCount {
        /// How many were given.
        count: usize,
        /// How many the shape has.
        expected: usize,
    },
    /// A shape that has no vertex buffer was to be deformed.
    #[error("a {kind} has no vertex buffer; only meshes and complex shapes deform")]
    NotDeformable {
        /// The shape's kind.
        kind: crate::ShapeKind,
    },
    /// A mesh that is not closed was to be solid.
    #[error(
        "mesh is not closed: of its edges, {} must be run through by as many triangles one way as the other: {edges}",
        edges.len()
    )]
    OpenMesh {
        /// The edges where it is not.
        edges: OpenEdges,
    },
    /// A shape of another kind stands where only a mesh may.
    #[error("shape is a {kind}; it must be a mesh")]
    NotAMesh {
        /// The shape's kind.
        kind: crate::ShapeKind,
    },
    /// A deformation would open a solid.
    #[error(
        "vertices {} and {} of a solid are one place and must stay so; positions puts them at {} and {}",
        vertices[0],
        vertices[1],
        coordinates(&positions[0]),
        coordinates(&positions[1])
    )]
    TornSolid {
        /// Two vertices that had the same position when the mesh was made solid.
        vertices: [u32; 2],
        /// Their new positions.
        positions: [DVec3; 2],
    },
    /// The intersection curve was asked for of a shape that has no flat facets.
    #[error(
        "{argument} is a {kind}, whose surface is curved; an intersection curve is between boxes, convex hulls, meshes and \
         complex shapes"
    )]
    NoFacets {
        /// The argument's name.
        argument: &'static str,
        /// The shape's kind.
        kind: crate::ShapeKind,
    },
    /// A point or a vector has a coordinate that is not finite, or too large.
    #[error(
        "{argument} is {}; each coordinate must be finite and at most {MAGNITUDE_MAX:e} in magnitude",
        coordinates(value)
    )]
    Coordinates {
        /// The argument's name.
        argument: &'static str,
        /// Its value.
        value: DVec3,
    },
    /// A direction is zero, or too short to be one.
    #[error(
        "{argument} is {}; it needs a coordinate of at least {MAGNITUDE_MIN:e} in magnitude",
        coordinates(value)
    )]
    NoDirection {
        /// The argument's name.
        argument: &'static str,
        /// Its value.
        value: DVec3,
    },
    /// A limit is negative or not a number.
    #[error("{argument} is {value:?}; it must be at least 0")]
    Negative {
        /// The argument's name.
        argument: &'static str,
        /// Its value.
        value: f64,
    },
    /// A clearance is negative, not a number, or too large.
    #[error("clearance is {value:?}; it must be from 0 to {MAGNITUDE_MAX:e}")]
    Clearance {
        /// Its value.
        value: f64,
    },
    /// A tolerance is out of range.
    #[error("{argument} is {value:?}; it must be from {least:e} to 1")]
    Tolerance {
        /// The argument's name.
        argument: &'static str,
        /// Its value.
        value: f64,
        /// The least that it may be.
        least: f64,
    },
    /// Two shapes that should be the ends of one motion are different ones.
    #[error("the two shapes of {argument} are a {} and a {}, or of different origin; each must be a deformed clone of the other, or the same", kinds[0], kinds[1])]
    NotADeformation {
        /// The argument's name.
        argument: &'static str,
        /// The kinds of the two.
        kinds: [crate::ShapeKind; 2],
    },
    /// A placement has an entry that is not finite, or too large.
    #[error(
        "{argument} has the entry {value:?}; each must be finite and at most {MAGNITUDE_MAX:e} in magnitude"
    )]
    PlacementEntry {
        /// The argument's name.
        argument: &'static str,
        /// The entry.
        value: f64,
    },
    /// A placement flattens space.
    #[error(
        "{argument} is singular: its axes are {}, {}, {}; each needs a direction of its own, out of the plane of the \
         others, and a coordinate of at least {MAGNITUDE_MIN:e} in magnitude",
        coordinates(x),
        coordinates(y),
        coordinates(z)
    )]
    SingularPlacement {
        /// The argument's name.
        argument: &'static str,
        /// The image of the axis x.
        x: DVec3,
        /// The image of the axis y.
        y: DVec3,
        /// The image of the axis z.
        z: DVec3,
    },
    /// An object that is not in the world, or no longer.
    #[error("{argument} is {id:?}, which is not in this world (removed, or of another world)")]
    UnknownObject {
        /// The argument's name.
        argument: &'static str,
        /// The object.
        id: ObjectId,
    },
    /// A pair of an object with itself.
    #[error("a pair needs two objects, but both are {id:?}")]
    SameObject {
        /// The object.
        id: ObjectId,
    },
}

/// Three coordinates, short also when they are huge.
pub(crate) fn coordinates(v: &DVec3) -> String {
    format!("({:?}, {:?}, {:?})", v.x, v.y, v.z)
}

/// `1 element`, `2 elements`.
fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// `1 vertex`, `2 vertices`.
pub(crate) fn counted_vertices(count: usize) -> String {
    counted(count, "vertex", "vertices")
}

/// `there is 1 vertex`, `there are 2 vertices`.
pub(crate) fn there_are_vertices(count: usize) -> String {
    format!("there {} {}", if count == 1 { "is" } else { "are" }, counted_vertices(count))
}

/// A result whose error names what was wrong with the input.
pub type Result<T> = std::result::Result<T, Error>;

/// Refuses what is negative or not a number.
pub(crate) fn at_least_zero(argument: &'static str, value: f64) -> Result<()> {
    if value >= 0.0 { Ok(()) } else { Err(Error::Negative { argument, value }) }
}

/// Refuses coordinates that are not finite or out of range.
pub(crate) fn bounded(argument: &'static str, value: DVec3) -> Result<()> {
    match value.abs().cmple(DVec3::splat(MAGNITUDE_MAX)).all() {
        true => Ok(()),
        false => Err(Error::Coordinates { argument, value }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nouns_agree_with_their_number() {
        let index = |vertices| Error::VertexIndex { primitive: 0, index: 4, vertices }.to_string();
        assert_eq!(index(1), "primitive 0 names vertex 4, but there is 1 vertex");
        assert_eq!(index(2), "primitive 0 names vertex 4, but there are 2 vertices");
        let size = |count| Error::PrimitiveSize { primitive: 0, count, least: 3 }.to_string();
        assert_eq!(size(1), "primitive 0 has 1 vertex; it needs at least 3");
        assert_eq!(size(0), "primitive 0 has 0 vertices; it needs at least 3");
        let positions = |count, expected| Error::PositionCount { count, expected }.to_string();
        assert_eq!(positions(1, 2), "positions has 1 element, but the shape has 2 vertices");
        assert_eq!(positions(2, 1), "positions has 2 elements, but the shape has 1 vertex");

        let chain = || "outer".to_owned();
        let index = |vertices| PolygonError::VertexIndex { chain: chain(), index: 4, vertices }.to_string();
        assert_eq!(index(1), "outer names vertex 4, but there is 1 vertex");
        let size = |count| PolygonError::TooFewVertices { chain: chain(), count }.to_string();
        assert_eq!(size(1), "outer has 1 vertex; a closed chain needs at least 3");
        assert_eq!(size(2), "outer has 2 vertices; a closed chain needs at least 3");
    }
}
