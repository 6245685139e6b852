//! How deep a triangle and eight others are in each other, in closed form.
//!
//! The difference of two triangles is a polytope whose facets are spanned by two edges each, of one triangle or of both: the eleven
//! axes of the separating-axis theorem. How far the difference reaches along any axis bounds the depth from above, and along the one
//! of the nearest facet is the depth. Where an axis has few right digits, as two edges are nearly parallel, a bound from below says so, and
//! nothing is taken on trust: the caller asks EPA.

use fearless_simd::Simd;
use fearless_simd::prelude::*;

use super::vector::{Vector, Wide, cross, dot, minus, one, splat, splat_triangle, steps_with, store};
use super::{Lanes, Row};
use crate::pair::triangle_triangle::Triangle;

/// What is known of the depths of a triangle in eight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Depths {
    /// The depth is at most this, up to rounding.
    pub most: Lanes,
    /// It is at least this; where [`most`](Self::most) is below the bound that was given, nothing need be true of it.
    pub least: Lanes,
}

/// Roundings of 2^-53 of a cross product, relative to the product of the lengths of two edges.
pub(crate) const CROSS_ERROR: f64 = 8.0 / (1u64 << 53) as f64;

/// The sine of the angle of two edges that are taken for parallel. Turning one of them into the direction of the other, after which they
/// span no facet, moves no point of the difference by more than its length times this.
pub(crate) const PARALLEL_SINE: f64 = 1.0 / (1u64 << 49) as f64;

/// The square of the length of an axis, or a normal, whose coordinates have been rounded as they should, not to numbers below the normal ones.
pub(crate) const SQUARED_MIN: f64 = 1e-290;

/// How deep a triangle is in those of a row that meet it, in some lanes, given as bits. Whether a depth is below `bound` is all that need be
/// known of it.
#[inline(never)] // see `distances`
pub(crate) fn depths<S: Simd>(simd: S, x: &Triangle, row: &Row, lanes: u32, bound: f64) -> Depths {
    simd.vectorize(
        #[inline(always)]
        || depths_on(simd, x, row, lanes, bound),
    )
}

#[inline(always)]
fn depths_on<S: Simd>(simd: S, x: &Triangle, row: &Row, lanes: u32, bound: f64) -> Depths {
    let mut depths = Depths { most: [0.0; 8], least: [0.0; 8] };
    // Around a corner, so that what is small beside the frame loses no digits.
    let around = splat(simd, x[0]);
    let x = splat_triangle(simd, &x.map(|corner| corner - x[0]));
    let of_x = Edges::new(&x);
    let infinite = one(simd, f64::INFINITY);
    for from in steps_with::<S>(lanes) {
        let y = row.corners(simd, from);
        let y = [minus(y[0], around), minus(y[1], around), minus(y[2], around)];
        let of_y = Edges::new(&y);
        let reach = of_x.longest.sqrt() + of_y.longest.sqrt();
        let mut bounds = Bounds { x, y, reach, most: infinite, least: infinite };
        bounds.take(simd, of_x.edges[0], of_x.edges[1]);
        bounds.take(simd, of_y.edges[0], of_y.edges[1]);
        if bounds.most.simd_ge(one(simd, bound)).any_true() {
            for e in of_x.edges {
                for f in of_y.edges {
                    bounds.take(simd, e, f);
                }
            }
        }
        // For edges that were taken for parallel; where all are, the difference is a segment.
        let least = bounds.least - reach * one(simd, 4.0 * PARALLEL_SINE);
        let least = bounds.least.simd_lt(infinite).select(least, -infinite);
        // `min` leaves the sign of zero open.
        store(simd, bounds.most + one(simd, 0.0), &mut depths.most, from);
        store(simd, least, &mut depths.least, from);
    }
    depths
}

/// The edges of triangles, with the square of the length of each and of the longest.
struct Edges<S: Simd> {
    edges: [(Vector<S>, Wide<S>); 3],
    longest: Wide<S>,
}

impl<S: Simd> Edges<S> {
    #[inline(always)]
    fn new(corners: &[Vector<S>; 3]) -> Self {
        let edges =
            [minus(corners[1], corners[0]), minus(corners[2], corners[1]), minus(corners[0], corners[2])];
        let squared = [dot(edges[0], edges[0]), dot(edges[1], edges[1]), dot(edges[2], edges[2])];
        let longest = squared[0].max(squared[1]).max(squared[2]);
        Edges { edges: [(edges[0], squared[0]), (edges[1], squared[1]), (edges[2], squared[2])], longest }
    }
}

/// The depths of triangles in each other, by the axes so far.
struct Bounds<S: Simd> {
    x: [Vector<S>; 3],
    y: [Vector<S>; 3],
    /// No point of the difference is further from the origin, which is in it.
    reach: Wide<S>,
    most: Wide<S>,
    least: Wide<S>,
}

