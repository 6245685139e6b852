//! What makes a mesh the boundary of a solid (thesis, section 3.1.2).
//!
//! The solid is the surface with every point around which it winds: whose *winding number*, the signed count of
//! triangles that a ray from the point crosses, is not 0. That count is the same for every ray if and only if the triangles
//! are a *cycle*: every edge is run through as often in one direction as in the other. So that is what a solid needs, no
//! less and no more: several parts, cavities, edges that four triangles share, and triangles that pass through others are
//! all welcome. Which way round the surface is does not matter.
//!
//! The even-odd rule would need less, and is not what is meant where a surface passes through itself: the parts of a body
//! that overlap would be holes in each other.

use std::collections::HashMap;
use std::fmt::{self, Debug, Display, Formatter};
use std::ops::Deref;

use glam::DVec3;

use crate::error::{Error, Result};

/// An edge of a mesh that has no triangle on one side, or one that runs the wrong way round; see
/// [`Shape::into_solid`](super::Shape::into_solid).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct OpenEdge {
    /// Its ends, the lesser first. Of vertices at the same position, the first one that a triangle names.
    pub vertices: [u32; 2],
    /// How many triangles run through it from the first to the second end.
    pub forward: usize,
    /// How many run through it from the second to the first end: another number.
    pub backward: usize,
}

/// All edges that keep a mesh from being closed, in ascending order: a slice, of which a message, be it for users or for programmers, has the first.
#[derive(Clone, PartialEq, Eq)]
pub struct OpenEdges(Box<[OpenEdge]>);

impl Deref for OpenEdges {
    type Target = [OpenEdge];

    fn deref(&self) -> &[OpenEdge] {
        &self.0
    }
}

impl Display for OpenEdges {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        const SHOWN_MAX: usize = 8;
        for (i, OpenEdge { vertices: [from, to], forward, backward }) in
            self.iter().take(SHOWN_MAX).enumerate()
        {
            let comma = if i > 0 { ", " } else { "" };
            write!(f, "{comma}{from}-{to} ({forward} and {backward})")?;
        }
        match self.len().saturating_sub(SHOWN_MAX) {
            0 => Ok(()),
            more => write!(f, ", and {more} more"),
        }
    }
}

impl Debug for OpenEdges {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "[{self}]")
    }
}

/// What a closed mesh has to keep to stay closed. Invariant: with twins taken for one vertex, the triangles are a cycle.
#[derive(Debug)]
pub(super) struct Solid {
    /// A vertex and an earlier one at the same position.
    twins: Vec<[u32; 2]>,
}

impl Solid {
    /// The indices must be in range. Cost: O(n log n).
    pub fn of(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Result<Solid> {
        let mut first_at = HashMap::new();
        let mut first = vec![u32::MAX; vertices.len()];
        let mut twins = Vec::new();
        for &index in triangles.as_flattened() {
            let welded = &mut first[index as usize];
            if *welded == u32::MAX {
                *welded = *first_at.entry(bits(vertices[index as usize])).or_insert(index);
                if *welded != index {
                    twins.push([*welded, index]);
                }
            }
        }
        let welded = triangles.iter().map(|t| t.map(|index| first[index as usize]));
        let edges = open_edges(welded);
        if edges.is_empty() {
            Ok(Solid { twins })
        } else {
            Err(Error::OpenMesh { edges: OpenEdges(edges.into()) })
        }
    }

    /// Vertices at one position, in pairs: what connects parts of the surface beside their indices.
    pub fn twins(&self) -> &[[u32; 2]] {
        &self.twins
    }

    /// The memory that it owns, in bytes.
    pub fn memory(&self) -> usize {
        size_of::<Solid>() + self.twins.capacity() * size_of::<[u32; 2]>()
    }

    /// Whether the mesh is still closed with other positions: what was at one place must stay at one.
    pub fn check(&self, positions: &[DVec3]) -> Result<()> {
        let at = |index: u32| positions[index as usize];
        match self.twins.iter().find(|&&[i, j]| at(i) != at(j)) {
            Some(&vertices) => Err(Error::TornSolid { vertices, positions: vertices.map(at) }),
            None => Ok(()),
        }
    }
}

/// The position as a key; 0 and -0 are the same.
pub(super) fn bits(position: DVec3) -> [u64; 3] {
    (position + DVec3::ZERO).to_array().map(f64::to_bits)
}

/// The edges that are not run through equally often in both directions, in ascending order. An edge from a vertex to itself
/// is none, so a triangle with two equal vertices counts for nothing.
fn open_edges(triangles: impl Iterator<Item = [u32; 3]>) -> Vec<OpenEdge> {
    let directed = triangles.flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]).filter(|[i, j]| i != j);
    // A direction of `false` is from the lesser to the greater vertex.
    let mut edges: Vec<([u32; 2], bool)> = directed.map(|[i, j]| ([i.min(j), i.max(j)], i > j)).collect();
    edges.sort_unstable();
    let same_edge = edges.chunk_by(|(edge, _), (other, _)| edge == other);
    let counted = same_edge.map(|run| {
        let forward = run.partition_point(|&(_, reversed)| !reversed);
        OpenEdge { vertices: run[0].0, forward, backward: run.len() - forward }
    });
    counted.filter(|edge| edge.forward != edge.backward).collect()
}
