//! The depth of two parallelepipeds, in closed form.
//!
//! `A - B` is a zonotope: the sum of the six edges of the two. Each of its facets is spanned by two of these, so that the fifteen
//! cross products of two edges have among them the normal of the facet nearest to the origin: the fifteen axes of the
//! separating-axis theorem (Gottschalk, Lin and Manocha, *OBBTree*, 1996, section 5), of any two placed boxes, sheared ones too.

use fearless_simd::{Simd, f64x4, prelude::*};
use glam::DVec3;

use super::{Nearest, Penetration};
use crate::difference::{Difference, SUPPORT_ERROR};
use crate::gjk::TOUCHING_ERROR;
use crate::simd::dispatch;
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

/// The pairs of six edges, those of one object first: of equal depths, faces go before edges that cross. With each its place in [`Slabs`], where four
/// make a vector: an edge of `A` with each of `B` and with the next of `A`, and at last those of `B`.
const PAIRS: [([usize; 2], usize); 15] = [
    ([1, 2], 7),
    ([2, 0], 11),
    ([0, 1], 3),
    ([4, 5], 13),
    ([5, 3], 14),
    ([3, 4], 12),
    ([0, 3], 0),
    ([0, 4], 1),
    ([0, 5], 2),
    ([1, 3], 4),
    ([1, 4], 5),
    ([1, 5], 6),
    ([2, 3], 8),
    ([2, 4], 9),
    ([2, 5], 10),
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

/// The slabs between facets that face each other, of all pairs of edges.
struct Slabs {
    /// The sines of the angles between the two edges.
    sine: [f64; 16],
    /// How far the origin is from the nearer facet. No number where the sine is 0.
    height: [f64; 16],
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
        let slabs = dispatch!(simd => self.slabs(simd));
        let mut nearest: Option<([usize; 2], usize)> = None;
        let mut lower = f64::INFINITY;
        for (pair, k) in PAIRS {
            if slabs.sine[k] <= PARALLEL_SINE {
                continue;
            }
            // So much may the normal be tilted.
            let (height, error) = (slabs.height[k], CROSS_ERROR / slabs.sine[k] * REACH);
            lower = lower.min(height - error);
            if nearest.is_none_or(|(_, best)| height + error < slabs.height[best]) {
                nearest = Some((pair, k));
            }
        }
        let (spanned_by @ [i, j], k) = nearest?;
        let normal = self.units[i].cross(self.units[j]) / slabs.sine[k];
        let normal = if normal.dot(self.middle) > 0.0 { -normal } else { normal };
        // Edges that were taken for parallel.
        Some((Facet { normal, height: slabs.height[k], spanned_by }, lower - SUPPORT_ERROR))
    }

    /// Of all pairs of edges, each where [`PAIRS`] says.
    #[inline(always)]
    fn slabs<S: Simd>(&self, simd: S) -> Slabs {
        let [a, b, c, d, e, f] = self.units;
        let pairs = [
            (splat(simd, a), four(simd, [d, e, f, b])),
            (splat(simd, b), four(simd, [d, e, f, c])),
            (splat(simd, c), four(simd, [d, e, f, a])),
            (four(simd, [d, e, f, DVec3::ZERO]), four(simd, [e, f, d, DVec3::ZERO])),
        ];
        let middle = splat(simd, self.middle);
        let mut slabs = Slabs { sine: [0.0; 16], height: [0.0; 16] };
        for (i, (u, v)) in pairs.iter().enumerate() {
            let [x, y, z] = cross(u, v);
            let sine = dot(&[x, y, z], &[x, y, z]).sqrt();
            let normal = [x / sine, y / sine, z / sine];
            let mut reach = f64x4::splat(simd, 0.0);
            for edge in &self.edges {
                reach += dot(&normal, &splat(simd, *edge)).abs();
            }
            sine.store_slice(&mut slabs.sine[4 * i..4 * i + 4]);
            (reach - dot(&normal, &middle).abs()).store_slice(&mut slabs.height[4 * i..4 * i + 4]);
        }
        slabs
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

/// Four vectors, by coordinates.
type Four<S> = [f64x4<S>; 3];

/// One vector four times.
#[inline(always)]
fn splat<S: Simd>(simd: S, v: DVec3) -> Four<S> {
    [f64x4::splat(simd, v.x), f64x4::splat(simd, v.y), f64x4::splat(simd, v.z)]
}

#[inline(always)]
fn four<S: Simd>(simd: S, [a, b, c, d]: [DVec3; 4]) -> Four<S> {
    [
        f64x4::simd_from(simd, [a.x, b.x, c.x, d.x]),
        f64x4::simd_from(simd, [a.y, b.y, c.y, d.y]),
        f64x4::simd_from(simd, [a.z, b.z, c.z, d.z]),
    ]
}

#[inline(always)]
fn dot<S: Simd>(u: &Four<S>, v: &Four<S>) -> f64x4<S> {
    u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
}

/// As [`DVec3::cross`] has it, to the bit.
#[inline(always)]
fn cross<S: Simd>(u: &Four<S>, v: &Four<S>) -> Four<S> {
    [u[1] * v[2] - v[1] * u[2], u[2] * v[0] - v[2] * u[0], u[0] * v[1] - v[0] * u[1]]
}

#[cfg(test)]
mod tests {
    use solid_oracle::generate::seeded;

    use super::*;
    use crate::simd::levels;
    use crate::testing::in_cube;

    /// The slow twin: one pair of edges after the other.
    fn one_by_one(zonotope: &Zonotope, [i, j]: [usize; 2]) -> (f64, f64) {
        let across = zonotope.units[i].cross(zonotope.units[j]);
        let sine = across.length();
        let normal = across / sine;
        let reach = zonotope.edges.iter().fold(0.0, |reach, edge| reach + normal.dot(*edge).abs());
        (sine, reach - normal.dot(zonotope.middle).abs())
    }

    /// Law: on every level the slabs are those of one pair after the other, to the bit; of parallel edges, too.
    #[test]
    fn slabs_are_those_of_the_pairs() {
        let mut rng = seeded(153);
        for case in 0..1000 {
            let mut edges: [DVec3; 6] = std::array::from_fn(|_| in_cube(&mut rng));
            if case % 2 == 0 {
                edges[4] = edges[1] * 0.5;
            }
            let units = edges.map(DVec3::normalize_or_zero);
            let zonotope = Zonotope { edges, units, middle: in_cube(&mut rng) };
            for level in levels() {
                let slabs = dispatch!(level, simd => zonotope.slabs(simd));
                for (pair, k) in PAIRS {
                    let (sine, height) = one_by_one(&zonotope, pair);
                    assert_eq!(slabs.sine[k].to_bits(), sine.to_bits(), "{case}: {pair:?}");
                    assert!(slabs.height[k] == height || sine == 0.0, "{case}: {pair:?}");
                }
            }
        }
    }
}
