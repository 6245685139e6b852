//! IndexedLineSet.

use super::{Builder, Coordinates, Geometry};
use crate::error::SceneError;
use crate::soup::Soup;
use crate::vrml::graph::Node;

impl Builder<'_> {
    /// A segment from each point of a polyline to the next.
    pub(super) fn line_set(&mut self, node: Node) -> Result<Option<Geometry>, SceneError> {
        let Coordinates { points, deformation } = self.coordinates(node)?;
        let mut segments = Vec::new();
        for polyline in self.graph.integers(node, "coordIndex").split(|&index| index == -1) {
            let vertices = self.vertices(node, polyline, points.len())?;
            segments.extend(vertices.windows(2).map(|pair| [pair[0], pair[1]]));
        }
        self.soup(node, Soup { vertices: points, segments, ..Soup::default() }, deformation)
    }
}
