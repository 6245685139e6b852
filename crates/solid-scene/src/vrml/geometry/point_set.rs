//! PointSet.

use solid3d::ComplexShapeBuilder;

use super::{Builder, Coordinates, Geometry};
use crate::error::SceneError;
use crate::vrml::graph::Node;

impl Builder<'_> {
    pub(super) fn point_set(&mut self, node: Node) -> Result<Option<Geometry>, SceneError> {
        let Coordinates { points, deformation } = self.coordinates(node)?;
        if points.is_empty() {
            return self.empty(node);
        }
        let count = points.len() as u32;
        let builder = (0..count).fold(ComplexShapeBuilder::new(points), ComplexShapeBuilder::point);
        let shape = builder.build().map_err(|error| self.graph.error(node, error))?;
        Ok(Some(Geometry { shape, degenerate: 0, deformation }))
    }
}
