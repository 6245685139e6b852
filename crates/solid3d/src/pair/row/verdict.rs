//! Which triangles of a row meet a triangle, wherever rounding cannot change the answer; of the rest nothing is said.
//!
//! Two triangles in general position are told by the signs of fifteen determinants: where the corners of each lie to the
//! plane of the other, and how each edge of one passes each edge of the other. An edge goes through a triangle if its ends
//! are on different sides of the plane and its line passes all three edges on one side; it misses the triangle if its ends
//! are on one side, or its line passes two edges on different sides. They meet if some edge of either goes through the
//! other, and are apart if each of the six misses. (As `triangle_triangle` has it, with exact signs.)
//!
//! # The error of a determinant
//!
//! Each is the triple product of three differences of corners. On an axis no such difference exceeds the extent D of both
//! triangles, also as computed, since rounding is monotone. So each of the six products of three, one factor from each
//! axis, is at most DxDyDz; it takes part in three roundings of differences and five of the triple product. With u = 2^-53 the
//! error is below 6 * 8u DxDyDz, but for terms in u^2: [`ROUNDING`] is 64u, which pays for the rounding of the bound too. What
//! underflows loses less than [`UNDERFLOW`], as coordinates of the common frame are below 2.

use fearless_simd::Simd;
use fearless_simd::prelude::*;

use super::{Row, Vector, Wide, cross, dot, load, minus, one, splat_triangle, steps, width};
use crate::bounds::Aabb;
use crate::pair::triangle_triangle::Triangle;

/// 64u: see the module.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// More than a dozen of the least numbers.
const UNDERFLOW: f64 = f64::MIN_POSITIVE;

/// What is certain of a triangle and those of a row, as bits for the lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Verdict {
    /// Those that meet it.
    pub meet: u32,
    /// Those that do not.
    pub apart: u32,
}

/// What is certain of a triangle, in its box, and those of a row in the lanes asked for.
#[inline(never)] // see `distances`
pub(crate) fn verdict<S: Simd>(simd: S, x: &Triangle, bounds: &Aabb, row: &Row, lanes: u32) -> Verdict {
    simd.vectorize(
        #[inline(always)]
        || verdict_on(simd, x, bounds, row, lanes),
    )
}

#[inline(always)]
fn verdict_on<S: Simd>(simd: S, x: &Triangle, bounds: &Aabb, row: &Row, lanes: u32) -> Verdict {
    let x = splat_triangle(simd, x);
    let mut all = Verdict { meet: 0, apart: 0 };
    for from in steps::<S>() {
        let asked = lanes >> from & ((1 << width::<S>()) - 1);
        if asked == 0 {
            continue;
        }
        let y = row.corners(simd, from);
        let mut bound = one(simd, ROUNDING);
        for axis in 0..3 {
            let greatest = load(simd, &row.max[axis], from).max(one(simd, bounds.max[axis]));
            let least = load(simd, &row.min[axis], from).min(one(simd, bounds.min[axis]));
            bound *= greatest - least;
        }
        let some = of_step(&x, &y, bound + one(simd, UNDERFLOW), asked);
        all.meet |= some.meet << from;
        all.apart |= some.apart << from;
    }
    Verdict { meet: all.meet & lanes, apart: all.apart & lanes }
}

/// A sign that is certain: the lanes where it is positive, and those where it is negative.
#[derive(Clone, Copy)]
struct Sign<S: Simd> {
    positive: S::mask64s,
    negative: S::mask64s,
}

impl<S: Simd> Sign<S> {
    #[inline(always)]
    fn of(determinant: Wide<S>, bound: Wide<S>) -> Self {
        Sign { positive: determinant.simd_gt(bound), negative: determinant.simd_lt(-bound) }
    }

    #[inline(always)]
    fn same(self, other: Self) -> S::mask64s {
        (self.positive & other.positive) | (self.negative & other.negative)
    }

    #[inline(always)]
    fn opposite(self, other: Self) -> S::mask64s {
        (self.positive & other.negative) | (self.negative & other.positive)
    }
}

#[inline(always)]
fn of_step<S: Simd>(x: &[Vector<S>; 3], y: &[Vector<S>; 3], bound: Wide<S>, asked: u32) -> Verdict {
    let (e, f) = (edges(x), edges(y));
    let (across_x, across_y) = (cross(e[0], e[1]), cross(f[0], f[1]));
    let side_of_y = |j: usize| Sign::of(dot(across_x, minus(y[j], x[0])), bound);
    let side_of_x = |i: usize| Sign::of(dot(across_y, minus(x[i], y[0])), bound);
    let of_y: [Sign<S>; 3] = [side_of_y(0), side_of_y(1), side_of_y(2)];
    let of_x: [Sign<S>; 3] = [side_of_x(0), side_of_x(1), side_of_x(2)];
    let mut apart = one_side(&of_x) | one_side(&of_y);
    if asked & !(apart.to_bitmask() as u32) == 0 {
        return Verdict { meet: 0, apart: asked };
    }
    let mut passes = [of_x; 3];
    for i in 0..3 {
        for j in 0..3 {
            passes[i][j] = Sign::of(dot(cross(e[i], f[j]), minus(y[j], x[i])), bound);
        }
    }
    let mut meet = bound.simd_lt(bound);
    let mut missed = bound.simd_le(bound);
    for i in 0..3 {
        let next = (i + 1) % 3;
        for (sides, [p, q, r]) in [
            ([of_x[i], of_x[next]], [passes[i][0], passes[i][1], passes[i][2]]),
            ([of_y[i], of_y[next]], [passes[0][i], passes[1][i], passes[2][i]]),
        ] {
            meet |= sides[0].opposite(sides[1]) & one_side(&[p, q, r]);
            let mixed = p.opposite(q) | q.opposite(r) | r.opposite(p);
            missed &= sides[0].same(sides[1]) | mixed;
        }
    }
    apart |= missed;
    Verdict { meet: meet.to_bitmask() as u32, apart: apart.to_bitmask() as u32 }
}

