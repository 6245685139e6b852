//! Building a complex shape.

use std::sync::Arc;

use glam::DVec3;

use super::complex::{Complex, Primitives};
use super::{Geometry, Shape, validate};
use crate::error::{Error, Result};

/// Builds a *complex shape*: a soup of points, segments, triangles, tetrahedra, convex polygons and convex polyhedra
/// over one vertex buffer (thesis, sections 6.2 and B.2).
///
/// Vertices of a primitive may coincide or be collinear or coplanar: a primitive is the convex hull of its vertices.
/// The first mistake is reported by [`build`](ComplexShapeBuilder::build).
///
/// ```
/// use solid3d::{ComplexShapeBuilder, glam::DVec3};
/// // The pyramid of thesis section B.2, as its base and two of its sides.
/// let vertices = [
///     DVec3::new(1.0, 0.0, 1.0), DVec3::new(1.0, 0.0, -1.0), DVec3::new(-1.0, 0.0, -1.0),
///     DVec3::new(-1.0, 0.0, 1.0), DVec3::new(0.0, 1.27, 0.0),
/// ];
/// let pyramid = ComplexShapeBuilder::new(vertices)
///     .polygon(&[0, 1, 2, 3])
///     .triangle([0, 1, 4])
///     .triangle([1, 2, 4])
///     .build()?;
/// assert_eq!(pyramid.primitive_count(), 3);
/// # Ok::<(), solid3d::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct ComplexShapeBuilder {
    vertices: Vec<DVec3>,
    first: Vec<u32>,
    indices: Vec<u32>,
    error: Option<Error>,
}

impl ComplexShapeBuilder {
    /// Starts a shape over a vertex buffer.
    pub fn new(vertices: impl Into<Vec<DVec3>>) -> Self {
        ComplexShapeBuilder { vertices: vertices.into(), first: vec![0], indices: Vec::new(), error: None }
    }

    /// Adds a point.
    #[must_use]
    pub fn point(self, vertex: u32) -> Self {
        self.add(&[vertex], 1)
    }

    /// Adds a line segment.
    #[must_use]
    pub fn segment(self, vertices: [u32; 2]) -> Self {
        self.add(&vertices, 2)
    }

    /// Adds a triangle.
    #[must_use]
    pub fn triangle(self, vertices: [u32; 3]) -> Self {
        self.add(&vertices, 3)
    }

    /// Adds a tetrahedron, solid.
    #[must_use]
    pub fn tetrahedron(self, vertices: [u32; 4]) -> Self {
        self.add(&vertices, 4)
    }

    /// Adds a convex polygon of three or more vertices, approximately coplanar. A polygon that is not convex counts as
    /// its convex hull: triangulate it.
    #[must_use]
    pub fn polygon(self, vertices: &[u32]) -> Self {
        self.add(vertices, 3)
    }

    /// Adds a convex polyhedron, solid: the hull of any vertices.
    #[must_use]
    pub fn polyhedron(self, vertices: &[u32]) -> Self {
        self.add(vertices, 1)
    }

    /// The shape, or the first mistake made. Cost: O(n log n).
    pub fn build(self) -> Result<Shape> {
        if let Some(error) = self.error {
            return Err(error);
        }
        validate::vertex_count("vertices", self.vertices.len())?;
        validate::primitive_count("primitives", self.first.len() - 1)?;
        validate::at_most(validate::NAMEABLE_MAX, "indices", self.indices.len())?;
        let primitives = Primitives::Mixed { first: self.first, indices: self.indices };
        Ok(Geometry::Complex(Arc::new(Complex::new(self.vertices, primitives)?)).into())
    }

    fn add(mut self, vertices: &[u32], least: usize) -> Self {
        let primitive = self.first.len() - 1;
        let checked = if vertices.len() < least {
            Err(Error::PrimitiveSize { primitive, count: vertices.len(), least })
        } else {
            validate::indices(primitive, vertices, self.vertices.len())
        };
        match checked {
            Ok(()) => {
                self.indices.extend_from_slice(vertices);
                self.first.push(self.indices.len().min(u32::MAX as usize) as u32);
            }
            Err(error) => {
                self.error.get_or_insert(error);
            }
        }
        self
    }
}
