//! A dynamic 8-wide bounding-volume tree of fattened boxes.
//!
//! Each tight `f64` box lies in a fat `f32` box with room for some frames of motion. While it stays inside, a move costs
//! one comparison. A box that has left gets a new fat box, is placed anew in the tree, and its overlaps with other fat
//! boxes are found again. The pairs of fat boxes are kept; the pairs shown are those whose tight boxes overlap too, which is
//! decided again for the pairs of the boxes that moved. (Deciding it for all pairs whenever they are visited took most of
//! the frame where little moves: 0.75 instead of 0.35 ms for 100,000 boxes of which 1 % move. To keep of each pair how far all
//! boxes together must come before it has to be decided again took twice the frame where all move: what has to be known of the
//! moves, and the branches that nobody can foretell, cost more than the comparisons that they spare.)
//!
//! When more than one in [`REBUILD_AT_ONE_IN`] boxes leave in one frame, the whole tree is built anew, and all pairs of fat boxes are
//! found anew by the tree against itself, node by node along the curve that it was built along: that is cheaper than to place boxes
//! one by one, each of which goes down from the root. Either path gives the same pairs. (A million boxes: 0.3 s at first, where a
//! search for each box took 0.85 s.)
//!
//! With the feature `rayon`, where there is much to do, boxes that are told many at a time, the pass over all pairs, the search for the
//! pairs of boxes that were placed anew and all of a rebuild are shared among threads; pairs that were found are linked by one of them while
//! the others seek the next.
//!
//! What is done for everything that moves is free of branches and reads memory in order, or many places at a time: while all move
//! and stay inside, a frame of 10,000 boxes takes 71 us, where the same work with branches took 240 us.

mod along;
mod build;
mod codes;
mod fat_box;
mod nearest;
mod node;
mod notes;
mod origin;
mod search;
mod self_pairs;
mod slots;
mod status;
mod told;
mod tree;

use super::boxes::Boxes;
use super::pair_lists::PairLists;
use super::room::{resize_on_threads, room};
use super::{
    BoundsOf, BroadPhase, Counters, PROXY_MAX, PairChange, PairId, Proxy, assert_valid, bounds_of_one,
};
use crate::bounds::Aabb;
use crate::threads::{between, both, in_pool};
use crate::tree::TreeRay;
use crate::working::Working;
use build::Builder;
use fat_box::FatBox;
use notes::Notes;
use origin::Origin;
use search::{Found, Search};
use slots::Slots;
use status::Status;
use told::Told;
use tree::{DEPTH_MAX, Tree};

/// Everything is built anew when more than one in this many boxes leave their fat boxes in one frame.
/// Measured: 10, 5 and 3 give means within 10 % of one another where all boxes move.
const REBUILD_AT_ONE_IN: usize = 10;

/// Fewer boxes than this are placed one by one whatever their share: a small tree is changed faster than built.
const REBUILD_MIN: usize = 32;

/// Pairs of so many boxes, while the tree is built anew, are worth another thread.
const REBUILD_MANY: usize = 1 << 12;

/// Where more than one in this many boxes moved, one pass over all pairs is cheaper than a walk along their lists.
const REFRESH_ALL_AT_ONE_IN: usize = 4;

/// Broad phase by a dynamic wide tree of fattened boxes; the default.
///
/// ```
/// use solid3d::broad::{BroadPhase, DynamicTree};
/// use solid3d::{Aabb, glam::DVec3};
/// let mut broad = DynamicTree::default();
/// for i in 0..100 {
///     let corner = DVec3::new(f64::from(i), 0.0, 0.0);
///     broad.insert(i, Aabb::new(corner, corner + 0.75));
/// }
/// broad.flush();
/// assert!(broad.sorted_pairs().is_empty());
/// broad.update(0, Aabb::new(DVec3::new(50.8, 0.0, 0.0), DVec3::new(51.2, 1.0, 1.0)));
/// broad.flush();
/// assert_eq!(broad.sorted_pairs(), [(0, 51)]); // the fat boxes of 50 and 0 overlap, the boxes do not
/// ```
#[derive(Clone, Debug, Default)]
pub struct DynamicTree {
    /// By proxy: the current box where the proxy is in use.
    tight: Boxes,
    /// By proxy: contains `FatBox::around(tight)`, from the origin. The box in the tree, unless queued.
    fat: Vec<FatBox>,
    origin: Origin,
    status: Vec<Status>,
    tree: Tree,
    /// The pairs of fat boxes in the tree that overlap, exactly, except of queued proxies until the next flush.
    pairs: PairLists,
    /// What became of the boxes since the last flush.
    notes: Notes,
    alive: usize,
    /// Changes of the tree since it was last built.
    changes: usize,
    counters: Counters,
    builder: Working<Builder>,
    search: Working<Search>,
}

