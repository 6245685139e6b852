//! The leaves of the tree by a bound, least first.

use super::DynamicTree;
use super::fat_box::FatBox;
use super::node::Kind;
use super::status::Status;
use super::tree::ROOT;
use crate::bounds::Aabb;
use crate::broad::{Proxy, matters};
use glam::DVec3;

impl DynamicTree {
    /// See [`BroadPhase::for_each_nearest`](crate::broad::BroadPhase::for_each_nearest).
    pub(super) fn visit_nearest(
        &self,
        bound: &dyn Fn(&Aabb) -> f64,
        mut until: f64,
        visit: &mut dyn FnMut(Proxy) -> f64,
    ) {
        self.visit_queued(bound, &mut until, visit);
        let mut stack = vec![(f64::NEG_INFINITY, Kind::Node(ROOT))];
        while let Some((least, kind)) = stack.pop() {
            if least > until {
                continue;
            }
            match kind {
                Kind::Leaf(proxy) => self.visit_leaf(proxy, bound, &mut until, visit),
                Kind::Node(index) => {
                    let node = &self.tree.nodes[index as usize];
                    let from = stack.len();
                    let lanes = (0..node.count()).map(|lane| {
                        (bound(&self.origin.world(&unclamped(&node.lane_box(lane)))), node.child(lane))
                    });
                    stack.extend(lanes.filter(|(least, _)| matters(*least, until)));
                    stack[from..].sort_by(|(x, _), (y, _)| y.total_cmp(x));
                }
            }
        }
    }

    /// Visits what waits for the next flush: it is not in the tree, or not where it is.
    pub(super) fn visit_queued(
        &self,
        bound: &dyn Fn(&Aabb) -> f64,
        until: &mut f64,
        visit: &mut dyn FnMut(Proxy) -> f64,
    ) {
        for &proxy in &self.notes.queue {
            if self.is_alive(proxy) && matters(bound(&self.tight.get(proxy)), *until) {
                *until = visit(proxy);
            }
        }
    }

    /// Visits what is in the tree, where it is.
    #[inline(always)]
    pub(super) fn visit_leaf(
        &self,
        proxy: Proxy,
        bound: impl Fn(&Aabb) -> f64,
        until: &mut f64,
        visit: &mut dyn FnMut(Proxy) -> f64,
    ) {
        let here = self.is_alive(proxy) && !self.status[proxy as usize].is(Status::QUEUED);
        if here && matters(bound(&self.tight.get(proxy)), *until) {
            *until = visit(proxy);
        }
    }
}

/// The box, with sides that clamping to the range of `f32` moved inward put far beyond.
fn unclamped(b: &FatBox) -> Aabb {
    let min = b.min.map(|x| if x == -f32::MAX { -f64::MAX } else { x.into() });
    let max = b.max.map(|x| if x == f32::MAX { f64::MAX } else { x.into() });
    Aabb::new(DVec3::from_array(min), DVec3::from_array(max))
}
