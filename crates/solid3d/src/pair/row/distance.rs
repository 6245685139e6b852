//! The distances of a triangle and eight others: over all pairs of edges, and of a corner and the other's face.
//!
//! Two triangles that do not meet are closest on two edges, or at a corner of one and inside the other. Each of these
//! fifteen gives two points, one on each triangle, whose distance is an upper bound whatever rounding does to parameters, as
//! they are clamped to the triangle. Nearly parallel edges and slivers may miss the best points; so nothing is taken on trust:
//! the plane across the segment between the points gives a lower bound (as in GJK, thesis, section 4.3.3), and where it does
//! not confirm the distance, the caller asks GJK.

use fearless_simd::Simd;
use fearless_simd::prelude::*;
use glam::DVec3;

use super::depth::SQUARED_MIN;
use super::vector::{
    Vector, Wide, along, cross, dot, minus, one, splat, splat_triangle, steps_with, store, times,
};
use super::{Lanes, Row};
use crate::pair::triangle_triangle::Triangle;
use crate::tree::bits;

/// What is known of the distances of a triangle and eight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Near {
    /// The distance of two points, one on each.
    pub distance: Lanes,
    /// A lower bound of the distance, up to rounding: not above it.
    pub least: Lanes,
    /// From the point of a lane to that of the one.
    v: [Lanes; 3],
}

impl Near {
    /// Nothing is known.
    pub const UNKNOWN: Near = Near { distance: [f64::INFINITY; 8], least: [0.0; 8], v: [[0.0; 8]; 3] };

    /// Of some lanes, given as bits, the nearest; the lowest of those.
    #[inline(always)]
    pub fn nearest(&self, lanes: u32) -> Option<usize> {
        bits(lanes).reduce(|i, j| if self.distance[j] < self.distance[i] { j } else { i })
    }

    /// Takes in what was found of some lanes.
    #[inline(always)]
    fn take<S: Simd>(&mut self, simd: S, best: &Best<S>, x: &[Vector<S>], y: &[Vector<S>; 3], from: usize) {
        // v points from y to x: what y has most of it, and x least, bounds the distance from below.
        let (v, distance) = (best.v, best.squared.sqrt());
        let mut of_x = dot(x[0], v);
        for corner in &x[1..] {
            of_x = of_x.min(dot(*corner, v));
        }
        let of_y = dot(y[0], v).max(dot(y[1], v)).max(dot(y[2], v));
        store(simd, distance, &mut self.distance, from);
        store(simd, (of_x - of_y) / distance.max(one(simd, TINY)), &mut self.least, from);
        for axis in 0..3 {
            store(simd, v.0[axis], &mut self.v[axis], from);
        }
    }

    /// The direction from the point of a lane to that of the one; zero when they coincide.
    pub fn axis(&self, lane: usize) -> DVec3 {
        let [x, y, z] = &self.v;
        DVec3::new(x[lane], y[lane], z[lane]).normalize_or_zero()
    }
}

/// A distance of triangles is taken for right when a lower bound comes as near, in the common frame, where the size of the
/// data is from 1 to 2: well within the error that distances may have.
pub(crate) const CONFIRMED: f64 = 1e-13;

/// The greater of a positive number and this is not zero: what is divided by.
const TINY: f64 = f64::MIN_POSITIVE;

/// The distances of a triangle and those of a row in some lanes, given as bits; of others nothing need be known.
#[inline(never)] // nor into the loops of the walk: on the scalar level, optimising these then takes minutes
pub(crate) fn distances<S: Simd>(simd: S, x: &Triangle, row: &Row, lanes: u32) -> Near {
    simd.vectorize(
        #[inline(always)]
        || distances_on(simd, x, row, lanes),
    )
}

/// The distances of a point, or of a segment, by its two ends, and the triangles of a row in some lanes: as of a triangle that is
/// but that.
#[inline(never)] // see `distances`
pub(crate) fn distances_of_core<S: Simd, const N: usize>(
    simd: S,
    core: &[DVec3; N],
    row: &Row,
    lanes: u32,
) -> Near {
    simd.vectorize(
        #[inline(always)]
        || distances_of_core_on(simd, core, row, lanes),
    )
}

#[inline(always)]
fn distances_of_core_on<S: Simd, const N: usize>(simd: S, core: &[DVec3; N], row: &Row, lanes: u32) -> Near {
    let mut x = [splat(simd, core[0]); N];
    for i in 1..N {
        x[i] = splat(simd, core[i]);
    }
    let mut near = Near::UNKNOWN;
    for from in steps_with::<S>(lanes) {
        let y = row.corners(simd, from);
        let mut best = Best { squared: one(simd, f64::INFINITY), v: x[0] };
        if N == 1 {
            point_and_all(simd, x[0], &y, &mut best);
        } else {
            edge_and_all(simd, [x[0], x[N - 1]], &y, &mut best);
        }
        all_faces(simd, &x, &y, 1.0, &mut best);
        near.take(simd, &best, &x, &y, from);
    }
    near
}