impl DynamicTree {
    fn is_alive(&self, proxy: Proxy) -> bool {
        self.status.get(proxy as usize).is_some_and(|s| s.is(Status::ALIVE))
    }

    /// More queued boxes than this are not placed one by one.
    fn queue_max(&self) -> usize {
        REBUILD_MIN.max(self.alive / REBUILD_AT_ONE_IN)
    }

    /// All boxes, and what is noted of them.
    fn slots(&mut self) -> (Slots<'_>, &mut Notes) {
        let Self { tight, fat, origin, status, notes, .. } = self;
        (Slots { first: 0, origin, tight: tight.rows_mut(), fat, status }, notes)
    }

    /// Where more boxes than this moved, one pass over all pairs is cheaper than a walk along their lists.
    fn moved_max(&self) -> usize {
        self.alive / REFRESH_ALL_AT_ONE_IN
    }

    /// Makes room for proxies below `proxies`.
    fn grow(&mut self, proxies: usize) {
        if proxies > self.tight.len() {
            self.tight.grow(proxies);
            resize_on_threads(&mut self.fat, proxies, FatBox::EMPTY);
            resize_on_threads(&mut self.status, proxies, Status::default());
            self.tree.grow(proxies);
            self.pairs.grow(proxies);
        }
    }

    /// Adds many boxes.
    fn add_many(&mut self, boxes: &[(Proxy, Aabb)]) {
        // Of proxies that ascend this is the greatest; for others room is made as they come.
        let last = boxes.iter().map(|(proxy, _)| *proxy).rfind(|&proxy| proxy <= PROXY_MAX);
        self.grow(last.map_or(0, |last| last as usize + 1));
        let queued = self.notes.queue.len() + boxes.len();
        room(&mut self.notes.queue, queued);
        let mut rest = boxes;
        // Ends, because there are fewer boxes each time.
        while !rest.is_empty() {
            let (taken, refused) = self.tell_many(Told::New(rest));
            self.alive += taken;
            let Some(refused) = refused else { return };
            let (proxy, bounds) = rest[refused];
            self.insert(proxy, bounds);
            rest = &rest[refused + 1..];
        }
    }

    /// Adds or moves many boxes; how many were, and which one is refused, if one is.
    fn tell_many(&mut self, told: Told) -> (usize, Option<usize>) {
        let moved_max = self.moved_max();
        let (slots, notes) = self.slots();
        in_pool(told.is_worth_entering(), || slots.many(told, notes, moved_max))
    }

    #[cold]
    fn refuse_insert(&self, proxy: Proxy, bounds: &Aabb) -> ! {
        assert_valid(proxy, bounds);
        panic!("proxy {proxy} is already in use");
    }

    #[cold]
    fn refuse_update(&self, proxy: Proxy, bounds: &Aabb) -> ! {
        assert!(self.is_alive(proxy), "proxy {proxy} is not in use");
        assert_valid(proxy, bounds);
        unreachable!("such a box of such a proxy is not refused")
    }

    /// Gives back memory for more boxes, and for building anew. The first tree is of all boxes, and is the only one where few leave
    /// their fat boxes at a time; where it is not, it is not worth while, since it is needed again.
    fn trim(&mut self) {
        self.tight.trim();
        self.fat.shrink_to_fit();
        self.status.shrink_to_fit();
        self.tree.nodes.shrink_to_fit();
        self.tree.places.shrink_to_fit();
        self.pairs.trim();
        self.notes.trim();
        self.builder = Working::default();
        self.search = Working::default();
    }

