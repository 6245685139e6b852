//! Box, Sphere, Cone and Cylinder.

use solid3d::Shape;

use super::{Builder, Geometry};
use crate::error::SceneError;
use crate::vrml::graph::Node;

impl Builder<'_> {
    pub(super) fn cuboid(&mut self, node: Node) -> Result<Geometry, SceneError> {
        let size = self.graph.vector(node, "size")?;
        self.convex(node, Shape::cuboid(size))
    }

    pub(super) fn sphere(&mut self, node: Node) -> Result<Geometry, SceneError> {
        let radius = self.graph.number(node, "radius")?;
        self.convex(node, Shape::sphere(radius))
    }

    pub(super) fn cone(&mut self, node: Node) -> Result<Geometry, SceneError> {
        self.warn_if_open(node, &["side", "bottom"]);
        let radius = self.graph.number(node, "bottomRadius")?;
        let height = self.graph.number(node, "height")?;
        self.convex(node, Shape::cone(radius, height))
    }

    pub(super) fn cylinder(&mut self, node: Node) -> Result<Geometry, SceneError> {
        self.warn_if_open(node, &["side", "bottom", "top"]);
        let radius = self.graph.number(node, "radius")?;
        let height = self.graph.number(node, "height")?;
        self.convex(node, Shape::cylinder(radius, height))
    }

    fn warn_if_open(&mut self, node: Node, parts: &[&str]) {
        let graph = self.graph;
        for part in parts.iter().filter(|part| !graph.flag(node, part)) {
            self.warn(node, format!("{part} is FALSE, but it is taken as solid"));
        }
    }

    fn convex(&self, node: Node, shape: solid3d::Result<Shape>) -> Result<Geometry, SceneError> {
        let shape = shape.map_err(|error| self.graph.error(node, error))?;
        Ok(Geometry { shape, degenerate: 0, deformation: None })
    }
}
