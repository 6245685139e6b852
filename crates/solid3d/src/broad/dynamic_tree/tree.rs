//! The tree of boxes: insert, move, remove, query.
//!
//! Insertion goes down into the child whose box grows least, and splits a leaf lane of a full node. That is the
//! simplest rule that keeps boxes small; it does not balance. Degradation is bounded from outside: the engine builds
//! the tree anew after as many changes as there are leaves, so the build's cost is shared among them, and at once when
//! an insertion ends deeper than [`DEPTH_MAX`].

use fearless_simd::Simd;
use solid_convex::simd::dispatch;

use super::fat_box::FatBox;
use super::node::{Child, Kind, Node, Place, PlaceCell, WIDTH};
use crate::broad::Proxy;
use crate::broad::room::{push, room};
use crate::tree::bits;

/// No node stays deeper than this after a flush; recursion and stacks are bounded by it.
pub(super) const DEPTH_MAX: usize = 64;

/// The root is node 0, always there, perhaps without children.
pub(super) const ROOT: u32 = 0;

/// A tree over boxes named by proxies. Every lane's box is exactly the union of the boxes below it.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    pub nodes: Vec<Node>,
    /// Nodes not in use.
    pub free: Vec<u32>,
    /// By proxy: where its leaf hangs.
    pub places: Vec<PlaceCell>,
}

impl Default for Tree {
    fn default() -> Self {
        Tree { nodes: vec![Node::empty(Place::NONE)], free: Vec::new(), places: Vec::new() }
    }
}

impl Tree {
    /// Makes room for proxies below `proxies`.
    pub fn grow(&mut self, proxies: usize) {
        room(&mut self.places, proxies);
        self.places.resize_with(proxies, || PlaceCell::new(Place::NONE));
    }

    /// Where a leaf hangs.
    pub fn place(&self, proxy: Proxy) -> Place {
        self.places[proxy as usize].get()
    }

    /// Adds a leaf; gives its depth.
    pub fn insert(&mut self, proxy: Proxy, b: &FatBox) -> usize {
        let mut at = ROOT;
        // Ends, because each step goes down.
        for depth in 1.. {
            let node = &mut self.nodes[at as usize];
            if node.count() == 0 {
                return self.attach(at, proxy, b, depth);
            }
            let lane = node.cheapest_lane(b);
            match node.child(lane) {
                Kind::Node(below) => {
                    let grown = node.lane_box(lane).union(b);
                    node.set_box(lane, &grown);
                    at = below;
                }
                Kind::Leaf(_) if node.count() < WIDTH => return self.attach(at, proxy, b, depth),
                Kind::Leaf(sibling) => {
                    let sibling_box = node.lane_box(lane);
                    let below = self.allocate(Place::new(at, lane));
                    let node = &mut self.nodes[at as usize];
                    node.set_child(lane, Child::node(below));
                    node.set_box(lane, &sibling_box.union(b));
                    self.attach(below, sibling, &sibling_box, depth + 1);
                    return self.attach(below, proxy, b, depth + 1);
                }
            }
        }
        unreachable!("the loop above has no end but its returns")
    }

    fn attach(&mut self, node: u32, proxy: Proxy, b: &FatBox, depth: usize) -> usize {
        let lane = self.nodes[node as usize].push(Child::leaf(proxy), b);
        self.places[proxy as usize].set(Place::new(node, lane));
        depth
    }

    fn allocate(&mut self, parent: Place) -> u32 {
        match self.free.pop() {
            Some(index) => {
                self.nodes[index as usize] = Node::empty(parent);
                index
            }
            None => {
                push(&mut self.nodes, Node::empty(parent));
                self.nodes.len() as u32 - 1
            }
        }
    }

    /// Takes a leaf out.
    pub fn remove(&mut self, proxy: Proxy) {
        let mut place = self.place(proxy);
        self.places[proxy as usize].set(Place::NONE);
        // Ends at the root, which has no place.
        loop {
            let (at, lane) = (place.node(), place.lane());
            let node = &mut self.nodes[at as usize];
            node.swap_remove(lane);
            if lane < node.count() {
                match node.child(lane) {
                    Kind::Leaf(moved) => self.places[moved as usize].set(place),
                    Kind::Node(moved) => self.nodes[moved as usize].parent = place,
                }
            } else if node.count() == 0 && at != ROOT {
                place = node.parent;
                self.free.push(at);
                continue;
            }
            return self.refit_above(at);
        }
    }

    /// Gives a leaf another box where it hangs.
    pub fn set_box(&mut self, proxy: Proxy, b: &FatBox) {
        let place = self.place(proxy);
        self.nodes[place.node() as usize].set_box(place.lane(), b);
        self.refit_above(place.node());
    }

    pub fn leaf_box(&self, proxy: Proxy) -> FatBox {
        let place = self.place(proxy);
        self.nodes[place.node() as usize].lane_box(place.lane())
    }

    /// Makes the boxes above a node the unions of what is below them again, as far as something changes.
    fn refit_above(&mut self, mut at: u32) {
        while at != ROOT {
            let node = &self.nodes[at as usize];
            let (parent, bounds) = (node.parent, node.bounds());
            at = parent.node();
            let node = &mut self.nodes[at as usize];
            if node.lane_box(parent.lane()) == bounds {
                return;
            }
            node.set_box(parent.lane(), &bounds);
        }
    }

    /// Visits the leaves whose boxes overlap `b`; gives the number of nodes visited. `stack` is scratch.
    pub fn query(&self, b: &FatBox, stack: &mut Vec<u32>, mut visit: impl FnMut(Proxy)) -> u64 {
        dispatch!(simd => self.query_with(simd, b, stack, &mut visit))
    }

    #[inline(always)]
    fn query_with<S: Simd>(
        &self,
        simd: S,
        b: &FatBox,
        stack: &mut Vec<u32>,
        visit: &mut impl FnMut(Proxy),
    ) -> u64 {
        let mut visits = 0;
        stack.clear();
        stack.push(ROOT);
        while let Some(at) = stack.pop() {
            visits += 1;
            let node = &self.nodes[at as usize];
            for lane in bits(node.overlap_mask(simd, b)) {
                match node.child(lane) {
                    Kind::Node(below) => stack.push(below),
                    Kind::Leaf(proxy) => visit(proxy),
                }
            }
        }
        visits
    }

    /// Checks boxes, links and depth; gives the number of leaves.
    pub fn validate(&self) -> usize {
        let (mut leaves, mut seen) = (0, 0);
        let mut stack = vec![(ROOT, 1)];
        assert_eq!(self.nodes[ROOT as usize].parent, Place::NONE);
        while let Some((at, depth)) = stack.pop() {
            seen += 1;
            assert!(depth <= DEPTH_MAX, "depth {depth}");
            let node = &self.nodes[at as usize];
            assert!(at == ROOT || node.count() > 0, "an empty node");
            for lane in 0..node.count() {
                let place = Place::new(at, lane);
                match node.child(lane) {
                    Kind::Leaf(proxy) => {
                        assert_eq!(self.place(proxy), place);
                        leaves += 1;
                    }
                    Kind::Node(below) => {
                        assert_eq!(self.nodes[below as usize].parent, place);
                        assert_eq!(self.nodes[below as usize].bounds(), node.lane_box(lane));
                        stack.push((below, depth + 1));
                    }
                }
            }
        }
        assert_eq!(seen + self.free.len(), self.nodes.len(), "a node is lost");
        leaves
    }
}