    /// Moves the origin to where the boxes are, if they are far from it, and gives all of them fat boxes from there.
    fn settle_origin(&mut self) {
        let Self { tight, fat, origin, status, .. } = self;
        if origin.approach(self.alive, living(status), |proxy| tight.get(proxy)) {
            for proxy in living(status) {
                let local = origin.local(&tight.get(proxy));
                fat[proxy as usize] = FatBox::with_room(proxy, &local, &local);
            }
        }
    }

    /// Builds the tree anew from all living boxes, and meanwhile forgets the pairs that do not overlap.
    fn rebuild(&mut self) {
        self.settle_origin();
        let Self { status, fat, tree, pairs, builder, .. } = self;
        for s in status.iter_mut() {
            s.set(Status::IN_TREE, s.is(Status::ALIVE));
        }
        let build = || builder.build(tree, living(status), fat);
        both(fat.len() >= REBUILD_MANY, build, || pairs.forget_apart());
        self.changes = 0;
        self.counters.rebuilds += 1;
    }

    /// Decides again which tight boxes overlap, among the pairs of boxes that moved.
    fn refresh_moved(&mut self, shared: bool) {
        let Self { tight, pairs, notes, .. } = self;
        if notes.all_moved {
            pairs.refresh_all(tight, shared);
        } else {
            for &proxy in &notes.moved {
                pairs.refresh_of(proxy, |partner| tight.overlap(proxy, partner));
            }
            // Then what became of them is told in the order in which a pass over all tells it.
            pairs.sort_touched();
        }
        pairs.settle(|_| true);
    }

    /// Takes out the pairs of the queued boxes whose fat boxes are apart now.
    fn part_queued(&mut self) {
        let Self { fat, pairs, notes, .. } = self;
        for &proxy in &notes.queue {
            let b = fat[proxy as usize];
            pairs.retain_of(proxy, |partner| fat[partner as usize].overlaps(&b));
        }
    }

    /// Places the queued boxes in the tree, one by one; false if the tree is no longer as it should be.
    fn place_queued(&mut self) -> bool {
        let mut too_deep = false;
        for &proxy in &self.notes.queue {
            let fat = self.fat[proxy as usize];
            let is_new = self.status[proxy as usize].put(Status::IN_TREE);
            if !is_new && self.tree.leaf_box(proxy).overlaps(&fat) {
                // It drifts: it may hang where it hung.
                self.tree.set_box(proxy, &fat);
            } else {
                if !is_new {
                    self.tree.remove(proxy);
                }
                too_deep |= self.tree.insert(proxy, &fat) > DEPTH_MAX;
            }
        }
        self.changes += self.notes.queue.len();
        self.counters.reinsertions += self.notes.queue.len() as u64;
        !too_deep && self.changes <= self.alive.max(REBUILD_MIN)
    }

    /// Finds the pairs of the queued boxes that are not there yet, box by box.
    fn pair_queued(&mut self) {
        let Self { tight, fat, status, tree, pairs, notes, search, .. } = self;
        let is_queued = |proxy| status[proxy as usize].is(Status::QUEUED);
        self.counters.node_visits += search.seek_of(tree, tight, fat, &notes.queue, is_queued, pairs);
        for &Found { proxies: [a, b], overlaps } in search.found() {
            pairs.insert(a, b, overlaps);
        }
        pairs.settle(|_| true);
    }

    /// Finds all pairs anew, in a tree that was just built: nodes that follow one another are near one another, and so are the pairs
    /// that are found in them.
    fn pair_all(&mut self) {
        let Self { tight, tree, pairs, search, .. } = self;
        let none_known = pairs.is_empty();
        self.counters.node_visits +=
            search.run(tree, tight, |&Found { proxies: [a, b], overlaps }, later| {
                later.into_iter().flat_map(|later| later.proxies).for_each(|proxy| pairs.prefetch(proxy));
                // Those that do not overlap are not known any more.
                if none_known || !overlaps {
                    pairs.insert(a, b, overlaps);
                } else {
                    pairs.insert_new(a, b, overlaps);
                }
            });
        pairs.settle(|_| true);
        pairs.give_back();
    }

    /// Takes those that were removed out of the queue.
    fn drop_removed(&mut self) {
        if !std::mem::take(&mut self.notes.queued_removed) {
            return;
        }
        let status = &mut self.status;
        self.notes.queue.retain(|&proxy| {
            let status = &mut status[proxy as usize];
            status.set(Status::QUEUED, status.is(Status::ALIVE));
            status.is(Status::ALIVE)
        });
    }

