//! Checks of what a shape is built from.

use glam::DVec3;
use solid_convex::MAGNITUDE_MAX;

use crate::error::{Error, Result};

/// Every coordinate finite and in range.
pub(super) fn vertices(vertices: &[DVec3]) -> Result<()> {
    let in_range = |v: &DVec3| v.is_finite() && v.abs().max_element() <= MAGNITUDE_MAX;
    match vertices.iter().position(|v| !in_range(v)) {
        Some(index) => Err(Error::Vertex { index, value: vertices[index] }),
        None => Ok(()),
    }
}

/// At least one, and no more than 32-bit indices can name.
pub(super) fn vertex_count(argument: &'static str, count: usize) -> Result<()> {
    match count {
        0 => Err(Error::NoVertices { argument }),
        _ => nameable(argument, count),
    }
}

/// At least one, and no more than 32-bit indices can name.
pub(super) fn primitive_count(argument: &'static str, count: usize) -> Result<()> {
    match count {
        0 => Err(Error::NoPrimitives { argument }),
        _ => nameable(argument, count),
    }
}

/// No more elements than 32-bit indices can name.
pub(super) fn nameable(argument: &'static str, count: usize) -> Result<()> {
    if count > u32::MAX as usize { Err(Error::TooMany { argument, count }) } else { Ok(()) }
}

/// Every index of a primitive names a vertex.
pub(super) fn indices(primitive: usize, indices: &[u32], vertices: usize) -> Result<()> {
    match indices.iter().find(|&&index| index as usize >= vertices) {
        Some(&index) => Err(Error::VertexIndex { primitive, index, vertices }),
        None => Ok(()),
    }
}
