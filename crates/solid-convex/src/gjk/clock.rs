//! The motion clock: an answer, and whether it still is one after the two objects have moved.
//!
//! Of objects that are apart, the gap along the axis that separates them is room to move in: from the placements then and now follows a
//! bound on how far any point of the objects has come along the axis, and while that is less than the gap, no support point is
//! asked for. Of objects that intersect, the four points of each whose differences contained the origin are looked at where they
//! are now. (Bounds on motion are what I-COLLIDE schedules pairs by; here they change no answer.)

use fearless_simd::{Simd, f64x4, prelude::*};
use glam::{DAffine3, DMat3, DVec3};

use super::intersection::CACHED_GAP_MIN;
use super::pairs::{Pairs, images};
use crate::Support;
use crate::simd::dispatch;
use crate::simplex::VOLUME_ERROR;

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
    /// The objects are apart along a unit axis, from `B` to `A`, by more than this and what the clock leaves.
    Apart { axis: DVec3, gap: f64 },
    /// The tetrahedron of the differences of the four pairs of points that are kept contains the origin.
    Common,
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
    /// set with. Placements of an answer are finite, not near singular, and of magnitudes below 1e37.
    #[inline]
    pub fn answer(&self, pairs: &Pairs, at_a: &DAffine3, at_b: &DAffine3) -> Option<bool> {
        match &self.evidence {
            Evidence::None => None,
            Evidence::Apart { axis, gap } => {
                dispatch!(simd => self.still_apart(simd, at_a, at_b, *axis, *gap)).then_some(false)
            }
            Evidence::Common => dispatch!(simd => self.still_common(simd, at_a, at_b, pairs)).then_some(true),
        }
    }

    #[inline(always)]
    fn still_apart<S: Simd>(&self, simd: S, at_a: &DAffine3, at_b: &DAffine3, axis: DVec3, gap: f64) -> bool {
        let (change_a, allowed_a) = self.a.change(simd, at_a);
        let (change_b, allowed_b) = self.b.change(simd, at_b);
        // How the balls moved along the axis: a centre by a product, any other point by at most a length more.
        let (linear_a, by_a) = along(&change_a, axis);
        let (linear_b, by_b) = along(&change_b, axis);
        let left = gap + (linear_a.dot(self.a.center) + by_a) - (linear_b.dot(self.b.center) + by_b);
        allowed_a & allowed_b & sum_is_less(linear_a * self.a.radius, linear_b * self.b.radius, left)
    }

    #[inline(always)]
    fn still_common<S: Simd>(&self, simd: S, at_a: &DAffine3, at_b: &DAffine3, pairs: &Pairs) -> bool {
        let (_, allowed_a) = self.a.change(simd, at_a);
        let (_, allowed_b) = self.b.change(simd, at_b);
        let offset = at_b.translation - at_a.translation;
        let (on_a, on_b) = (images(simd, &at_a.matrix3, &pairs.a), images(simd, &at_b.matrix3, &pairs.b));
        let mut points = [[0.0; 4]; 3];
        for i in 0..3 {
            (on_a[i] - on_b[i] - f64x4::splat(simd, offset[i])).store_slice(&mut points[i]);
        }
        let error = VOLUME_ERROR * self.size * self.size * self.size;
        allowed_a & allowed_b & contains_origin(&points, error)
    }

    /// Sets it for objects that are apart: `gap` is a lower bound of the gap along a unit axis, from `B` to `A`, in the world.
    pub fn set_apart<A, B>(
        &mut self,
        (a, at_a): (&A, &DAffine3),
        (b, at_b): (&B, &DAffine3),
        axis: DVec3,
        gap: f64,
    ) where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        self.set((a, at_a), (b, at_b), |size| Evidence::Apart { axis, gap: gap - GAP_LEFT_MIN * size });
    }

    /// Sets it for objects that intersect, by the four pairs of points that are kept.
    pub fn set_common<A, B>(&mut self, (a, at_a): (&A, &DAffine3), (b, at_b): (&B, &DAffine3))
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        self.set((a, at_a), (b, at_b), |_| Evidence::Common);
    }

    /// Stops it: nothing is sure.
    pub fn stop(&mut self) {
        self.evidence = Evidence::None;
    }

    /// Sets it; `evidence` is given the size of the data.
    fn set<A, B>(
        &mut self,
        (a, at_a): (&A, &DAffine3),
        (b, at_b): (&B, &DAffine3),
        evidence: impl FnOnce(f64) -> Evidence,
    ) where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        self.stop();
        if let (Some((a, extent_a)), Some((b, extent_b))) = (Body::of(a, at_a), Body::of(b, at_b)) {
            let extent = extent_a + extent_b;
            // Each may come as far as this: then less than four times that is added to the sum of an offset's magnitudes.
            let (a, b) = (a.with_travel_max(extent), b.with_travel_max(extent));
            let size = 5.0 * extent + (at_b.translation - at_a.translation).abs().element_sum();
            *self = Clock { evidence: evidence(size), a, b, size };
        }
    }
}