    /// Whether what a flush has to do is worth entering the pool of threads.
    fn is_worth_entering(&self) -> bool {
        /// Of so many boxes the tree is built anew, or all pairs are looked at.
        const BUILT_MANY: usize = 1 << 13;
        const LOOKED_AT_MANY: usize = 1 << 16;
        let builds = self.notes.queue.len() > self.queue_max();
        let many = if builds { BUILT_MANY } else { LOOKED_AT_MANY };
        (builds || self.notes.all_moved) && self.alive >= many
    }

    /// Does what a [`flush`](BroadPhase::flush) has to do where something changed.
    fn bring_up_to_date(&mut self) {
        let rebuilds = self.counters.rebuilds;
        let shared = std::mem::take(&mut self.notes.shared);
        self.refresh_moved(shared);
        self.drop_removed();
        if !self.notes.queue.is_empty() {
            self.admit_queued(shared);
        }
        for proxy in self.notes.queue.drain(..) {
            self.status[proxy as usize].set(Status::QUEUED, false);
        }
        if self.counters.rebuilds > rebuilds && rebuilds == 0 {
            self.trim();
        }
        if std::mem::take(&mut self.notes.all_moved) {
            self.status.iter_mut().for_each(|status| status.set(Status::MOVED, false));
        } else {
            for &proxy in &self.notes.moved {
                self.status[proxy as usize].set(Status::MOVED, false);
            }
        }
        self.notes.moved.clear();
    }

    /// Brings the tree and the pairs of fat boxes up to date.
    fn admit_queued(&mut self, shared: bool) {
        let few = self.notes.queue.len() <= self.queue_max();
        if !few || !between(shared, || self.admit_few()) {
            self.rebuild();
            self.pair_all();
        }
    }

    /// The same box by box; false, and only begun, if the tree is no longer as it should be.
    fn admit_few(&mut self) -> bool {
        // Boxes that are near one another find the same nodes, and those are then at hand. Since the tree was built, its nodes are
        // about in the order of space.
        let tree = &self.tree;
        self.notes.queue.sort_unstable_by_key(|&proxy| (tree.place(proxy), proxy));
        self.part_queued();
        let placed = self.place_queued();
        if placed {
            self.pair_queued();
        }
        placed
    }
}

/// The proxies in use.
fn living(status: &[Status]) -> impl Iterator<Item = Proxy> {
    (0..).zip(status).filter_map(|(proxy, status)| status.is(Status::ALIVE).then_some(proxy))
}

impl BroadPhase for DynamicTree {
    fn boxed_clone(&self) -> Box<dyn BroadPhase> {
        Box::new(self.clone())
    }

    fn insert(&mut self, proxy: Proxy, bounds: Aabb) {
        assert_valid(proxy, &bounds);
        self.grow(proxy as usize + 1);
        let (mut slots, notes) = self.slots();
        if !slots.insert(proxy, &bounds, notes) {
            self.refuse_insert(proxy, &bounds);
        }
        self.alive += 1;
    }

    #[inline]
    fn update(&mut self, proxy: Proxy, bounds: Aabb) {
        let moved_max = self.moved_max();
        let (mut slots, notes) = self.slots();
        if !slots.update(proxy, &bounds, notes, moved_max) {
            self.refuse_update(proxy, &bounds);
        }
    }

    fn insert_many(&mut self, boxes: &[(Proxy, Aabb)]) {
        // Making room is shared too.
        in_pool(Told::New(boxes).is_worth_entering(), || self.add_many(boxes));
    }

    fn update_many(&mut self, boxes: &[(Proxy, Aabb)]) {
        if let (_, Some(refused)) = self.tell_many(Told::Moved(boxes)) {
            let (proxy, bounds) = boxes[refused];
            self.refuse_update(proxy, &bounds);
        }
    }

    fn update_with(&mut self, proxies: &[Proxy], bounds: &BoundsOf) {
        if let (_, Some(refused)) = self.tell_many(Told::MovedTo(proxies, bounds)) {
            let proxy = proxies[refused];
            self.refuse_update(proxy, &bounds_of_one(proxy, bounds));
        }
    }

