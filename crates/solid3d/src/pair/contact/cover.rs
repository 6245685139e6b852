//! A flat surface under a flat face of a body.
//!
//! Where all that a body meets is of one plane, with nothing else around it, and each corner of the face is over some of it, what the two have in common has the
//! outline of the face. Triangles with none of these corners over them say no more than that they are connected: one point of each is enough.

use glam::DVec3;
use smallvec::SmallVec;

use super::face::{self, Face};
use super::leaving::{Leaving, WayOut};
use super::soup_body::Encounter;
use super::stars::LEVEL;

/// Fewer triangles are each looked at.
const FEW: usize = 8;

/// A face of a body that is over a flat surface, with all of its corners.
pub(super) struct Cover {
    pub face: Face,
    outline: Polygon,
    /// The primitives under its corners; ascending.
    under_corners: Vec<u32>,
}

/// A convex polygon as it is seen along a normal.
struct Polygon {
    /// The normal, or its opposite: against which it goes around counter-clockwise.
    axis: DVec3,
    edges: SmallVec<[Edge; 4]>,
}

/// An edge of a polygon, and a way inward from it.
struct Edge {
    from: DVec3,
    inward: DVec3,
}

impl Encounter<'_> {
    /// The face of the body that covers all that it leaves, if one does.
    pub fn cover(&self, leaving: &[Leaving]) -> Option<Cover> {
        let first = leaving.first().filter(|_| leaving.len() > FEW)?;
        let (out, face) = (first.way.out(), self.body.face(-first.way.out()));
        let height = |primitive| out.dot(self.stars.corners(primitive)[0]);
        let plane = height(first.primitive);
        let is_beyond = |corner: &face::Corner| plane - out.dot(corner.point) > LEVEL - self.pair.margin;
        let is_of_plane = |&Leaving { primitive, ref way, .. }: &Leaving| {
            matches!(*way, WayOut::Own(other) if other.distance_squared(out) <= LEVEL * LEVEL)
                && self.stars.is_flat(primitive)
                && (height(primitive) - plane).abs() <= LEVEL
        };
        let covers = face.is_aligned() && face.corners.iter().all(is_beyond);
        if !(covers && leaving.iter().all(is_of_plane)) {
            return None;
        }
        let corners: SmallVec<[DVec3; 4]> = face.corners.iter().map(|corner| corner.point).collect();
        let outline = Polygon::seen(&corners, out);
        let under_corners = self.under_corners(&outline, leaving, out)?;
        Some(Cover { face, outline, under_corners })
    }

    /// The primitives under the corners of a face; `None` where one has none under it.
    fn under_corners(&self, outline: &Polygon, leaving: &[Leaving], out: DVec3) -> Option<Vec<u32>> {
        let mut is_over = vec![false; outline.edges.len()];
        let mut holds_any = |&primitive: &u32| {
            let corners = self.stars.corners(primitive);
            let triangle = Polygon::seen(&corners, out);
            let near = outline.edges_near(&corners).into_iter();
            let over =
                near.filter(|&i| triangle.edges.iter().all(|edge| edge.has_inside(outline.edges[i].from)));
            over.map(|i| is_over[i] = true).count() > 0
        };
        let primitives = leaving.iter().map(|leaving| leaving.primitive);
        let under_corners = primitives.filter(&mut holds_any).collect();
        is_over.iter().all(|&is_over| is_over).then_some(under_corners)
    }
}

impl Cover {
    /// The first corner of a triangle that is under the face, where no corner of the face is over the triangle.
    pub fn over(&self, primitive: u32, corners: &[DVec3]) -> Option<usize> {
        let is_inner = self.under_corners.binary_search(&primitive).is_err();
        let under = || {
            let near = self.outline.edges_near(corners);
            let is_under = |&corner: &DVec3| near.iter().all(|&i| self.outline.edges[i].has_inside(corner));
            corners.iter().position(is_under)
        };
        is_inner.then(under).flatten()
    }
}

impl Polygon {
    fn seen(corners: &[DVec3], normal: DVec3) -> Polygon {
        let ends = || corners.iter().zip(corners.iter().cycle().skip(1));
        let area: f64 = ends().map(|(p, q)| normal.dot((p - corners[0]).cross(q - corners[0]))).sum();
        let axis = normal * area.signum();
        let edges = ends().map(|(&from, to)| Edge { from, inward: axis.cross(to - from) }).collect();
        Polygon { axis, edges }
    }

    /// The edges that may have a corner of a triangle on their outer side, and those that begin at a corner which may be over it.
    fn edges_near(&self, triangle: &[DVec3]) -> SmallVec<[usize; 16]> {
        face::part(self.edges.len(), |i| self.edges[i].from, self.axis, triangle, 0)
    }
}

impl Edge {
    /// Whether it does not have a point on its outer side. A corner on an edge may be rounded off both triangles there: then nothing covers.
    fn has_inside(&self, point: DVec3) -> bool {
        self.inward.dot(point - self.from) >= 0.0
    }
}
