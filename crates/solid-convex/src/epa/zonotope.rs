//! The depth of two parallelepipeds, in closed form.
//!
//! `A - B` is a zonotope: the sum of the six edges of the two. Each of its facets is spanned by two of these, so that the fifteen
//! cross products of two edges have among them the normal of the facet nearest to the origin: the fifteen axes of the
//! separating-axis theorem (Gottschalk, Lin and Manocha, *OBBTree*, 1996, section 5), of any two placed boxes, sheared ones too.

use glam::DVec3;

use super::{Nearest, Penetration};
use crate::difference::{Difference, SUPPORT_ERROR};
use crate::gjk::TOUCHING_ERROR;
use crate::{Support, Witness};

/// Roundings of 2^-53 of the cross product of two unit vectors: of the two, three each, and of the product itself.
const CROSS_ERROR: f64 = 8.0 / (1u64 << 53) as f64;

/// The sine of the angle of two edges that are taken for parallel: twice what rounding may make of parallel ones. Turning one of them into the
/// direction of the other, after which they span no facet, moves no point of the difference by more than its half length times this.
const PARALLEL_SINE: f64 = 2.0 * CROSS_ERROR;

/// No point of the difference, whose coordinates are below 2, is further from the origin.
const REACH: f64 = 4.0;

/// Depths that are known to be at least this are beyond what GJK may take for a gap.
const DEPTH_MIN: f64 = 4.0 * TOUCHING_ERROR;

/// Bounds that are further apart, in the unit of the difference, are for the search to narrow: where edges are nearly parallel, and
/// span a facet that may be the nearest.
const BOUNDS_APART_MAX: f64 = 1.0 / (1u64 << 44) as f64;

/// The pairs of six edges, those of one object first: of equal depths, faces go before edges that cross.
const PAIRS: [[usize; 2]; 15] = [
    [1, 2],
    [2, 0],
    [0, 1],
    [4, 5],
    [5, 3],
    [3, 4],
    [0, 3],
    [0, 4],
    [0, 5],
    [1, 3],
    [1, 4],
    [1, 5],
    [2, 3],
    [2, 4],
    [2, 5],
];

/// The difference of two parallelepipeds. Space: that of the difference.
struct Zonotope {
    /// The half edges, three of `A` and three of `B`.
    edges: [DVec3; 6],
    /// The same of unit length; zero for those too short to have a direction.
    units: [DVec3; 6],
    middle: DVec3,
}

/// A facet.
struct Facet {
    /// Outward, unit.
    normal: DVec3,
    /// Its distance from the origin along the normal.
    height: f64,
    /// Two edges that span it.
    spanned_by: [usize; 2],
}

/// How deep two parallelepipeds are in each other; `None` for other objects, and where that is not certain to
/// [`BOUNDS_APART_MAX`], or not more than [`DEPTH_MIN`].
pub(super) fn penetration<A, B>(difference: &Difference<A, B>) -> Option<Penetration>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let (local, edges, middle) = difference.half_edges()?;
    let zonotope = Zonotope { edges, units: edges.map(DVec3::normalize_or_zero), middle };
    let (facet, lower) = zonotope.nearest()?;
    let certain = lower > DEPTH_MIN && facet.height - lower <= BOUNDS_APART_MAX;
    if !certain {
        return None;
    }
    let parts = zonotope.parts(&facet, facet.normal * facet.height);
    let sum = |from: usize| (from..from + 3).fold(DVec3::ZERO, |sum, k| sum + local[k] * parts[k]);
    let [of_a, of_b] = difference.centers();
    let points = Witness { on_a: of_a + sum(0), on_b: of_b - sum(3) };
    let Facet { height, normal, .. } = facet;
    Some(Nearest { height, lower, normal, points }.penetration(difference.scale(), 0.0))
}

impl Zonotope {
    /// The facet nearest to the origin, and a lower bound of the distance of all.
    fn nearest(&self) -> Option<(Facet, f64)> {
        let mut nearest: Option<Facet> = None;
        let mut lower = f64::INFINITY;
        for [i, j] in PAIRS {
            let across = self.units[i].cross(self.units[j]);
            let sine = across.length();
            if sine <= PARALLEL_SINE {
                continue;
            }
            let normal = across / sine;
            let along = normal.dot(self.middle);
            let reach = self.edges.iter().fold(0.0, |reach, edge| reach + normal.dot(*edge).abs());
            let height = reach - along.abs();
            // So much may the normal be tilted.
            let error = CROSS_ERROR / sine * REACH;
            lower = lower.min(height - error);
            if nearest.as_ref().is_none_or(|nearest| height + error < nearest.height) {
                let normal = if along > 0.0 { -normal } else { normal };
                nearest = Some(Facet { normal, height, spanned_by: [i, j] });
            }
        }
        // Edges that were taken for parallel.
        Some((nearest?, lower - SUPPORT_ERROR))
    }

    /// How much of each edge, from -1 to 1, there is in a point of a facet.
    fn parts(&self, facet: &Facet, target: DVec3) -> [f64; 6] {
        let normal = facet.normal;
        let lies_in =
            |k: usize| facet.spanned_by.contains(&k) || normal.dot(self.units[k]).abs() <= SUPPORT_ERROR;
        let inside: [bool; 6] = std::array::from_fn(lies_in);
        let mut parts = [0.0; 6];
        let mut rest = target - self.middle;
        for k in (0..6).filter(|&k| !inside[k]) {
            parts[k] = normal.dot(self.units[k]).signum();
            rest -= self.edges[k] * parts[k];
        }
        // What is left is in the plane of the facet, a polygon whose sides are edges that lie in it. The ray to it from the middle of the
        // facet leaves that through the side which it comes nearest to, as a part of the way.
        let mut exit = (0.0, facet.spanned_by[0], DVec3::ZERO);
        for side in (0..6).filter(|&k| inside[k]) {
            let out = normal.cross(self.units[side]);
            let reach = (0..6).filter(|&k| inside[k]).map(|k| out.dot(self.edges[k]).abs()).sum::<f64>();
            let share = out.dot(rest) / reach;
            if share.abs() > exit.0 {
                exit = (share.abs(), side, out * share.signum());
            }
        }
        let (share, side, out) = exit;
        if share == 0.0 {
            return parts;
        }
        let mut at_side = rest / share;
        let share = share.min(1.0);
        let is_parallel = |k: usize| k == side || out.dot(self.units[k]).abs() <= SUPPORT_ERROR;
        for k in (0..6).filter(|&k| inside[k] && !is_parallel(k)) {
            let part = out.dot(self.units[k]).signum();
            at_side -= self.edges[k] * part;
            parts[k] = share * part;
        }
        let along = self.units[side];
        let parallel = || (0..6).filter(|&k| inside[k] && is_parallel(k));
        let length: f64 = parallel().map(|k| self.edges[k].length()).sum();
        let place = (at_side.dot(along) / length).clamp(-1.0, 1.0);
        for k in parallel() {
            parts[k] = share * place * along.dot(self.units[k]).signum();
        }
        parts
    }
}
