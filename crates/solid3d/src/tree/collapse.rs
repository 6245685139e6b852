//! From a binary tree to nodes of eight lanes.
//!
//! Which sets of a binary tree become nodes, and which are taken apart in the lanes of a node above, decides how many nodes a query visits:
//! each whose box it meets. So the sum of the measures of all nodes is made the least that the binary tree allows. It is found from the
//! leaves up: for each set, the least sum in it where it may take one lane, two, and so on, from those of its halves. (Ylitie, Karras and
//! Laine, *Efficient incoherent ray traversal on GPUs through compressed wide BVHs*, 2017, section 3.1.)

#[cfg(feature = "rayon")]
use rayon::prelude::*;

use super::Place;
#[cfg(feature = "rayon")]
use super::build::MANY;
use super::cost::measure;
use super::node::{Child, LEAF_SIZE, Node, WIDTH};
use super::packed::PackedBox;
use super::split::Set;

/// What a node costs beside its measure, so that of nothing, as of many points in one place, there are few nodes, too. Far below the measure of any
/// node of a million triangles; that of a tree is 1 and more.
const NODE_COST: f32 = 1.0 / 65536.0;

/// Primitives of a leaf, or fewer than most have: for how much room is made.
const LEAF_USUAL: usize = 6;

/// The least sums of costs of nodes in a set that takes up to 1, 2, ... lanes of a node above.
type Costs = [f32; WIDTH - 1];

/// A set of a binary tree.
#[derive(Clone, Copy, Debug)]
struct Branch {
    bounds: PackedBox,
    start: u32,
    len: u32,
    /// The first of its halves, which the second follows; 0 for a leaf, and where they stand apart.
    below: u32,
    costs: Costs,
}

/// A binary tree, cut until sets are leaves.
#[derive(Debug)]
pub(super) struct Binary {
    /// The root first, each before its halves. One that was cut in two that stand apart is alone.
    branches: Vec<Branch>,
    apart: Option<Box<[Binary; 2]>>,
}

/// A set of a binary tree, where it stands.
#[derive(Clone, Copy)]
struct At<'t> {
    tree: &'t Binary,
    index: usize,
}

impl Branch {
    fn new(set: &Set) -> Self {
        Branch {
            bounds: set.bounds,
            start: set.start as u32,
            len: set.len as u32,
            below: 0,
            costs: [0.0; WIDTH - 1],
        }
    }

    fn is_leaf(&self) -> bool {
        self.len as usize <= LEAF_SIZE
    }

    /// The costs of a set that is cut into halves of these costs.
    #[inline(always)]
    fn cost_by(&mut self, halves: [&Costs; 2]) {
        self.costs[0] = measure(&self.bounds) + NODE_COST + least(halves, WIDTH).0;
        for lanes in 2..WIDTH {
            self.costs[lanes - 1] = least(halves, lanes).0.min(self.costs[lanes - 2]);
        }
    }
}

/// The least sum of costs of two sets that take so many lanes together, and how many the first takes.
#[inline(always)]
fn least([first, second]: [&Costs; 2], lanes: usize) -> (f32, usize) {
    let mut best = (f32::INFINITY, 0);
    for of_first in 1..lanes {
        let sum = first[of_first - 1] + second[lanes - of_first - 1];
        best = if sum < best.0 { (sum, of_first) } else { best };
    }
    best
}

impl Binary {
    /// Cuts a set until all are leaves: `halve` cuts one in two, so deep below the first.
    #[inline(always)]
    pub fn cut<P: Copy>(
        root: P,
        set_of: impl Fn(&P) -> Set,
        mut halve: impl FnMut(&P, u32) -> [P; 2],
    ) -> Self {
        let set = set_of(&root);
        let mut branches = Vec::with_capacity(2 * set.len / LEAF_USUAL);
        branches.push(Branch::new(&set));
        let mut tasks = vec![(0, root, 0)];
        while let Some((index, part, depth)) = tasks.pop() {
            if !branches[index].is_leaf() {
                let below = branches.len();
                branches[index].below = below as u32;
                let halves = halve(&part, depth);
                branches.extend([Branch::new(&set_of(&halves[0])), Branch::new(&set_of(&halves[1]))]);
                tasks.extend([(below + 1, halves[1], depth + 1), (below, halves[0], depth + 1)]);
            }
        }
        for index in (0..branches.len()).rev() {
            let below = branches[index].below as usize;
            if below != 0 {
                let [first, second] = [branches[below].costs, branches[below + 1].costs];
                branches[index].cost_by([&first, &second]);
            }
        }
        Binary { branches, apart: None }
    }

