//! A face of the polytope, and how it hangs together with others.

use super::plane::Plane;

/// A triangle of the polytope, counterclockwise from outside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Its vertices.
    pub corners: [u32; 3],
    /// For the edge from each corner to the next, the same edge of the face across it.
    pub twins: [HalfEdge; 3],
    /// Where it lies.
    pub plane: Plane,
    /// Whether the point being inserted sees it.
    pub seen: bool,
}

impl Face {
    /// In a place that no face has.
    pub const NONE: Face =
        Face { corners: [0; 3], twins: [HalfEdge(0); 3], plane: Plane::BEYOND, seen: false };

    /// Whether it is of the polytope, not a place that none has.
    pub fn is_live(&self) -> bool {
        self.plane.offset < f64::INFINITY
    }
}

/// An edge of a face: four times its number, plus that of the corner which the edge starts at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HalfEdge(u32);

impl HalfEdge {
    pub const fn new(face: u32, corner: u32) -> Self {
        HalfEdge(4 * face + corner)
    }

    /// The face that it is an edge of.
    pub fn face(self) -> usize {
        (self.0 / 4) as usize
    }

    /// Which of the face's corners it starts at.
    pub fn corner(self) -> usize {
        (self.0 % 4) as usize
    }

    /// The edges of the same face that follow, in their order.
    pub fn others(self) -> [HalfEdge; 2] {
        const NEXT: [[u32; 2]; 3] = [[1, 2], [2, 0], [0, 1]];
        NEXT[self.corner()].map(|corner| HalfEdge(self.0 / 4 * 4 + corner))
    }
}
