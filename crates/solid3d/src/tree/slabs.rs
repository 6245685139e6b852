//! Slabs: how flat the surface under each lane of a tree is, for bounds on distances, and to part what only boxes hold together.
//!
//! A box around a patch of surface that lies aslant is nearly as thick as it is wide, so boxes tell distances badly: of two
//! tori of 100,000 triangles, 8,080 pairs of leaves seem nearer than their distance. The patch itself is thinner by far:
//! it lies between two parallel planes, across its mean normal. With bounds that know of these ([`facing`](super::facing)), 318 pairs
//! remain; of the pairs of leaves whose boxes overlap in an intersection, half ([`parting`](super::parting)).
//!
//! Swept spheres serve the same end (Larsen, Gottschalk, Lin and Manocha, *Fast proximity queries with swept
//! sphere volumes*, 1999); they are tight all around, but take three times the memory beside the boxes that are here anyway.

use std::ops::Range;

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4};
use glam::DVec3;
use solid_convex::simd::{dispatch, each};

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
        let place = |&index: &u32| (vertices[index as usize] - tree.normal.origin) * tree.normal.inverse;
        let points_of = |primitive: u32| points_of(primitive).iter().map(place);
        let mut eights = vec![Eight::NONE; tree.nodes.len()];
        Finder { tree, points_of, eights: &mut eights, points: Points::default() }.look_below(0);
        Slabs { eights }
    }

    /// The memory that the slabs own, in bytes.
    pub fn bytes(&self) -> usize {
        self.eights.capacity() * size_of::<Eight>()
    }
}

/// Goes through a tree, and places each point once.
struct Finder<'f, F> {
    tree: &'f Tree,
    /// The points of a primitive, in tree coordinates.
    points_of: F,
    eights: &'f mut [Eight],
    /// Of the subtrees that were looked at last, and have slabs.
    points: Points,
}

/// Points by coordinate.
#[derive(Default)]
struct Points([Vec<f64>; 3]);

impl<P: Iterator<Item = DVec3>, F: Fn(u32) -> P> Finder<'_, F> {
    /// Finds the slabs below a node, and leaves the points there. The number of primitives, and the sum of their normals.
    fn look_below(&mut self, index: usize) -> (usize, DVec3) {
        let node = &self.tree.nodes[index];
        let (mut primitives, mut sum, start) = (0, DVec3::ZERO, self.points.len());
        for lane in 0..WIDTH {
            let from = self.points.len();
            let (count, normal) = match node.child[lane].kind() {
                Kind::Empty => break,
                Kind::Inner(child) => self.look_below(child),
                Kind::Leaf(leaf) => (leaf.len(), self.add(leaf)),
            };
            if count <= PRIMITIVES_MAX {
                self.eights[index].set(lane, normal, node, &self.points, from);
            }
            primitives += count;
            sum += normal;
        }
        if primitives > PRIMITIVES_MAX {
            self.points.truncate(start);
        }
        (primitives, sum)
    }

    /// Adds the points of a leaf. The sum of its normals.
    fn add(&mut self, leaf: Range<usize>) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for &primitive in self.tree.leaf(leaf) {
            let from = self.points.len();
            for point in (self.points_of)(primitive) {
                self.points.push(point);
            }
            if self.points.len() >= from + 3 {
                let (p, q, r) = (self.points.at(from), self.points.at(from + 1), self.points.at(from + 2));
                sum += (q - p).cross(r - p);
            }
        }
        sum
    }
}

impl Points {
    fn len(&self) -> usize {
        self.0[0].len()
    }

    fn at(&self, index: usize) -> DVec3 {
        let [x, y, z] = &self.0;
        DVec3::new(x[index], y[index], z[index])
    }

    fn push(&mut self, point: DVec3) {
        let [x, y, z] = &mut self.0;
        x.push(point.x);
        y.push(point.y);
        z.push(point.z);
    }

    fn truncate(&mut self, len: usize) {
        self.0.iter_mut().for_each(|axis| axis.truncate(len));
    }

    /// The least and the greatest height of the points from one on along a direction, of which there is at least one.
    #[inline(always)]
    fn heights<S: Simd>(&self, simd: S, from: usize, along: DVec3) -> (f64, f64) {
        let [x, y, z] = self.0.each_ref().map(|axis| axis[from..].chunks_exact(4));
        let rest = [x.remainder(), y.remainder(), z.remainder()];
        let first = along.dot(self.at(from));
        let (mut least, mut greatest) = (f64x4::splat(simd, first), f64x4::splat(simd, first));
        for ((x, y), z) in x.zip(y).zip(z) {
            let [x, y, z] =
                [f64x4::from_slice(simd, x), f64x4::from_slice(simd, y), f64x4::from_slice(simd, z)];
            let height = x * along.x + y * along.y + z * along.z;
            (least, greatest) = (least.min(height), greatest.max(height));
        }
        let mut ends = (least.reduce_min(), greatest.reduce_max());
        for i in 0..rest[0].len() {
            let height = along.dot(DVec3::from_array(rest.map(|axis| axis[i])));
            ends = (ends.0.min(height), ends.1.max(height));
        }
        ends
    }
}

impl Eight {
    /// Takes in the slab across a direction around the points from one on.
    fn set(&mut self, lane: usize, across: DVec3, node: &Node, points: &Points, from: usize) {
        let Some(normal) = across.try_normalize() else { return };
        let normal = each(normal.to_array(), |x| x as f32);
        let exact = DVec3::from_array(each(normal, f64::from));
        let center = DVec3::from_array(
            [0, 1, 2].map(|axis| f64::from(center(node.min[axis][lane], node.max[axis][lane]))),
        );
        let (least, greatest) = dispatch!(simd => points.heights(simd, from, exact));
        let (least, greatest) = (least - exact.dot(center), greatest - exact.dot(center));
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
