//! A mesh that stands on a flat face of a body.
//!
//! It does so on its lowest corner. Other triangles that are in the body as well, but have lower ones beside them, tell no way out that the surface has: their
//! own normals lead aside, or through the body.

use glam::DVec3;

use super::DEPTH_ERROR;
use super::face::Placed;
use super::other::Other;
use super::stars::{LEVEL, Stars};

/// The way out of all primitives of a soup that were found to meet a body, across a face of that; `None` where there is none, or it may not be the shortest.
/// `ways` are the shortest ones out of some of them, with how long they are. No way out of all is shorter than the longest of these: where that leads
/// out of all, it is the shortest.
pub(super) fn way(
    ways: impl Iterator<Item = (f64, DVec3)>,
    body: &Placed,
    other: &Other,
    stars: &Stars,
    found: &[u32],
) -> Option<DVec3> {
    let (depth, out) = ways.max_by(|(x, _), (y, _)| x.total_cmp(y))?;
    let height = other.lowest(out) + depth + LEVEL + DEPTH_ERROR * depth.abs();
    let is_left = |&primitive: &u32| stars.corners(primitive).iter().all(|corner| out.dot(*corner) <= height);
    (body.face(-out).is_aligned() && found.iter().all(is_left)).then_some(out)
}
