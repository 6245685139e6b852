use std::collections::HashMap;

use super::Polytope;

/// An edge of a polyhedron, as seen from outside with the tail below: the faces to both sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// The vertices.
    pub ends: [u32; 2],
    /// The face that runs along the edge, and the one that runs against it.
    pub faces: [u32; 2],
}

/// The features of a polyhedron and how they touch each other: what a walk from feature to feature needs.
#[derive(Clone, Debug, Default)]
pub struct Edges {
    /// All edges.
    pub edges: Vec<Edge>,
    /// Those of each face, in its order.
    pub of_face: Vec<[u32; 3]>,
    /// Those of each vertex.
    pub of_vertex: Vec<Vec<u32>>,
}

impl Edges {
    /// Of a solid polyhedron; its triangles are its faces, flat facets cut.
    ///
    /// # Panics
    /// When the surface is not closed.
    pub fn of(polytope: &Polytope) -> Self {
        let mut edges: Vec<Edge> = Vec::new();
        let mut slots: HashMap<[u32; 2], u32> = HashMap::new();
        let mut of_face = Vec::new();
        for (face, t) in (0..).zip(polytope.triangles()) {
            of_face.push([0, 1, 2].map(|i| {
                let ends = [t[i], t[(i + 1) % 3]];
                if let Some(&slot) = slots.get(&[ends[1], ends[0]]) {
                    edges[slot as usize].faces[1] = face;
                    return slot;
                }
                let slot = edges.len() as u32;
                slots.insert(ends, slot);
                edges.push(Edge { ends, faces: [face, u32::MAX] });
                slot
            }));
        }
        assert!(edges.iter().all(|edge| edge.faces[1] != u32::MAX), "the surface is closed");
        let mut of_vertex = vec![Vec::new(); polytope.vertices().len()];
        for (slot, edge) in (0..).zip(&edges) {
            for end in edge.ends {
                of_vertex[end as usize].push(slot);
            }
        }
        Edges { edges, of_face, of_vertex }
    }
}
