//! A mesh that stands on a flat face of a body.
//!
//! It does so on its lowest corner. Other triangles that are in the body as well, but have lower ones beside them, tell no way out that the surface has: their
//! own normals lead aside, or through the body.

use glam::DVec3;
use solid_convex::gjk;

use super::bodies::DEPTH_ERROR;
use super::leaving::{Leaving, WayOut};
use super::other::highest;
use super::soup_body::Encounter;
use super::stars::LEVEL;

impl Encounter<'_> {
    /// The way out of all primitives that were found, across a face of the body, and how long it is; `None` where there is none, or it may not be the
    /// shortest. No way out of all is shorter than the longest of those that some of them told: where that leads out of all, it is the shortest.
    pub fn standing(&self, told: &[Leaving]) -> Option<(f64, DVec3)> {
        let ways = told.iter().filter_map(|leaving| match leaving.way {
            WayOut::Shortest { out, meeting } => Some((meeting.depth, out)),
            _ => None,
        });
        let (depth, out) = ways.max_by(|(x, _), (y, _)| x.total_cmp(y))?;
        if !self.body.face(-out).is_aligned() {
            return None;
        }
        let length = depth + LEVEL + DEPTH_ERROR * depth.abs();
        let height = self.other.lowest(out) + length;
        let is_below = |primitive| highest(&self.stars.corners(primitive), out) <= height;
        // Beside the face a primitive may be higher.
        let is_left = |&primitive: &u32| is_below(primitive) || self.has_left(primitive, out * length);
        self.found.iter().all(is_left).then_some((depth, out))
    }

    /// Where the soup stands on a face of the body, that is left along its normal by what would have a longer way, and by what meets it and is open. What is
    /// only near may be on any side.
    pub fn stand(&self, leaving: &mut Leaving, depth: f64, out: DVec3) {
        if !leaving.meets {
            self.look_around(leaving);
        }
        let Leaving { primitive, way, meets } = leaving;
        let is_longer = |other: DVec3| {
            let corners = self.stars.corners(*primitive);
            let across = self.other.depth(&corners, out);
            (if *meets { across.min(depth) } else { across }) < self.other.depth(&corners, other) - LEVEL
        };
        match *way {
            WayOut::Open(_) => *way = WayOut::Across(out),
            WayOut::Own(other) | WayOut::Across(other) if is_longer(other) => *way = WayOut::Across(out),
            _ => {}
        }
    }

    /// Whether the body does not meet a primitive, once it went some way. Space: common.
    fn has_left(&self, primitive: u32, way: DVec3) -> bool {
        let mut moved = self.other.map.affine;
        moved.translation += way;
        let hull = self.stars.complex.primitive_hull(primitive);
        let found = gjk::intersection(self.other.support, &moved, &hull, &self.stars.map.affine);
        matches!(found, gjk::Outcome::Separated { .. })
    }
}
