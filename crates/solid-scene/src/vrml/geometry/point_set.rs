//! PointSet.

use super::{Builder, Coordinates, Geometry};
use crate::error::SceneError;
use crate::soup::Soup;
use crate::vrml::graph::Node;

impl Builder<'_> {
    pub(super) fn point_set(&mut self, node: Node) -> Result<Option<Geometry>, SceneError> {
        let Coordinates { points: vertices, deformation } = self.coordinates(node)?;
        // The number of points is below ELEMENTS_MAX.
        let points = (0..vertices.len() as u32).collect();
        self.soup(node, Soup { vertices, points, ..Soup::default() }, deformation)
    }
}
