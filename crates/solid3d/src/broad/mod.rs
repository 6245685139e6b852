//! The broad phase: which of many moving boxes overlap?
//!
//! It knows boxes and the integers that name them; it knows no shapes, no objects and no world. Two engines stand
//! behind one trait and give exactly the same pairs:
//!
//! * [`DynamicTree`], the default: an 8-wide bounding-volume tree over fattened `f32` boxes. Its cost follows the
//!   number of boxes that *leave* their fat box in a frame.
//! * [`SweepAndPrune`]: the incremental sweep and prune of the thesis (section 5.2.2). Its cost follows the number of
//!   endpoints that change places.
//!
//! The laws, each tested against brute force in `tests.rs`:
//!
//! 1. After [`flush`](BroadPhase::flush) the pairs are exactly those whose current `f64` boxes share a point; boxes
//!    that touch count. No fattening and no rounding shows.
//! 2. Every pair is given once, the smaller proxy first.
//! 3. The same calls give the same pairs in the same order and the same [`Counters`].

mod bits;
mod boxes;
mod dynamic_tree;
mod pair_ids;
mod pair_lists;
pub(crate) mod room;
mod sweep_and_prune;
#[cfg(test)]
mod tests;

pub use dynamic_tree::DynamicTree;
pub use sweep_and_prune::SweepAndPrune;

use crate::bounds::Aabb;
use crate::tree::{TreeRay, entry};

/// Names a box in a broad phase: dense small integers chosen by the caller (slots, reused after removal).
///
/// Memory is proportional to the greatest proxy ever used. At most [`PROXY_MAX`].
pub type Proxy = u32;

/// Writes the boxes of some proxies beside them: some at a time, so that what it prepares serves several.
pub type BoundsOf<'a> = dyn Fn(&mut [(Proxy, Aabb)]) + Sync + 'a;

/// So many boxes that are asked for are worth another thread.
pub(crate) const ASKED_MANY: usize = 1 << 12;

/// The box of a proxy alone.
fn bounds_of_one(proxy: Proxy, bounds: &BoundsOf) -> Aabb {
    let mut one = [(proxy, Aabb::EMPTY)];
    bounds(&mut one);
    one[0].1
}

/// The greatest proxy: both engines keep one bit of the word for themselves, and the tree three more for its lanes.
pub const PROXY_MAX: Proxy = (1 << 28) - 1;

/// Names a pair whose boxes overlap, in one broad phase: a dense small integer, the same from the flush that shows that the
/// boxes overlap to the one that shows that they no longer do. It may name another pair after that, or after one of
/// its boxes was removed.
pub type PairId = u32;

/// A pair whose boxes came to overlap, or ceased to, from one flush to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PairChange {
    /// The pair.
    pub pair: PairId,
    /// Its boxes, the smaller proxy first.
    pub proxies: [Proxy; 2],
    /// Whether they overlap now.
    pub overlaps: bool,
}

/// Finds all pairs of boxes that overlap among moving boxes.
///
/// ```
/// use solid3d::broad::{BroadPhase, BroadPhaseKind};
/// use solid3d::{Aabb, glam::DVec3};
/// let unit_at = |x: f64| Aabb::new(DVec3::new(x, 0.0, 0.0), DVec3::new(x + 1.0, 1.0, 1.0));
/// for kind in [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune] {
///     let mut broad = kind.build();
///     broad.insert(0, unit_at(0.0));
///     broad.insert(1, unit_at(1.0)); // touches box 0
///     broad.insert(2, unit_at(5.0));
///     broad.flush();
///     assert_eq!(broad.sorted_pairs(), [(0, 1)]);
///     broad.update(1, unit_at(4.5));
///     broad.flush();
///     assert_eq!(broad.sorted_pairs(), [(1, 2)]);
/// }
/// ```
pub trait BroadPhase: Send + Sync + std::fmt::Debug {
    /// A copy, which does from here on what this one does when it is told the same. Cost: linear in the boxes and pairs.
    ///
    /// ```
    /// use solid3d::broad::{BroadPhase, DynamicTree};
    /// use solid3d::{Aabb, glam::DVec3};
    /// let mut broad = DynamicTree::default();
    /// broad.insert_many(&[0, 1].map(|proxy| (proxy, Aabb::new(DVec3::ZERO, DVec3::ONE))));
    /// broad.flush();
    /// let before = broad.boxed_clone();
    /// broad.remove(1);
    /// broad.flush();
    /// assert_eq!((broad.sorted_pairs(), before.sorted_pairs()), (vec![], vec![(0, 1)]));
    /// ```
    fn boxed_clone(&self) -> Box<dyn BroadPhase>;

