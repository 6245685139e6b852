use solid3d::glam::{DAffine3, DVec3};

use super::Polytope;
use super::edges::Edges;
use super::lin_canny::Feature;

/// A placed polyhedron and the Voronoi regions of its features. Space: the world; the placement must keep lengths.
pub struct Body<'a> {
    pub shape: &'a Polytope,
    pub placement: &'a DAffine3,
}

impl<'a> Body<'a> {
    pub fn edges(&self) -> &'a Edges {
        self.shape.edges()
    }

    pub fn vertex(&self, v: u32) -> DVec3 {
        self.placement.transform_point3(self.shape.vertices()[v as usize])
    }

    pub fn ends(&self, e: u32) -> [DVec3; 2] {
        self.edges().edges[e as usize].ends.map(|v| self.vertex(v))
    }

    /// The other end of an edge.
    pub fn far_end(&self, e: u32, v: u32) -> DVec3 {
        let [tail, head] = self.edges().edges[e as usize].ends;
        self.vertex(if tail == v { head } else { tail })
    }

    /// Outward, of any length.
    pub fn normal(&self, f: u32) -> DVec3 {
        let [p, q, r] = self.shape.triangles()[f as usize].map(|v| self.shape.vertices()[v as usize]);
        self.placement.transform_vector3((q - p).cross(r - p))
    }

    /// How far above the plane of a face a point is, in lengths of the normal.
    pub fn height(&self, f: u32, x: DVec3) -> f64 {
        self.normal(f).dot(x - self.vertex(self.shape.triangles()[f as usize][0]))
    }

    /// How far a point is on the face's side of the plane through one of its edges and its normal.
    pub fn inside_of_edge(&self, f: u32, e: u32, x: DVec3) -> f64 {
        let [tail, head] = self.ends(e);
        let inward = self.normal(f).cross(head - tail);
        let along = self.edges().edges[e as usize].faces[0] == f;
        (x - tail).dot(if along { inward } else { -inward })
    }

    /// An edge at a vertex in whose direction a point lies, if the point is not in the vertex's region.
    pub fn edge_beyond_vertex(&self, v: u32, x: DVec3) -> Option<u32> {
        let at = self.vertex(v);
        let mut edges = self.edges().of_vertex[v as usize].iter().copied();
        edges.find(|&e| (x - at).dot(self.far_end(e, v) - at) > 0.0)
    }

    /// The neighbour of an edge in whose direction a point lies, if the point is not in the edge's region.
    pub fn feature_beyond_edge(&self, e: u32, x: DVec3) -> Option<Feature> {
        let edge = self.edges().edges[e as usize];
        let [tail, head] = self.ends(e);
        if (x - tail).dot(head - tail) < 0.0 {
            return Some(Feature::Vertex(edge.ends[0]));
        }
        if (x - head).dot(tail - head) < 0.0 {
            return Some(Feature::Vertex(edge.ends[1]));
        }
        edge.faces.into_iter().find(|&f| self.inside_of_edge(f, e, x) > 0.0).map(Feature::Face)
    }
}
