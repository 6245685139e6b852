//! The leaves along a ray, nearest first.
//!
//! A ray is tested against the eight boxes of a node at once, by slabs, in `f32`. In tree coordinates the boxes lie in
//! `[-1, 1]^3`; a ray from afar is first moved to where it comes near, in `f64`.
//!
//! # Why nothing is lost
//!
//! The origin is not a point here but a box around it, so that what is computed in `f64`, and how the boxes of a moving box
//! grow, is all in one place: the sides of it are rounded outward to `f32`. Then a side of a slab is left to
//! `(side - origin) * inverse`: a difference whose sign is exact, and three roundings, of the difference, of the inverse and of the
//! product. [`ROUNDING`] is more than those of both ends of an interval, which is stretched by it (Ize, *Robust BVH Ray
//! Traversal*, 2013). A direction nearly along a plane has its least coordinate raised to [`DIRECTION_MIN`]; over the few
//! units of path that are left, the origin's box pays for that.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};
use glam::DVec3;
use solid_convex::simd::{self, Level, dispatch};
use solid_convex::unit_scale;

use super::insertion::push_unless_far;
use super::lanes::bits;
use super::node::{Kind, Node, WIDTH};
use super::normal::round_down;
use super::{Leaf, Place, Traversal, Tree};
use crate::Aabb;

/// What is done with the leaves along a ray, in vectors of the level of instructions that the walk runs on.
pub(crate) trait RayLeaves {
    /// Asks for the memory of a leaf that the walk may come to.
    #[inline(always)]
    fn prefetch(&self, _leaf: &Leaf) {}

    /// Called with the leaves that the ray may meet up to `until`; lowers it.
    fn visit<S: Simd>(&mut self, simd: S, leaf: &Leaf, until: &mut f64);
}

/// Leaves are given to a function.
struct Plain<F>(F);

impl<F: FnMut(&[u32], &mut f64)> RayLeaves for Plain<F> {
    #[inline(always)]
    fn visit<S: Simd>(&mut self, _: S, leaf: &Leaf, until: &mut f64) {
        (self.0)(leaf.primitives, until);
    }
}

/// A ray, or a box that moves along one, in the space of the tree: what is within `half_extents` of
/// `origin + t * direction` for some `t >= 0`.
///
/// The direction must not be zero; coordinates are at most 1e200 in magnitude.
///
/// ```
/// use solid3d::{Aabb, glam::DVec3, tree::{Traversal, Tree, TreeRay}};
///
/// let unit = |i: u32| Aabb::new(DVec3::splat(f64::from(i)), DVec3::splat(f64::from(i) + 0.5));
/// let boxes: Vec<Aabb> = (0..100).map(unit).collect();
/// let ray = TreeRay { origin: DVec3::splat(200.25), direction: DVec3::NEG_ONE, half_extents: DVec3::ZERO };
/// // The leaf that it comes to first has the last box. Nothing behind that is asked for.
/// let (mut until, mut first) = (f64::INFINITY, None);
/// Tree::build(&boxes).along(&ray, &mut until, &mut Traversal::default(), |leaf, until| {
///     first = leaf.iter().max().copied();
///     *until = 101.0;
/// });
/// assert_eq!(first, Some(99));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeRay {
    /// Where it starts: the centre of the box that moves.
    pub origin: DVec3,
    /// The way in one unit of time.
    pub direction: DVec3,
    /// How far the box reaches from its centre; zero for a ray.
    pub half_extents: DVec3,
}

impl TreeRay {
    /// A lower bound of the parameter at which it meets a box, beyond 0; `None` when it surely does not.
    pub(crate) fn reaches(&self, bounds: &Aabb) -> Option<f64> {
        let half = bounds.half_extents() + self.half_extents;
        let offset = self.origin - bounds.center();
        let margin = ROUNDING_F64 * (self.origin.abs() + bounds.center().abs() + half);
        entry(offset, self.direction, half + margin)
    }
}

/// Rounding of the two ends of an interval, relative: six times 2^-24, and some.
const ROUNDING: f32 = 4.0 * f32::EPSILON;