    /// That of a set, from those of its halves.
    pub fn join(set: &Set, halves: [Binary; 2]) -> Self {
        let mut branch = Branch::new(set);
        branch.cost_by([&halves[0].branches[0].costs, &halves[1].branches[0].costs]);
        Binary { branches: vec![branch], apart: Some(Box::new(halves)) }
    }

    /// The nodes of the tree, depth first, each after its parent.
    pub fn nodes(&self) -> Vec<Node> {
        At { tree: self, index: 0 }.nodes()
    }
}

impl<'t> At<'t> {
    fn branch(self) -> &'t Branch {
        &self.tree.branches[self.index]
    }

    fn below(self) -> Option<[At<'t>; 2]> {
        let At { tree, .. } = self;
        match (self.branch().below as usize, &tree.apart) {
            (0, None) => None,
            (0, Some(halves)) => Some([0, 1].map(|k| At { tree: &halves[k], index: 0 })),
            (first, _) => Some([first, first + 1].map(|index| At { tree, index })),
        }
    }

    /// The sets that are the lanes of a node of this one, in order.
    fn lanes(self) -> Lanes<'t> {
        let mut lanes = Lanes { sets: [self; WIDTH], len: 0 };
        match self.below() {
            Some(halves) => lanes.push_halves(halves, WIDTH),
            None => lanes.push(self, 1),
        }
        lanes
    }

    /// The nodes of this set, depth first.
    fn nodes(self) -> Vec<Node> {
        #[cfg(feature = "rayon")]
        if crate::threads::share(self.branch().len as usize, MANY) {
            return self.nodes_of_lanes();
        }
        let mut nodes: Vec<Node> = Vec::new();
        let mut tasks = vec![(self, Place::ROOT)];
        while let Some((set, place)) = tasks.pop() {
            let index = nodes.len();
            if let Some((parent, lane)) = place.split() {
                nodes[parent].child[lane] = Child::inner(index);
            }
            let lanes = set.lanes();
            nodes.push(lanes.node());
            for (lane, set) in
                lanes.sets().iter().enumerate().rev().filter(|(_, set)| !set.branch().is_leaf())
            {
                tasks.push((*set, Place::lane(index, lane)));
            }
        }
        nodes
    }

    /// The same, with what is below each lane found on a thread of its own.
    #[cfg(feature = "rayon")]
    fn nodes_of_lanes(self) -> Vec<Node> {
        let lanes = self.lanes();
        let below = |set: &At| if set.branch().is_leaf() { Vec::new() } else { set.nodes() };
        let subtrees: Vec<Vec<Node>> = lanes.sets().par_iter().map(below).collect();
        let mut nodes = Vec::with_capacity(1 + subtrees.iter().map(Vec::len).sum::<usize>());
        nodes.push(lanes.node());
        for (lane, subtree) in subtrees.into_iter().enumerate().filter(|(_, nodes)| !nodes.is_empty()) {
            let first = nodes.len();
            nodes[0].child[lane] = Child::inner(first);
            nodes.extend(subtree.into_iter().map(|mut node| {
                node.child = node.child.map(|child| child.after(first));
                node
            }));
        }
        nodes
    }
}

/// The lanes of a node.
struct Lanes<'t> {
    sets: [At<'t>; WIDTH],
    len: usize,
}

impl<'t> Lanes<'t> {
    fn sets(&self) -> &[At<'t>] {
        &self.sets[..self.len]
    }

    /// Adds a set in up to so many lanes, by the least cost; in as few as have that.
    fn push(&mut self, set: At<'t>, lanes: usize) {
        let costs = &set.branch().costs[..lanes];
        let lanes = costs.iter().position(|cost| *cost <= costs[lanes - 1]).map_or(lanes, |k| k + 1);
        match set.below() {
            Some(halves) if lanes > 1 => self.push_halves(halves, lanes),
            _ => {
                self.sets[self.len] = set;
                self.len += 1;
            }
        }
    }