    /// Adds a box. Shown in the pairs from the next [`flush`](Self::flush) on.
    ///
    /// # Panics
    /// If the proxy is in use or above [`PROXY_MAX`], or if the box is empty or not finite.
    fn insert(&mut self, proxy: Proxy, bounds: Aabb);

    /// Moves a box.
    ///
    /// # Panics
    /// If the proxy is not in use, or if the box is empty or not finite.
    fn update(&mut self, proxy: Proxy, bounds: Aabb);

    /// Adds many boxes; the same as to add them one by one, in this order. With the feature `rayon`, and if their proxies ascend, on the
    /// threads of the current pool.
    ///
    /// ```
    /// use solid3d::broad::{BroadPhase, DynamicTree};
    /// use solid3d::{Aabb, glam::DVec3};
    /// let unit_at = |x: f64| Aabb::new(DVec3::splat(x), DVec3::splat(x + 1.0));
    /// let mut broad = DynamicTree::default();
    /// broad.insert_many(&[(0, unit_at(0.0)), (1, unit_at(0.5)), (2, unit_at(5.0))]);
    /// broad.flush();
    /// assert_eq!(broad.sorted_pairs(), [(0, 1)]);
    /// broad.update_many(&[(0, unit_at(4.5)), (1, unit_at(0.6))]);
    /// broad.flush();
    /// assert_eq!(broad.sorted_pairs(), [(0, 2)]);
    /// ```
    ///
    /// # Panics
    /// As [`insert`](Self::insert) for the first box that it would refuse; then any of the others were added.
    fn insert_many(&mut self, boxes: &[(Proxy, Aabb)]) {
        boxes.iter().for_each(|(proxy, bounds)| self.insert(*proxy, *bounds));
    }

    /// Moves many boxes; the same as to move them one by one, in this order. With the feature `rayon`, and if their proxies ascend, on the
    /// threads of the current pool.
    ///
    /// # Panics
    /// As [`update`](Self::update) for the first box that it would refuse; then any of the others were moved.
    fn update_many(&mut self, boxes: &[(Proxy, Aabb)]) {
        boxes.iter().for_each(|(proxy, bounds)| self.update(*proxy, *bounds));
    }

    /// Moves many boxes to where `bounds` says; the same as to move them one by one, in this order. With the feature `rayon`, and if their
    /// proxies ascend, on the threads of the current pool, which then also ask `bounds`.
    ///
    /// ```
    /// use solid3d::broad::{BroadPhase, DynamicTree};
    /// use solid3d::{Aabb, glam::DVec3};
    /// let unit_at = |x: f64| Aabb::new(DVec3::splat(x), DVec3::splat(x + 1.0));
    /// let mut broad = DynamicTree::default();
    /// broad.insert_many(&[(0, unit_at(0.0)), (1, unit_at(2.0)), (2, unit_at(4.0))]);
    /// broad.update_with(&[1, 2], &|boxes| {
    ///     boxes.iter_mut().for_each(|(proxy, bounds)| *bounds = unit_at(0.5 * f64::from(*proxy)));
    /// });
    /// broad.flush();
    /// assert_eq!(broad.sorted_pairs(), [(0, 1), (0, 2), (1, 2)]);
    /// ```
    ///
    /// # Panics
    /// As [`update_many`](Self::update_many).
    fn update_with(&mut self, proxies: &[Proxy], bounds: &BoundsOf) {
        proxies.iter().for_each(|&proxy| self.update(proxy, bounds_of_one(proxy, bounds)));
    }

