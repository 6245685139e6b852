//! A mesh that stands on a flat face of a body.
//!
//! It does so on its lowest corner. Other triangles that are in the body as well, but have lower ones beside them, tell no way out that the surface has: their
//! own normals lead aside, or through the body.

use glam::DVec3;

use super::DEPTH_ERROR;
use super::face::Placed;
use super::other::Other;
use super::stars::{LEVEL, Stars};

/// The way out of all primitives of a soup that were found to meet a body, across a face of that, and how long it is; `None` where there is none, or it
/// may not be the shortest. `ways` are the shortest ones out of some of them, with how long they are. No way out of all is shorter than the longest of
/// these: where that leads out of all, it is the shortest. `has_left` tells whether the body does not meet a primitive, once it went such a way.
pub(super) fn way(
    ways: impl Iterator<Item = (f64, DVec3)>,
    body: &Placed,
    other: &Other,
    stars: &Stars,
    found: &[u32],
    has_left: impl Fn(u32, DVec3) -> bool,
) -> Option<(f64, DVec3)> {
    let (depth, out) = ways.max_by(|(x, _), (y, _)| x.total_cmp(y))?;
    if !body.face(-out).is_aligned() {
        return None;
    }
    let length = depth + LEVEL + DEPTH_ERROR * depth.abs();
    let height = other.lowest(out) + length;
    let is_below = |primitive: u32| stars.corners(primitive).iter().all(|corner| out.dot(*corner) <= height);
    // Beside the face a primitive may be higher.
    found
        .iter()
        .all(|&primitive| is_below(primitive) || has_left(primitive, out * length))
        .then_some((depth, out))
}