/// Relative rounding of what is computed in `f64`: some dozen operations.
const ROUNDING_F64: f64 = 16.0 * f64::EPSILON;

/// The least coordinate of a direction whose greatest is from 1 to 2.
const DIRECTION_MIN: f64 = 1e-12;

/// More than what raising a direction's coordinate to [`DIRECTION_MIN`] moves over the path that is left.
const RAISED: f64 = 1e-10;

/// A ray from further away than this, beyond the moving box, is moved up. The tree lies within 1.
const FAR_AWAY: f64 = 4.0;

/// What is beyond is as good as endless, and its products do not overflow in `f32`.
const ENDLESS: f64 = 1e20;

/// Room for the entries of most rays, so that memory is asked for once.
const STACK: usize = 64;

/// A ray in tree coordinates, ready for lanes.
struct Probe {
    /// The sides of the origin's box that count for where a slab is entered, and where it is left.
    enter_from: [f32; 3],
    leave_from: [f32; 3],
    inverse: [f32; 3],
    /// Parameters times this are those of the lanes, from `start` on.
    speed: f64,
    start: f64,
}

impl Probe {
    /// `None` for a ray that clearly passes the tree.
    fn new(tree: &Tree, ray: &TreeRay) -> Option<Probe> {
        let normal = &tree.normal;
        let to_tree = |v: DVec3| v * normal.inverse;
        let largest = ray.direction.abs().max_element();
        // Rounded up, as the rounding of the origin is. Not cut off before it is added to that, which may be as far.
        let mut half = to_tree(ray.half_extents);
        let mut origin = to_tree(ray.origin - normal.origin);
        let unit = unit_scale(largest);
        let direction = ray.direction * unit;
        let terms = to_tree(ray.origin.abs() + normal.origin.abs());
        half += ROUNDING_F64 * (terms + half) + RAISED;
        let mut start = 0.0;
        if (origin.abs() - half).max_element() > FAR_AWAY {
            start = entry(origin, direction, half + FAR_AWAY)?;
            origin += direction * start;
            half += ROUNDING_F64 * (terms + DVec3::splat(start));
        }
        let low = (origin - half).to_array().map(|x| round_down(x.max(-ENDLESS)));
        let high = (origin + half).to_array().map(|x| -round_down(-x.min(ENDLESS)));
        let direction = direction.to_array().map(|d| d.abs().max(DIRECTION_MIN).copysign(d));
        let from =
            |ahead: bool| [0, 1, 2].map(|i| if (direction[i] > 0.0) == ahead { high[i] } else { low[i] });
        Some(Probe {
            enter_from: from(true),
            leave_from: from(false),
            inverse: direction.map(|d| (1.0 / d) as f32),
            // One unit of the lanes' parameter is a way of `direction` in tree coordinates.
            speed: normal.inverse / unit,
            start,
        })
    }

    /// A bound on the lanes' parameters, rounded up; negative when nothing is left.
    fn until(&self, until: f64) -> f32 {
        let left = until * self.speed - self.start;
        let slack = ROUNDING_F64 * self.start + f64::from(f32::MIN_POSITIVE);
        -round_down(-(left + slack).min(ENDLESS))
    }
}

/// When a point comes into a box around the origin: `None` when it does not.
fn entry(origin: DVec3, direction: DVec3, half: DVec3) -> Option<f64> {
    let (mut enter, mut leave) = (0.0f64, f64::INFINITY);
    for axis in 0..3 {
        let (p, d, h) = (origin[axis], direction[axis], half[axis]);
        if d == 0.0 {
            if p.abs() > h {
                return None;
            }
            continue;
        }
        let side = h.copysign(d);
        enter = enter.max((-side - p) / d);
        leave = leave.min((side - p) / d);
    }
    (enter <= leave).then_some(enter)
}

