//! The boxes of tree nodes: `f32`, rounded outward.

use crate::bounds::Aabb;
use crate::broad::{Proxy, is_ordered};
use fearless_simd::{Simd, f32x8, f64x4, prelude::*};
use glam::DVec3;

/// How much a fat box exceeds its tight box on each side, as a fraction of the tight box's largest extent.
/// Measured at 100,000 boxes: 0.05 is up to 25 % faster than 0.1 where little moves, because there
/// are fewer fat pairs to filter, and as fast where all do.
const MARGIN: f64 = 0.05;

/// Over how many frames like the last one a fat box should hold its tight box.
/// Measured with `AHEAD_MAX`: 8 and 1 are up to 30 % faster than 2 and 0.2, and within 10 % of 4 and 0.5.
const FRAMES_AHEAD: f64 = 8.0;

/// The look-ahead is at most this multiple of the tight box's largest extent.
const AHEAD_MAX: f64 = 1.0;

/// How far each side of a fat box makes room for a body that turns or deforms, in sums of what was last added to or taken from the three
/// half extents. Sides of its box come and go: while each was foreseen to go on as in the last frame, more than a tenth of the polyhedra of
/// I-COLLIDE left their fat boxes in every frame. Measured there, with fat boxes that make room for: 0, 2, 4, 6 sums, of 1,000 a frame takes
/// 125, 29, 15, 9 us where they swing to and fro, 180, 67, 59, 72 where they turn on.
const SWAY: f64 = 4.0;

/// That is at most this multiple of the tight box's largest extent.
const SWAY_MAX: f64 = 0.5;

/// Room that does not last so many frames like the last one is not made: all that it would do is overlap more boxes. Measured with 20,000
/// swept balls that jump by up to six radii: 0.26 s a frame and 59 MB, with all the room they may have 2.2 s and 515 MB.
const FRAMES_MIN: f64 = 2.0;

/// A box of `f32`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FatBox {
    pub min: [f32; 3],
    pub max: [f32; 3],
}

impl FatBox {
    /// Holds nothing.
    pub const EMPTY: FatBox = FatBox { min: [f32::INFINITY; 3], max: [f32::NEG_INFINITY; 3] };

    /// The smallest `f32` box around `bounds`.
    ///
    /// Coordinates beyond the range of `f32` are clamped to it. Such a box does not contain `bounds`, yet no overlap
    /// is lost: rounding and clamping are monotone, so `a.min <= b.max` implies the same of their images.
    ///
    /// Inlined: a call of its own made a box that is added or leaves its fat box take a third more.
    #[inline(always)]
    pub fn around(bounds: &Aabb) -> Self {
        FatBox { min: bounds.min.to_array().map(round_down), max: bounds.max.to_array().map(round_up) }
    }

    /// A box with room around `bounds`, more if it changes, and more where it is heading, judged by where it was.
    pub fn with_room(proxy: Proxy, was: &Aabb, bounds: &Aabb) -> Self {
        let extent = 2.0 * bounds.half_extents().max_element();
        // Staggered by proxy, so that boxes that move alike do not all leave in the same frame.
        let stagger = f64::from(proxy.wrapping_mul(0x9E37_79B9) >> 16) / 65536.0;
        let margin = MARGIN * (0.75 + 0.5 * stagger) * extent;
        let change = (bounds.half_extents() - was.half_extents()).abs().element_sum();
        let moved = bounds.center() - was.center();
        let (sway_max, ahead_max) = (SWAY_MAX * extent, AHEAD_MAX * extent);
        let lasts = FRAMES_MIN * change <= sway_max && FRAMES_MIN * moved.abs().max_element() <= ahead_max;
        let (change, moved) = if lasts { (change, moved) } else { (0.0, DVec3::ZERO) };
        let sway = (SWAY * change).min(sway_max);
        let way = FRAMES_AHEAD * moved;
        let [below, above] = [-way, way].map(|way| way.clamp(DVec3::ZERO, DVec3::splat(ahead_max)));
        let room = DVec3::splat(margin + sway);
        FatBox::around(&Aabb::new(bounds.min - room - below, bounds.max + room + above))
    }