    /// Takes a box out; its proxy may be used again at once.
    ///
    /// # Panics
    /// If the proxy is not in use.
    fn remove(&mut self, proxy: Proxy);

    /// Brings the pairs up to date with every insertion, move and removal before it. The cost follows what changed.
    fn flush(&mut self);

    /// Visits the pairs `(a, b)`, `a < b`, whose boxes overlap, each once. The order is unspecified, but the same
    /// for the same sequence of calls.
    ///
    /// # Panics
    /// If something changed since the last [`flush`](Self::flush): the pairs would be neither the old nor the new.
    fn for_each_pair(&self, visit: &mut dyn FnMut(Proxy, Proxy));

    /// Visits the proxies whose boxes overlap that of `proxy`, each once, in unspecified order. The cost follows their number.
    ///
    /// # Panics
    /// As [`for_each_pair`](Self::for_each_pair).
    fn for_each_partner(&self, proxy: Proxy, visit: &mut dyn FnMut(Proxy));

    /// What the last [`flush`](Self::flush) changed, in an order in which it can be replayed: a [`PairId`] that is used anew
    /// ends before it begins. Pairs of a box that was removed ended with it and are not told.
    ///
    /// ```
    /// use solid3d::broad::{BroadPhase, DynamicTree};
    /// use solid3d::{Aabb, glam::DVec3};
    /// let mut broad = DynamicTree::default();
    /// broad.insert(4, Aabb::new(DVec3::ZERO, DVec3::ONE));
    /// broad.insert(2, Aabb::new(DVec3::ZERO, DVec3::ONE));
    /// broad.flush();
    /// let change = broad.changes()[0];
    /// assert_eq!((change.proxies, change.overlaps), ([2, 4], true));
    /// broad.flush();
    /// assert!(broad.changes().is_empty());
    /// ```
    fn changes(&self) -> &[PairChange];

    /// Visits the pairs of a box that overlapped at the last [`flush`](Self::flush), except those with boxes removed since, and
    /// the other box of each. The cost follows their number.
    fn for_each_pair_of(&self, proxy: Proxy, visit: &mut dyn FnMut(PairId, Proxy));

    /// The pair of two boxes, if they overlapped at the last [`flush`](Self::flush). The cost follows the number of boxes near
    /// the one of the two that has fewer.
    fn pair(&self, a: Proxy, b: Proxy) -> Option<PairId>;

    /// The box of a proxy in use.
    ///
    /// # Panics
    /// If the proxy is above every one ever used.
    fn bounds(&self, proxy: Proxy) -> Aabb;

    /// Visits the proxies whose box has a `bound` of at most `until`, about in the order of their bounds; each visit gives the new
    /// `until`. Boxes that were added or moved since the last [`flush`](Self::flush) may be missing; all others are not, nor are
    /// they visited twice.
    ///
    /// `bound` must not be less for a box than for one that contains it; infinity is for boxes that do not matter.
    ///
    /// ```
    /// use solid3d::broad::{BroadPhase, BroadPhaseKind};
    /// use solid3d::{Aabb, glam::DVec3};
    /// for kind in [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune] {
    ///     let mut broad = kind.build();
    ///     for i in 0..10 {
    ///         let corner = DVec3::splat(f64::from(i));
    ///         broad.insert(i, Aabb::new(corner, corner + 0.5));
    ///     }
    ///     broad.flush();
    ///     let region = Aabb::new(DVec3::splat(2.1), DVec3::splat(3.1));
    ///     let bound = |b: &Aabb| if b.overlaps(&region) { 0.0 } else { f64::INFINITY };
    ///     let mut found = Vec::new();
    ///     broad.for_each_nearest(&bound, 0.0, &mut |proxy| {
    ///         found.push(proxy);
    ///         0.0
    ///     });
    ///     found.sort_unstable();
    ///     assert_eq!(found, [2, 3]);
    /// }
    /// ```
    fn for_each_nearest(&self, bound: &dyn Fn(&Aabb) -> f64, until: f64, visit: &mut dyn FnMut(Proxy) -> f64);

