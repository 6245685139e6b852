//! The way out of a surface across one of its edges, where no triangle by itself tells one.
//!
//! The shortest way out of a triangle may lead past the end of such an edge, where the surface goes on, and its own normal to where the body is not over it. Of many
//! small triangles along a straight edge that may be so of all.

use glam::DVec3;
use smallvec::{SmallVec, smallvec};

use super::ball::Way;
use super::other::Other;
use super::stars::{LEVEL, Stars};

/// By so many halvings an angle is as small as rounding.
const HALVINGS: usize = 52;

/// Normals from one to another.
type Arc = [DVec3; 2];

/// An edge of a triangle.
#[derive(Clone, Copy)]
struct Edge {
    triangle: u32,
    ends: [DVec3; 2],
    /// The third corner.
    far: DVec3,
    vertices: [u32; 2],
}

/// What is found along a normal.
#[derive(Clone, Copy)]
struct Look {
    normal: DVec3,
    /// The point of the body that is furthest against it.
    tip: DVec3,
    /// How much deeper the body gets where the normal is turned along the arc.
    slope: f64,
}

/// The shortest way of a body out of a surface along a normal that this has at an edge of one of some triangles, between those of the two that meet there,
/// and the triangle. Cost: five support points for each edge, and fifty where there is such a way.
pub(super) fn shortest(
    stars: &Stars,
    body: &Other,
    triangles: impl Iterator<Item = u32>,
) -> Option<(u32, Way)> {
    let edges = triangles.filter_map(|triangle| Edge::all(stars, triangle)).flatten();
    let ways = edges.flat_map(|edge| {
        let of_edge = edge.arcs(stars, body).into_iter().filter_map(move |arc| edge.way(arc, body));
        of_edge.map(move |way| (edge.triangle, way))
    });
    ways.min_by(|(_, x), (_, y)| x.depth.total_cmp(&y.depth))
}

impl Edge {
    /// Those of a primitive, if it is a triangle.
    fn all(stars: &Stars, triangle: u32) -> Option<[Edge; 3]> {
        let (corners, vertices) = (stars.corners(triangle), stars.welded(triangle));
        let (&[p, q, r], &[u, v, w]) = (&corners[..], &vertices[..]) else { return None };
        let edge = |ends, far, vertices| Edge { triangle, ends, far, vertices };
        Some([edge([p, q], r, [u, v]), edge([q, r], p, [v, w]), edge([r, p], q, [w, u])])
    }

    /// The normals that the surface has here, none where it is flat, or where more than two triangles meet.
    fn arcs(&self, stars: &Stars, body: &Other) -> SmallVec<[Arc; 2]> {
        let none = SmallVec::new();
        let [from, to] = self.ends;
        let own = stars.plane(self.triangle, body).normal;
        let mut others = stars.across(&self.vertices, self.triangle);
        let (beside, None) = (others.next(), others.next()) else { return none };
        let Some(beside) = beside else {
            // The end of the surface.
            let Some(aside) = own.cross(to - from).try_normalize() else { return none };
            let aside = if aside.dot(self.far - from) > 0.0 { -aside } else { aside };
            return smallvec![[own, aside], [aside, -own]];
        };
        let furthest = |normal: DVec3, corners: &[DVec3]| {
            let heights = corners.iter().map(|&corner| normal.dot(corner - from));
            heights.max_by(|x, y| x.abs().total_cmp(&y.abs())).unwrap_or(0.0)
        };
        let next = stars.plane(beside, body).normal;
        let (of_next, of_own) = (furthest(own, &stars.corners(beside)), furthest(next, &[self.far]));
        let leads_in = stars.orientation * of_next > 0.0;
        if leads_in || of_next.abs() < LEVEL || of_own.abs() < LEVEL {
            return none;
        }
        smallvec![[-own * of_next.signum(), -next * of_own.signum()]]
    }

    /// The shortest way of a body along a normal of an arc, where it is shorter than along those beside it and the body leaves the edge last.
    fn way(&self, [first, last]: Arc, body: &Other) -> Option<Way> {
        let [from, to] = self.ends;
        let along = (to - from).try_normalize()?;
        let turn = last - first;
        let look = |normal: DVec3| {
            let (tip, toward) = (body.furthest(-normal), turn - normal * normal.dot(turn));
            Look { normal, tip, slope: toward.dot(from - tip) }
        };
        let lowest = |[mut before, mut after]: [Look; 2]| {
            for _ in 0..HALVINGS {
                let middle = look((before.normal + after.normal).normalize());
                *(if middle.slope < 0.0 { &mut before } else { &mut after }) = middle;
            }
            let tip = before.tip.lerp(after.tip, before.slope / (before.slope - after.slope));
            let (out, place) = (before.normal, along.dot(tip - from));
            let is_at_the_edge = (0.0..=from.distance(to)).contains(&place);
            let way = Way { out, depth: out.dot(from - tip), foot: from + along * place };
            (is_at_the_edge && way.depth >= 0.0).then_some(way)
        };
        let looks = [0.0, 0.25, 0.5, 0.75, 1.0].map(|part| look((first + turn * part).normalize()));
        let valleys = looks.windows(2).filter(|ends| ends[0].slope < 0.0 && ends[1].slope > 0.0);
        let ways = valleys.filter_map(|ends| lowest([ends[0], ends[1]]));
        ways.min_by(|x, y| x.depth.total_cmp(&y.depth))
    }
}