/// A point against the edges of a triangle.
#[inline(always)]
fn point_and_all<S: Simd>(simd: S, x: Vector<S>, y: &[Vector<S>; 3], best: &mut Best<S>) {
    for j in 0..3 {
        let q = minus(y[(j + 1) % 3], y[j]);
        let r = minus(x, y[j]);
        let t = clamped(simd, dot(q, r) / dot(q, q).max(one(simd, TINY)));
        let v = along(r, q, -t);
        best.offer(dot(v, v), v);
    }
}

#[inline(always)]
fn distances_on<S: Simd>(simd: S, x: &Triangle, row: &Row, lanes: u32) -> Near {
    let x = splat_triangle(simd, x);
    let mut near = Near::UNKNOWN;
    for from in steps_with::<S>(lanes) {
        let y = row.corners(simd, from);
        let mut best = Best { squared: one(simd, f64::INFINITY), v: x[0] };
        for i in 0..3 {
            edge_and_all(simd, [x[i], x[(i + 1) % 3]], &y, &mut best);
        }
        all_faces(simd, &x, &y, 1.0, &mut best);
        all_faces(simd, &y, &x, -1.0, &mut best);
        near.take(simd, &best, &x, &y, from);
    }
    near
}

/// The closest two points so far.
struct Best<S: Simd> {
    squared: Wide<S>,
    /// From the point of `y` to that of `x`.
    v: Vector<S>,
}

impl<S: Simd> Best<S> {
    #[inline(always)]
    fn offer(&mut self, squared: Wide<S>, v: Vector<S>) {
        let nearer = squared.simd_lt(self.squared);
        self.squared = nearer.select(squared, self.squared);
        for axis in 0..3 {
            self.v.0[axis] = nearer.select(v.0[axis], self.v.0[axis]);
        }
    }
}

/// An edge of one against all of the other (Ericson, *Real-Time Collision Detection*, 2005, section 5.1.9).
#[inline(always)]
fn edge_and_all<S: Simd>(simd: S, [x, x_end]: [Vector<S>; 2], y: &[Vector<S>; 3], best: &mut Best<S>) {
    let tiny = one(simd, TINY);
    let p = minus(x_end, x);
    let squared_p = dot(p, p);
    let per_p = one(simd, 1.0) / squared_p.max(tiny);
    for j in 0..3 {
        let q = minus(y[(j + 1) % 3], y[j]);
        let squared_q = dot(q, q);
        let per_q = one(simd, 1.0) / squared_q.max(tiny);
        let r = minus(x, y[j]);
        let (b, c, f) = (dot(p, q), dot(p, r), dot(q, r));
        let denominator = squared_p * squared_q - b * b;
        let s = clamped(simd, (b * f - c * squared_q) / denominator.max(tiny));
        let t = clamped(simd, (b * s + f) * per_q);
        let s = clamped(simd, (b * t - c) * per_p);
        let v = along(along(r, p, s), q, -t);
        best.offer(dot(v, v), v);
    }
}

/// Within an edge.
#[inline(always)]
fn clamped<S: Simd>(simd: S, t: Wide<S>) -> Wide<S> {
    let zero = one(simd, 0.0);
    // Not `max`, which leaves the sign of zero open.
    t.simd_gt(zero).select(t, zero).min(one(simd, 1.0))
}

