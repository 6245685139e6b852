//! Small images of the triangles of each leaf: what is looked at before the triangles themselves.
//!
//! To go from the order of the tree to a triangle, and from there to its corners, waits for memory three times; here the
//! triangles of a leaf stand beside each other, in lanes, each corner in one word. Its coordinates are whole numbers from 0 to
//! [`STEPS`], those of a grid over the box of the leaf, which is known when the leaf is visited: 12 bytes a triangle. What is told from an
//! image must hold for all triangles that have it; what cannot be told, the triangles themselves tell. The indices of their corners stand
//! right behind, for as many bytes again, so that one wait is left.
//!
//! # The error
//!
//! A coordinate x in `f64` is `u = (x - origin) * inverse` in tree coordinates. The product is exact, and rounding of the difference is
//! below 2^-53 |u|. The box of the leaf has u in it, and has grown by at least 2^-24 |u| to either side when it was rounded to `f32`
//! (`normal`); so a step of its grid is at least 2^-33 |u|, and the error 2^-20 of a step. Roundings on the way from `u - min` to the grid are
//! relative to numbers up to [`STEPS`]: below 2^-40. So the nearest point of the grid is within [`HALF_STEP`] of the corner, counted from
//! where the grid exactly is.

use std::ops::Range;

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, i32x8, u32x8};
use glam::DVec3;
use solid_convex::simd;

#[cfg(test)]
use super::near::Boxes;
use super::node::{Kind, LEAF_SIZE, Node, WIDTH};
use super::{Normal, Place, Signposts, Tree};

/// The steps of the grid over a leaf's box, along each axis.
pub(crate) const STEPS: u32 = (1 << AXIS_BITS) - 1;

/// How far a corner is from its image, in steps, along each axis: see the module.
pub(crate) const HALF_STEP: f64 = 0.5 + 1.0 / 65536.0;

/// The bits of a word that one axis has.
const AXIS_BITS: u32 = 10;

/// Corners of a triangle.
const CORNERS: usize = 3;

/// What stands for a triangle: the words of its corners, and their indices.
const WORDS: usize = 2 * CORNERS;

/// The images of the leaves of a tree over triangles.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LeafImages {
    /// Those of a leaf that begins at `start` in the order begin at `WORDS * start`: all first corners, all second ones, all
    /// third ones; then the indices of each triangle. At the end is room for a vector that begins at the last.
    words: Vec<u32>,
    /// Which of them to look at first.
    signposts: Option<Signposts>,
}

/// A leaf to which a walk has come.
#[derive(Clone, Copy)]
pub(crate) struct Leaf<'t> {
    /// What is in it.
    pub primitives: &'t [u32],
    /// Where it begins in the order.
    start: usize,
    /// Where its box is.
    node: &'t Node,
    lane: usize,
}

/// The image of a leaf.
#[derive(Clone, Copy)]
pub(crate) struct Image<'t> {
    leaf: Leaf<'t>,
    /// From its first word on.
    words: &'t [u32],
}

/// The images of a corner of up to eight triangles. What is in lanes beyond those of the leaf means nothing.
#[derive(Clone, Copy)]
pub(crate) struct ImageCorner<S: Simd>(u32x8<S>);

impl LeafImages {
    /// Of a tree, given the corners of its primitives by their indices, around which its boxes are. Cost: `O(n)`.
    pub fn new(tree: &Tree, vertices: &[DVec3], triangle: impl Fn(u32) -> [u32; CORNERS]) -> Self {
        let mut words = vec![0; WORDS * tree.len() + LEAF_SIZE - 1];
        for leaf in tree.leaves() {
            let grid = Grid::new(&tree.normal, &leaf);
            let count = leaf.primitives.len();
            let (columns, indices) = words[WORDS * leaf.start..].split_at_mut(CORNERS * count);
            for (lane, &primitive) in leaf.primitives.iter().enumerate() {
                let corners = triangle(primitive);
                for (corner, index) in corners.into_iter().enumerate() {
                    columns[corner * count + lane] = grid.nearest(vertices[index as usize]);
                }
                indices[CORNERS * lane..][..CORNERS].copy_from_slice(&corners);
            }
        }
        LeafImages { words, signposts: Signposts::new(tree) }
    }

    /// The image of a leaf of their tree.
    #[inline(always)]
    pub fn of<'t>(&'t self, leaf: &Leaf<'t>) -> Image<'t> {
        Image { leaf: *leaf, words: &self.words[WORDS * leaf.start..] }
    }