impl Tree {
    /// Visits the leaves that a ray, or a moving box, may meet at a parameter from 0 to `until`, nearest first: all
    /// primitives whose boxes it does, and some whose boxes it does not.
    ///
    /// `visit` lowers `until` as it finds hits: leaves that are entered later are skipped, those that are entered at that time are
    /// not. Below zero the query ends. See [`TreeRay`] for an example.
    pub fn along(
        &self,
        ray: &TreeRay,
        until: &mut f64,
        traversal: &mut Traversal,
        visit: impl FnMut(&[u32], &mut f64),
    ) {
        self.along_on(simd::level(), ray, until, traversal, &mut Plain(visit));
    }

    /// As [`along`](Tree::along), on a level of instructions.
    pub(crate) fn along_on(
        &self,
        level: Level,
        ray: &TreeRay,
        until: &mut f64,
        traversal: &mut Traversal,
        visitor: &mut impl RayLeaves,
    ) {
        if let Some(probe) = Probe::new(self, ray) {
            dispatch!(level, simd => self.walk_along(simd, &probe, until, traversal, visitor));
        }
    }

    #[inline(always)]
    fn walk_along<S: Simd>(
        &self,
        simd: S,
        probe: &Probe,
        until: &mut f64,
        traversal: &mut Traversal,
        visitor: &mut impl RayLeaves,
    ) {
        let Traversal { counters, ahead: stack, .. } = traversal;
        stack.clear();
        stack.reserve(STACK);
        let mut left = probe.until(*until);
        // Of a node with one lane on the way that is next: what is pushed would be popped at once.
        let mut only = Some((0.0, (self.child_at(Place::ROOT), Place::ROOT)));
        while let Some((enter, (child, place))) = only.take().or_else(|| stack.pop()) {
            if enter > left {
                continue;
            }
            match child.kind() {
                Kind::Empty => {}
                Kind::Leaf(range) => {
                    counters.leaf_visits += 1;
                    visitor.visit(simd, &self.leaf_at(place, range), until);
                    left = probe.until(*until);
                }
                Kind::Inner(index) => {
                    counters.box_tests += 1;
                    let node = &self.nodes[index];
                    let (hits, enters) = entries(simd, node, probe, left);
                    let entry = |lane: usize| (enters[lane], (node.child[lane], Place::lane(index, lane)));
                    if hits.is_power_of_two() {
                        only = Some(entry(hits.trailing_zeros() as usize));
                        continue;
                    }
                    let from = stack.len();
                    for lane in bits(hits) {
                        let next = entry(lane);
                        self.prefetch(
                            next.1,
                            #[inline(always)]
                            |leaf| visitor.prefetch(leaf),
                        );
                        push_unless_far(next, f32::INFINITY, stack, from);
                    }
                }
            }
        }
    }
}

