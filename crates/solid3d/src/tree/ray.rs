//! The leaves along a ray, nearest first.

use fearless_simd::Simd;
use glam::DVec3;
use solid_convex::simd::{self, Level, dispatch};

use super::insertion::push_unless_far;
use super::lanes::bits;
use super::node::Kind;
use super::ray_probe::{ROUNDING_F64, RayProbe, Space, entry};
use super::{Leaf, Place, Traversal, Tree};
use crate::Aabb;

/// What is done with the leaves along a ray, in vectors of the level of instructions that the walk runs on.
pub(crate) trait RayLeaves {
    /// Asks for the memory of a leaf that the walk may come to, given where it begins in the order of the tree.
    #[inline(always)]
    fn prefetch(&self, _start: usize) {}

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

/// Room for the entries of most rays, so that memory is asked for once.
const STACK: usize = 64;

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
        let space = Space { origin: self.normal.origin, inverse: self.normal.inverse, scale: 1.0 };
        if let Some(probe) = RayProbe::new(&space, ray) {
            dispatch!(level, simd => self.walk_along(simd, &probe, until, traversal, visitor));
        }
    }

    #[inline(always)]
    fn walk_along<S: Simd>(
        &self,
        simd: S,
        probe: &RayProbe,
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
                    let (hits, enters) = probe.entries(simd, [&node.min, &node.max], left);
                    let entry = |lane: usize| (enters[lane], (node.child[lane], Place::lane(index, lane)));
                    if hits.is_power_of_two() {
                        only = Some(entry(hits.trailing_zeros() as usize));
                        continue;
                    }
                    let from = stack.len();
                    for lane in bits(hits) {
                        let next = entry(lane);
                        self.prefetch(
                            node.child[lane],
                            #[inline(always)]
                            |start| visitor.prefetch(start),
                        );
                        push_unless_far(next, f32::INFINITY, stack, from);
                    }
                }
            }
        }
    }
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
                let (mut traversal, mut found) = (Traversal::default(), Vec::new());
                let visit = &mut Plain(|leaf: &[u32], _: &mut f64| found.extend_from_slice(leaf));
                tree.along_on(level, &ray, &mut until.clone(), &mut traversal, visit);
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