    fn remove(&mut self, proxy: Proxy) {
        assert!(self.is_alive(proxy), "proxy {proxy} is not in use");
        let status = &mut self.status[proxy as usize];
        status.set(Status::ALIVE, false);
        let is_queued = status.is(Status::QUEUED);
        self.fat[proxy as usize] = FatBox::EMPTY;
        if status.is(Status::IN_TREE) {
            status.set(Status::IN_TREE, false);
            self.tree.remove(proxy);
            self.pairs.remove_all_of(proxy, |_| {});
            self.changes += 1;
        }
        self.alive -= 1;
        self.notes.changed = true;
        self.notes.queued_removed |= is_queued;
    }

    fn flush(&mut self) {
        self.pairs.begin();
        if std::mem::take(&mut self.notes.changed) {
            in_pool(self.is_worth_entering(), || self.bring_up_to_date());
        }
    }

    fn for_each_pair(&self, visit: &mut dyn FnMut(Proxy, Proxy)) {
        assert!(!self.notes.changed, "boxes changed since the last flush");
        self.pairs.for_each(|_, [a, b]| visit(a, b));
    }

    fn for_each_partner(&self, proxy: Proxy, visit: &mut dyn FnMut(Proxy)) {
        assert!(!self.notes.changed, "boxes changed since the last flush");
        self.pairs.for_each_overlap_of(proxy, |_, partner| visit(partner));
    }

    fn changes(&self) -> &[PairChange] {
        self.pairs.changes()
    }

    fn for_each_pair_of(&self, proxy: Proxy, visit: &mut dyn FnMut(PairId, Proxy)) {
        self.pairs.for_each_shown_of(proxy, visit);
    }

    fn pair(&self, a: Proxy, b: Proxy) -> Option<PairId> {
        self.pairs.find_shown(a, b)
    }

    fn bounds(&self, proxy: Proxy) -> Aabb {
        self.tight.get(proxy)
    }

    fn for_each_nearest(
        &self,
        bound: &dyn Fn(&Aabb) -> f64,
        until: f64,
        visit: &mut dyn FnMut(Proxy) -> f64,
    ) {
        self.visit_nearest(bound, until, visit);
    }

    fn for_each_along(&self, ray: &TreeRay, until: f64, visit: &mut dyn FnMut(Proxy) -> f64) {
        self.visit_along(ray, until, visit);
    }

    fn for_each_in(&self, region: &Aabb, visit: &mut dyn FnMut(Proxy)) {
        self.visit_in(region, visit);
    }

    fn counters(&self) -> Counters {
        self.counters
    }

    fn validate(&self) {
        self.pairs.validate();
        let count = |what| self.status.iter().filter(|s| s.is(what)).count();
        assert_eq!(self.tree.validate(), count(Status::IN_TREE));
        assert_eq!(count(Status::ALIVE), self.alive);
        assert_eq!(count(Status::QUEUED), self.notes.queue.len());
        assert!(self.notes.all_moved || count(Status::MOVED) == self.notes.moved.len());
        for (proxy, status) in (0..).zip(&self.status) {
            assert!(status.is(Status::ALIVE) || !status.is(Status::IN_TREE));
            if status.is(Status::ALIVE) {
                let fat = self.fat[proxy as usize];
                let around = FatBox::around(&self.origin.local(&self.tight.get(proxy)));
                assert_eq!(fat.union(&around), fat);
                let in_place = || status.is(Status::IN_TREE) && self.tree.leaf_box(proxy) == fat;
                assert!(status.is(Status::QUEUED) || in_place());
            }
        }
        self.pairs.for_each_known(|[a, b], overlaps| {
            assert!(
                self.notes.changed || overlaps == self.tight.overlap(a, b),
                "pair ({a}, {b}): {overlaps}"
            );
            let (s, t) = (self.status[a as usize], self.status[b as usize]);
            assert!(
                s.is(Status::IN_TREE) && t.is(Status::IN_TREE),
                "pair ({a}, {b}) of a box that is not there"
            );
            assert!(
                s.is(Status::QUEUED)
                    || t.is(Status::QUEUED)
                    || self.fat[a as usize].overlaps(&self.fat[b as usize]),
                "the fat boxes of pair ({a}, {b}) are apart"
            );
        });
    }
}