/// The lanes that a ray meets at a parameter up to `left`, as bits, and when it enters each.
#[inline(always)]
fn entries<S: Simd>(simd: S, node: &Node, probe: &Probe, left: f32) -> (u32, [f32; WIDTH]) {
    let splat = |x: f32| f32x8::splat(simd, x);
    let mut enter = splat(0.0);
    let mut leave = splat(left);
    for axis in 0..3 {
        let (min, max) = (&node.min[axis], &node.max[axis]);
        let (near, far) = if probe.inverse[axis] > 0.0 { (min, max) } else { (max, min) };
        let inverse = splat(probe.inverse[axis]);
        let near = (f32x8::from_slice(simd, near) - splat(probe.enter_from[axis])) * inverse;
        let far = (f32x8::from_slice(simd, far) - splat(probe.leave_from[axis])) * inverse;
        enter = near.max(enter);
        leave = (far * splat(1.0 + ROUNDING)).min(leave);
    }
    let enter = enter * splat(1.0 - ROUNDING);
    let hits = enter.simd_le(leave).to_bitmask() as u32;
    let mut enters = [0.0; WIDTH];
    enter.store_slice(&mut enters);
    (hits, enters)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::tests::scenes::{point, random_boxes, rng};
    use rand::Rng;

    /// The parameter at which a moving box meets a box, in `f64`, by slabs.
    fn slow(ray: &TreeRay, bounds: &Aabb) -> Option<f64> {
        let half = bounds.half_extents() + ray.half_extents;
        entry(ray.origin - bounds.center(), ray.direction, half)
    }

    /// Against brute force, on every level of instructions: nothing is lost, and the levels agree to the bit.
    #[test]
    fn no_box_on_the_way_is_lost() {
        let mut rng = rng(71);
        let (mut hits, mut cases) = (0, 0);
        for case in 0..600 {
            let size = 10f64.powi(rng.random_range(-60..60));
            let away = if case % 3 == 0 { 0.0 } else { 10f64.powi(rng.random_range(0..9)) };
            let boxes: Vec<Aabb> = random_boxes(&mut rng, 300, 0.02)
                .iter()
                .map(|b| Aabb::new((b.min + away) * size, (b.max + away) * size))
                .collect();
            let tree = Tree::build(&boxes);
            let far = 10f64.powi(rng.random_range(-1..12));
            let mut target = point(&mut rng, 1.0);
            let mut from = target + point(&mut rng, 1.0).normalize() * far;
            if case % 4 == 0 {
                // Along an axis.
                from = target + DVec3::AXES[case / 4 % 3] * far;
            }
            let mut half = if case % 2 == 0 { DVec3::ZERO } else { point(&mut rng, 0.3).abs() };
            if case % 10 == 7 {
                // A box beside which the tree is nothing, and that passes over it with any part of it.
                let huge = 10f64.powi(rng.random_range(1..100));
                half *= huge;
                from = target + (from - target) / far * huge;
                target += half * point(&mut rng, 0.9);
            }
            let ray = TreeRay {
                origin: (from + away) * size,
                direction: (target - from) * size * 10f64.powi(rng.random_range(-3..3)),
                half_extents: half * size,
            };
            let until = if case % 5 == 0 { 0.9 * size * far / ray.direction.length() } else { f64::INFINITY };
            let mut answers = Vec::new();
            for level in simd::levels() {
                let probe = Probe::new(&tree, &ray);
                let (mut traversal, mut found) = (Traversal::default(), Vec::new());
                if let Some(probe) = &probe {
                    let visit = &mut Plain(|leaf: &[u32], _: &mut f64| found.extend_from_slice(leaf));
                    let until = &mut until.clone();
                    dispatch!(level, simd => tree.walk_along(simd, probe, until, &mut traversal, visit));
                }
                answers.push((found, traversal.counters));
            }
            assert!(answers.iter().all(|answer| *answer == answers[0]));
            let (found, _) = &answers[0];
            let expected = |b: &Aabb| slow(&ray, b).is_some_and(|t| t <= until);
            for (i, bounds) in boxes.iter().enumerate().filter(|(_, b)| expected(b)) {
                assert!(found.contains(&(i as u32)), "case {case}: {bounds:?} {ray:?}");
            }
            cases += 1;
            hits += usize::from(boxes.iter().any(expected));
        }
        println!("{hits} of {cases} hit");
        assert!((0.3..=0.9).contains(&(hits as f64 / cases as f64)));
    }

    #[test]
    fn what_is_behind_the_limit_is_not_visited() {
        let mut rng = rng(72);
        let boxes = random_boxes(&mut rng, 20_000, 0.04);
        let tree = Tree::build(&boxes);
        let (mut all, mut first) = (Traversal::default(), Traversal::default());
        for _ in 0..200 {
            let target = point(&mut rng, 0.5);
            let origin = target + point(&mut rng, 1.0).normalize() * 10.0;
            let ray = TreeRay { origin, direction: target - origin, half_extents: DVec3::ZERO };
            tree.along(&ray, &mut f64::INFINITY.clone(), &mut all, |_, _| {});
            let mut until = f64::INFINITY;
            tree.along(&ray, &mut until, &mut first, |leaf, until| {
                let hits = leaf.iter().filter_map(|&i| slow(&ray, &boxes[i as usize]));
                *until = hits.fold(*until, f64::min);
            });
            let expected = boxes.iter().filter_map(|b| slow(&ray, b)).fold(f64::INFINITY, f64::min);
            assert_eq!(until, expected);
        }
        let (all, first) = (all.counters, first.counters);
        assert!(2 * first.leaf_visits < all.leaf_visits, "{first:?} {all:?}");
    }
}
