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
    /// Where it is seen counter-clockwise.
    axis: DVec3,
    edges: Edges,
    /// The primitives under its corners; ascending.
    under_corners: Vec<u32>,
}

/// Those of a polygon.
type Edges = SmallVec<[Edge; 4]>;

/// An edge of a polygon as it is seen along a normal, and a way inward from it.
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
        let under_corners = self.under_corners(&face, leaving, out)?;
        let (axis, edges) = edges(&points(&face), out);
        Some(Cover { face, axis, edges, under_corners })
    }

    /// The primitives under the corners of a face; `None` where one has none under it.
    fn under_corners(&self, face: &Face, leaving: &[Leaving], out: DVec3) -> Option<Vec<u32>> {
        let (points, mut is_over) = (points(face), vec![false; face.corners.len()]);
        let (axis, _) = edges(&points, out);
        let mut holds_any = |&primitive: &u32| {
            let triangle = self.stars.corners(primitive);
            let (_, edges) = edges(&triangle, out);
            let near = face::part(points.len(), |i| points[i], axis, &triangle, 0);
            let over = near.into_iter().filter(|&i| edges.iter().all(|edge| edge.has_inside(points[i])));
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
        let Cover { axis, edges, .. } = self;
        let under = || {
            let near = face::part(edges.len(), |i| edges[i].from, *axis, corners, 0);
            corners.iter().position(|&corner| near.iter().all(|&i| edges[i].has_inside(corner)))
        };
        is_inner.then(under).flatten()
    }
}

impl Edge {
    /// Whether it does not have a point on its outer side. A corner on an edge may be rounded off both triangles there: then nothing covers.
    fn has_inside(&self, point: DVec3) -> bool {
        self.inward.dot(point - self.from) >= 0.0
    }
}

/// The corners of a face.
fn points(face: &Face) -> SmallVec<[DVec3; 4]> {
    face.corners.iter().map(|corner| corner.point).collect()
}

/// The edges of a convex polygon, whichever way around it goes; and the normal, or its opposite, against which that is counter-clockwise.
fn edges(corners: &[DVec3], normal: DVec3) -> (DVec3, Edges) {
    let ends = || corners.iter().zip(corners.iter().cycle().skip(1));
    let area: f64 = ends().map(|(p, q)| normal.dot((p - corners[0]).cross(q - corners[0]))).sum();
    let turned = normal * area.signum();
    (turned, ends().map(|(&from, to)| Edge { from, inward: turned.cross(to - from) }).collect())
}
