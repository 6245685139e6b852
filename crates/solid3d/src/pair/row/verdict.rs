//! Which triangles of a row meet a triangle, wherever rounding cannot change the answer; of the rest nothing is said.
//!
//! Eight at a time and in single precision, around a corner of the one triangle. Two triangles of which neither lies on one side of the
//! plane of the other meet the line common to the planes in a segment each (Moller, *A Fast Triangle-Triangle Intersection Test*, 1997). A
//! segment ends on the two edges from the corner that is alone on its side of the other plane. How an edge of one passes an edge of the
//! other, a determinant, says in which order their points on the line come; of the four there are all have the same factor, by the sides
//! on which the two corners are. So the triangles are apart if all four have one sign, and meet if two differ.
//!
//! # The error of a determinant
//!
//! Let u = 2^-24. A coordinate from the corner of the one triangle, rounded to `f32`, is off by u of it. On an axis neither it nor the
//! difference of two exceeds the extent D of both triangles, as computed, since rounding is monotone; so a difference is off by 3u D. Each
//! determinant is the triple product of three such: each of its six products of three, one factor from each axis, is at most DxDyDz, and
//! takes part in five more roundings. The error is below 6 * 14u DxDyDz, but for terms in u^2: [`ROUNDING`] is 128u, which pays for the
//! rounding of the bound too. What underflows loses less than [`UNDERFLOW`], as coordinates of the common frame are below 2.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, f64x4, mask32x8};

use super::{Lanes, Row};
use crate::pair::glance::{Points, dot, minus};
use crate::tree::LEAF_SIZE;

/// 128u: see the module.
const ROUNDING: f32 = 64.0 * f32::EPSILON;

/// More than a dozen of the least numbers.
const UNDERFLOW: f32 = f32::MIN_POSITIVE;

/// What is certain of a triangle and those of a row, as bits for the lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Verdict {
    /// Those that meet it.
    pub meet: u32,
    /// Those that do not.
    pub apart: u32,
}

/// What is certain of the triangle in a lane of a row, the one, and those of another row in the lanes asked for.
#[inline(never)] // see `distances`
pub(crate) fn verdict<S: Simd>(simd: S, (one, lane): (&Row, usize), row: &Row, lanes: u32) -> Verdict {
    simd.vectorize(
        #[inline(always)]
        || verdict_on(simd, (one, lane), row, lanes),
    )
}

#[inline(always)]
fn verdict_on<S: Simd>(simd: S, (one, lane): (&Row, usize), row: &Row, lanes: u32) -> Verdict {
    let x = |corner: usize, axis: usize| one.corners[corner][axis][lane % LEAF_SIZE];
    let zero = f32x8::splat(simd, 0.0);
    let mut xs = [[zero; 3]; 3];
    let mut ys = xs;
    let mut bound = f32x8::splat(simd, ROUNDING);
    for axis in 0..3 {
        let from = x(0, axis);
        for corner in 0..3 {
            if corner > 0 {
                xs[corner][axis] = f32x8::splat(simd, (x(corner, axis) - from) as f32);
            }
            ys[corner][axis] = around(simd, &row.corners[corner][axis], from);
        }
        let (x1, x2) = (xs[1][axis], xs[2][axis]);
        let (y0, y1, y2) = (ys[0][axis], ys[1][axis], ys[2][axis]);
        let greatest = x1.max(x2).max(zero).max(y0.max(y1).max(y2));
        let least = x1.min(x2).min(zero).min(y0.min(y1).min(y2));
        bound *= greatest - least;
    }
    let Verdict { meet, apart } = of_eight(&xs, &ys, bound + f32x8::splat(simd, UNDERFLOW), lanes);
    Verdict { meet: meet & lanes, apart: apart & lanes }
}

/// Coordinates from an origin.
#[inline(always)]
fn around<S: Simd>(simd: S, lanes: &Lanes, from: f64) -> f32x8<S> {
    let from = f64x4::splat(simd, from);
    let low = f64x4::from_slice(simd, &lanes[..4]) - from;
    let high = f64x4::from_slice(simd, &lanes[4..]) - from;
    simd.narrow_f64x4(low, high)
}

/// On which sides of the plane of one triangle the corners of the other are.
struct Sides<S: Simd> {
    /// Where that is certain of all three.
    known: mask32x8<S>,
    /// Where it is certain that all are on one side.
    one: mask32x8<S>,
    /// Where the first is alone on its side, and where the last is; elsewhere it is the second.
    first: mask32x8<S>,
    last: mask32x8<S>,
}

impl<S: Simd> Sides<S> {
    #[inline(always)]
    fn of([p, q, r]: [f32x8<S>; 3], bound: f32x8<S>) -> Self {
        let below = -bound;
        let (p_up, q_up, r_up) = (p.simd_gt(bound), q.simd_gt(bound), r.simd_gt(bound));
        let (p_down, q_down, r_down) = (p.simd_lt(below), q.simd_lt(below), r.simd_lt(below));
        Sides {
            known: (p_up | p_down) & (q_up | q_down) & (r_up | r_down),
            one: (p_up & q_up & r_up) | (p_down & q_down & r_down),
            first: (q_up & r_up) | (q_down & r_down),
            last: (p_up & q_up) | (p_down & q_down),
        }
    }

