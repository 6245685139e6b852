//! The motion clock: an answer, and whether it still is one after the two objects have moved.
//!
//! Of objects that are apart, the gap is room to move in, and no support point is asked for as long as they came by less: along the axis that
//! separates them, by a bound that follows from the placements then and now, or, where balls around them are apart, whichever way, by a
//! bound that is larger and sooner found. By how much balls in them overlap is room too; of others that intersect, the four points of each
//! whose differences contained the origin are looked at where they are now. (Bounds on motion are what I-COLLIDE schedules pairs by;
//! here they change no answer.)

use fearless_simd::{Simd, f64x4, prelude::*};
use glam::{DAffine3, DMat3, DVec3};

use super::balls::{Ball, Balls, Look};
use super::intersection::CACHED_GAP_MIN;
use super::pairs::{Pairs, images};
use crate::feature::VOLUME_ERROR;
use crate::simd::dispatch;
use crate::similarity::STRETCH_ERROR;
use crate::{Polytope, Support};

/// What was last sure of two objects, and how far that goes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Clock {
    evidence: Evidence,
    a: Body,
    b: Body,
    /// At least the size of the data for as long as the bodies allow it. World units.
    size: f64,
}

/// Why it is so.
#[derive(Clone, Copy, Debug, Default)]
enum Evidence {
    /// Nothing is known.
    #[default]
    None,
    /// Balls around the objects are apart, or balls in them overlap.
    Balls { meet: bool, haste: Haste },
    /// The objects are apart along a unit axis, from `B` to `A`, by more than this and what the clock leaves.
    Apart { axis: DVec3, gap: f64 },
    /// The tetrahedron of the differences of the four pairs of points that are kept contains the origin.
    Common,
}

/// How much a change of a number of a placement counts for, squared: of the linear parts of `A` and of `B`, and of both translations. While the
/// squares of the changes, times these, sum to at most one, no point has used up the room that the answer leaves, and placements are good.
///
/// A point moves by at most the Frobenius norm of the change of the linear part, times its distance from the local origin, and the length of that of the
/// translation. Four lengths sum to at most twice the root of the sum of their squares: so each counts for two over the room.
#[derive(Clone, Copy, Debug, Default)]
struct Haste {
    linear: [f64; 2],
    translation: f64,
}

impl Haste {
    /// For objects that reach as far as this from their local origins, in their own units, and the axes of whose placements may change at most at these
    /// rates in any case.
    #[inline(always)]
    fn new(room: f64, reach: [f64; 2], rates: [f64; 2]) -> Haste {
        let each = 2.0 / room;
        let square = |x: f64| x * x;
        let linear = |k: usize| square((each * reach[k]).max(rates[k]));
        Haste { linear: [linear(0), linear(1)], translation: square(each) }
    }
}

/// A placement by its columns, the translation last, for vector instructions.
type Columns = [f64; 12];

/// An object as it was when the clock was set.
#[derive(Clone, Copy, Debug, Default)]
struct Body {
    placement: Columns,
    /// The reciprocal of how much each number may change, were it to change alone: the clock goes on while the squares of the changes
    /// times these sum to at most one.
    rates: Columns,
    /// A ball that contains the object. Space: local.
    center: DVec3,
    radius: f64,
}

/// Lengths and magnitudes, of axes, positions and objects, of which a clock is set: squares of products of two neither overflow nor
/// lose digits.
const PLAIN_MIN: f64 = 1e-35;
const PLAIN_MAX: f64 = 1e35;

/// The least volume between the axes of a placement, brought to unit length, of which a clock is set.
const VOLUME_MIN: f64 = 1e-6;

/// That of a placement that nearly is a similarity, at least.
const SIMILAR_VOLUME: f64 = 1.0 - 8.0 * STRETCH_ERROR;

/// By this part of its length, times the volume between the unit axes, may an axis change, if it is alone to. Unit axes are then off by at most
/// 1.04 times that; the volume, which is linear in each of three, by at most the root of three times that, or 0.91 of itself, so that a
/// placement that was far from singular still is. And no object is larger by more than half.
const CHANGE_MAX: f64 = 0.5;

/// What must be left of a gap, relative to the size of the data as it is counted here, which is at least that of
/// [`CACHED_GAP_MIN`]: that, times the sum of the magnitudes of a unit axis, at most 1.74; and what the some forty roundings
/// of 2^-53 between then and now may change, which is less than a millionth of the rest.
const GAP_LEFT_MIN: f64 = 2.0 * CACHED_GAP_MIN;

