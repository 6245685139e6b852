//! The supporting face of a body: the flat or straight part of its surface that faces a direction best.

mod flat;
mod normal;
mod part;
mod placed;
mod round;

use glam::DVec3;
use smallvec::SmallVec;

use super::Feature;
pub(super) use normal::triangle_normal;
pub(super) use part::part;
pub(super) use placed::Placed;
pub(super) use round::{RIM, SIDE_COSINE};

/// A face and a direction are aligned when the sine of the angle between them is at most this: half a degree. Faces need not be:
/// a box that lands on an edge has its lower face for contacts too, with the gap at the other edge.
pub(super) const ALIGNED_SINE: f64 = 0.01;

/// A face that is turned away further than this is no longer faced: its height along the direction loses its digits.
const FACING_COSINE: f64 = 0.05;

/// A corner of a supporting face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// Space: common.
    pub point: DVec3,
    /// Its number among the vertices of its body.
    pub vertex: u32,
}

/// Most faces have no more than four.
type Corners = SmallVec<[Corner; 4]>;

/// A part of the surface: a convex polygon, a segment or a point.
#[derive(Clone, Debug)]
pub(super) struct Face {
    /// In order around it.
    pub corners: Corners,
    /// The outward unit normal of a polygon; of others a direction that they face.
    pub normal: DVec3,
    /// Its number among the faces of its body.
    pub number: u32,
    /// The cosine of the angle between the normal and the direction that was asked for.
    pub cosine: f64,
}

/// Whether a normal and a direction at an angle with this cosine are aligned.
pub(super) fn is_aligned(cosine: f64) -> bool {
    cosine >= 1.0 - 0.5 * ALIGNED_SINE * ALIGNED_SINE
}

/// Whether an edge that leads so far from a furthest point lies across the direction along which that is.
fn is_level(along: DVec3, direction: DVec3) -> bool {
    -along.dot(direction) <= ALIGNED_SINE * along.length()
}

impl Face {
    /// Whether it is a polygon that lies across the direction it was asked for.
    pub fn is_aligned(&self) -> bool {
        self.corners.len() >= 3 && is_aligned(self.cosine)
    }

    /// Whether it is not seen from its edge.
    pub fn is_faced(&self) -> bool {
        self.corners.len() < 3 || self.cosine >= FACING_COSINE
    }

    /// A body that is a segment or a point; of a segment seen from its end, that.
    fn slight(corners: Corners, direction: DVec3) -> Face {
        let mut face = Face { corners, normal: direction, number: 0, cosine: 1.0 };
        if let [from, to] = face.corners[..]
            && is_aligned((to.point - from.point).normalize_or_zero().dot(direction).abs())
        {
            face.slim(direction);
        }
        face
    }

    /// What a point within it is of.
    pub fn feature(&self) -> Feature {
        match self.corners[..] {
            [corner] => Feature::Vertex(corner.vertex),
            [from, to] => Feature::edge(from.vertex, to.vertex),
            _ => Feature::Face(self.number),
        }
    }

    /// Leaves of it what is furthest along a direction: an edge that is aligned, or a corner.
    pub fn slim(&mut self, direction: DVec3) {
        let height = |corner: &Corner| corner.point.dot(direction);
        let highest =
            *self.corners.iter().max_by(|x, y| height(x).total_cmp(&height(y))).expect("a face has a corner");
        let count = self.corners.len();
        let first = self.corners.iter().position(|corner| corner.vertex == highest.vertex).unwrap_or(0);
        let neighbours = [(first + 1) % count, (first + count - 1) % count].map(|i| self.corners[i]);
        let level = |corner: &&Corner| {
            corner.vertex != highest.vertex && is_level(corner.point - highest.point, direction)
        };
        let other = neighbours.iter().filter(level).max_by(|x, y| height(x).total_cmp(&height(y))).copied();
        self.corners.clear();
        self.corners.push(highest);
        self.corners.extend(other);
    }
}
