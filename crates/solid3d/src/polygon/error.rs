//! What can be wrong with a polygon.

use glam::DVec3;
use solid_convex::MAGNITUDE_MAX;

use crate::error::{coordinates, counted_vertices, there_are_vertices};

/// Vertices that make no polygon. The message names what, where and the limit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PolygonError {
    /// Fewer than three vertices.
    #[error("{chain} has {}; a closed chain needs at least 3", counted_vertices(*count))]
    TooFewVertices {
        /// Which chain: `polygon`, `outer`, or `hole 0`.
        chain: String,
        /// How many vertices it has.
        count: usize,
    },
    /// A vertex is not finite, or too far out.
    #[error(
        "vertex {index} is {}; each coordinate must be finite and at most {MAGNITUDE_MAX:e} in magnitude",
        coordinates(value)
    )]
    Vertex {
        /// Its place in the chain.
        index: usize,
        /// Its position.
        value: DVec3,
    },
    /// A chain names a vertex that is not there.
    #[error("{chain} names vertex {index}, but {}", there_are_vertices(*vertices))]
    VertexIndex {
        /// Which chain: `outer`, or `hole 0`.
        chain: String,
        /// The index.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// The vertices do not lie in a plane.
    #[error("vertex {index} is {deviation:e} off the plane of the polygon; at most {tolerance:e} is allowed")]
    NotFlat {
        /// The vertex that is farthest off.
        index: usize,
        /// Its distance from the plane.
        deviation: f64,
        /// What was allowed.
        tolerance: f64,
    },
    /// Two edges cross. Edges are named by their first vertices' places in the chain.
    #[error(
        "edges {first} and {second} of the polygon cross; a simple polygon's edges may touch but not cross"
    )]
    NotSimple {
        /// An edge.
        first: usize,
        /// An edge after it.
        second: usize,
    },
    /// A hole is not in the polygon, or is in another hole, or crosses a boundary.
    #[error("hole {hole} is not inside the outer boundary and outside the other holes")]
    HoleOutside {
        /// Its place among the holes.
        hole: usize,
    },
    /// A sphere's centre or radius, or a corner of a box, that no query can be made of.
    #[error("{argument} is {value:?}; {}", limit(argument))]
    Argument {
        /// The argument's name.
        argument: &'static str,
        /// The value it had.
        value: f64,
    },
}

/// What the argument of a query must be.
fn limit(argument: &str) -> String {
    match argument {
        "radius" => format!("it must be from 0 to {MAGNITUDE_MAX:e}"),
        "bounds" => format!("each coordinate must be infinite, or at most {MAGNITUDE_MAX:e} in magnitude"),
        _ => format!("each coordinate must be finite and at most {MAGNITUDE_MAX:e} in magnitude"),
    }
}

impl PolygonError {
    /// The same, of a chain that was made of rings, by the names that its vertices have there; `next` says which comes after each in its ring. The chain
    /// may run backward along an edge.
    pub(super) fn of_rings(self, chain: &[u32], next: &[u32]) -> Self {
        let edge = |i: usize| {
            let [from, to] = [chain[i], chain[(i + 1) % chain.len()]];
            if next[to as usize] == from { to as usize } else { from as usize }
        };
        match self {
            PolygonError::NotFlat { index, deviation, tolerance } => {
                PolygonError::NotFlat { index: chain[index] as usize, deviation, tolerance }
            }
            PolygonError::NotSimple { first, second } => {
                let [one, other] = [edge(first), edge(second)];
                PolygonError::NotSimple { first: one.min(other), second: one.max(other) }
            }
            error => error,
        }
    }
}

/// A result whose error says why vertices make no polygon.
pub type Result<T> = std::result::Result<T, PolygonError>;
