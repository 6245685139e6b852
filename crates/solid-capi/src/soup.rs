//! From polytopes over a vertex array to a shape, and its deformation.

use solid3d::glam::DVec3;
use solid3d::{ComplexShapeBuilder, Shape, ShapeKind};

use crate::fault::{Code, Fault, Result};

/// The largest magnitude of a coordinate or a size.
pub(crate) const MAGNITUDE_MAX: f64 = solid3d::convex::MAGNITUDE_MAX;

/// Polytopes over the vertices of a shape: first those that come from the client's array, then those given by value.
#[derive(Debug)]
pub(crate) struct Soup {
    /// The places in the client's array that a polytope names, ascending.
    places: Vec<u32>,
    /// The vertices given by value.
    fixed: Vec<DVec3>,
    /// Polytope `i` is the hull of the vertices `indices[ends[i - 1]..ends[i]]`.
    indices: Vec<u32>,
    ends: Vec<usize>,
}

impl Soup {
    pub fn new(places: Vec<u32>, fixed: Vec<DVec3>, indices: Vec<u32>, ends: Vec<usize>) -> Self {
        Soup { places, fixed, indices, ends }
    }

    /// Whether some vertices come from the client's array.
    pub fn has_array(&self) -> bool {
        !self.places.is_empty()
    }

    /// The shape over what the client's array holds now.
    ///
    /// A single polytope becomes a convex shape, which has no need of a tree and whose separating axes can be cached.
    pub fn shape(&self, read: impl Fn(u32) -> [f64; 3]) -> Result<Shape> {
        let vertices = self.vertices(read)?;
        if let ([_], true) = (&self.ends[..], self.indices.len() > 3) {
            let points: Vec<DVec3> = self.indices.iter().map(|&i| vertices[i as usize]).collect();
            return Ok(Shape::convex_hull(&points)?);
        }
        self.complex(vertices)
    }

    /// A shape of this soup with what the client's array holds now. `spare` is an earlier deformation, whose memory is used if
    /// nobody else does.
    ///
    /// What deforms once is expected to do so again: a single polytope becomes a soup, which is refitted faster than a hull is
    /// found.
    pub fn deformed(
        &self,
        current: &Shape,
        spare: Option<Shape>,
        read: impl Fn(u32) -> [f64; 3],
    ) -> Result<Shape> {
        let vertices = self.vertices(read)?;
        if current.kind() == ShapeKind::ConvexHull {
            return self.complex(vertices);
        }
        let mut shape = spare.unwrap_or_else(|| current.clone());
        shape.deform(&vertices)?;
        Ok(shape)
    }

    fn complex(&self, vertices: Vec<DVec3>) -> Result<Shape> {
        let mut builder = ComplexShapeBuilder::new(vertices);
        let mut start = 0;
        for &end in &self.ends {
            builder = builder.polyhedron(&self.indices[start..end]);
            start = end;
        }
        Ok(builder.build()?)
    }

    fn vertices(&self, read: impl Fn(u32) -> [f64; 3]) -> Result<Vec<DVec3>> {
        let from_array = self.places.iter().map(|&place| {
            let vertex = DVec3::from(read(place));
            in_range(vertex).map_err(|limit| {
                let message = format!("vertex {place} of the array is {}; {limit}", coordinates(vertex));
                Fault::new(Code::Value, message)
            })
        });
        from_array.chain(self.fixed.iter().map(|&vertex| Ok(vertex))).collect()
    }
}

/// The vertex itself, or what its limit is.
pub(crate) fn in_range(vertex: DVec3) -> std::result::Result<DVec3, String> {
    if vertex.is_finite() && vertex.abs().max_element() <= MAGNITUDE_MAX {
        Ok(vertex)
    } else {
        Err(format!("each coordinate must be finite and at most {MAGNITUDE_MAX:e} in magnitude"))
    }
}

/// A vertex as a message shows it: huge numbers by their exponent.
pub(crate) fn coordinates(v: DVec3) -> String {
    format!("({:?}, {:?}, {:?})", v.x, v.y, v.z)
}
