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
//! When more than one in [`REBUILD_AT_ONE_IN`] boxes leave in one frame, the whole tree is built anew: that is cheaper than to
//! place them one by one, and a tree that was just built answers faster. Either path gives the same pairs.

mod build;
mod fat_box;
mod nearest;
mod node;
mod tree;

use super::pair_lists::PairLists;
use super::room::{push, resize};
use super::{BroadPhase, Counters, PairChange, PairId, Proxy, assert_valid};
use crate::bounds::Aabb;
use build::Builder;
use fat_box::FatBox;
use tree::{DEPTH_MAX, Tree};

/// Everything is built anew when more than one in this many boxes leave their fat boxes in one frame.
/// Measured: 10, 5 and 3 give means within 10 % of one another where all boxes move.
const REBUILD_AT_ONE_IN: usize = 10;

/// Fewer boxes than this are placed one by one whatever their share: a small tree is changed faster than built.
const REBUILD_MIN: usize = 32;

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
#[derive(Debug, Default)]
pub struct DynamicTree {
    /// By proxy: the current box where the proxy is in use.
    tight: Vec<Aabb>,
    /// By proxy: contains `FatBox::around(tight)`. The box in the tree, unless queued.
    fat: Vec<FatBox>,
    status: Vec<Status>,
    tree: Tree,
    /// The pairs of fat boxes in the tree that overlap, exactly, except of queued proxies until the next flush.
    pairs: PairLists,
    /// By proxy: the last mark that `pair_queued` gave it, as a partner that a box has already.
    known: Vec<u32>,
    /// The last mark given; the first is 1.
    mark: u32,
    /// Proxies whose fat boxes are not in the tree as they are, each once; some may have been removed since.
    queue: Vec<Proxy>,
    /// Proxies whose tight boxes changed since the last flush, each once; some may have been removed since.
    moved: Vec<Proxy>,
    /// Whether a tight box changed, was added or removed since the last flush.
    dirty: bool,
    alive: usize,
    /// Changes of the tree since it was last built.
    changes: usize,
    counters: Counters,
    builder: Builder,
    stack: Vec<u32>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Status {
    alive: bool,
    /// Stands in the queue.
    queued: bool,
    /// Stands among the moved ones.
    moved: bool,
    /// Hangs in the tree.
    in_tree: bool,
}

impl DynamicTree {
    fn is_alive(&self, proxy: Proxy) -> bool {
        self.status.get(proxy as usize).is_some_and(|s| s.alive)
    }

    fn enqueue(&mut self, proxy: Proxy) {
        let status = &mut self.status[proxy as usize];
        if !std::mem::replace(&mut status.queued, true) {
            push(&mut self.queue, proxy);
        }
    }

    /// Builds the tree anew from all living boxes.
    fn rebuild(&mut self) {
        let Self { status, fat, tree, builder, .. } = self;
        for s in status.iter_mut() {
            s.in_tree = s.alive;
        }
        let living = (0..).zip(status.iter()).filter_map(|(proxy, s)| s.alive.then_some(proxy));
        builder.build(tree, living, fat);
        // Boxes that are near one another find the same nodes, and those are then at hand: where 100,000 boxes leave again and again,
        // this order has a third fewer cache misses than that of the queue, and takes a quarter less time.
        self.queue.clear();
        self.queue.extend(builder.leaves().filter(|&proxy| status[proxy as usize].queued));
        self.changes = 0;
        self.counters.rebuilds += 1;
    }

    /// Decides again which tight boxes overlap, among the pairs of boxes that moved.
    fn refresh_moved(&mut self) {
        let Self { tight, pairs, moved, .. } = self;
        if moved.len() * REFRESH_ALL_AT_ONE_IN > self.alive {
            pairs.refresh_all(|a, b| overlap(tight, a, b));
        } else {
            for &proxy in moved.iter() {
                pairs.refresh_of(proxy, |partner| overlap(tight, proxy, partner));
            }
        }
        pairs.settle(|_| true);
    }

    /// Takes out the pairs of the queued boxes whose fat boxes are apart now.
    fn part_queued(&mut self) {
        let Self { fat, pairs, queue, .. } = self;
        for &proxy in queue.iter() {
            let b = fat[proxy as usize];
            pairs.retain_of(proxy, |partner| fat[partner as usize].overlaps(&b));
        }
    }

    /// The same where many are queued: one pass over the pairs in place of walks along their lists.
    fn part_all(&mut self) {
        let Self { fat, pairs, .. } = self;
        pairs.retain(|a, b| fat[a as usize].overlaps(&fat[b as usize]));
    }

    /// Places the queued boxes in the tree, one by one.
    fn place_queued(&mut self) {
        let mut too_deep = false;
        for &proxy in &self.queue {
            let fat = self.fat[proxy as usize];
            let status = &mut self.status[proxy as usize];
            if status.in_tree && self.tree.leaf_box(proxy).overlaps(&fat) {
                // It drifts: it may hang where it hung.
                self.tree.set_box(proxy, &fat);
            } else {
                if status.in_tree {
                    self.tree.remove(proxy);
                }
                status.in_tree = true;
                too_deep |= self.tree.insert(proxy, &fat) > DEPTH_MAX;
            }
        }
        self.changes += self.queue.len();
        self.counters.reinsertions += self.queue.len() as u64;
        if too_deep || self.changes > self.alive.max(REBUILD_MIN) {
            self.rebuild();
        }
    }

