//! Building a complex shape.

use std::sync::Arc;

use glam::DVec3;

use super::complex::{Complex, CutPolygon, Primitives};
use super::{Geometry, Shape, validate};
use crate::error::{Error, Result};
use crate::polygon::{Polygon, PolygonError};

/// Builds a *complex shape*: a soup of points, segments, triangles, tetrahedra, convex polygons and convex polyhedra
/// over one vertex buffer (thesis, sections 6.2 and B.2), and of polygons that need not be convex (chapter 3).
///
/// Vertices of a primitive may coincide or be collinear or coplanar: a primitive is the convex hull of its vertices, except a
/// [simple polygon](ComplexShapeBuilder::simple_polygon).
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
    /// The number of the user's primitive that each belongs to.
    owners: Vec<u32>,
    /// Simple polygons of several pieces.
    polygons: Vec<CutPolygon>,
    /// How many primitives the user gave so far.
    given: usize,
    error: Option<Error>,
}

impl ComplexShapeBuilder {
    /// Starts a shape over a vertex buffer.
    pub fn new(vertices: impl Into<Vec<DVec3>>) -> Self {
        ComplexShapeBuilder {
            vertices: vertices.into(),
            first: vec![0],
            indices: Vec::new(),
            owners: Vec::new(),
            polygons: Vec::new(),
            given: 0,
            error: None,
        }
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
    /// its convex hull: see [`simple_polygon`](ComplexShapeBuilder::simple_polygon).
    #[must_use]
    pub fn polygon(self, vertices: &[u32]) -> Self {
        self.add(vertices, 3)
    }

    /// Adds a polygon that need not be convex, with holes by doubled edges: one closed chain, flat up to
    /// [`FLATNESS_TOLERANCE`](crate::polygon::FLATNESS_TOLERANCE), whose edges may touch but not cross (thesis, section 2.1.1).
    /// [`join_holes`](crate::polygon::join_holes) makes such a chain. It counts as one primitive. Where a depth or
    /// [smart response](crate::Response::Smart) is said of a pair of primitives, it is said of the polygon where that is convex, up to the
    /// same tolerance; of any other of one of its triangles, as its hull may be met where it has a hole.
    ///
    /// It is cut into triangles here, once, by the positions that the vertices have now. A deformation moves the triangles with the
    /// vertices. They go on covering the polygon while it stays about flat and simple, and no triangle is turned over: bend and
    /// stretch it, but do not drag a corner across the inside. Cost: O(n^2), at worst O(n^3).
    ///
    /// ```
    /// use solid3d::{ComplexShapeBuilder, Shape, query, polygon, glam::{DAffine3, DVec3}};
    /// // A wall with a window.
    /// let square = |from: f64, to: f64| [(from, from), (to, from), (to, to), (from, to)].map(|(x, y)| DVec3::new(x, y, 0.0));
    /// let vertices = [square(0.0, 4.0), square(1.0, 3.0)].concat();
    /// let chain = polygon::join_holes(&vertices, &[0, 1, 2, 3], &[vec![4, 5, 6, 7]])?;
    /// let wall = ComplexShapeBuilder::new(vertices).simple_polygon(&chain).build()?;
    /// assert_eq!(wall.primitive_count(), 1);
    ///
    /// let ball = Shape::sphere(0.9)?;
    /// let at = |x: f64| DAffine3::from_translation(DVec3::new(x, 2.0, 0.0));
    /// assert!(!query::intersects(&wall, &DAffine3::IDENTITY, &ball, &at(2.0))?); // through the window
    /// assert!(query::intersects(&wall, &DAffine3::IDENTITY, &ball, &at(0.5))?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn simple_polygon(mut self, vertices: &[u32]) -> Self {
        let polygon = self.checked(vertices, 3).and_then(|()| {
            let corners: Vec<DVec3> = vertices.iter().map(|&i| self.vertices[i as usize]).collect();
            Polygon::new(corners).and_then(Polygon::simple).map_err(|error| match error {
                PolygonError::Vertex { index, value } => {
                    Error::Vertex { index: vertices[index] as usize, value }
                }
                error => Error::Polygon { primitive: self.given, error },
            })
        });
        match polygon {
            Ok(polygon) => {
                let first = self.count();
                for triangle in polygon.triangles() {
                    self.push(&triangle.map(|place| vertices[place as usize]));
                }
                let pieces = first..self.count();
                if pieces.len() > 1 {
                    self.polygons.push(CutPolygon { pieces, chain: vertices.into() });
                }
            }
            Err(error) => {
                self.error.get_or_insert(error);
            }
        }
        self.given += 1;
        self
    }

    /// Adds a convex polyhedron, solid: the hull of any vertices.
    #[must_use]
    pub fn polyhedron(self, vertices: &[u32]) -> Self {
        self.add(vertices, 1)
    }

    /// The shape, or the first mistake made; of nothing but triangles, a [mesh](Shape::mesh). Cost: O(n log n).
    pub fn build(self) -> Result<Shape> {
        if let Some(error) = self.error {
            return Err(error);
        }
        validate::vertex_count("vertices", self.vertices.len())?;
        validate::primitive_count("primitives", self.first.len() - 1)?;
        validate::at_most(validate::NAMEABLE_MAX, "indices", self.indices.len())?;
        let ComplexShapeBuilder { vertices, first, indices, owners, polygons, given, .. } = self;
        let all_whole = given == first.len() - 1;
        let primitives = if all_whole && first.windows(2).all(|ends| ends[1] - ends[0] == 3) {
            Primitives::Triangles(indices.as_chunks().0.to_vec())
        } else {
            let owners = if all_whole { Vec::new() } else { owners };
            Primitives::Mixed { first, indices, owners, polygons }
        };
        Ok(Geometry::Complex(Arc::new(Complex::new(vertices, primitives)?)).into())
    }

    fn add(mut self, vertices: &[u32], least: usize) -> Self {
        match self.checked(vertices, least) {
            Ok(()) => self.push(vertices),
            Err(error) => {
                self.error.get_or_insert(error);
            }
        }
        self.given += 1;
        self
    }

    fn checked(&self, vertices: &[u32], least: usize) -> Result<()> {
        if vertices.len() < least {
            return Err(Error::PrimitiveSize { primitive: self.given, count: vertices.len(), least });
        }
        validate::indices(self.given, vertices, self.vertices.len())
    }

    /// How many primitives, or pieces of them, there are so far.
    fn count(&self) -> u32 {
        (self.first.len() - 1).min(u32::MAX as usize) as u32
    }

    /// Adds a primitive, or a piece of one.
    fn push(&mut self, vertices: &[u32]) {
        self.indices.extend_from_slice(vertices);
        self.first.push(self.indices.len().min(u32::MAX as usize) as u32);
        self.owners.push(self.given.min(u32::MAX as usize) as u32);
    }
}
