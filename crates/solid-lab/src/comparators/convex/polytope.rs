use std::sync::OnceLock;

use solid3d::convex::Support;
use solid3d::glam::DVec3;
use solid3d::hull::Hull;

use super::edges::Edges;
use crate::comparators::bsp::BspTree;

/// A convex polyhedron: vertices, the edges at each, and the surface. Space: its own.
#[derive(Clone, Debug)]
pub struct Polytope {
    vertices: Vec<DVec3>,
    neighbour_starts: Vec<u32>,
    neighbours: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    /// Made when first asked for: only solid polytopes have them.
    edges: OnceLock<Edges>,
    /// Made when first asked for.
    bsp_tree: OnceLock<Box<BspTree>>,
}

impl Polytope {
    /// The convex hull of points; `None` for no points.
    pub fn hull_of(points: &[DVec3]) -> Option<Polytope> {
        let hull = Hull::of(points)?;
        let slot = |i: u32| hull.vertices().binary_search(&i).expect("triangles join vertices") as u32;
        let (mut neighbour_starts, mut neighbours) = (vec![0], Vec::new());
        for i in 0..hull.vertices().len() {
            neighbours.extend_from_slice(hull.neighbours(i));
            neighbour_starts.push(neighbours.len() as u32);
        }
        Some(Polytope {
            vertices: hull.vertices().iter().map(|&i| points[i as usize]).collect(),
            neighbour_starts,
            neighbours,
            triangles: hull.triangles().iter().map(|t| t.map(slot)).collect(),
            edges: OnceLock::new(),
            bsp_tree: OnceLock::new(),
        })
    }

    /// All corners.
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// The surface, counter-clockwise seen from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The features and how they touch each other.
    ///
    /// # Panics
    /// When the polytope is not solid.
    pub(super) fn edges(&self) -> &Edges {
        self.edges.get_or_init(|| Edges::of(self))
    }

    /// The planes of the facets as a tree.
    pub(super) fn bsp_tree(&self) -> &BspTree {
        let corners = |t: &[u32; 3]| t.map(|v| self.vertices[v as usize]);
        self.bsp_tree.get_or_init(|| Box::new(BspTree::of_triangles(self.triangles.iter().map(corners))))
    }

    /// The vertices joined to one by an edge.
    pub fn neighbours(&self, vertex: u32) -> &[u32] {
        let i = vertex as usize;
        &self.neighbours[self.neighbour_starts[i] as usize..self.neighbour_starts[i + 1] as usize]
    }

    /// The vertex farthest along `d`, by looking at all; ties go to the first.
    pub fn scan(&self, d: DVec3) -> u32 {
        let mut best = (f64::NEG_INFINITY, 0);
        for (i, p) in self.vertices.iter().enumerate() {
            let height = d.dot(*p);
            if height > best.0 {
                best = (height, i as u32);
            }
        }
        best.1
    }

    /// The vertex farthest along `d`, by walking along edges uphill from `start` (thesis, section 4.4.2). Rising strictly, it
    /// meets no vertex twice.
    pub fn climb(&self, d: DVec3, start: u32) -> u32 {
        let mut best = (d.dot(self.vertices[start as usize]), start);
        loop {
            let from = best.1;
            for &i in self.neighbours(from) {
                let height = d.dot(self.vertices[i as usize]);
                if height > best.0 {
                    best = (height, i);
                }
            }
            if best.1 == from {
                return from;
            }
        }
    }
}

impl Support for Polytope {
    fn support(&self, direction: DVec3) -> DVec3 {
        self.vertices[self.scan(direction) as usize]
    }

    fn reach(&self) -> DVec3 {
        self.vertices.iter().fold(DVec3::ZERO, |reach, p| reach.max(p.abs()))
    }

    fn center(&self) -> DVec3 {
        self.vertices.iter().sum::<DVec3>() / self.vertices.len() as f64
    }
}