impl Clock {
    /// Whether the objects intersect where they are now; `None` when that is to be found again. The pairs of points must be those that it was
    /// set with. Placements of an answer are finite, not near singular, and of magnitudes that are allowed.
    #[inline]
    pub fn answer(&self, pairs: &Pairs, at_a: &DAffine3, at_b: &DAffine3) -> Option<bool> {
        dispatch!(move simd => self.answer_by(simd, pairs, at_a, at_b))
    }

    /// The same, as a part of a kernel.
    #[inline(always)]
    pub fn answer_by<S: Simd>(
        &self,
        simd: S,
        pairs: &Pairs,
        at_a: &DAffine3,
        at_b: &DAffine3,
    ) -> Option<bool> {
        match self.evidence {
            Evidence::None => None,
            Evidence::Balls { meet, haste } => self.moved_little(simd, at_a, at_b, haste).then_some(meet),
            Evidence::Apart { axis, gap } => self.still_apart(simd, at_a, at_b, axis, gap).then_some(false),
            Evidence::Common => self.still_common(simd, at_a, at_b, pairs).then_some(true),
        }
    }

    /// Whether they moved by less than they may, whichever way.
    #[inline(always)]
    fn moved_little<S: Simd>(&self, simd: S, at_a: &DAffine3, at_b: &DAffine3, haste: Haste) -> bool {
        let Haste { linear, translation } = haste;
        let of = {
            #[inline(always)]
            |change: [f64x4<S>; 3], linear: f64| {
                let [x, y, z] = change;
                let last = f64x4::simd_from(simd, [linear, translation, translation, translation]);
                (x * x + y * y) * f64x4::splat(simd, linear) + (z * z) * last
            }
        };
        sum(of(self.a.change(simd, at_a), linear[0]) + of(self.b.change(simd, at_b), linear[1])) <= 1.0
    }

    /// Whether they came by less along the axis than they may.
    #[inline(always)]
    fn still_apart<S: Simd>(&self, simd: S, at_a: &DAffine3, at_b: &DAffine3, axis: DVec3, gap: f64) -> bool {
        let (change_a, change_b) = (self.a.change(simd, at_a), self.b.change(simd, at_b));
        // How the balls moved along the axis: a centre by a product, any other point by at most a length more.
        let (linear_a, by_a) = along(&change_a, axis);
        let (linear_b, by_b) = along(&change_b, axis);
        let left = gap + (linear_a.dot(self.a.center) + by_a) - (linear_b.dot(self.b.center) + by_b);
        self.a.allows(simd, &change_a)
            & self.b.allows(simd, &change_b)
            & sum_is_less(linear_a * self.a.radius, linear_b * self.b.radius, left)
    }

    #[inline(always)]
    fn still_common<S: Simd>(&self, simd: S, at_a: &DAffine3, at_b: &DAffine3, pairs: &Pairs) -> bool {
        let (change_a, change_b) = (self.a.change(simd, at_a), self.b.change(simd, at_b));
        let offset = at_b.translation - at_a.translation;
        let (on_a, on_b) = (images(simd, &at_a.matrix3, &pairs.a), images(simd, &at_b.matrix3, &pairs.b));
        let [x, y, z] = [on_a[0] - on_b[0], on_a[1] - on_b[1], on_a[2] - on_b[2]];
        let splat = |value: f64| f64x4::splat(simd, value);
        let points = [x - splat(offset.x), y - splat(offset.y), z - splat(offset.z)];
        let error = VOLUME_ERROR * self.size * self.size * self.size;
        self.a.allows(simd, &change_a) & self.b.allows(simd, &change_b) & contains_origin(simd, points, error)
    }