    /// Visits the proxies whose box a ray, or a box that moves along one, meets up to `until`, about in the order in which it does, and perhaps
    /// some that it passes by less than rounding errors; each visit gives the new `until`. Otherwise as [`for_each_nearest`](Self::for_each_nearest).
    ///
    /// ```
    /// use solid3d::broad::{BroadPhase, BroadPhaseKind};
    /// use solid3d::{Aabb, glam::DVec3, tree::TreeRay};
    /// for kind in [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune] {
    ///     let mut broad = kind.build();
    ///     for i in 0..10 {
    ///         let corner = DVec3::X * f64::from(i);
    ///         broad.insert(i, Aabb::new(corner, corner + 0.5));
    ///     }
    ///     broad.flush();
    ///     let ray = TreeRay { origin: DVec3::new(2.2, 3.0, 0.2), direction: DVec3::NEG_Y, half_extents: DVec3::ZERO };
    ///     let mut found = Vec::new();
    ///     broad.for_each_along(&ray, f64::INFINITY, &mut |proxy| {
    ///         found.push(proxy);
    ///         f64::INFINITY
    ///     });
    ///     assert_eq!(found, [2]);
    /// }
    /// ```
    fn for_each_along(&self, ray: &TreeRay, until: f64, visit: &mut dyn FnMut(Proxy) -> f64) {
        self.for_each_nearest(&bound_along(ray), until, visit);
    }

    /// Visits the proxies whose box shares a point with a region, in any order. Otherwise as [`for_each_nearest`](Self::for_each_nearest).
    ///
    /// ```
    /// use solid3d::broad::{BroadPhase, BroadPhaseKind};
    /// use solid3d::{Aabb, glam::DVec3};
    /// let mut broad = BroadPhaseKind::default().build();
    /// for i in 0..10 {
    ///     let corner = DVec3::splat(f64::from(i));
    ///     broad.insert(i, Aabb::new(corner, corner + 0.5));
    /// }
    /// broad.flush();
    /// let mut found = Vec::new();
    /// broad.for_each_in(&Aabb::new(DVec3::splat(2.1), DVec3::splat(3.1)), &mut |proxy| found.push(proxy));
    /// found.sort_unstable();
    /// assert_eq!(found, [2, 3]);
    /// ```
    fn for_each_in(&self, region: &Aabb, visit: &mut dyn FnMut(Proxy)) {
        self.for_each_nearest(&bound_in(region), 0.0, &mut |proxy| {
            visit(proxy);
            0.0
        });
    }

    /// The work done since the engine was made.
    fn counters(&self) -> Counters;

    /// Checks every invariant of the data structure, in time about linear in its size. For tests.
    ///
    /// # Panics
    /// If an invariant is broken, that is, if the engine has a bug.
    fn validate(&self);

    /// The pairs in ascending order, in a new vector.
    fn sorted_pairs(&self) -> Vec<(Proxy, Proxy)> {
        let mut pairs = Vec::new();
        self.for_each_pair(&mut |a, b| pairs.push((a, b)));
        pairs.sort_unstable();
        pairs
    }
}

impl Clone for Box<dyn BroadPhase> {
    fn clone(&self) -> Self {
        (**self).boxed_clone()
    }
}