    fn push_halves(&mut self, [first, second]: [At<'t>; 2], lanes: usize) {
        let (_, of_first) = least([first, second].map(|set| &set.branch().costs), lanes);
        self.push(first, of_first);
        self.push(second, lanes - of_first);
    }

    /// The node, with its leaves.
    fn node(&self) -> Node {
        let mut node = Node::EMPTY;
        for (lane, set) in self.sets().iter().enumerate() {
            let Branch { bounds, start, len, .. } = *set.branch();
            node.set_lane(lane, &bounds);
            if set.branch().is_leaf() {
                node.child[lane] = Child::leaf(start as usize..(start + len) as usize);
            }
        }
        node
    }
}

#[cfg(test)]
mod tests {
    use rand::Rng;

    use super::*;
    use crate::tree::tests::scenes::rng;

    /// What the nodes cost of which the sets are kept whose bits are set, of those that are cut, counted from the root; `None` if one has more
    /// lanes than there are.
    fn cost(tree: &Binary, kept: u32) -> Option<f32> {
        let cut: Vec<usize> = (0..tree.branches.len()).filter(|&i| tree.branches[i].below != 0).collect();
        let is_kept = |index: usize| cut.iter().position(|&i| i == index).is_some_and(|k| kept >> k & 1 != 0);
        let mut sum = 0.0;
        for &node in cut.iter().filter(|&&index| is_kept(index)) {
            let (mut lanes, mut open) = (0, vec![node]);
            while let Some(index) = open.pop() {
                let below = tree.branches[index].below as usize;
                if below != 0 && (index == node || !is_kept(index)) {
                    open.extend([below, below + 1]);
                } else {
                    lanes += 1;
                }
            }
            if lanes > WIDTH {
                return None;
            }
            sum += measure(&tree.branches[node].bounds) + NODE_COST;
        }
        Some(sum)
    }

    /// Law: no other choice of nodes from the same binary tree costs less; the slow twin looks at all.
    #[test]
    fn no_other_nodes_cost_less() {
        let mut fewer = 0;
        for case in 0..200 {
            let mut rng = rng(case);
            let count = rng.random_range(2..=14);
            let size = if case % 10 == 0 { 0.0 } else { 0.2 };
            let leaves: Vec<(PackedBox, usize)> = (0..count)
                .map(|_| {
                    let mut side = |of: f32| rng.random_range(-of..=of);
                    let [x, y, z] = [side(1.0 - size), side(1.0 - size), side(1.0 - size)];
                    let [u, v, w] = [side(size).abs(), side(size).abs(), side(size).abs()];
                    (PackedBox([x, y, z, 0.0, -x - u, -y - v, -z - w, 0.0]), rng.random_range(5..=LEAF_SIZE))
                })
                .collect();
            let set_of = |&(first, end): &(usize, usize)| {
                let mut bounds = PackedBox::EMPTY;
                leaves[first..end].iter().for_each(|leaf| bounds.grow(&leaf.0));
                let len = |leaves: &[(PackedBox, usize)]| leaves.iter().map(|leaf| leaf.1).sum::<usize>();
                let mut set = Set::of_bounds(bounds, len(&leaves[first..end]));
                set.start = len(&leaves[..first]);
                set
            };
            let tree = Binary::cut((0, count), set_of, |&(first, end), _| {
                let middle = rng.random_range(first + 1..end);
                [(first, middle), (middle, end)]
            });
            let nodes = tree.nodes();
            let found: f32 = nodes.iter().map(|node| measure(&node.union()) + NODE_COST).sum();
            // The root is always kept.
            let all = (0..1 << (count - 2)).filter_map(|others| cost(&tree, others << 1 | 1));
            let least = all.fold(f32::INFINITY, f32::min);
            assert!((found - least).abs() <= 1e-5 * least, "{case}: {found}, not {least}");
            let in_leaves = nodes
                .iter()
                .flat_map(|node| node.child)
                .filter(|child| child.is_leaf() && *child != Child::EMPTY);
            assert_eq!(in_leaves.count(), count, "{case}");
            fewer += usize::from(nodes.len() < count - 1);
        }
        assert!(fewer > 150, "{fewer} of 200: not representative");
    }
}