    /// The corner that is alone, and the ways from it to the others.
    #[inline(always)]
    fn fan(&self, [p, q, r]: &[Points<S>; 3]) -> (Points<S>, [Points<S>; 2]) {
        let (mut alone, mut next, mut other) = (*q, *p, *r);
        for axis in 0..3 {
            alone[axis] = self.first.select(p[axis], self.last.select(r[axis], q[axis]));
            next[axis] = self.first.select(q[axis], p[axis]);
            other[axis] = self.last.select(q[axis], r[axis]);
        }
        (alone, [minus(&next, &alone), minus(&other, &alone)])
    }
}

/// The first corner of `x` is at the origin.
#[inline(always)]
fn of_eight<S: Simd>(x: &[Points<S>; 3], y: &[Points<S>; 3], bound: f32x8<S>, asked: u32) -> Verdict {
    let across_x = cross(&x[1], &x[2]);
    let across_y = cross(&minus(&y[1], &y[0]), &minus(&y[2], &y[0]));
    let of_y = Sides::of([dot(&across_x, &y[0]), dot(&across_x, &y[1]), dot(&across_x, &y[2])], bound);
    let side_of_x = |i: usize| dot(&across_y, &minus(&x[i], &y[0]));
    let of_x = Sides::of([side_of_x(0), side_of_x(1), side_of_x(2)], bound);
    let parted = of_x.one | of_y.one;
    let apart = parted.to_bitmask() as u32;
    if asked & !apart == 0 {
        return Verdict { meet: 0, apart };
    }
    let ((p, [e, f]), (q, [g, h])) = (of_x.fan(x), of_y.fan(y));
    let way = minus(&q, &p);
    let (by_e, by_f) = (cross(&way, &e), cross(&way, &f));
    let passes = [dot(&g, &by_e), dot(&h, &by_e), dot(&g, &by_f), dot(&h, &by_f)];
    let below = -bound;
    let (mut some_up, mut some_down) = (passes[0].simd_gt(bound), passes[0].simd_lt(below));
    let (mut all_up, mut all_down) = (some_up, some_down);
    for pass in &passes[1..] {
        let (up, down) = (pass.simd_gt(bound), pass.simd_lt(below));
        some_up |= up;
        some_down |= down;
        all_up &= up;
        all_down &= down;
    }
    let crossing = of_x.known & of_y.known & !parted;
    let meet = crossing & some_up & some_down;
    let missed = crossing & (all_up | all_down);
    Verdict { meet: meet.to_bitmask() as u32, apart: apart | missed.to_bitmask() as u32 }
}

#[inline(always)]
fn cross<S: Simd>(a: &Points<S>, b: &Points<S>) -> Points<S> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair::row::tests::row_of;
    use crate::pair::triangle_triangle::{Triangle, intersect};
    use glam::DVec3;
    use rand::Rng;
    use solid_convex::simd::{alike, dispatch};
    use solid_oracle::generate::seeded;

    /// Holds what is said of a triangle and eight against the exact test, on every level of instructions; returns how many
    /// lanes meet, and of how many nothing is said.
    fn check(x: &Triangle, ys: &[Triangle; 8]) -> [usize; 2] {
        let (one, row) = (row_of(&[*x; 8]), row_of(ys));
        let asked = 0b1101_1111;
        let Verdict { meet, apart } =
            alike(|level| dispatch!(widest level, simd => verdict(simd, (&one, 5), &row, asked)));
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

    /// Law: nothing false is said, even one unit in the last place from touching, nor on either side of the margin; and what is clear is said.
    #[test]
    fn nothing_is_said_that_rounding_might_change() {
        let seed = 30;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let (mut hits, mut unknown_of_clear) = (0, 0);
        for case in 0..6000 {
            let about_margin = -10f64.powf(rng.random_range(-9.0..-3.0));
            let mut point = || DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)));
            let x: Triangle = [point(), point(), point()];
            let normal = (x[1] - x[0]).cross(x[2] - x[0]).normalize();
            // Corners near the plane of x, or near an edge, off by rounding or by a little more; the rest on one side.
            let off = [0.0, 1e-16, -1e-16, 1e-2, about_margin, -1e-2][case % 6];
            let inside = case % 18 < 12;
            let ys = std::array::from_fn(|lane| {
                let (s, t) = ((lane as f64 + 0.5) / 16.0, if inside { 0.3 } else { 0.0 });
                let near = x[0] + (x[1] - x[0]) * s + (x[2] - x[0]) * t * (1.0 - s) + normal * off;
                let tiny = if lane % 2 == 0 { 1.0 } else { 1e-5 };
                [near, near + (normal + point() * 0.3) * tiny, near + (normal * 2.0 + point() * 0.3) * tiny]
            });
            let [meet, unknown] = check(&x, &ys);
            hits += meet;
            unknown_of_clear += if off.abs() > 5e-3 && inside { unknown } else { 0 };
        }
        println!("{hits} of 42000 meet, of {unknown_of_clear} of 9333 that are clear nothing is said");
        assert!((42_000 * 3 / 10..42_000 * 7 / 10).contains(&hits) && unknown_of_clear < 933);
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
        assert!(random[0] > 2_800 && random[1] < 28);
    }
}