    /// Whether a box is not empty and lies in this one. Then so does [`around`](Self::around) it: this box is one of those that it is chosen
    /// from.
    #[inline]
    pub fn holds(&self, bounds: &Aabb) -> bool {
        // Without a branch: nearly all boxes are asked this in each frame, and nearly all lie inside.
        (0..3).fold(is_ordered(bounds), |inside, k| {
            inside & (f64::from(self.min[k]) <= bounds.min[k]) & (bounds.max[k] <= f64::from(self.max[k]))
        })
    }

    /// The same, in vectors.
    #[inline(always)]
    pub fn holds_with<S: Simd>(&self, simd: S, bounds: &Aabb) -> bool {
        // The first four numbers and the last four of each box, as they stand in memory: of one vector the last lane is of no account,
        // of the other the first.
        let [[a, b, c], [d, e, f]] = [self.min, self.max];
        let (fat_min, fat_max) = f32x8::simd_from(simd, [a, b, c, d, c, d, e, f]).widen();
        let [[a, b, c], [d, e, f]] = [bounds.min.to_array(), bounds.max.to_array()];
        let (min, max) = (f64x4::simd_from(simd, [a, b, c, d]), f64x4::simd_from(simd, [c, d, e, f]));
        let from = fat_min.simd_le(min) & min.simd_le(max.slide::<1>(max));
        let until = max.simd_le(fat_max);
        !(from.to_bitmask() & until.to_bitmask() >> 1) & 0b111 == 0
    }

    pub fn overlaps(&self, other: &FatBox) -> bool {
        (0..3).all(|k| self.min[k] <= other.max[k] && other.min[k] <= self.max[k])
    }

    pub fn union(&self, other: &FatBox) -> FatBox {
        FatBox {
            min: std::array::from_fn(|k| self.min[k].min(other.min[k])),
            max: std::array::from_fn(|k| self.max[k].max(other.max[k])),
        }
    }

    /// Half the surface area, in `f64`, where it cannot overflow.
    pub fn half_area(&self) -> f64 {
        let [x, y, z] = std::array::from_fn(|k| f64::from(self.max[k]) - f64::from(self.min[k]));
        x * y + y * z + z * x
    }

    pub fn center(&self) -> [f32; 3] {
        std::array::from_fn(|k| 0.5 * self.min[k] + 0.5 * self.max[k])
    }
}

/// The greatest `f32` that is not above, within the range of `f32`. Without a branch: there is no telling which way a number rounds.
#[inline]
fn round_down(x: f64) -> f32 {
    let nearest = x as f32;
    // The order of these integers is that of the numbers; what rounded up to zero is minus zero, the one before it.
    let flipped = |bits: i32| bits ^ (bits >> 31 & i32::MAX);
    let below = flipped(nearest.to_bits() as i32) - i32::from(f64::from(nearest) > x);
    f32::from_bits(flipped(below) as u32).clamp(-f32::MAX, f32::MAX)
}

#[inline]
fn round_up(x: f64) -> f32 {
    -round_down(-x)
}

#[cfg(test)]
mod tests {
    use glam::DQuat;
    use rand::Rng;
    use solid_convex::simd::{dispatch, levels};
    use solid_oracle::generate::seeded;

    use super::*;

    #[test]
    fn rounding_is_outward_and_monotone_over_the_whole_range() {
        let mut values = vec![0.0, -0.0, 1.0, 0.1, 1e-100, 1e-40, 3e38, 3.5e38, 1e39, 1e100, 1.0 + 1e-12];
        values.extend(values.clone().iter().map(|x| -x));
        values.sort_by(f64::total_cmp);
        for &x in &values {
            let (down, up) = (round_down(x), round_up(x));
            assert!(down.is_finite() && up.is_finite() && down <= up);
            if x.abs() <= f64::from(f32::MAX) {
                assert!(f64::from(down) <= x && x <= f64::from(up));
            }
        }
        for w in values.windows(2) {
            assert!(round_down(w[0]) <= round_down(w[1]) && round_up(w[0]) <= round_up(w[1]));
            assert!(round_down(w[0]) <= round_up(w[1]));
        }
    }