    /// Finds the pairs of the queued boxes that are not there yet.
    fn pair_queued(&mut self) {
        let Self { tight, fat, tree, pairs, queue, known, mark, stack, .. } = self;
        for &proxy in queue.iter() {
            *mark = mark.checked_add(1).unwrap_or_else(|| {
                known.fill(0);
                1
            });
            // Of two queued boxes the one that comes first finds the pair; the other knows it then.
            pairs.for_each_partner_of(proxy, |partner| known[partner as usize] = *mark);
            known[proxy as usize] = *mark;
            self.counters.node_visits += tree.query(&fat[proxy as usize], stack, |other| {
                if known[other as usize] != *mark {
                    pairs.insert(proxy, other, overlap(tight, proxy, other));
                }
            });
        }
        pairs.settle(|_| true);
    }
}

fn overlap(tight: &[Aabb], a: Proxy, b: Proxy) -> bool {
    tight[a as usize].overlaps(&tight[b as usize])
}

impl BroadPhase for DynamicTree {
    fn insert(&mut self, proxy: Proxy, bounds: Aabb) {
        assert_valid(proxy, &bounds);
        let slot = proxy as usize;
        if slot >= self.tight.len() {
            resize(&mut self.tight, slot + 1, Aabb::EMPTY);
            resize(&mut self.fat, slot + 1, FatBox { min: [0.0; 3], max: [0.0; 3] });
            resize(&mut self.status, slot + 1, Status::default());
            self.tree.grow(slot + 1);
            self.pairs.grow(slot + 1);
            resize(&mut self.known, slot + 1, 0);
        }
        assert!(!self.status[slot].alive, "proxy {proxy} is already in use");
        self.status[slot].alive = true;
        self.tight[slot] = bounds;
        self.fat[slot] = FatBox::with_room(proxy, &bounds, &bounds);
        self.alive += 1;
        self.dirty = true;
        self.enqueue(proxy);
    }

    fn update(&mut self, proxy: Proxy, bounds: Aabb) {
        assert_valid(proxy, &bounds);
        assert!(self.is_alive(proxy), "proxy {proxy} is not in use");
        let was = std::mem::replace(&mut self.tight[proxy as usize], bounds);
        if was == bounds {
            return;
        }
        self.dirty = true;
        if !std::mem::replace(&mut self.status[proxy as usize].moved, true) {
            push(&mut self.moved, proxy);
        }
        if !self.fat[proxy as usize].contains(&bounds) {
            self.fat[proxy as usize] = FatBox::with_room(proxy, &was, &bounds);
            self.enqueue(proxy);
        }
    }

    fn remove(&mut self, proxy: Proxy) {
        assert!(self.is_alive(proxy), "proxy {proxy} is not in use");
        let status = &mut self.status[proxy as usize];
        status.alive = false;
        if std::mem::take(&mut status.in_tree) {
            self.tree.remove(proxy);
            self.pairs.remove_all_of(proxy, |_| {});
            self.changes += 1;
        }
        self.alive -= 1;
        self.dirty = true;
    }

    fn flush(&mut self) {
        self.pairs.begin();
        if !std::mem::take(&mut self.dirty) {
            return;
        }
        self.refresh_moved();
        let status = &mut self.status;
        self.queue.retain(|&proxy| {
            status[proxy as usize].queued = status[proxy as usize].alive;
            status[proxy as usize].alive
        });
        if !self.queue.is_empty() {
            if self.queue.len() > REBUILD_MIN.max(self.alive / REBUILD_AT_ONE_IN) {
                self.part_all();
                self.rebuild();
            } else {
                self.part_queued();
                self.place_queued();
            }
            self.pair_queued();
        }
        for proxy in self.queue.drain(..) {
            self.status[proxy as usize].queued = false;
        }
        for proxy in self.moved.drain(..) {
            self.status[proxy as usize].moved = false;
        }
    }

    fn for_each_pair(&self, visit: &mut dyn FnMut(Proxy, Proxy)) {
        assert!(!self.dirty, "boxes changed since the last flush");
        self.pairs.for_each(|_, [a, b]| visit(a, b));
    }

    fn for_each_partner(&self, proxy: Proxy, visit: &mut dyn FnMut(Proxy)) {
        assert!(!self.dirty, "boxes changed since the last flush");
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

    fn bounds(&self, proxy: Proxy) -> &Aabb {
        &self.tight[proxy as usize]
    }

    fn for_each_nearest(
        &self,
        bound: &dyn Fn(&Aabb) -> f64,
        until: f64,
        visit: &mut dyn FnMut(Proxy) -> f64,
    ) {
        self.visit_nearest(bound, until, visit);
    }

    fn counters(&self) -> Counters {
        self.counters
    }

    fn validate(&self) {
        self.pairs.validate();
        let in_tree = self.status.iter().filter(|s| s.in_tree).count();
        assert_eq!(self.tree.validate(), in_tree);
        assert_eq!(self.status.iter().filter(|s| s.alive).count(), self.alive);
        assert_eq!(self.status.iter().filter(|s| s.queued).count(), self.queue.len());
        for (proxy, status) in (0..).zip(&self.status) {
            assert!(status.alive || !status.in_tree);
            if status.alive {
                let fat = self.fat[proxy as usize];
                let around = FatBox::around(&self.tight[proxy as usize]);
                assert_eq!(fat.union(&around), fat);
                assert!(status.queued || status.in_tree && self.tree.leaf_box(proxy) == fat);
            }
        }
        self.pairs.for_each_known(|[a, b], overlaps| {
            assert!(self.dirty || overlaps == overlap(&self.tight, a, b), "pair ({a}, {b}): {overlaps}");
            let (s, t) = (self.status[a as usize], self.status[b as usize]);
            assert!(s.in_tree && t.in_tree, "pair ({a}, {b}) of a box that is not there");
            assert!(
                s.queued || t.queued || self.fat[a as usize].overlaps(&self.fat[b as usize]),
                "the fat boxes of pair ({a}, {b}) are apart"
            );
        });
    }
}
