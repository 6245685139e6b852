//! IndexedLineSet.

use glam::DVec3;
use solid3d::ComplexShapeBuilder;

use super::{Builder, Coordinates, Geometry};
use crate::error::SceneError;
use crate::vrml::graph::Node;

impl Builder<'_> {
    /// A segment from each point of a polyline to the next.
    pub(super) fn line_set(&mut self, node: Node) -> Result<Option<Geometry>, SceneError> {
        let Coordinates { points, deformation } = self.coordinates(node)?;
        let mut segments = Vec::new();
        let graph = self.graph;
        for polyline in graph.integers(node, "coordIndex").split(|&index| index == -1) {
            let vertices = polyline.iter().map(|&index| self.vertex(node, index, points.len()));
            let vertices = vertices.collect::<Result<Vec<u32>, SceneError>>()?;
            segments.extend(vertices.windows(2).map(|pair| [pair[0], pair[1]]));
        }
        if segments.is_empty() {
            return self.empty(node);
        }
        self.count(node, segments.len())?;
        let is_point = |&&[a, b]: &&[u32; 2]| length(&points, a, b) == 0.0;
        let degenerate = segments.iter().filter(is_point).count();
        let builder = ComplexShapeBuilder::new(points);
        let builder = segments.into_iter().fold(builder, ComplexShapeBuilder::segment);
        let shape = builder.build().map_err(|error| graph.error(node, error))?;
        Ok(Some(Geometry { shape, degenerate, deformation }))
    }
}

fn length(points: &[DVec3], a: u32, b: u32) -> f64 {
    points[a as usize].distance(points[b as usize])
}
