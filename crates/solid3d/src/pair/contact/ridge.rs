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

/// The shortest way of a body out of a surface along a normal that this has at an edge of one of some triangles, between those of the two that meet there,
/// and the triangle. Cost: five support points for each edge, and fifty where there is such a way.
pub(super) fn shortest(stars: &Stars, body: &Other, triangles: &[u32]) -> Option<(u32, Way)> {
    let mut shortest = None::<(u32, Way)>;
    for &triangle in triangles {
        let (corners, vertices) = (stars.corners(triangle), stars.welded(triangle));
        let (&[p, q, r], &[u, v, w]) = (&corners[..], &vertices[..]) else { continue };
        for (ends, far, edge) in [([p, q], r, [u, v]), ([q, r], p, [v, w]), ([r, p], q, [w, u])] {
            for arc in arcs(stars, body, triangle, (ends, far, edge)) {
                if let Some(way) = way(ends, arc, body)
                    && shortest.as_ref().is_none_or(|(_, known)| way.depth < known.depth)
                {
                    shortest = Some((triangle, way));
                }
            }
        }
    }
    shortest
}

/// The normals that a surface has at an edge of a triangle, with its third corner: from one to the other. None where it is flat, or where there are more than two
/// triangles.
fn arcs(
    stars: &Stars,
    body: &Other,
    triangle: u32,
    ([from, to], far, edge): ([DVec3; 2], DVec3, [u32; 2]),
) -> SmallVec<[[DVec3; 2]; 2]> {
    let none = SmallVec::new();
    let own = stars.plane(triangle, body).normal;
    let Some(aside) = own.cross(to - from).try_normalize() else { return none };
    let mut others = stars.across(edge, triangle);
    let (beside, None) = (others.next(), others.next()) else { return none };
    let Some(beside) = beside else {
        // The end of the surface.
        let aside = if aside.dot(far - from) > 0.0 { -aside } else { aside };
        return smallvec![[own, aside], [aside, -own]];
    };
    let bend = |normal: DVec3, corners: &[DVec3]| {
        let heights = corners.iter().map(|&corner| normal.dot(corner - from));
        heights.max_by(|x, y| x.abs().total_cmp(&y.abs())).unwrap_or(0.0)
    };
    let next = stars.plane(beside, body).normal;
    let (of_next, of_own) = (bend(own, &stars.corners(beside)), bend(next, &[far]));
    let is_out = stars.orientation * of_next <= 0.0;
    if !is_out || of_next.abs() < LEVEL || of_own.abs() < LEVEL {
        return none;
    }
    smallvec![[-own * of_next.signum(), -next * of_own.signum()]]
}

/// The shortest way of a body out of an edge along a normal between two, where it is shorter than along those beside it and the body leaves the edge last.
fn way([from, to]: [DVec3; 2], [first, last]: [DVec3; 2], body: &Other) -> Option<Way> {
    let along = (to - from).try_normalize()?;
    let turn = last - first;
    let look = |normal: DVec3| {
        let (tip, toward) = (body.furthest(-normal), turn - normal * normal.dot(turn));
        Look { normal, tip, slope: toward.dot(from - tip) }
    };
    let parts = [0.0, 0.25, 0.5, 0.75, 1.0].map(|part| look((first + turn * part).normalize()));
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
    let valleys = parts.windows(2).filter(|ends| ends[0].slope < 0.0 && ends[1].slope > 0.0);
    let ways = valleys.filter_map(|ends| lowest([ends[0], ends[1]]));
    ways.min_by(|x, y| x.depth.total_cmp(&y.depth))
}

/// What is found along a normal.
#[derive(Clone, Copy)]
struct Look {
    normal: DVec3,
    /// The point of the body that is furthest against it.
    tip: DVec3,
    /// How much deeper the body gets where it is turned.
    slope: f64,
}