    /// Sets it for objects that are apart: `gap` is a lower bound of the gap along a unit axis, from `B` to `A`, in the world.
    pub fn set_apart<A, B>(&mut self, a: (&A, &DAffine3), b: (&B, &DAffine3), axis: DVec3, gap: f64)
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        self.set_at_length([&Spread::of(a), &Spread::of(b)], Evidence::Apart { axis, gap });
    }

    /// Sets it for objects that intersect, by the four pairs of points that are kept.
    pub fn set_common<A, B>(&mut self, a: (&A, &DAffine3), b: (&B, &DAffine3))
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        self.set_at_length([&Spread::of(a), &Spread::of(b)], Evidence::Common);
    }

    /// Sets it for polytopes whose balls tell whether they meet.
    #[inline(always)]
    pub fn set_by_balls(
        &mut self,
        (a, at_a): (&Polytope, &DAffine3),
        (b, at_b): (&Polytope, &DAffine3),
        look: &Look,
        meet: bool,
    ) {
        let (reach, scales) = ([a.farthest(), b.farthest()], look.scales);
        // As long as it goes the linear parts grow by at most half, and the offset by a distance that is at most this.
        let size = 4.0 * (reach[0] * scales[0] + reach[1] * scales[1] + look.offset.abs().element_sum());
        let room = look.room(meet) - GAP_LEFT_MIN * size;
        if !((room > 0.0) & (PLAIN_MIN..=PLAIN_MAX).contains(&size)) {
            return self.stop();
        }
        let rate = |k: usize| 1.0 / (CHANGE_MAX * scales[k]);
        self.a.placement = at_a.to_cols_array();
        self.b.placement = at_b.to_cols_array();
        self.evidence = Evidence::Balls { meet, haste: Haste::new(room, reach, [rate(0), rate(1)]) };
    }

    /// Sets it for polytopes that are apart, as [`set_apart`](Clock::set_apart).
    #[inline(always)]
    pub fn set_similar_apart(
        &mut self,
        a: (&Polytope, &DAffine3),
        b: (&Polytope, &DAffine3),
        look: &Look,
        axis: DVec3,
        gap: f64,
    ) {
        let [a, b] = [Spread::of_similar(a, look.scales[0]), Spread::of_similar(b, look.scales[1])];
        self.set([&a, &b], Evidence::Apart { axis, gap });
    }

    /// Stops it: nothing is sure.
    #[inline(always)]
    pub fn stop(&mut self) {
        self.evidence = Evidence::None;
    }

    /// The same as [`set`](Clock::set), out of the way.
    #[inline(never)]
    fn set_at_length(&mut self, objects: [&Spread; 2], evidence: Evidence) {
        self.set(objects, evidence);
    }

    /// Sets it, where all is of plain size; of a gap, something is left.
    #[inline(always)]
    fn set(&mut self, [a, b]: [&Spread; 2], evidence: Evidence) {
        self.stop();
        if !(a.is_plain() & b.is_plain()) {
            return;
        }
        // Each may come as far as this: then less than four times that is added to the sum of an offset's magnitudes.
        let extent = a.extent() + b.extent();
        let rate = extent.recip();
        self.size = 5.0 * extent + (b.at.translation - a.at.translation).abs().element_sum();
        self.a.set(a, rate);
        self.b.set(b, rate);
        self.evidence = match evidence {
            Evidence::Apart { axis, gap } => Evidence::Apart { axis, gap: gap - GAP_LEFT_MIN * self.size },
            evidence => evidence,
        };
    }
}

/// An object where it is placed.
struct Spread<'p> {
    at: &'p DAffine3,
    /// A ball that contains the object. Space: local.
    center: DVec3,
    radius: f64,
    /// No point is further from the local origin.
    reach: f64,
    /// The lengths of the axes.
    lengths: DVec3,
    /// The volume between the axes, brought to unit length.
    volume: f64,
}

