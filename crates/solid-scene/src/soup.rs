//! What every mesh reader fills: vertices, and the triangles, segments and points over them.

use glam::{DAffine3, DVec3};
use solid3d::{ComplexShapeBuilder, Shape};

use crate::fault::Result;
use crate::part::{Part, PartObject, Still};

/// Primitives over one vertex buffer.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Soup {
    pub vertices: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    pub segments: Vec<[u32; 2]>,
    pub points: Vec<u32>,
}

impl Soup {
    /// Whether there is no primitive, whatever the number of vertices.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty() && self.segments.is_empty() && self.points.is_empty()
    }

    /// A mesh where there are triangles only, a complex shape otherwise.
    pub fn into_shape(self) -> Result<Shape> {
        let shape = if self.segments.is_empty() && self.points.is_empty() {
            Shape::mesh(self.vertices, self.triangles)
        } else {
            self.into_builder().build()
        };
        shape.map_err(|error| error.to_string().into())
    }

    fn into_builder(self) -> ComplexShapeBuilder {
        let mut builder = ComplexShapeBuilder::new(self.vertices);
        builder = self.triangles.into_iter().fold(builder, ComplexShapeBuilder::triangle);
        builder = self.segments.into_iter().fold(builder, ComplexShapeBuilder::segment);
        self.points.into_iter().fold(builder, ComplexShapeBuilder::point)
    }

    /// How many triangles have no area and how many segments no length: two corners are equal, or the cross product of
    /// two edges, in double precision, is zero. Needs indices in range.
    pub fn degenerate(&self) -> usize {
        let at = |i: u32| self.vertices[i as usize];
        let flat =
            |&&[a, b, c]: &&[u32; 3]| (at(b) - at(a)).cross(at(c) - at(a)) == DVec3::ZERO || at(b) == at(c);
        let short = |&&[a, b]: &&[u32; 2]| at(a) == at(b);
        self.triangles.iter().filter(flat).count() + self.segments.iter().filter(short).count()
    }

    /// The object that the soup is: child `number` of the file's root, node 0.
    pub fn into_object(self, name: &str, number: u32) -> Result<PartObject> {
        let degenerate = self.degenerate();
        let shape = self.into_shape()?;
        Ok(PartObject { name: name.to_owned(), shape, path: vec![0, number], degenerate })
    }
}

/// A file of meshes that stay where they are, in no unit that the format tells.
pub(crate) fn still_part(objects: Vec<PartObject>, warnings: Vec<String>) -> Part {
    let motion = Box::new(Still(vec![DAffine3::IDENTITY; objects.len()]));
    Part { objects, motion, duration: 0.0, unit: "unspecified", warnings, files: Vec::new() }
}

#[cfg(test)]
mod tests {
    use solid3d::ShapeKind;

    use super::*;

    fn corners() -> Vec<DVec3> {
        vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X * 2.0, DVec3::X]
    }

    #[test]
    fn triangles_alone_are_a_mesh() {
        let mesh = Soup { vertices: corners(), triangles: vec![[0, 1, 2]], ..Soup::default() };
        let mixed = Soup { points: vec![3], ..mesh.clone() };
        assert_eq!(mesh.into_shape().unwrap().kind(), ShapeKind::Mesh);
        let mixed = mixed.into_shape().unwrap();
        assert_eq!((mixed.kind(), mixed.primitive_count()), (ShapeKind::Complex, 2));
    }

    #[test]
    fn degenerate_primitives_are_counted() {
        let triangles = vec![[0, 1, 2], [0, 1, 3], [0, 0, 2], [2, 1, 4], [1, 2, 1]];
        let soup = Soup { vertices: corners(), triangles, segments: vec![[0, 1], [1, 4]], points: vec![0] };
        assert_eq!(soup.degenerate(), 5);
    }
}