/// The corners of one above the face of the other. `sign` is that of a vector from the face to the corner in `Best::v`,
/// which points to `x`. A face too small for digits of its normal is left to its edges.
#[inline(always)]
fn all_faces<S: Simd>(simd: S, of: &[Vector<S>], face: &[Vector<S>; 3], sign: f64, best: &mut Best<S>) {
    let (zero, least) = (one(simd, 0.0), one(simd, SQUARED_MIN));
    let edges = [minus(face[1], face[0]), minus(face[2], face[1]), minus(face[0], face[2])];
    let normal = cross(edges[0], edges[1]);
    let inward = [cross(normal, edges[0]), cross(normal, edges[1]), cross(normal, edges[2])];
    let squared = dot(normal, normal);
    let per_squared = one(simd, sign) / squared.max(one(simd, TINY));
    for corner in of {
        let from = minus(*corner, face[0]);
        let inside = dot(from, inward[0]).simd_ge(zero)
            & dot(minus(*corner, face[1]), inward[1]).simd_ge(zero)
            & dot(minus(*corner, face[2]), inward[2]).simd_ge(zero)
            & squared.simd_gt(least);
        let v = times(normal, dot(from, normal) * per_squared);
        best.offer(inside.select(dot(v, v), one(simd, f64::INFINITY)), v);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair::row::tests::row_of;
    use rand::Rng;
    use solid_convex::simd::{Level, alike, dispatch};
    use solid_oracle::generate::seeded;
    use solid_oracle::triangle_distance;

    /// The distances and their lower bounds, the same bits on every level of instructions.
    fn on_all(near: impl Fn(Level) -> Near) -> [Lanes; 2] {
        let bits = alike(|level| {
            let Near { distance, least, .. } = near(level);
            [distance, least].map(|lanes| lanes.map(f64::to_bits))
        });
        bits.map(|lanes| lanes.map(f64::from_bits))
    }

    /// Of a point and of a segment: as of a triangle that is but that, and the levels of instructions agree.
    #[test]
    fn a_core_is_a_triangle_of_no_area() {
        let seed = 33;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let (mut apart, mut crossing) = (0, 0);
        for round in 0..2000 {
            let mut point = || DVec3::from_array(std::array::from_fn(|_| rng.random_range(-0.5..0.5)));
            let core = [point(), point()];
            let ys = std::array::from_fn(|lane| {
                let (q, r) = (point(), point());
                if lane == 7 && round % 2 == 0 { [q, r, q.lerp(r, 0.3)] } else { [q, r, point()] }
            });
            let row = row_of(&ys);
            let point = on_all(
                |level| dispatch!(widest level, simd => distances_of_core(simd, &[core[0]], &row, 0xff)),
            );
            let segment =
                on_all(|level| dispatch!(widest level, simd => distances_of_core(simd, &core, &row, 0xff)));
            for (lane, y) in ys.iter().enumerate() {
                for (near, x) in [(&point, [core[0]; 3]), (&segment, [core[0], core[1], core[1]])] {
                    let exact = triangle_distance(&x, y);
                    let (distance, least) = (near[0][lane], near[1][lane]);
                    assert!(distance >= exact - 1e-15, "{distance} for {exact}: {x:?} {y:?}");
                    assert!(least <= exact + 4e-15, "at least {least} for {exact}: {x:?} {y:?}");
                    if exact > 0.0 {
                        // The way between what nearly touches is short, and its direction rounded.
                        let doubt = if exact > 1e-2 { 1e-13 } else { 1e-9 };
                        assert!(distance - least <= doubt, "{least} to {distance}: {x:?} {y:?}");
                        apart += 1;
                    } else {
                        crossing += 1;
                    }
                }
            }
        }
        println!("{apart} are apart, {crossing} cross");
        assert!(apart > 10 * crossing && crossing > 300);
    }

    /// Random triangles, slivers, parallel edges, and degenerate ones: the distance is never below the true one, the lower bound
    /// never above it, nearly all are confirmed, and every level of instructions gives the same bits.
    #[test]
    fn distances_are_bounded_on_both_sides() {
        let seed = 31;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let (mut lanes, mut confirmed, mut apart) = (0, 0, 0);
        for round in 0..3000 {
            let mut point = || DVec3::from_array(std::array::from_fn(|_| rng.random_range(-0.5..0.5)));
            let mut triangle = |away: DVec3| -> Triangle {
                let (p, q, r) = (point() + away, point() + away, point() + away);
                match round % 6 {
                    0..3 => [p, q, r],
                    3 => [p, q, p + (q - p) * 0.3 + r * 1e-7],
                    4 => [p, p + DVec3::X, p + DVec3::Y * r.y],
                    _ => [p, q, q],
                }
            };
            let x = triangle(DVec3::ZERO);
            let ys = std::array::from_fn(|lane| triangle(DVec3::Z * 0.25 * lane as f64));
            let row = row_of(&ys);
            let near = on_all(|level| dispatch!(widest level, simd => distances(simd, &x, &row, 0xff)));
            for (lane, y) in ys.iter().enumerate() {
                let exact = triangle_distance(&x, y);
                let (distance, least) = (near[0][lane], near[1][lane]);
                assert!(distance >= exact - 1e-15, "{distance} for {exact}: {x:?} {y:?}");
                assert!(least <= exact + 4e-15, "at least {least} for {exact}: {x:?} {y:?}");
                if exact > 0.0 {
                    lanes += 1;
                    apart += i32::from(exact > 0.1);
                    confirmed += i32::from(distance - least <= 1e-13);
                }
            }
        }
        println!("{lanes} are apart, {apart} of them by much; {confirmed} are confirmed");
        assert!(confirmed * 100 > lanes * 99);
    }
}