    /// Asks for the memory of the image of a leaf that begins there in the order, which may soon be looked at.
    #[inline(always)]
    pub fn prefetch(&self, start: usize) {
        simd::prefetch_some::<u32, { WORDS * LEAF_SIZE }>(&self.words, WORDS * start);
    }

    /// Where to look first, in a tree of many leaves.
    #[inline(always)]
    pub fn signposts(&self) -> Option<&Signposts> {
        self.signposts.as_ref()
    }

    /// The memory that they own, in bytes.
    pub fn bytes(&self) -> usize {
        self.words.capacity() * size_of::<u32>() + self.signposts.as_ref().map_or(0, Signposts::bytes)
    }
}

/// The grid over a leaf's box.
struct Grid<'t> {
    normal: &'t Normal,
    min: DVec3,
    per_step: DVec3,
}

impl<'t> Grid<'t> {
    fn new(normal: &'t Normal, leaf: &Leaf) -> Self {
        let packed = leaf.node.lane(leaf.lane);
        let [min, max] = [packed.min(), packed.max()].map(|corner| DVec3::from_array(corner.map(f64::from)));
        // A box that is rounded outward has a size on each axis.
        Grid { normal, min, per_step: f64::from(STEPS) / (max - min) }
    }

    /// The word of the point of the grid nearest to a point in the box.
    fn nearest(&self, point: DVec3) -> u32 {
        let u = (point - self.normal.origin) * self.normal.inverse;
        let [x, y, z] = ((u - self.min) * self.per_step + 0.5).to_array().map(|q| (q as u32).min(STEPS));
        x | y << AXIS_BITS | z << (2 * AXIS_BITS)
    }
}

impl Tree {
    /// All leaves.
    pub(crate) fn leaves(&self) -> impl Iterator<Item = Leaf<'_>> {
        self.placed_leaves().map(|(_, leaf)| leaf)
    }

    /// The same, and where they are.
    pub(super) fn placed_leaves(&self) -> impl Iterator<Item = (Place, Leaf<'_>)> {
        let lanes =
            (0..self.nodes.len()).flat_map(|node| (0..WIDTH).map(move |lane| Place::lane(node, lane)));
        lanes.filter_map(|place| self.leaf_if_any(place).map(|leaf| (place, leaf)))
    }

    /// The leaf in a lane, if there is one.
    #[inline(always)]
    pub(super) fn leaf_if_any(&self, place: Place) -> Option<Leaf<'_>> {
        match self.child_at(place).kind() {
            Kind::Leaf(range) => Some(self.leaf_at(place, range)),
            Kind::Empty | Kind::Inner(_) => None,
        }
    }
}

impl<'t> Leaf<'t> {
    pub(super) fn new(tree: &'t Tree, range: Range<usize>, node: usize, lane: usize) -> Self {
        Leaf { start: range.start, primitives: tree.leaf(range), node: &tree.nodes[node], lane }
    }

    /// The lanes in use, as bits.
    #[inline(always)]
    pub fn lanes(&self) -> u32 {
        (1 << self.primitives.len()) - 1
    }
}

#[cfg(test)]
impl<'t> Leaf<'t> {
    /// The boxes of the node that it hangs in, and which of them is its own.
    pub fn boxes(&self) -> (Boxes<'t>, usize) {
        (Boxes(self.node), self.lane)
    }
}

impl Image<'_> {
    /// The first point of the grid along an axis, and the length of a step, in tree coordinates; the step rounded, by less than 2^-50 of it.
    #[inline(always)]
    pub fn axis(&self, axis: usize) -> (f64, f64) {
        let Leaf { node, lane, .. } = self.leaf;
        let (min, max) = (f64::from(node.min[axis][lane]), f64::from(node.max[axis][lane]));
        (min, (max - min) * (1.0 / f64::from(STEPS)))
    }

    /// The indices of the corners of the triangle in a lane.
    #[inline(always)]
    pub fn indices(&self, lane: usize) -> [u32; CORNERS] {
        let from = CORNERS * (self.leaf.primitives.len() + lane);
        *self.words[from..].first_chunk().expect("a leaf has all words of its triangles")
    }

    /// The images of one corner of all triangles.
    #[inline(always)]
    pub fn corner<S: Simd>(&self, simd: S, corner: usize) -> ImageCorner<S> {
        let from = corner * self.leaf.primitives.len();
        ImageCorner(u32x8::from_slice(simd, &self.words[from..from + LEAF_SIZE]))
    }
}