#[inline(always)]
fn edges<S: Simd>(t: &[Vector<S>; 3]) -> [Vector<S>; 3] {
    [minus(t[1], t[0]), minus(t[2], t[1]), minus(t[0], t[2])]
}

/// The lanes in which three signs are certain and the same.
#[inline(always)]
fn one_side<S: Simd>([p, q, r]: &[Sign<S>; 3]) -> S::mask64s {
    (p.positive & q.positive & r.positive) | (p.negative & q.negative & r.negative)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair::row::tests::row_of;
    use crate::pair::triangle_triangle::intersect;
    use glam::DVec3;
    use rand::Rng;
    use solid_convex::simd::dispatch;
    use solid_convex::simd::levels;
    use solid_oracle::generate::seeded;

    /// Holds what is said of a triangle and eight against the exact test, on every level of instructions; returns how many
    /// lanes meet, and of how many nothing is said.
    fn check(x: &Triangle, ys: &[Triangle; 8]) -> [usize; 2] {
        let (row, bounds) = (row_of(ys), Aabb::of_points(*x));
        let asked = 0b1101_1111;
        let all = levels().map(|level| dispatch!(level, simd => verdict(simd, x, &bounds, &row, asked)));
        assert_eq!(all[0], all[1]);
        let Verdict { meet, apart } = all[0];
        assert_eq!((meet | apart) & !asked, 0);
        let (mut hits, mut unknown) = (0, 0);
        for (lane, y) in ys.iter().enumerate().filter(|(lane, _)| asked >> lane & 1 == 1) {
            let expected = intersect(x, y);
            assert!(expected || meet >> lane & 1 == 0, "{x:?} {y:?} do not meet");
            assert!(!expected || apart >> lane & 1 == 0, "{x:?} {y:?} meet");
            hits += usize::from(expected);
            unknown += usize::from((meet | apart) >> lane & 1 == 0);
        }
        [hits, unknown]
    }

    /// Law: nothing false is said, even one unit in the last place from touching; and what is clear is said.
    #[test]
    fn nothing_is_said_that_rounding_might_change() {
        let seed = 30;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let (mut hits, mut unknown_of_clear) = (0, 0);
        for case in 0..6000 {
            let mut point = || DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)));
            let x: Triangle = [point(), point(), point()];
            let normal = (x[1] - x[0]).cross(x[2] - x[0]).normalize();
            // Corners near the plane of x, or near an edge, off by rounding or by a little more; the rest on one side.
            let off = [0.0, 1e-16, 1e-15, 1e-3, -1e-6, -1e-7][case % 6];
            let inside = case % 18 < 12;
            let ys = std::array::from_fn(|lane| {
                let (s, t) = ((lane as f64 + 0.5) / 16.0, if inside { 0.3 } else { 0.0 });
                let near = x[0] + (x[1] - x[0]) * s + (x[2] - x[0]) * t * (1.0 - s) + normal * off;
                let tiny = if lane % 2 == 0 { 1.0 } else { 1e-5 };
                [near, near + (normal + point() * 0.3) * tiny, near + (normal * 2.0 + point() * 0.3) * tiny]
            });
            let [meet, unknown] = check(&x, &ys);
            hits += meet;
            unknown_of_clear += if off.abs() > 1e-9 && inside { unknown } else { 0 };
        }
        println!("{hits} of 42000 meet, of {unknown_of_clear} of 14000 that are clear nothing is said");
        assert!((42_000 * 3 / 10..42_000 * 7 / 10).contains(&hits) && unknown_of_clear < 1400);
    }

    /// On a lattice, where touching, coplanar and degenerate triangles abound, and at random.
    #[test]
    fn what_is_said_of_lattice_triangles_is_right() {
        let mut rng = seeded(32);
        let mut totals = [[0; 2]; 2];
        for case in 0..8000 {
            let mut point = || {
                let coordinate = |_: usize| {
                    if case % 2 == 0 {
                        f64::from(rng.random_range(0..=2))
                    } else {
                        rng.random_range(0.0..2.0)
                    }
                };
                DVec3::from_array(std::array::from_fn(coordinate))
            };
            let mut triangle = || [point(), point(), point()];
            let ys = std::array::from_fn(|_| triangle());
            let [hits, unknown] = check(&triangle(), &ys);
            totals[case % 2][0] += hits;
            totals[case % 2][1] += unknown;
        }
        let [on_lattice, random] = totals;
        println!("of 28000 on the lattice and at random: {on_lattice:?} {random:?} meet, and are not known");
        assert!((28_000 * 3 / 10..28_000 * 7 / 10).contains(&on_lattice[0]));
        assert!(random[0] > 2_800 && random[1] == 0);
    }
}
