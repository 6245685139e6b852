//! Triangles that a body does not meet, though its deepest point is behind them: it came through a flat part of the surface beside them, and leans
//! over.

use std::collections::BTreeSet;

use glam::DVec3;

use super::other::Other;
use super::stars::{LEVEL, Stars};

/// Looks for the triangles in front of the deepest points of a body.
pub(super) struct Overhang<'a> {
    stars: &'a Stars<'a>,
    body: Other<'a>,
    /// The primitives that the body meets, or is near; ascending.
    met: &'a [u32],
    looked_at: BTreeSet<u32>,
    /// The plane of a triangle that the body meets in front of where it is deepest, by its normal and its height along that: the last one.
    covered: Option<(DVec3, f64)>,
    /// What was found: a triangle that the body meets, the one that it does not meet and leans over beside that, and the normal along which it leaves both.
    pub found: Vec<(u32, u32, DVec3)>,
}

impl<'a> Overhang<'a> {
    pub fn new(stars: &'a Stars<'a>, body: Other<'a>, met: &'a [u32]) -> Self {
        Overhang { stars, body, met, looked_at: BTreeSet::new(), covered: None, found: Vec::new() }
    }

    /// Goes straight from a triangle that the body meets, and leaves along a normal of it, to the one in front of where it is deepest, through others of that
    /// plane which it does not meet. Cost: each of these is looked at once.
    pub fn look(&mut self, first: u32, out: DVec3) {
        let start = self.stars.corners(first).iter().sum::<DVec3>() / 3.0;
        let height = out.dot(start);
        if self.covered.is_some_and(|(normal, at)| normal == out && (height - at).abs() <= LEVEL) {
            return;
        }
        let tip = self.body.furthest(-out);
        let mut triangle = first;
        while let Some(edge) = exit(&self.stars.corners(triangle), out, start, tip) {
            let vertices = self.stars.welded(triangle);
            let ends = [vertices[edge], vertices[(edge + 1) % 3]];
            let next = self.stars.across(&ends, triangle).find(|beside| {
                self.met.binary_search(beside).is_err()
                    && self.stars.is_level(*beside, out, &self.body)
                    && self.looked_at.insert(*beside)
            });
            let Some(next) = next else { return };
            triangle = next;
        }
        if triangle == first {
            self.covered = Some((out, height));
        } else {
            self.found.push((first, triangle, out));
        }
    }
}

/// The edge of a triangle through which a straight way leaves it, seen along the triangle's normal; `None` of one that ends in it.
fn exit(corners: &[DVec3], normal: DVec3, from: DVec3, to: DVec3) -> Option<usize> {
    let leaves = |i: usize| {
        let [p, q, r] = [0, 1, 2].map(|k| corners[(i + k) % 3]);
        let inward = normal.cross(q - p);
        let inward = inward * inward.dot(r - p).signum();
        let (before, after) = (inward.dot(from - p), inward.dot(to - p));
        let part = if before > after { before / (before - after) } else { f64::INFINITY };
        (after < 0.0).then_some((part, i))
    };
    let (_, edge) = (0..3).filter_map(leaves).min_by(|(s, _), (t, _)| s.total_cmp(t))?;
    Some(edge)
}
