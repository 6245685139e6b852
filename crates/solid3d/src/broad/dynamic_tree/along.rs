//! The leaves of the tree along a ray, and in a box: eight boxes of a node at once.

use fearless_simd::Simd;
use solid_convex::simd::{dispatch, level, prefetch};
use solid_convex::unit_scale;

use super::DynamicTree;
use super::fat_box::FatBox;
use super::node::Kind;
use super::tree::ROOT;
use crate::bounds::Aabb;
use crate::broad::{Proxy, ROUNDING_ALONG, bound_along, bound_in};
use crate::tree::{RayProbe, Space, TreeRay, bits, push_unless_far};

/// Coordinates whose greatest is from this on, up to its inverse, are told by a [`RayProbe`].
const REACH_MIN: f64 = 1.0 / (1_u64 << 40) as f64;

/// Room for the nodes and leaves that most walks have ahead, so that memory is asked for once.
const STACK: usize = 64;

impl DynamicTree {
    /// See [`BroadPhase::for_each_along`](crate::broad::BroadPhase::for_each_along).
    pub(super) fn visit_along(&self, ray: &TreeRay, mut until: f64, visit: &mut dyn FnMut(Proxy) -> f64) {
        let bound = bound_along(ray);
        let Some(space) = self.space() else { return self.visit_nearest(&bound, until, visit) };
        self.visit_queued(&bound, &mut until, visit);
        // What is added to the boxes by `bound` is added to the ray here, as far as a probe does not.
        let far = ROUNDING_ALONG * ray.origin.abs().max_element();
        let ray = TreeRay { half_extents: ray.half_extents + far, ..*ray };
        if let Some(probe) = RayProbe::new(&space, &ray) {
            dispatch!(level(), simd => self.walk_along(simd, &probe, &bound, until, visit));
        }
    }

    #[inline(always)]
    fn walk_along<S: Simd>(
        &self,
        simd: S,
        probe: &RayProbe,
        bound: &impl Fn(&Aabb) -> f64,
        mut until: f64,
        visit: &mut dyn FnMut(Proxy) -> f64,
    ) {
        let left_of = |until: f64| probe.until(until * (1.0 + ROUNDING_ALONG));
        let (mut left, mut stack) = (left_of(until), Vec::with_capacity(STACK));
        stack.push((0.0, Kind::Node(ROOT)));
        while let Some((enter, kind)) = stack.pop() {
            if enter > left {
                continue;
            }
            match kind {
                Kind::Leaf(proxy) => {
                    self.visit_leaf(proxy, bound, &mut until, visit);
                    left = left_of(until);
                }
                Kind::Node(index) => {
                    let node = &self.tree.nodes[index as usize];
                    let (hits, enters) = probe.entries(simd, node.sides(), left);
                    let from = stack.len();
                    for lane in bits(hits) {
                        match node.child(lane) {
                            Kind::Leaf(proxy) => self.tight.prefetch(proxy),
                            Kind::Node(index) => prefetch(&self.tree.nodes[index as usize]),
                        }
                        push_unless_far((enters[lane], node.child(lane)), f32::INFINITY, &mut stack, from);
                    }
                }
            }
        }
    }

    /// The space of the fat boxes; none where their numbers are so great or small that products of them are no numbers of `f32`.
    fn space(&self) -> Option<Space> {
        let FatBox { min, max } = self.tree.nodes[ROOT as usize].bounds();
        let reach = (0..3).fold(0.0, |reach, k| max[k].max(-min[k]).max(reach));
        let scale = 2.0 / unit_scale(f64::from(reach));
        (REACH_MIN..=1.0 / REACH_MIN).contains(&scale).then(|| Space {
            origin: self.origin.point(),
            inverse: 1.0 / scale,
            scale,
        })
    }

    /// See [`BroadPhase::for_each_in`](crate::broad::BroadPhase::for_each_in).
    pub(super) fn visit_in(&self, region: &Aabb, visit: &mut dyn FnMut(Proxy)) {
        let overlaps = bound_in(region);
        let visit = &mut |proxy| {
            visit(proxy);
            0.0
        };
        self.visit_queued(&overlaps, &mut 0.0, visit);
        let fat = FatBox::around(&self.origin.local(region));
        dispatch!(level(), simd => self.walk_in(simd, &fat, &overlaps, visit));
    }

    #[inline(always)]
    fn walk_in<S: Simd>(
        &self,
        simd: S,
        region: &FatBox,
        overlaps: &impl Fn(&Aabb) -> f64,
        visit: &mut dyn FnMut(Proxy) -> f64,
    ) {
        let mut stack = Vec::with_capacity(STACK);
        stack.push(ROOT);
        while let Some(index) = stack.pop() {
            let node = &self.tree.nodes[index as usize];
            for lane in bits(node.overlap_mask(simd, region)) {
                match node.child(lane) {
                    Kind::Leaf(proxy) => self.visit_leaf(proxy, overlaps, &mut 0.0, visit),
                    Kind::Node(index) => stack.push(index),
                }
            }
        }
    }
}