impl<S: Simd> ImageCorner<S> {
    /// The coordinates along an axis, in steps of the grid.
    #[inline(always)]
    pub fn along(self, simd: S, axis: usize) -> f32x8<S> {
        let steps = self.0 >> (axis as u32 * AXIS_BITS) & u32x8::splat(simd, STEPS);
        let steps: i32x8<S> = steps.bitcast();
        f32x8::float_from(steps)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Aabb;
    use crate::tree::tests::scenes::{point, rng};
    use rand::Rng;
    use solid_convex::simd::{alike, dispatch};

    /// A primitive, the images of its corners in whole steps, and the grid of its leaf.
    type Found = (u32, [[f32; 3]; 3], [(f64, f64); 3]);

    /// The images of all leaves.
    fn images_of(tree: &Tree, images: &LeafImages) -> Vec<Found> {
        let mut found = Vec::new();
        for leaf in tree.leaves() {
            let image = images.of(&leaf);
            for (lane, &i) in leaf.primitives.iter().enumerate() {
                assert_eq!(image.indices(lane), [3 * i, 3 * i + 1, 3 * i + 2]);
            }
            let steps = alike(|level| {
                let mut steps = [[[0.0f32; 8]; 3]; 3];
                dispatch!(widest level, simd => {
                    for (corner, axes) in steps.iter_mut().enumerate() {
                        for (axis, lanes) in axes.iter_mut().enumerate() {
                            *lanes = image.corner(simd, corner).along(simd, axis).to_array();
                        }
                    }
                });
                let lanes = steps.as_flattened_mut().iter_mut();
                lanes.for_each(|lanes| lanes[leaf.primitives.len()..].fill(0.0));
                steps
            });
            let grid = [image.axis(0), image.axis(1), image.axis(2)];
            for (lane, &primitive) in leaf.primitives.iter().enumerate() {
                let at = |corner: usize| [0, 1, 2].map(|axis| steps[corner][axis][lane]);
                found.push((primitive, [at(0), at(1), at(2)], grid));
            }
        }
        found
    }

    /// Law: a corner is within half a step of its image, at any size, far from the origin, of flat and degenerate triangles.
    #[test]
    fn corners_are_near_their_images() {
        let mut rng = rng(91);
        let mut largest: f64 = 0.0;
        for case in 0..200 {
            let size = 10f64.powi(rng.random_range(-90..90));
            let away = if case % 2 == 0 { 0.0 } else { 10f64.powi(rng.random_range(0..10)) };
            let count = rng.random_range(1..100);
            let triangles: Vec<[DVec3; 3]> = (0..count)
                .map(|_| {
                    let (p, reach) = (point(&mut rng, 1.0), 10f64.powi(rng.random_range(-12..0)));
                    let mut corners = [p, p + point(&mut rng, reach), p + point(&mut rng, reach)];
                    match case % 4 {
                        0 => corners[2] = corners[1],
                        1 => corners.iter_mut().for_each(|corner| corner.z = 0.25),
                        _ => {}
                    }
                    corners.map(|corner| (corner + away) * size)
                })
                .collect();
            let boxes: Vec<Aabb> = triangles.iter().map(|corners| Aabb::of_points(*corners)).collect();
            let tree = Tree::build(&boxes);
            let images = LeafImages::new(&tree, triangles.as_flattened(), |i| [3 * i, 3 * i + 1, 3 * i + 2]);
            let found = images_of(&tree, &images);
            assert_eq!(found.len(), count);
            for (primitive, corners, grid) in found {
                for (image, corner) in corners.iter().zip(triangles[primitive as usize]) {
                    for axis in 0..3 {
                        let (min, step) = grid[axis];
                        // As exactly as may be: both differences are of numbers that are near each other.
                        let u = (corner[axis] - tree.normal.origin[axis]) * tree.normal.inverse;
                        let off = ((u - min) / step - f64::from(image[axis])).abs();
                        assert!(off <= HALF_STEP, "case {case}: {off} steps");
                        largest = largest.max(off);
                    }
                }
            }
        }
        println!("at most {largest} steps");
        assert!(largest > 0.49);
    }
}
