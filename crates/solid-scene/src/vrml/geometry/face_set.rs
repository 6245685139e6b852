//! IndexedFaceSet.

use super::polygon::{Face, Splitter};
use super::{Builder, Coordinates, Geometry};
use crate::error::SceneError;
use crate::vrml::graph::Node;
use crate::vrml::limits::CONCAVE_CORNERS_MAX;

impl Builder<'_> {
    /// The vertices are the points of the Coordinate node, all and in its order, so that they deform with it.
    ///
    /// The field `convex` is not believed: each face is looked at. A face whose corners coincide stays, as degenerate
    /// triangles: exporters write points and edges that way.
    pub(super) fn face_set(&mut self, node: Node) -> Result<Option<Geometry>, SceneError> {
        let Coordinates { points, deformation } = self.coordinates(node)?;
        let graph = self.graph;
        let mut splitter = Splitter::default();
        let (mut corners, mut triangles) = (Vec::new(), Vec::new());
        let mut small = 0;
        for polygon in graph.integers(node, "coordIndex").split(|&index| index == -1) {
            corners.clear();
            for &index in polygon {
                corners.push(self.vertex(node, index, points.len())?);
            }
            if corners.len() < 3 {
                small += usize::from(!polygon.is_empty());
                continue;
            }
            let face = Face { points: &points, corners: &corners };
            if corners.len() > CONCAVE_CORNERS_MAX && !splitter.is_convex(face) {
                let count = corners.len();
                let message =
                    format!("a concave face has {count} corners; the limit is {CONCAVE_CORNERS_MAX}");
                return Err(graph.error(node, message));
            }
            splitter.split(face, &mut triangles);
        }
        if small > 0 {
            self.warn(node, format!("{small} faces have fewer than three corners; passed over"));
        }
        self.mesh(node, points, triangles, deformation)
    }
}
