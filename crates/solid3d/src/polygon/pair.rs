//! Two polygons: what every algorithm for them begins with.

use std::borrow::Cow;

use solid_convex::unit_scale;

use super::Polygon;
use super::chain::{Base, Chain};
use super::exact::segments_meet_in_space;
use super::segment;

/// Two chains in one scale.
pub(super) struct Pair<'a> {
    pub a: Cow<'a, Chain>,
    pub b: Cow<'a, Chain>,
    /// What the coordinates were multiplied by: a power of two.
    pub scale: f64,
}

/// How two polygons' planes lie to each other.
pub(super) enum Setting {
    /// One plane holds both polygons; the base is of A.
    Coplanar(Base),
    /// At least one polygon has no area: all its vertices are collinear.
    Degenerate,
    /// The planes meet in a line, or are parallel. For the vertices of A their heights over the plane of B, and the other way
    /// round.
    Transversal { bases: [Base; 2], of_a: Vec<f64>, of_b: Vec<f64> },
    /// A vertex is so near the other's plane that the unevenness of that polygon decides.
    Unclear,
}

impl<'a> Pair<'a> {
    pub fn new(a: &'a Polygon, b: &'a Polygon) -> Pair<'a> {
        if a.fits_predicates && b.fits_predicates {
            return Pair { a: Cow::Borrowed(&a.chain), b: Cow::Borrowed(&b.chain), scale: 1.0 };
        }
        let scale = unit_scale(a.reach().max(b.reach()));
        Pair { a: Cow::Owned(a.chain.scaled(scale)), b: Cow::Owned(b.chain.scaled(scale)), scale }
    }

    pub fn setting(&self) -> Setting {
        let (a, b) = (&*self.a, &*self.b);
        let (Some(base_a), Some(base_b)) = (a.base, b.base) else { return Setting::Degenerate };
        let sides = |of: &Chain, over: &Chain, base: Base| -> Vec<f64> {
            of.vertices.iter().map(|&p| over.side(base, p)).collect()
        };
        let of_a = sides(a, b, base_b);
        if of_a.iter().any(|&side| b.is_unclear(side)) {
            return Setting::Unclear;
        }
        if of_a.iter().all(|&side| side == 0.0) {
            return Setting::Coplanar(base_a);
        }
        let of_b = sides(b, a, base_a);
        if of_b.iter().any(|&side| a.is_unclear(side)) {
            return Setting::Unclear;
        }
        Setting::Transversal { bases: [base_a, base_b], of_a, of_b }
    }

    /// Polygons of one plane meet if and only if their boundaries do, or one contains the other.
    pub fn coplanar_meet(&self, base: Base) -> bool {
        let (a, b) = (&*self.a, &*self.b);
        let meets = |[i, j]: [usize; 2]| segment::meets_in_plane(b, base, a.vertices[i], a.vertices[j]);
        a.edges().any(meets) || segment::meets_in_plane(a, base, b.vertices[0], b.vertices[0])
    }

    /// A polygon without an area is the union of its edges.
    pub fn degenerate_meet(&self) -> bool {
        let (a, b) = (&*self.a, &*self.b);
        match (a.base, b.base) {
            (None, None) => edges_meet_edges(a, b),
            (None, Some(base)) => edges_meet_polygon(a, b, base),
            (Some(base), _) => edges_meet_polygon(b, a, base),
        }
    }
}

fn edges_meet_edges(a: &Chain, b: &Chain) -> bool {
    let meet = |[i, j]: [usize; 2], [k, l]: [usize; 2]| {
        segments_meet_in_space(a.vertices[i], a.vertices[j], b.vertices[k], b.vertices[l])
    };
    a.edges().any(|x| b.edges().any(|y| meet(x, y)))
}

fn edges_meet_polygon(edges_of: &Chain, polygon: &Chain, base: Base) -> bool {
    edges_of
        .edges()
        .any(|[i, j]| segment::meets_polygon(polygon, base, edges_of.vertices[i], edges_of.vertices[j]))
}