impl<'p> Spread<'p> {
    fn of<S: Support + ?Sized>((object, at): (&S, &'p DAffine3)) -> Self {
        let (center, radius) = match object.balls() {
            Some(Balls { outer, .. }) => (outer.center, outer.radius),
            None => (DVec3::ZERO, object.reach().length()),
        };
        let DMat3 { x_axis: x, y_axis: y, z_axis: z } = at.matrix3;
        let lengths = DVec3::new(x.length(), y.length(), z.length());
        let volume = x.cross(y).dot(z).abs() / (lengths.x * lengths.y * lengths.z);
        Spread { at, center, radius, reach: radius + center.length(), lengths, volume }
    }

    /// Under what nearly is a similarity of this scale.
    #[inline(always)]
    fn of_similar((object, at): (&Polytope, &'p DAffine3), scale: f64) -> Self {
        let Ball { center, radius } = object.own_balls().outer;
        Spread {
            at,
            center,
            radius,
            reach: object.farthest(),
            lengths: DVec3::splat(scale),
            volume: SIMILAR_VOLUME,
        }
    }

    #[inline(always)]
    fn is_plain(&self) -> bool {
        (self.lengths.min_element() >= PLAIN_MIN)
            & (self.lengths.max_element() <= PLAIN_MAX)
            & (self.at.translation.abs().max_element() <= PLAIN_MAX)
            & (self.radius >= PLAIN_MIN)
            & (self.reach <= PLAIN_MAX)
            & (self.volume >= VOLUME_MIN)
    }

    /// A bound on the coordinates of the object's image under its linear part, also under one that is changed as much as may be.
    #[inline(always)]
    fn extent(&self) -> f64 {
        /// By Cauchy and Schwarz the root of three, and half as much again.
        const SPREAD: f64 = 2.6;
        SPREAD * self.lengths.length() * self.reach
    }

    /// The reciprocal of how much each axis may change.
    #[inline(always)]
    fn rates(&self) -> DVec3 {
        (self.lengths * (CHANGE_MAX * self.volume.min(1.0))).recip()
    }
}

impl Body {
    #[inline(always)]
    fn set(&mut self, object: &Spread, translation_rate: f64) {
        let (DVec3 { x, y, z }, t) = (object.rates(), translation_rate);
        self.placement = object.at.to_cols_array();
        self.rates = [x, x, x, y, y, y, z, z, z, t, t, t];
        self.center = object.center;
        self.radius = object.radius;
    }

    /// How its placement changed.
    #[inline(always)]
    fn change<S: Simd>(&self, simd: S, at: &DAffine3) -> [f64x4<S>; 3] {
        let (now, then) = (at_once(simd, at), &self.placement);
        [now[0] - four(simd, then, 0), now[1] - four(simd, then, 1), now[2] - four(simd, then, 2)]
    }

    /// Whether it may have changed so much: not to what is no number.
    #[inline(always)]
    fn allows<S: Simd>(&self, simd: S, change: &[f64x4<S>; 3]) -> bool {
        let part = |k: usize| change[k] * four(simd, &self.rates, k);
        let (x, y, z) = (part(0), part(1), part(2));
        sum(x * x + y * y + z * z) <= 1.0
    }
}

/// Four of twelve numbers, from the `4 k`th on.
#[inline(always)]
fn four<S: Simd>(simd: S, columns: &Columns, k: usize) -> f64x4<S> {
    f64x4::from_slice(simd, &columns[4 * k..4 * k + 4])
}

/// A placement as [`Columns`], read as it lies.
#[inline(always)]
fn at_once<S: Simd>(simd: S, at: &DAffine3) -> [f64x4<S>; 3] {
    let linear: &[f64; 9] = at.matrix3.as_ref();
    let DVec3 { x, y, z } = at.translation;
    let four = |k: usize| f64x4::from_slice(simd, &linear[k..k + 4]);
    [four(0), four(4), f64x4::simd_from(simd, [linear[8], x, y, z])]
}

#[inline(always)]
fn sum<S: Simd>(lanes: f64x4<S>) -> f64 {
    let lanes = lanes.as_slice();
    (lanes[0] + lanes[1]) + (lanes[2] + lanes[3])
}

/// The products of columns with an axis: those of the linear part, and that of the translation.
#[inline(always)]
fn along<S: Simd>(change: &[f64x4<S>; 3], axis: DVec3) -> (DVec3, f64) {
    let mut products = [0.0; 12];
    for k in 0..3 {
        let [x, y, z, w] = [axis[k], axis[(k + 1) % 3], axis[(k + 2) % 3], axis[k]];
        let axis = f64x4::simd_from(change[k].simd, [x, y, z, w]);
        (change[k] * axis).store_slice(&mut products[4 * k..4 * k + 4]);
    }
    let sum = |k: usize| products[k] + products[k + 1] + products[k + 2];
    (DVec3::new(sum(0), sum(3), sum(6)), sum(9))
}

/// Whether the sum of the lengths of two vectors is less than a number, without a root: of what is no number it is not.
#[inline(always)]
fn sum_is_less(x: DVec3, y: DVec3, bound: f64) -> bool {
    let (x, y) = (x.length_squared(), y.length_squared());
    let rest = bound * bound - x - y;
    (bound > 0.0) & (rest > 0.0) & (4.0 * x * y < rest * rest)
}

/// Whether a tetrahedron contains the origin: six times the volumes that it makes with the faces, each from a corner on, are, up to this error, of
/// turns of the same sign.
#[inline(always)]
fn contains_origin<S: Simd>(simd: S, [x, y, z]: [f64x4<S>; 3], error: f64) -> bool {
    // A lane for each face: its first corner, and the two after it.
    let (x1, y1, z1) = (x.slide::<1>(x), y.slide::<1>(y), z.slide::<1>(z));
    let (x2, y2, z2) = (x.slide::<2>(x), y.slide::<2>(y), z.slide::<2>(z));
    let volumes = (y * z1 - z * y1) * x2 + (z * x1 - x * z1) * y2 + (x * y1 - y * x1) * z2;
    let above = volumes.simd_gt(f64x4::splat(simd, error)).to_bitmask();
    let below = volumes.simd_lt(f64x4::splat(simd, -error)).to_bitmask();
    let (even, odd) = (0b0101, 0b1010);
    ((above == even) & (below == odd)) | ((above == odd) & (below == even))
}

#[cfg(test)]
mod tests;
