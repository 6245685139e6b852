//! A face as it is seen along the normal of a contact: a polygon of the plane, and what of the body its corners and edges are.

use glam::{DVec2, DVec3};
use smallvec::{SmallVec, smallvec};

use super::face::Face;
use super::{Feature, clip, ring};

/// A projected polygon whose area is below this share of the square of its extent is a segment.
const THIN: f64 = 1e-9;

/// A face in a plane.
pub(super) struct Outline<'f> {
    face: &'f Face,
    pub polygon: SmallVec<[DVec2; 4]>,
    /// Of a face that is seen from its edge, which corners the two of the polygon are.
    ends: Option<[usize; 2]>,
}

impl<'f> Outline<'f> {
    /// As `flat` shows its corners.
    #[inline(always)]
    pub fn new(face: &'f Face, flat: impl Fn(DVec3) -> DVec2) -> Self {
        let mut outline = Outline { face, polygon: SmallVec::new(), ends: None };
        outline.polygon.extend(face.corners.iter().map(|corner| flat(corner.point)));
        outline.slim();
        outline
    }

    /// Leaves the ends of what is too thin to be clipped against.
    fn slim(&mut self) {
        let all = &self.polygon;
        // No two are further apart than twice what one is from the first: of most that is enough.
        if all.len() < 3 || clip::area(all).abs() > THIN * 4.0 * ring::extent_squared(all) {
            return;
        }
        let far = |from: DVec2| {
            let distance = |&i: &usize| all[i].distance_squared(from);
            (0..all.len()).max_by(|i, j| distance(i).total_cmp(&distance(j)).then(j.cmp(i))).unwrap_or(0)
        };
        let from = far(all[0]);
        let to = far(all[from]);
        if clip::area(all).abs() <= THIN * all[from].distance_squared(all[to]) {
            self.polygon = smallvec![all[from], all[to]];
            self.ends = Some([from, to]);
        }
    }

    /// The number of a corner of the polygon among the vertices of the body.
    fn number(&self, corner: usize) -> u32 {
        let corner = if corner == self.polygon.len() { 0 } else { corner };
        self.face.corners[self.ends.map_or(corner, |ends| ends[corner])].vertex
    }

    /// What a corner of the polygon is.
    pub fn vertex(&self, corner: usize) -> Feature {
        Feature::Vertex(self.number(corner))
    }

    /// What the edge from a corner of the polygon to the next is.
    pub fn edge(&self, corner: usize) -> Feature {
        Feature::edge(self.number(corner), self.number(corner + 1))
    }
}
