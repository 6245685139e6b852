//! The depth of two parallelepipeds, in closed form.
//!
//! `A - B` is a zonotope: the sum of the six edges of the two. Each of its facets is spanned by two of these, so that the fifteen
//! cross products of two edges have among them the normal of the facet nearest to the origin: the fifteen axes of the
//! separating-axis theorem (Gottschalk, Lin and Manocha, *OBBTree*, 1996, section 5), of any two placed boxes, sheared ones too.

use fearless_simd::{Simd, f64x4, prelude::*};
use glam::DVec3;

use super::{Nearest, Penetration};
use crate::difference::{Difference, SUPPORT_ERROR};
use crate::gjk::BEYOND_TOUCHING;
use crate::simd::dispatch;
use crate::{Support, Witness};

/// Roundings of 2^-53 of the cross product of two unit vectors: of the two, three each, and of the product itself.
const CROSS_ERROR: f64 = 8.0 / (1u64 << 53) as f64;

/// The sine of the angle of two edges that are taken for parallel: twice what rounding may make of parallel ones. Turning one of them into the
/// direction of the other, after which they span no facet, moves no point of the difference by more than its half length times this.
const PARALLEL_SINE: f64 = 2.0 * CROSS_ERROR;

/// No point of the difference, whose coordinates are below 2, is further from the origin.
const REACH: f64 = 4.0;

/// So much may the height of the facet of two edges at right angles be off.
const TILT: f64 = CROSS_ERROR * REACH;

/// Bounds that are further apart, in the unit of the difference, are for the search to narrow: where edges are nearly parallel, and
/// span a facet that may be the nearest.
const BOUNDS_APART_MAX: f64 = 1.0 / (1u64 << 44) as f64;

/// The pairs of six edges, four to a vector: an edge of `A` with each of `B` and with the next of `A`, and at last those of `B`.
const PAIRS: [[usize; 2]; 15] = [
    [1, 3],
    [1, 4],
    [1, 5],
    [1, 2],
    [2, 3],
    [2, 4],
    [2, 5],
    [2, 0],
    [0, 3],
    [0, 4],
    [0, 5],
    [0, 1],
    [4, 5],
    [5, 3],
    [3, 4],
];

/// Those of one object, as bits: of depths that are equal up to rounding theirs goes first.
const FACES: u64 = 0b0111_1000_1000_1000;

/// The difference of two parallelepipeds. Space: that of the difference.
struct Zonotope {
    /// The half edges, three of `A` and three of `B`.
    edges: [DVec3; 6],
    /// The same of unit length; zero for those too short to have a direction.
    units: [DVec3; 6],
    middle: DVec3,
}

/// The facet nearest to the origin.
struct Facet {
    /// Outward, unit.
    normal: DVec3,
    /// Its distance from the origin along the normal.
    height: f64,
    /// Two edges that span it.
    spanned_by: [usize; 2],
}

/// The slabs between facets that face each other, of all [`PAIRS`] of edges.
struct Slabs {
    /// The sines of the angles between the two edges.
    sine: [f64; 16],
    /// How far the origin is from the nearer facet. No number where the sine is 0.
    height: [f64; 16],
    /// The least of these, and of those along normals as far tilted as rounding may have them.
    lower: f64,
    /// The pairs whose height is the least up to rounding, as bits; none of edges that are taken for parallel.
    nearest: u64,
}

