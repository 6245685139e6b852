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
mod tests {
    use glam::DQuat;

    use super::*;
    use crate::gjk::{Glance, Memory, intersects};
    use crate::simd::{Level, dispatch, levels};
    use crate::testing::{octahedron_faces, placement, shapes};
    use crate::{Cuboid, Polytope};

    /// A motion: in a frame it moves and turns by this, in sizes of the objects.
    const STEPS: [f64; 4] = [1e-9, 0.004, 0.03, 0.3];
    /// Units of length, and how far from the world's origin.
    const UNITS: [(f64, f64); 5] = [(1.0, 0.0), (1e-9, 1e-9), (1e9, 1e8), (1.0, 1e6), (1e-3, 1e5)];
    /// What a placement does to an object beside turning it.
    const LINEARS: [DMat3; 4] = [
        DMat3::IDENTITY,
        DMat3::from_cols(DVec3::new(2.0, 0.0, 0.0), DVec3::new(0.0, 0.5, 0.0), DVec3::new(0.0, 0.0, 1.0)),
        DMat3::from_cols(DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.9, 0.7, 0.0), DVec3::new(-0.3, 0.8, 0.6)),
        DMat3::from_cols(DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.0, 1e-4, 0.0), DVec3::new(0.0, 0.0, 1.5)),
    ];

    /// Law: it says nothing else than a search from nothing, whatever moves, by how little or much, in any unit, far from the origin, stretched,
    /// sheared and flat. And where little moves, it does say something.
    #[test]
    fn it_says_what_a_search_from_nothing_says() {
        let far_off = (0..60).map(|i| placement(i).translation + DVec3::new(3.0, 0.0, 1.0)).collect();
        let far_off = Box::new(Polytope::new(far_off).unwrap()) as Box<dyn Support>;
        let shapes: Vec<_> = shapes().into_iter().chain([far_off]).collect();
        let (mut asked, mut hits, mut told) = (0, 0, [0; STEPS.len()]);
        for (i, a) in shapes.iter().enumerate() {
            for (j, b) in shapes.iter().enumerate() {
                for (k, (unit, far)) in UNITS.into_iter().enumerate() {
                    for (s, step) in STEPS.into_iter().enumerate() {
                        let seed = (i + 7 * j + 31 * k + 173 * s) as u32;
                        let mut memory = Memory::default();
                        let linear = [LINEARS[(i + k + s) % 4], LINEARS[(j + k) % 4]];
                        let mut at = [placement(seed), placement(seed + 50)];
                        let spins =
                            [placement(seed + 1), placement(seed + 2)].map(|at| at.translation.normalize());
                        for frame in 0..40 {
                            let placed = [0, 1].map(|n| {
                                let linear = at[n].matrix3 * linear[n];
                                let center = [a.center(), b.center()][n];
                                let translation = at[n].translation * 1.0 - linear * center;
                                DAffine3 { matrix3: linear * unit, translation: (translation + far) * unit }
                            });
                            let [at_a, at_b] = &placed;
                            let expected = intersects(&**a, at_a, &**b, at_b);
                            let still = memory.still(at_a, at_b);
                            let context = format!("{i} and {j} in {unit:e} by {step:e}, frame {frame}");
                            assert!(still.is_none_or(|still| still == expected), "{context}: {still:?}");
                            assert_eq!(memory.intersects(&**a, at_a, &**b, at_b), expected, "{context}");
                            asked += 1;
                            hits += usize::from(expected);
                            told[s] += usize::from(still.is_some());
                            for n in 0..2 {
                                let turn = DMat3::from_quat(DQuat::from_axis_angle(spins[n], step));
                                at[n].matrix3 = turn * at[n].matrix3;
                                let way = placement(seed + frame / 20 + 3 * n as u32).translation.normalize();
                                at[n].translation += way * if frame % 10 < 5 { step } else { -step };
                            }
                        }
                    }
                }
            }
        }
        assert!((30..=70).contains(&(100 * hits / asked)), "{hits} of {asked}: not representative");
        let rates = told.map(|told| 100 * told * STEPS.len() / asked);
        assert!(rates[0] >= 90 && rates[1] >= 85 && rates[2] >= 55, "{rates:?} % were told");
    }

    /// At the bound: blocks that come near, or turn towards each other, are told apart until just before they touch, and not after.
    #[test]
    fn it_runs_out_just_before_they_touch() {
        let block = Cuboid::new(DVec3::ONE).unwrap();
        for unit in [1e-9, 1.0, 1e9] {
            let at = |x: f64| DAffine3 {
                matrix3: DMat3::IDENTITY * unit,
                translation: DVec3::new(x, 0.1, -0.1) * unit,
            };
            let mut memory = Memory::default();
            assert!(!memory.intersects(&block, &at(0.0), &block, &at(2.0)));
            assert_eq!(memory.still(&at(0.0), &at(1.00001)), Some(false));
            assert_eq!(memory.still(&at(0.99999), &at(2.0)), Some(false));
            for gap in [1e-9, 0.0, -1e-9] {
                assert_eq!(memory.still(&at(0.0), &at(1.0 + gap)), None, "{gap:e}");
                assert_eq!(memory.still(&at(0.5), &at(1.5 + gap)), None, "{gap:e}");
            }
            // Their corners are 0.866 from their middles: with such a way to go, no turn is safe.
            let turned = |x: f64, angle: f64| {
                let at = at(x);
                DAffine3 { matrix3: at.matrix3 * DMat3::from_rotation_z(angle), ..at }
            };
            let chord = |angle: f64| 2.0 * (0.5 * angle).sin() * 0.75f64.sqrt();
            for angle in [0.05, 0.1, 0.2] {
                let near = 1.0 + chord(angle);
                assert_eq!(memory.still(&at(0.0), &turned(near + 1e-5, angle)), Some(false), "{angle}");
                assert_eq!(memory.still(&at(0.0), &turned(near - 1e-5, angle)), None, "{angle}");
                let near = 1.0 - chord(angle);
                assert_eq!(memory.still(&turned(near - 1e-5, angle), &at(2.0)), Some(false), "{angle}");
                assert_eq!(memory.still(&turned(near + 1e-5, angle), &at(2.0)), None, "{angle}");
            }
        }
    }

    /// The answer of a memory of two polytopes, where there is one without a search, and whether the clock gave it.
    fn seen(level: Level, memory: &mut Memory, [a, b]: [(&Polytope, &DAffine3); 2]) -> (Glance, bool) {
        dispatch!(level, simd => match memory.still_by(simd, a.1, b.1) {
            Some(answer) => (Glance::Sure(answer), true),
            None => (memory.glance_by(simd, a, b), false),
        })
    }

    /// Law: what balls and the kept axis leave to the clock is what a search from nothing says, whatever moves, by how little or much, in any unit, far
    /// from the origin; and every level of instructions says the same.
    #[test]
    fn what_a_glance_leaves_is_what_a_search_from_nothing_says() {
        let cloud = |seed: u32, count: u32, off: DVec3| {
            Polytope::new((0..count).map(|i| placement(seed + i).translation + off).collect()).unwrap()
        };
        let corner = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) - 0.5;
        let faces = (0..6).flat_map(|k| {
            let (axis, side) = (k / 2, k % 2);
            // The lower face is seen from below.
            let [u, v] = [[2, 1], [1, 2]][side as usize];
            let at = |a: u32, b: u32| side << axis | a << ((axis + u) % 3) | b << ((axis + v) % 3);
            [[at(0, 0), at(1, 0), at(1, 1)], [at(0, 0), at(1, 1), at(0, 1)]]
        });
        let block =
            Polytope::new((0..8).map(corner).collect()).unwrap().with_faces(&faces.collect::<Vec<_>>());
        let objects = [block, cloud(3, 20, DVec3::ZERO), cloud(70, 40, DVec3::new(3.0, 0.0, 1.0))];
        let (mut asked, mut hits, mut told, mut glanced) = (0, 0, [0; STEPS.len()], 0);
        for (i, a) in objects.iter().enumerate() {
            for (j, b) in objects.iter().enumerate() {
                for (k, (unit, far)) in UNITS.into_iter().enumerate() {
                    for (s, step) in STEPS.into_iter().enumerate() {
                        let seed = (i + 5 * j + 37 * k + 191 * s) as u32;
                        let mut memories = [Memory::default(); 2];
                        let mut at = [placement(seed), placement(seed + 50)];
                        for frame in 0..60 {
                            let [at_a, at_b] = [(a, at[0]), (b, at[1])].map(|(object, at)| {
                                let linear = at.matrix3 * unit * 0.7;
                                let translation = (at.translation * 0.8 + far) * unit;
                                DAffine3 {
                                    matrix3: linear,
                                    translation: translation - linear * object.center(),
                                }
                            });
                            let expected = intersects(a, &at_a, b, &at_b);
                            let context = format!("{i} and {j} in {unit:e} by {step:e}, frame {frame}");
                            let mut answers = [None; 2];
                            for (n, memory) in memories.iter_mut().enumerate() {
                                let answer = seen(levels()[n], memory, [(a, &at_a), (b, &at_b)]);
                                match answer.0 {
                                    Glance::Sure(answer) => assert_eq!(answer, expected, "{context}"),
                                    _ => assert_eq!(
                                        memory.intersects_anew(a, &at_a, b, &at_b),
                                        expected,
                                        "{context}"
                                    ),
                                }
                                answers[n] = Some(answer);
                            }
                            assert_eq!(answers[0], answers[1], "{context}");
                            let (glance, clock) = answers[0].unwrap();
                            asked += 1;
                            hits += usize::from(expected);
                            told[s] += usize::from(clock);
                            glanced += usize::from(!clock && matches!(glance, Glance::Sure(_)));
                            for (n, at) in at.iter_mut().enumerate() {
                                let way = placement(seed + frame / 20 + 3 * n as u32).translation.normalize();
                                at.matrix3 = DMat3::from_quat(DQuat::from_axis_angle(way, step)) * at.matrix3;
                                at.translation += way * if frame % 20 < 10 { step } else { -step };
                            }
                        }
                    }
                }
            }
        }
        assert!((30..=70).contains(&(100 * hits / asked)), "{hits} of {asked}: not representative");
        let rates = told.map(|told| 100 * told * STEPS.len() / asked);
        assert!(rates[0] >= 90 && rates[1] >= 80 && rates[2] >= 40, "{rates:?} % were told");
        assert!(glanced > 500, "{glanced}");
    }

    /// At the bound: balls that come near, or part, straight or by a turn about a point far off, are told until just before they touch, and not after.
    #[test]
    fn balls_run_out_just_before_they_touch() {
        let corners = vec![DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z];
        let rod = Polytope::new(corners[..5].to_vec()).unwrap();
        let block = Polytope::new(corners).unwrap().with_faces(&octahedron_faces());
        let [_, around] = rod.sure_radii();
        let [inside, _] = block.sure_radii();
        for (object, distance, room, meet) in
            [(&rod, 10.0, 10.0 - 2.0 * around, false), (&block, 0.5, 2.0 * inside - 0.5, true)]
        {
            let reach = object.farthest();
            // Which way it goes on.
            let sign = if meet { -1.0 } else { 1.0 };
            for unit in [1e-9, 1.0, 1e9] {
                let at = |x: f64| DAffine3 {
                    matrix3: DMat3::IDENTITY * unit,
                    translation: DVec3::new(x, 0.0, 0.0) * unit,
                };
                let mut memory = Memory::default();
                for level in levels() {
                    let (here, there) = (at(0.0), at(distance));
                    memory.rest();
                    assert_eq!(
                        seen(level, &mut memory, [(object, &here), (object, &there)]),
                        (Glance::Sure(meet), false)
                    );
                    // Of the four lengths that sum to the room each may be half of it alone; and all a quarter.
                    let half = 0.5 * room;
                    let turn = |x: f64, part: f64| {
                        let change = DMat3::from_diagonal(DVec3::new(part / reach, 0.0, 0.0)) * unit;
                        DAffine3 { matrix3: at(x).matrix3 + change, ..at(x) }
                    };
                    for (part, told) in [(0.9999, Some(meet)), (1.0001, None)] {
                        assert_eq!(memory.still(&here, &at(distance - sign * half * part)), told);
                        assert_eq!(memory.still(&at(sign * half * part), &there), told);
                        // The axes may change by half at most.
                        let change = half.min(0.5 * reach) * part;
                        assert_eq!(memory.still(&here, &turn(distance, change)), told);
                    }
                }
            }
        }
    }

    /// What is no placement has no answer, and what turned far none by this.
    #[test]
    fn wild_placements_stop_it() {
        let block = Cuboid::new(DVec3::ONE).unwrap();
        let here = DAffine3::IDENTITY;
        for x in [0.25, 50.0] {
            let there = DAffine3::from_translation(DVec3::new(x, 0.1, -0.05));
            let mut memory = Memory::default();
            assert_eq!(memory.still(&here, &there), None);
            let expected = memory.intersects(&block, &here, &block, &there);
            assert_eq!(memory.still(&here, &there), Some(expected));
            let wild = [
                DAffine3 { translation: DVec3::new(x, f64::NAN, 0.0), ..there },
                DAffine3 { translation: DVec3::new(x, 0.0, f64::INFINITY), ..there },
                DAffine3 { matrix3: DMat3::from_diagonal(DVec3::new(1.0, f64::NAN, 1.0)), ..there },
                DAffine3 { matrix3: DMat3::from_diagonal(DVec3::new(1.0, 0.0, 1.0)), ..there },
                DAffine3 { matrix3: DMat3::from_diagonal(DVec3::new(1.0, 1e9, 1.0)), ..there },
                DAffine3 { matrix3: DMat3::from_rotation_y(0.5), ..there },
            ];
            for wild in wild {
                assert_eq!(memory.still(&here, &wild), None, "{wild}");
                assert_eq!(memory.still(&wild, &there), None, "{wild}");
            }
            // Both so far off that nothing shows it in their offset.
            let far = DVec3::splat(1e120);
            let [here, there] = [here, there].map(|at| DAffine3 { translation: at.translation + far, ..at });
            assert_eq!(memory.still(&here, &there), None);
        }
    }

    /// It is not set of placements next to singular, nor where products of lengths might overflow or vanish.
    #[test]
    fn it_is_set_of_plain_sizes_alone() {
        let tell = |size: f64, scale: f64, way: f64, matrix3: DMat3| {
            let block = Cuboid::new(DVec3::splat(size)).unwrap();
            let here = DAffine3 { matrix3: matrix3 * scale, translation: DVec3::splat(way) };
            let there = DAffine3 { translation: here.translation + DVec3::X * (4.0 * scale * size), ..here };
            let mut memory = Memory::default();
            let found = memory.intersects(&block, &here, &block, &there);
            assert_eq!(found, intersects(&block, &here, &block, &there));
            let still = memory.still(&here, &there);
            assert!(still.is_none_or(|still| still == found));
            still.is_some()
        };
        let square = DMat3::IDENTITY;
        for unit in [1e-30, 1.0, 1e30] {
            assert!(tell(1.0, unit, 0.0, square) && tell(unit, 1.0, 0.0, square), "{unit:e}");
        }
        for unit in [1e-80, 1e-36, 1e36, 1e80] {
            assert!(!tell(1.0, unit, 0.0, square) && !tell(unit, 1.0, 0.0, square), "{unit:e}");
        }
        assert!(tell(1e34, 1.0, 1e34, square) && !tell(1e34, 1.0, 1e36, square));
        let slanted = |z: f64| DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(1.0, 0.0, z));
        assert!(tell(1.0, 1.0, 0.0, slanted(1e-5)) && !tell(1.0, 1.0, 0.0, slanted(1e-7)));
    }

    /// Law: what was asked of the same two in between makes no answer wrong.
    #[test]
    fn other_questions_in_between_leave_it_right() {
        let (mut told, mut parted) = (0, 0);
        for k in 0..4_000u32 {
            let cloud = |seed: u32| {
                let off = placement(seed + 9).translation * 3.0;
                Polytope::new((seed..seed + 6).map(|i| placement(i).translation + off).collect()).unwrap()
            };
            let (a, b) = (cloud(7 * k), cloud(11 * k + 3));
            let way = placement(k + 5).translation.normalize();
            let at = |object: &Polytope, x: f64| DAffine3::from_translation(way * x - object.center());
            let (at_a, at_b) = (at(&a, 0.0), at(&b, 0.05));
            let mut memory = Memory::default();
            if !memory.intersects(&a, &at_a, &b, &at_b) {
                continue;
            }
            let away = at(&b, 0.2 + 0.2 * f64::from(k % 8));
            if k % 2 == 0 {
                memory.closest_points(&a, &at_a, &b, &away);
            } else {
                memory.quickly_closest(&a, &at_a, &b, &away);
            }
            for x in [0.05, 0.3, 0.6, 1.0, 1.4] {
                let there = at(&b, x);
                let expected = intersects(&a, &at_a, &b, &there);
                let still = memory.still(&at_a, &there);
                assert!(still.is_none_or(|still| still == expected), "{k}, {x}: {still:?}");
                told += usize::from(still.is_some());
                parted += usize::from(!expected);
            }
        }
        assert!(told > 1_000 && parted > 1_000, "{told} told, {parted} apart");
    }
}
