//! Checks of what a shape is built from.

use glam::DVec3;
use solid_convex::MAGNITUDE_MAX;

use crate::error::{Error, Result};
use crate::threads::first_part_where;
use crate::tree::PRIMITIVES_MAX;

/// What 32-bit indices can name.
pub(super) const NAMEABLE_MAX: usize = u32::MAX as usize;

/// Vertices, or triangles, that are checked or copied in one piece.
pub(super) const VERTICES_PART: usize = 1 << 12;

/// So many, of some 1 ns each, are worth another thread.
pub(super) const VERTICES_MANY: usize = 1 << 15;

/// Every coordinate finite and in range.
pub(super) fn vertices(vertices: &[DVec3]) -> Result<()> {
    // What is not a number is not in range either.
    let in_range = |v: &DVec3| {
        (v.x.abs() <= MAGNITUDE_MAX) & (v.y.abs() <= MAGNITUDE_MAX) & (v.z.abs() <= MAGNITUDE_MAX)
    };
    match first_wrong(vertices, in_range) {
        Some(index) => Err(Error::Vertex { index, value: vertices[index] }),
        None => Ok(()),
    }
}

/// The first element that is not right.
fn first_wrong<T: Sync>(items: &[T], is_right: impl Fn(&T) -> bool + Sync + Send) -> Option<usize> {
    // Without a branch within a part: nearly always all are.
    let fails = |part: &[T]| !part.iter().fold(true, |all, item| all & is_right(item));
    let first = first_part_where(items, VERTICES_PART, VERTICES_MANY, fails)? * VERTICES_PART;
    items[first..].iter().position(|item| !is_right(item)).map(|index| first + index)
}

/// At least one, and no more than 32-bit indices can name.
pub(super) fn vertex_count(argument: &'static str, count: usize) -> Result<()> {
    match count {
        0 => Err(Error::NoVertices { argument }),
        _ => at_most(NAMEABLE_MAX, argument, count),
    }
}

/// At least one, and no more than a tree takes.
pub(super) fn primitive_count(argument: &'static str, count: usize) -> Result<()> {
    match count {
        0 => Err(Error::NoPrimitives { argument }),
        _ => at_most(PRIMITIVES_MAX, argument, count),
    }
}

/// No more elements than that.
pub(super) fn at_most(limit: usize, argument: &'static str, count: usize) -> Result<()> {
    if count > limit { Err(Error::TooMany { argument, count, limit }) } else { Ok(()) }
}

/// Every index of a primitive names a vertex.
pub(super) fn indices(primitive: usize, indices: &[u32], vertices: usize) -> Result<()> {
    match indices.iter().find(|&&index| index as usize >= vertices) {
        Some(&index) => Err(Error::VertexIndex { primitive, index, vertices }),
        None => Ok(()),
    }
}

/// Every index of every triangle names a vertex.
pub(super) fn triangles(triangles: &[[u32; 3]], vertices: usize) -> Result<()> {
    let is_named =
        |triangle: &[u32; 3]| triangle.iter().fold(true, |all, &index| all & ((index as usize) < vertices));
    match first_wrong(triangles, is_named) {
        Some(primitive) => indices(primitive, &triangles[primitive], vertices),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Too large to be made in a test, so the counts alone are tested.
    #[test]
    fn what_a_tree_does_not_take_is_refused() {
        assert!(primitive_count("triangles", PRIMITIVES_MAX).is_ok());
        let error = primitive_count("triangles", PRIMITIVES_MAX + 1).unwrap_err();
        assert_eq!(error.to_string(), "triangles has 268435456 elements; the limit is 268435455");
        // Of 32 bits, a machine holds no more.
        assert!(NAMEABLE_MAX.checked_add(1).is_none_or(|count| vertex_count("vertices", count).is_err()));
    }

    /// Law: of many triangles the first that names no vertex is told of.
    #[test]
    fn the_first_wrong_triangle_is_told_of() {
        let mut many = vec![[0, 1, 2]; VERTICES_MANY + 100];
        assert!(triangles(&many, 3).is_ok());
        for wrong in [VERTICES_MANY + 99, VERTICES_PART + 7, 0] {
            many[wrong][1] = 3;
            let error = triangles(&many, 3).unwrap_err().to_string();
            assert_eq!(error, format!("primitive {wrong} names vertex 3, but there are 3 vertices"));
        }
    }
}
