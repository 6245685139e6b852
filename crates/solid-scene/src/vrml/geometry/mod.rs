//! Geometry nodes, as shapes.

mod elevation_grid;
mod extrusion;
mod face_set;
mod line_set;
mod point_set;
mod primitive;

use std::sync::Arc;

use glam::DVec3;
use solid3d::Shape;

use super::animation::Deformation;
use super::graph::{Graph, Node};
use super::interpolator::Event;
use super::limits::ELEMENTS_MAX;
use super::signal::SignalBuilder;
use crate::error::SceneError;
use crate::polygon::{Cut, folded_warning, triangulate};
use crate::soup::Soup;
use crate::text::counted;
use crate::warnings::Warnings;

/// The shape of a geometry node.
#[derive(Clone, Debug)]
pub(super) struct Geometry {
    pub shape: Shape,
    /// How many primitives are without length or area.
    pub degenerate: usize,
    pub deformation: Option<Deformation>,
}

/// What geometry is made from.
pub(super) struct Builder<'a> {
    pub graph: &'a Graph,
    pub signals: SignalBuilder<'a>,
    pub warnings: &'a mut Warnings,
    /// Vertices and primitives so far.
    elements: usize,
}

/// The coordinates of a geometry node.
struct Coordinates {
    /// At time 0.
    points: Vec<DVec3>,
    deformation: Option<Deformation>,
}

impl<'a> Builder<'a> {
    /// Starts without geometry.
    pub fn new(graph: &'a Graph, signals: SignalBuilder<'a>, warnings: &'a mut Warnings) -> Self {
        Builder { graph, signals, warnings, elements: 0 }
    }

    /// The shape of a geometry node; `None`, with a warning, when it is empty or of no use for collisions.
    pub fn geometry(&mut self, node: Node) -> Result<Option<Geometry>, SceneError> {
        match self.graph.type_name(node) {
            "Box" => self.cuboid(node).map(Some),
            "Sphere" => self.sphere(node).map(Some),
            "Cone" => self.cone(node).map(Some),
            "Cylinder" => self.cylinder(node).map(Some),
            "IndexedFaceSet" => self.face_set(node),
            "IndexedLineSet" => self.line_set(node),
            "PointSet" => self.point_set(node),
            "ElevationGrid" => self.elevation_grid(node),
            "Extrusion" => self.extrusion(node),
            other => {
                self.warnings.add(format!("{other} has no shape to collide with; passed over"));
                Ok(None)
            }
        }
    }

    /// A warning about a node.
    pub fn warn(&mut self, node: Node, message: impl std::fmt::Display) {
        self.warnings.add(format!("{}: {message}", self.graph.describe(node)));
    }

    /// The result for a node with nothing in it.
    fn empty(&mut self, node: Node) -> Result<Option<Geometry>, SceneError> {
        self.warn(node, "is empty; passed over");
        Ok(None)
    }

    /// Counts vertices and primitives, or coordinates copied, against the limit.
    pub fn count(&mut self, node: Node, elements: usize) -> Result<(), SceneError> {
        self.room_for(node, elements)?;
        self.elements += elements;
        Ok(())
    }

    /// Refuses what would be too many vertices and primitives, before they are made.
    fn room_for(&self, node: Node, elements: usize) -> Result<(), SceneError> {
        if self.elements.saturating_add(elements) > ELEMENTS_MAX {
            let message = format!("the scene has more than {ELEMENTS_MAX} vertices and primitives");
            return Err(self.graph.error(node, message));
        }
        Ok(())
    }

    /// The points in the field `coord`, which a CoordinateInterpolator may drive.
    fn coordinates(&mut self, node: Node) -> Result<Coordinates, SceneError> {
        let Some(coord) = self.graph.node(node, "coord") else {
            return Ok(Coordinates { points: Vec::new(), deformation: None });
        };
        self.count(coord, self.graph.count(coord, "point"))?;
        let points = self.graph.vectors(coord, "point")?;
        let signal = self.signals.driving(coord, "point", self.warnings)?;
        let Some(signal) = signal else { return Ok(Coordinates { points, deformation: None }) };
        let expected = self.signals.point_count(signal);
        if expected != Some(points.len()) {
            let sent = match expected {
                Some(1) => "1 point is".to_owned(),
                Some(count) => format!("{count} points are"),
                None => "changing numbers of points are".to_owned(),
            };
            let message = format!("has {}, but {sent} sent to it", counted(points.len(), "point"));
            return Err(self.graph.error(coord, message));
        }
        let deformation = Deformation { signal, rest: Arc::from(points.as_slice()) };
        let points = match self.signals.start(signal) {
            Some(Event::Points(points)) => points.to_vec(),
            _ => points,
        };
        Ok(Coordinates { points, deformation: Some(deformation) })
    }

    /// The geometry of vertices and primitives; `None`, with a warning, without a primitive.
    fn soup(
        &mut self,
        node: Node,
        soup: Soup,
        deformation: Option<Deformation>,
    ) -> Result<Option<Geometry>, SceneError> {
        if soup.is_empty() {
            return self.empty(node);
        }
        self.count(node, soup.triangles.len() + soup.segments.len() + soup.points.len())?;
        let degenerate = soup.degenerate();
        let shape = soup.into_shape().map_err(|fault| self.graph.fault(node, fault))?;
        Ok(Some(Geometry { shape, degenerate, deformation }))
    }

    /// Adds the triangles of a face. Says whether they are folded over.
    fn face(corners: &[u32], soup: &mut Soup) -> bool {
        triangulate(corners, &soup.vertices, &mut soup.triangles) == Cut::Folded
    }

    /// Warns of faces of a node that are folded over, where there are some.
    fn warn_of_folded(&mut self, node: Node, count: usize) {
        if let Some(warning) = folded_warning(count) {
            self.warn(node, warning);
        }
    }

    /// Indices of `count` points, checked.
    fn vertices(&self, node: Node, indices: &[i32], count: usize) -> Result<Vec<u32>, SceneError> {
        let vertex = |&index: &i32| match u32::try_from(index) {
            Ok(vertex) if (vertex as usize) < count => Ok(vertex),
            _ => {
                let message = format!(
                    "coordIndex holds {index}; expected -1, or less than {count}, the number of points"
                );
                Err(self.graph.error(node, message))
            }
        };
        indices.iter().map(vertex).collect()
    }
}
