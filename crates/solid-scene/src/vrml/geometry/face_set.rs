//! IndexedFaceSet.

use super::{Builder, Coordinates, Geometry};
use crate::error::SceneError;
use crate::soup::Soup;
use crate::vrml::graph::Node;

impl Builder<'_> {
    /// The vertices are the points of the Coordinate node, all and in its order, so that they deform with it.
    ///
    /// The field `convex` is not believed: each face is looked at. A face whose corners coincide stays, as degenerate
    /// triangles: exporters write points and edges that way.
    pub(super) fn face_set(&mut self, node: Node) -> Result<Option<Geometry>, SceneError> {
        let Coordinates { points, deformation } = self.coordinates(node)?;
        let mut soup = Soup { vertices: points, ..Soup::default() };
        let graph = self.graph;
        let (mut small, mut folded) = (0, 0);
        for face in graph.integers(node, "coordIndex").split(|&index| index == -1) {
            let corners = self.vertices(node, face, soup.vertices.len())?;
            match corners.len() {
                0 => {}
                1 | 2 => small += 1,
                _ => folded += usize::from(Self::face(&corners, &mut soup)),
            }
        }
        if small > 0 {
            let faces = if small == 1 { "1 face has".to_owned() } else { format!("{small} faces have") };
            self.warn(node, format!("{faces} fewer than three corners; passed over"));
        }
        self.warn_of_folded(node, folded);
        self.soup(node, soup, deformation)
    }
}
