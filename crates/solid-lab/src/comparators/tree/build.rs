use super::{Triangle, Volume};

/// A binary tree of bounding volumes with one triangle in each leaf. Space: that of its triangles.
#[derive(Clone, Debug)]
pub struct Tree<V> {
    pub(super) nodes: Vec<Node<V>>,
    pub(super) triangles: Vec<Triangle>,
}

/// A volume and what it bounds.
#[derive(Clone, Debug)]
pub struct Node<V> {
    /// Around everything below.
    pub volume: V,
    /// What is below.
    pub child: Child,
}

/// What a node has below it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Child {
    /// A triangle.
    Leaf(u32),
    /// Two nodes, at this index and the next; they lie behind their parent.
    Inner(u32),
}

impl<V: Volume> Tree<V> {
    /// The memory of the nodes and the triangles.
    pub fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + size_of_val(self.triangles.as_slice())
    }

    /// Splits from the top until each set has one triangle (thesis, section 5.2.4).
    ///
    /// # Panics
    /// When there are no triangles.
    pub fn build(triangles: Vec<Triangle>, options: V::Options) -> Self {
        assert!(!triangles.is_empty(), "a tree has at least one triangle");
        let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
        let mut nodes = Vec::with_capacity(2 * triangles.len() - 1);
        nodes.push(Node { volume: V::fit(&triangles, &order, options), child: Child::Leaf(0) });
        // A node and its part of the order.
        let mut open = vec![(0, 0..order.len())];
        while let Some((node, range)) = open.pop() {
            let members = &mut order[range.clone()];
            if let [triangle] = members {
                nodes[node].child = Child::Leaf(*triangle);
                continue;
            }
            let (axis, coordinate) = nodes[node].volume.split(&triangles, members);
            let middle = range.start
                + partition(members, |i| twice_midpoint(&triangles[i as usize], axis) <= 2.0 * coordinate);
            let first = nodes.len();
            nodes[node].child = Child::Inner(first as u32);
            for part in [range.start..middle, middle..range.end] {
                let volume = V::fit(&triangles, &order[part.clone()], options);
                open.push((nodes.len(), part));
                nodes.push(Node { volume, child: Child::Leaf(0) });
            }
        }
        // Backwards, so that each parent is still as it was fitted.
        for i in (0..nodes.len()).rev() {
            if let Child::Inner(first) = nodes[i].child {
                for j in [first as usize, first as usize + 1] {
                    nodes[j].volume = nodes[j].volume.within(&nodes[i].volume);
                }
            }
        }
        Tree { nodes, triangles }
    }
}

impl<V> Tree<V> {
    /// The triangles, as they were given.
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }
}

/// Twice the midpoint of the projection: the thesis's way to put a triangle on one side of a plane.
fn twice_midpoint(triangle: &Triangle, axis: solid3d::glam::DVec3) -> f64 {
    let [x, y, z] = triangle.map(|p| p.dot(axis));
    x.min(y).min(z) + x.max(y).max(z)
}

/// Moves those that belong below to the front and says how many; half when all are on one side.
fn partition(members: &mut [u32], mut below: impl FnMut(u32) -> bool) -> usize {
    let mut count = 0;
    for i in 0..members.len() {
        if below(members[i]) {
            members.swap(i, count);
            count += 1;
        }
    }
    if count == 0 || count == members.len() { members.len() / 2 } else { count }
}