    /// Law: at any level, a box is held where its numbers say so; one that is empty or not of numbers is not.
    #[test]
    fn vectors_hold_what_numbers_hold() {
        let mut rng = seeded(811);
        let (mut hits, cases) = (0, 4000);
        for case in 0..cases {
            // Half of the boxes lie inside, some of them with a face in that of the fat box.
            let mut any = |most: i32| f64::from(rng.random_range(0..=most));
            let min = DVec3::new(any(2), any(2), any(2));
            let max = min + DVec3::new(any(4), any(4), any(4));
            let mut numbers = [min.x, min.y, min.z, max.x, max.y, max.z];
            let fat = FatBox { min: [0.0; 3], max: [4.0; 3] };
            if case % 16 == 0 {
                numbers[case / 16 % 6] = [f64::NAN, f64::INFINITY, -f64::INFINITY, 9.0, -9.0][case % 5];
            }
            let bounds = Aabb::new(DVec3::from_slice(&numbers[..3]), DVec3::from_slice(&numbers[3..]));
            let expected = (0..3).all(|k| {
                let (from, until) = (numbers[k], numbers[k + 3]);
                0.0 <= from && from <= until && until <= 4.0
            });
            assert_eq!(fat.holds(&bounds), expected, "{bounds:?}");
            for level in levels() {
                let held = dispatch!(level, simd => fat.holds_with(simd, &bounds));
                assert_eq!(held, expected, "{level:?}, {bounds:?}");
                let empty = dispatch!(level, simd => FatBox::EMPTY.holds_with(simd, &bounds));
                assert!(!empty && !FatBox::EMPTY.holds(&bounds));
            }
            hits += usize::from(expected);
        }
        assert!((cases * 3 / 10..cases * 7 / 10).contains(&hits), "{hits} of {cases} are held");
    }

    /// Law: of bodies that fly and turn by 10 degrees a frame fewer than a tenth leave their fat boxes, or the tree would be built in every
    /// frame; yet those are no giants.
    #[test]
    fn few_bodies_that_turn_leave() {
        let mut rng = seeded(813);
        let (mut leaves, mut frames, mut sides) = (0, 0, 0.0);
        for proxy in 0..50 {
            let mut direction = || loop {
                let v = DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)));
                if (0.1..1.0).contains(&v.length()) {
                    return v.normalize();
                }
            };
            let points: Vec<DVec3> = (0..20).map(|_| direction()).collect();
            let (axis, velocity) = (direction(), 0.05 * direction());
            let at = |frame: u32| {
                let turn = DQuat::from_axis_angle(axis, (10.0 * f64::from(frame)).to_radians());
                Aabb::of_points(points.iter().map(|&point| turn * point + f64::from(frame) * velocity))
            };
            let mut fat = FatBox::with_room(proxy, &at(0), &at(0));
            for frame in 1..200 {
                if !fat.holds(&at(frame)) {
                    fat = FatBox::with_room(proxy, &at(frame - 1), &at(frame));
                    leaves += 1;
                }
                frames += 1;
                sides += f64::from(fat.max[0] - fat.min[0]);
            }
        }
        assert!(100 * leaves < 8 * frames, "{leaves} in {frames} frames");
        assert!(sides < 3.2 * f64::from(frames), "{} is the mean side", sides / f64::from(frames));
    }

    /// Law: a box that was elsewhere, or another, a frame ago has no room but its margin, for in the next frame it will be so again.
    #[test]
    fn a_teleport_leaves_no_giant() {
        let [unit, large] = [1.0, 3.0].map(|side| Aabb::new(DVec3::ZERO, DVec3::splat(side)));
        for was in [Aabb::new(DVec3::splat(-1e6), DVec3::splat(-1e6 + 1.0)), large] {
            let fat = FatBox::with_room(3, &was, &unit);
            assert!(fat.max[0] < 1.1 && fat.min[0] > -0.1, "{fat:?}");
        }
    }
}
