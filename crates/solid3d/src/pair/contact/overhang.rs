//! Triangles that a body does not meet, though its deepest point is behind them: it came through a flat part of the surface beside them, and leans
//! over.

use std::collections::BTreeSet;

use glam::DVec3;
use smallvec::{SmallVec, smallvec};

use super::other::Other;
use super::stars::Stars;

/// Looks for the triangles in front of the deepest points of a body.
pub(super) struct Overhang<'a> {
    stars: &'a Stars<'a>,
    body: Other<'a>,
    /// The primitives that the body meets; ascending.
    met: &'a [u32],
    looked_at: BTreeSet<u32>,
    /// What was found: triangles that the body does not meet, each with the normal along which it leaves them.
    pub found: Vec<(u32, DVec3)>,
}

impl<'a> Overhang<'a> {
    pub fn new(stars: &'a Stars<'a>, body: Other<'a>, met: &'a [u32]) -> Self {
        Overhang { stars, body, met, looked_at: BTreeSet::new(), found: Vec::new() }
    }

    /// Goes from a triangle that the body meets, and leaves along a normal of it, to the one in front of where it is deepest, across others of that
    /// plane which it does not meet. Cost: each of these is looked at once.
    pub fn look(&mut self, first: u32, out: DVec3) {
        let tip = self.body.furthest(-out);
        let mut pending: SmallVec<[u32; 8]> = smallvec![first];
        while let Some(triangle) = pending.pop() {
            let (corners, vertices) = (self.stars.corners(triangle), self.stars.welded(triangle));
            let mut is_in_front = triangle != first;
            for i in 0..3 {
                let [j, k] = [(i + 1) % 3, (i + 2) % 3];
                let inward = out.cross(corners[j] - corners[i]);
                let height = |point: DVec3| inward.dot(point - corners[i]);
                if height(tip) * height(corners[k]) >= 0.0 {
                    continue;
                }
                is_in_front = false;
                for beside in self.stars.across([vertices[i], vertices[j]], triangle) {
                    let goes_on = self.met.binary_search(&beside).is_err()
                        && self.stars.is_level(beside, out, &self.body)
                        && self.looked_at.insert(beside);
                    if goes_on {
                        pending.push(beside);
                    }
                }
            }
            if is_in_front {
                self.found.push((triangle, out));
            }
        }
    }
}