impl<S: Simd> Bounds<S> {
    /// Takes in the axis across two edges, given with the squares of their lengths.
    #[inline(always)]
    fn take(&mut self, simd: S, (e, squared_e): (Vector<S>, Wide<S>), (f, squared_f): (Vector<S>, Wide<S>)) {
        let axis = cross(e, f);
        let squared = dot(axis, axis);
        let [of_x, of_y] = [extent(&self.x, axis), extent(&self.y, axis)];
        let overlap = (of_x[1] - of_y[0]).min(of_y[1] - of_x[0]);
        let per_length = one(simd, 1.0) / squared.sqrt();
        let height = overlap * per_length;
        let lengths = squared_e * squared_f;
        // So much may the axis be tilted.
        let tilt = one(simd, CROSS_ERROR) * lengths.sqrt() * per_length;
        let is_axis = squared.simd_gt(one(simd, SQUARED_MIN));
        let spans = is_axis & squared.simd_gt(lengths * one(simd, PARALLEL_SINE * PARALLEL_SINE));
        let infinite = one(simd, f64::INFINITY);
        self.most = self.most.min(is_axis.select(height, infinite));
        self.least = self.least.min(spans.select(height - tilt * self.reach, infinite));
    }
}

/// The least and the greatest height of corners along an axis.
#[inline(always)]
fn extent<S: Simd>(corners: &[Vector<S>; 3], axis: Vector<S>) -> [Wide<S>; 2] {
    let (p, q, r) = (dot(corners[0], axis), dot(corners[1], axis), dot(corners[2], axis));
    [p.min(q).min(r), p.max(q).max(r)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair::row::CONFIRMED;
    use crate::pair::row::tests::row_of;
    use crate::pair::triangle_triangle::intersect;
    use glam::{DAffine3, DVec3};
    use rand::Rng;
    use solid_convex::simd::{alike, dispatch};
    use solid_oracle::generate::seeded;
    use solid_oracle::{Convex, penetration_bounds};

    /// Law: the depth lies within the bounds, of random triangles, slivers, those with parallel edges or in one plane, and degenerate ones; nearly
    /// all are confirmed, and every level of instructions gives the same bits.
    #[test]
    fn depths_are_bounded_on_both_sides() {
        let seed = 71;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let hull = |triangle: &Triangle| Convex::Hull { points: triangle.to_vec() };
        let here = DAffine3::IDENTITY;
        // By kind of triangle.
        let (mut meet, mut confirmed) = ([0; 6], [0; 6]);
        for round in 0..1200 {
            let kind = round % 6;
            let tilt = 10f64.powf(rng.random_range(-16.0..-4.0));
            let mut point = || DVec3::from_array(std::array::from_fn(|_| rng.random_range(-0.5..0.5)));
            let mut triangle = || -> Triangle {
                let (p, q, r) = (point(), point(), point());
                match kind {
                    0 => [p, q, r].map(|corner| corner * 1e-3),
                    1 => [p, q, p + (q - p) * 0.3 + r * 1e-7],
                    2 => [p, p + DVec3::X + r * tilt, p + DVec3::Y * r.y],
                    3 => [p, q, r].map(|corner| corner * DVec3::new(1.0, 1.0, 0.0)),
                    4 => [p, q, q],
                    _ => [p, q, r],
                }
            };
            let x = triangle();
            let ys = std::array::from_fn(|lane| if lane == 0 { x } else { triangle() });
            let row = row_of(&ys);
            let all = f64::NEG_INFINITY;
            let bits = alike(|level| {
                let Depths { most, least } =
                    dispatch!(widest level, simd => depths(simd, &x, &row, 0xff, all));
                [most, least].map(|lanes| lanes.map(f64::to_bits))
            });
            let [most, least] = bits.map(|lanes| lanes.map(f64::from_bits));
            for (lane, y) in ys.iter().enumerate().filter(|(_, y)| intersect(&x, y)) {
                let Some((lower, upper)) = penetration_bounds(&hull(&x), &here, &hull(y), &here) else {
                    continue;
                };
                let (most, least) = (most[lane], least[lane]);
                assert!(most >= lower - 1e-14, "at most {most}, not {lower}: {x:?} {y:?}");
                assert!(least <= upper + 1e-14, "at least {least}, not {upper}: {x:?} {y:?}");
                meet[kind] += 1;
                confirmed[kind] += i32::from(most - least <= CONFIRMED);
                // A bound ends the search early, and only then.
                let bound = most - 1e-3 + 2e-3 * f64::from(round % 2 == 1);
                let known = dispatch!(simd => depths(simd, &x, &row, 1 << lane, bound));
                assert!(if bound > most { known.most[lane] < bound } else { known.most[lane] == most });
            }
        }
        println!("{confirmed:?} of {meet:?} are confirmed");
        assert!(meet.iter().all(|&meet| meet > 190), "few triangles meet");
        // In one plane edges are often nearly parallel.
        for (kind, percent) in [(0, 99), (3, 90), (5, 99)] {
            assert!(confirmed[kind] * 100 >= meet[kind] * percent);
        }
    }
}