/// Work done by a broad phase since it was made. Counts, not times: they repeat exactly, so tests can hold them.
///
/// ```
/// use solid3d::broad::{BroadPhase, Counters, DynamicTree};
/// assert_eq!(DynamicTree::default().counters(), Counters::default());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Swaps of neighbouring endpoints (sweep and prune).
    pub swaps: u64,
    /// Batches sorted and swept at once (sweep and prune).
    pub sweeps: u64,
    /// Boxes that left their fat box and were placed anew, one by one (dynamic tree).
    pub reinsertions: u64,
    /// Nodes whose eight boxes were tested against one box (dynamic tree).
    pub node_visits: u64,
    /// Times the whole tree was built (dynamic tree).
    pub rebuilds: u64,
}

/// Chooses an engine.
///
/// ```
/// use solid3d::broad::BroadPhaseKind;
/// assert_eq!(BroadPhaseKind::default(), BroadPhaseKind::DynamicTree);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BroadPhaseKind {
    /// [`DynamicTree`]: the faster one in every scene measured here.
    #[default]
    DynamicTree,
    /// [`SweepAndPrune`]: the engine of the thesis.
    SweepAndPrune,
}

impl BroadPhaseKind {
    /// A new, empty engine of this kind.
    ///
    /// ```
    /// use solid3d::broad::BroadPhaseKind;
    /// let broad = BroadPhaseKind::SweepAndPrune.build();
    /// assert!(broad.sorted_pairs().is_empty());
    /// ```
    pub fn build(self) -> Box<dyn BroadPhase> {
        match self {
            BroadPhaseKind::DynamicTree => Box::new(DynamicTree::default()),
            BroadPhaseKind::SweepAndPrune => Box::new(SweepAndPrune::default()),
        }
    }
}

/// Beyond the rounding of when a ray comes into a box, relative to the coordinates of either.
const ROUNDING_ALONG: f64 = 1e-14;

/// When a ray, or a box that moves along one, comes into a box, or before; infinity where it does not.
pub(crate) fn bound_along(ray: &TreeRay) -> impl Fn(&Aabb) -> f64 {
    let far = ray.origin.abs().max_element();
    move |bounds| {
        let margin = ROUNDING_ALONG * (far + bounds.min.abs().max(bounds.max.abs()).max_element());
        let half = bounds.half_extents() + ray.half_extents + margin;
        entry(ray.origin - bounds.center(), ray.direction, half)
            .map_or(f64::INFINITY, |t| t * (1.0 - ROUNDING_ALONG))
    }
}

/// Zero for a box that shares a point with a region, else infinity.
fn bound_in(region: &Aabb) -> impl Fn(&Aabb) -> f64 {
    |bounds| if bounds.overlaps(region) { 0.0 } else { f64::INFINITY }
}

/// Whether a box of some bound is visited by [`BroadPhase::for_each_nearest`]; that of infinity never is, not even without end.
#[inline]
pub(crate) fn matters(bound: f64, until: f64) -> bool {
    bound <= until && bound < f64::INFINITY
}

/// The contract of [`BroadPhase::insert`] and [`BroadPhase::update`].
#[inline]
fn assert_valid(proxy: Proxy, bounds: &Aabb) {
    assert!(proxy <= PROXY_MAX, "proxy {proxy} is above PROXY_MAX = {PROXY_MAX}");
    assert!(is_valid(bounds), "the box of proxy {proxy} is empty or not finite: {bounds:?}");
}

/// Whether a box is of finite numbers and not empty.
#[inline]
fn is_valid(bounds: &Aabb) -> bool {
    let is_finite = |is, k| is & (bounds.min[k] >= -f64::MAX) & (bounds.max[k] <= f64::MAX);
    is_ordered(bounds) & (0..3).fold(true, is_finite)
}

/// Whether a box is of numbers and not empty. Without a branch: this is asked of every box that moves.
#[inline]
fn is_ordered(bounds: &Aabb) -> bool {
    // No comparison holds of what is not a number.
    (0..3).fold(true, |is, k| is & (bounds.min[k] <= bounds.max[k]))
}
