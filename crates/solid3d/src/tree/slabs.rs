//! Slabs: how flat the surface under each lane of a tree is, for bounds on distances.
//!
//! A box around a patch of surface that lies aslant is nearly as thick as it is wide, so boxes tell distances badly: of two
//! tori of 100,000 triangles, 8,080 pairs of leaves seem nearer than their distance. The patch itself is thinner by far:
//! it lies between two parallel planes, across its mean normal. With bounds that know of these ([`facing`](super::facing)), 318 pairs
//! remain.
//!
//! Swept spheres serve the same end (Larsen, Gottschalk, Lin and Manocha, *Fast proximity queries with swept
//! sphere volumes*, 1999); they are tight all around, but take three times the memory beside the boxes that are here anyway.

use glam::DVec3;

use super::Tree;
use super::node::{Kind, Node, WIDTH};

/// A subtree of more primitives has no slab: a surface is seldom flat so far.
const PRIMITIVES_MAX: usize = 512;

/// The slab of each lane of a tree, found from the points of its primitives.
#[derive(Clone, Debug)]
pub(crate) struct Slabs {
    /// One for each node.
    pub(super) eights: Vec<Eight>,
}

/// The slabs of the lanes of a node, in tree coordinates.
#[derive(Clone, Debug)]
#[repr(C, align(32))]
pub(super) struct Eight {
    /// Unit vectors, rounded; zero where there is no slab.
    pub normal: [[f32; WIDTH]; 3],
    /// Along the normal, from the centre of the lane's box.
    pub middle: [f32; WIDTH],
    pub half: [f32; WIDTH],
}

impl Eight {
    const NONE: Eight = Eight { normal: [[0.0; WIDTH]; 3], middle: [0.0; WIDTH], half: [0.0; WIDTH] };
}

impl Slabs {
    /// For a tree over primitives that are hulls of vertices. Cost: `O(n)`.
    pub fn new<'p>(tree: &Tree, vertices: &[DVec3], points_of: impl Fn(u32) -> &'p [u32]) -> Slabs {
        let place = |index: u32| (vertices[index as usize] - tree.normal.origin) * tree.normal.inverse;
        let mut eights = vec![Eight::NONE; tree.nodes.len()];
        // Of each node, the primitives below it, which are a range of the order, and the sum of their normals.
        let mut below = vec![(0..0, DVec3::ZERO); tree.nodes.len()];
        for index in (0..tree.nodes.len()).rev() {
            let node = &tree.nodes[index];
            let (mut start, mut end, mut sum) = (usize::MAX, 0, DVec3::ZERO);
            for lane in 0..WIDTH {
                let (range, normal) = match node.child[lane].kind() {
                    Kind::Empty => break,
                    Kind::Inner(child) => below[child].clone(),
                    Kind::Leaf(range) => {
                        let normals =
                            tree.order[range.clone()].iter().map(|&primitive| match *points_of(primitive) {
                                [i, j, k, ..] => (place(j) - place(i)).cross(place(k) - place(i)),
                                _ => DVec3::ZERO,
                            });
                        let sum = normals.sum();
                        (range, sum)
                    }
                };
                (start, end) = (start.min(range.start), end.max(range.end));
                sum += normal;
                if range.len() <= PRIMITIVES_MAX {
                    let points = tree.order[range].iter().flat_map(|&primitive| points_of(primitive));
                    eights[index].set(lane, normal, node, points.map(|&point| place(point)));
                }
            }
            below[index] = (start..end, sum);
        }
        Slabs { eights }
    }

    /// The memory that the slabs own, in bytes.
    pub fn bytes(&self) -> usize {
        self.eights.capacity() * size_of::<Eight>()
    }
}

impl Eight {
    /// Takes in the slab across a direction around some points.
    fn set(&mut self, lane: usize, across: DVec3, node: &Node, points: impl Iterator<Item = DVec3>) {
        let Some(normal) = across.try_normalize() else { return };
        let normal = normal.to_array().map(|x| x as f32);
        let exact = DVec3::from_array(normal.map(f64::from));
        let center = DVec3::from_array(
            [0, 1, 2].map(|axis| f64::from(center(node.min[axis][lane], node.max[axis][lane]))),
        );
        let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        for point in points {
            let height = exact.dot(point - center);
            (least, greatest) = (least.min(height), greatest.max(height));
        }
        let middle = (0.5 * (least + greatest)) as f32;
        let half = (greatest - f64::from(middle)).max(f64::from(middle) - least);
        for (row, x) in self.normal.iter_mut().zip(normal) {
            row[lane] = x;
        }
        self.middle[lane] = middle;
        // Rounded up, beyond what `f64` made of the heights: points lie within 1.
        self.half[lane] = (half * (1.0 + f64::from(f32::EPSILON)) + 1e-14) as f32;
    }
}

/// The middle of a box along an axis, as slabs and what reads them compute it.
pub(super) fn center(min: f32, max: f32) -> f32 {
    0.5 * (min + max)
}