impl Body {
    /// With a bound on the coordinates of the object's image under its linear part, also under one that is changed as much as may be. `None` for
    /// what is out of the ordinary.
    fn of<S: Support + ?Sized>(object: &S, at: &DAffine3) -> Option<(Body, f64)> {
        /// By Cauchy and Schwarz the root of three, and half as much again.
        const SPREAD: f64 = 2.6;
        let (center, radius) = match object.balls() {
            Some(balls) => (balls.center, balls.outer),
            None => (DVec3::ZERO, object.reach().length()),
        };
        let DMat3 { x_axis: x, y_axis: y, z_axis: z } = at.matrix3;
        let lengths = DVec3::new(x.length(), y.length(), z.length());
        let volume = x.cross(y).dot(z).abs() / (lengths.x * lengths.y * lengths.z);
        let farthest = radius + center.length();
        let plain = lengths.min_element() >= PLAIN_MIN
            && lengths.max_element() <= PLAIN_MAX
            && at.translation.abs().max_element() <= PLAIN_MAX
            && radius >= PLAIN_MIN
            && farthest <= PLAIN_MAX
            && volume >= VOLUME_MIN;
        let rates = (lengths * (CHANGE_MAX * volume.min(1.0))).recip();
        let rates = std::array::from_fn(|k| if k < 9 { rates[k / 3] } else { 0.0 });
        let body = Body { placement: at.to_cols_array(), rates, center, radius };
        plain.then(|| (body, SPREAD * lengths.length() * farthest))
    }

    /// The same, allowed to come this far.
    fn with_travel_max(mut self, travel_max: f64) -> Body {
        self.rates[9..].fill(travel_max.recip());
        self
    }

    /// How its placement changed, and whether it may have changed so much: not to what is no number.
    #[inline(always)]
    fn change<S: Simd>(&self, simd: S, at: &DAffine3) -> (Columns, bool) {
        let mut change = at.to_cols_array();
        let mut sum = f64x4::splat(simd, 0.0);
        for k in [0, 4, 8] {
            let four = |columns: &Columns| {
                f64x4::simd_from(simd, [columns[k], columns[k + 1], columns[k + 2], columns[k + 3]])
            };
            let changed = four(&change) - four(&self.placement);
            let part = changed * four(&self.rates);
            sum += part * part;
            change[k..k + 4].copy_from_slice(changed.as_slice());
        }
        let sums = sum.as_slice();
        let allowed = (sums[0] + sums[1]) + (sums[2] + sums[3]) <= 1.0;
        (change, allowed)
    }
}

/// The products of columns with an axis: those of the linear part, and that of the translation.
#[inline(always)]
fn along(columns: &Columns, axis: DVec3) -> (DVec3, f64) {
    let mut products = [0.0; 12];
    for k in 0..12 {
        products[k] = columns[k] * axis[k % 3];
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

/// Whether a tetrahedron contains the origin: six times the volume that it makes with each face is, up to this error, of the same sign.
#[inline(always)]
fn contains_origin(points: &[[f64; 4]; 3], error: f64) -> bool {
    // Around each face, and the corner opposite: as in `sides_of_origin`.
    const FACES: [[usize; 4]; 3] = [[0, 1, 2, 0], [1, 2, 0, 1], [3, 3, 3, 2]];
    let [px, py, pz] = points;
    let mut sides = [0.0; 4];
    for k in 0..4 {
        let (p, q, r) = (FACES[0][k], FACES[1][k], FACES[2][k]);
        let x = py[p] * pz[q] - pz[p] * py[q];
        let y = pz[p] * px[q] - px[p] * pz[q];
        let z = px[p] * py[q] - py[p] * px[q];
        sides[k] = x * px[r] + y * py[r] + z * pz[r];
    }
    let [a, b, c, d] = [-sides[0], -sides[1], -sides[2], sides[3]];
    let (least, greatest) = (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)));
    (least > error) | (greatest < -error)
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::*;
    use crate::gjk::{Memory, intersects};
    use crate::testing::{placement, shapes};
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
}