/// How deep two parallelepipeds are in each other; `None` for other objects, and where that is not certain to
/// [`BOUNDS_APART_MAX`], or not more than [`BEYOND_TOUCHING`].
pub(super) fn penetration<A, B>(difference: &Difference<A, B>) -> Option<Penetration>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let (local, edges, middle) = difference.half_edges()?;
    let zonotope = dispatch!(simd => Zonotope::new(simd, edges, middle));
    let (facet, lower) = zonotope.nearest()?;
    let certain = lower > BEYOND_TOUCHING && facet.height - lower <= BOUNDS_APART_MAX;
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
    #[inline(always)]
    fn new<S: Simd>(simd: S, edges: [DVec3; 6], middle: DVec3) -> Self {
        let [a, b, c, d, e, f] = edges;
        let of_first = unit(simd, &four(simd, [a, b, c, d]));
        let of_rest = unit(simd, &four(simd, [e, f, DVec3::ZERO, DVec3::ZERO]));
        let units = [of_first[0], of_first[1], of_first[2], of_first[3], of_rest[0], of_rest[1]];
        Zonotope { edges, units, middle }
    }

    /// The facet nearest to the origin, and a lower bound of the distance of all.
    fn nearest(&self) -> Option<(Facet, f64)> {
        let Slabs { sine, height, lower, nearest } = dispatch!(simd => self.slabs(simd));
        let first = if nearest & FACES != 0 { nearest & FACES } else { nearest };
        let k = first.trailing_zeros() as usize;
        let spanned_by @ [i, j] = *PAIRS.get(k)?;
        let normal = self.units[i].cross(self.units[j]) / sine[k];
        let normal = if normal.dot(self.middle) > 0.0 { -normal } else { normal };
        // Edges that were taken for parallel.
        Some((Facet { normal, height: height[k], spanned_by }, lower - SUPPORT_ERROR))
    }

    #[inline(always)]
    fn slabs<S: Simd>(&self, simd: S) -> Slabs {
        let [a, b, c, d, e, f] = self.units;
        let pairs = [
            (splat(simd, b), four(simd, [d, e, f, c])),
            (splat(simd, c), four(simd, [d, e, f, a])),
            (splat(simd, a), four(simd, [d, e, f, b])),
            (four(simd, [e, f, d, DVec3::ZERO]), four(simd, [f, d, e, DVec3::ZERO])),
        ];
        let middle = splat(simd, self.middle);
        let mut slabs = Slabs { sine: [0.0; 16], height: [0.0; 16], lower: 0.0, nearest: 0 };
        let infinite = f64x4::splat(simd, f64::INFINITY);
        let (mut lower, mut uppers) = (infinite, [infinite; 4]);
        for (i, (u, v)) in pairs.iter().enumerate() {
            let across = cross(u, v);
            let sine = dot(&across, &across).sqrt();
            let per_sine = f64x4::splat(simd, 1.0) / sine;
            let mut reach = f64x4::splat(simd, 0.0);
            for edge in &self.edges {
                reach += dot(&across, &splat(simd, *edge)).abs();
            }
            let height = (reach - dot(&across, &middle).abs()) * per_sine;
            // So much may the normal be tilted.
            let error = f64x4::splat(simd, TILT) * per_sine;
            let spans = sine.simd_gt(f64x4::splat(simd, PARALLEL_SINE));
            lower = lower.min(spans.select(height - error, infinite));
            uppers[i] = spans.select(height + error, infinite);
            sine.store_slice(&mut slabs.sine[4 * i..4 * i + 4]);
            height.store_slice(&mut slabs.height[4 * i..4 * i + 4]);
        }
        slabs.lower = least(lower);
        let [p, q, r, s] = uppers;
        let upper = f64x4::splat(simd, least(p.min(q).min(r.min(s))) + TILT);
        for (i, bound) in uppers.iter().enumerate() {
            slabs.nearest |= (bound.simd_le(upper) & bound.simd_lt(infinite)).to_bitmask() << (4 * i);
        }
        slabs
    }

    /// How much of each edge, from -1 to 1, there is in a point of a facet.
    fn parts(&self, facet: &Facet, target: DVec3) -> [f64; 6] {
        let Facet { normal, spanned_by, .. } = *facet;
        let lies_in = |k: usize| spanned_by.contains(&k) || normal.dot(self.units[k]).abs() <= SUPPORT_ERROR;
        let inside: [bool; 6] = std::array::from_fn(lies_in);
        let mut parts = [0.0; 6];
        let mut rest = target - self.middle;
        for k in (0..6).filter(|&k| !inside[k]) {
            parts[k] = normal.dot(self.units[k]).signum();
            rest -= self.edges[k] * parts[k];
        }
        // What is left is in the plane of the facet, a polygon whose sides are edges that lie in it.
        if inside.into_iter().filter(|&is_inside| is_inside).count() == 2 {
            self.parts_of_parallelogram(facet, rest, &mut parts);
        } else {
            self.parts_of_polygon(facet, &inside, rest, &mut parts);
        }
        parts
    }

    /// Of a facet in which no edges lie but those that span it: Cramer's rule.
    fn parts_of_parallelogram(&self, facet: &Facet, rest: DVec3, parts: &mut [f64; 6]) {
        let [i, j] = facet.spanned_by;
        for (k, other) in [(i, j), (j, i)] {
            let across = facet.normal.cross(self.units[other]);
            parts[k] = (across.dot(rest) / across.dot(self.edges[k])).clamp(-1.0, 1.0);
        }
    }

    /// Of any: the ray to the point from the middle of the facet leaves that through the side which it comes nearest to, as a part of the way.
    fn parts_of_polygon(&self, facet: &Facet, inside: &[bool; 6], rest: DVec3, parts: &mut [f64; 6]) {
        let Facet { normal, spanned_by, .. } = *facet;
        let mut exit = (0.0, spanned_by[0], DVec3::ZERO);
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
            return;
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

/// The units of four vectors, as [`DVec3::normalize_or_zero`] has them, to the bit.
#[inline(always)]
fn unit<S: Simd>(simd: S, v: &Four<S>) -> [DVec3; 4] {
    let (zero, infinite) = (f64x4::splat(simd, 0.0), f64x4::splat(simd, f64::INFINITY));
    let per_length = f64x4::splat(simd, 1.0) / dot(v, v).sqrt();
    let has_direction = per_length.simd_gt(zero) & per_length.simd_lt(infinite);
    let mut units = [DVec3::ZERO; 4];
    for (axis, x) in v.iter().enumerate() {
        let mut lanes = [0.0; 4];
        has_direction.select(*x * per_length, zero).store_slice(&mut lanes);
        for (unit, x) in units.iter_mut().zip(lanes) {
            unit[axis] = x;
        }
    }
    units
}

/// The least of four numbers.
#[inline(always)]
fn least<S: Simd>(x: f64x4<S>) -> f64 {
    let mut lanes = [0.0; 4];
    x.store_slice(&mut lanes);
    lanes[0].min(lanes[1]).min(lanes[2].min(lanes[3]))
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
    use rand::Rng;
    use solid_oracle::generate::seeded;

    use super::*;
    use crate::simd::levels;
    use crate::testing::in_cube;

    /// The slow twin: one pair of edges after the other.
    fn one_by_one(zonotope: &Zonotope, [i, j]: [usize; 2]) -> (f64, f64) {
        let across = zonotope.units[i].cross(zonotope.units[j]);
        let sine = across.length();
        let reach = zonotope.edges.iter().fold(0.0, |reach, edge| reach + across.dot(*edge).abs());
        (sine, (reach - across.dot(zonotope.middle).abs()) * (1.0 / sine))
    }

    /// Law: on every level units and slabs are those of one after the other, to the bit; of parallel edges, too, and of some without a length. The
    /// nearest are those that no other is below by more than rounding.
    #[test]
    fn slabs_are_those_of_the_pairs() {
        let mut rng = seeded(153);
        for case in 0..1000 {
            let mut edges: [DVec3; 6] = std::array::from_fn(|_| in_cube(&mut rng));
            match case % 4 {
                0 => edges[4] = edges[1] * 0.5,
                1 => edges[case / 4 % 6] *= [0.0, 1e-200][case / 24 % 2],
                _ => {}
            }
            let middle = in_cube(&mut rng);
            for level in levels() {
                let zonotope = dispatch!(level, simd => Zonotope::new(simd, edges, middle));
                assert_eq!(zonotope.units, edges.map(DVec3::normalize_or_zero), "{case}");
                let slabs = dispatch!(level, simd => zonotope.slabs(simd));
                let [mut lower, mut upper] = [f64::INFINITY; 2];
                for (k, pair) in PAIRS.into_iter().enumerate() {
                    let (sine, height) = one_by_one(&zonotope, pair);
                    assert_eq!(slabs.sine[k].to_bits(), sine.to_bits(), "{case}: {pair:?}");
                    assert!(slabs.height[k] == height || sine == 0.0, "{case}: {pair:?}");
                    if sine > PARALLEL_SINE {
                        lower = lower.min(height - TILT * (1.0 / sine));
                        upper = upper.min(height + TILT * (1.0 / sine));
                    }
                }
                assert_eq!(slabs.lower, lower, "{case}");
                for (k, height) in slabs.height.into_iter().enumerate() {
                    let is_near = slabs.sine[k] > PARALLEL_SINE
                        && height + TILT * (1.0 / slabs.sine[k]) <= upper + TILT;
                    assert_eq!(slabs.nearest >> k & 1 == 1, is_near, "{case}: {k}");
                }
            }
        }
    }

    /// Law: of a parallelogram Cramer's rule finds what the ray from its middle does.
    #[test]
    fn a_parallelogram_is_a_polygon() {
        let mut rng = seeded(177);
        for case in 0..1000 {
            let edges: [DVec3; 6] = std::array::from_fn(|_| in_cube(&mut rng));
            let units = edges.map(DVec3::normalize_or_zero);
            let zonotope = Zonotope { edges, units, middle: DVec3::ZERO };
            let spanned_by @ [i, j] = PAIRS[case % 15];
            let normal = units[i].cross(units[j]).normalize();
            let facet = Facet { normal, height: 0.0, spanned_by };
            let rest = edges[i] * rng.random_range(-1.0..1.0) + edges[j] * rng.random_range(-1.0..1.0);
            let inside = std::array::from_fn(|k| spanned_by.contains(&k));
            let [mut parts, mut expected] = [[0.0; 6]; 2];
            zonotope.parts_of_parallelogram(&facet, rest, &mut parts);
            zonotope.parts_of_polygon(&facet, &inside, rest, &mut expected);
            let sine = units[i].cross(units[j]).length();
            for k in 0..6 {
                let off = (parts[k] - expected[k]).abs() * edges[k].length() * sine;
                assert!(off < 1e-14, "{case}: {parts:?}, {expected:?}");
            }
        }
    }
}
