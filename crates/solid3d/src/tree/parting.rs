//! Pairs of [patches](super::patch) that boxes leave together, and that are apart across the slab of one of them.
//!
//! Where two surfaces pass close by each other, boxes overlap all along: of two tori of 100,000 triangles that are looked through for
//! all that meets, half of the pairs of leaves. Across its slab a patch is thin, and so is one beside it that lies alike.
//!
//! # The margin
//!
//! u = 2^-24. The normal n of a patch of A is taken to the tree coordinates of B, m = F^T n, where F, f take B to A; T = sum |F|, so that no
//! norm of m is greater. Coordinates, half extents and entries of n are at most 1, heights along n at most 1.74. Then
//! m is off by 4uT in all; the height of a centre of B over the slab by 10uT + 8u sum |f| + 24u; the reach of its box along what is left of m by
//! 20uT, as the multiple counts as it is; the reach of its slab along the multiple by 11uT; and the comparison adds 7uT + 7u. That is
//! less than 64u (T + sum |f| + 1).

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, mask32x8};
use solid_convex::simd::{each, part};

use super::crossing::{Folded, UNDERFLOW, row_sums, rows};
use super::eights::Overlaps;
use super::lanes::{LANES, splat};
use super::node::WIDTH;
use super::normal::round_down;
use super::patch::{Patch, Vector, dot, transposed_product};
use super::slabs::{Eight, Slabs};
use super::{Place, Tree};

/// 64u: see the module.
const MARGIN: f64 = 32.0 * f32::EPSILON as f64;

/// Two trees with slabs.
pub(super) struct Parting<'t> {
    sides: [Side<'t>; 2],
}

/// One of the trees, and the way to its coordinates from those of the other.
struct Side<'t> {
    tree: &'t Tree,
    slabs: &'t [Eight],
    /// F, by rows.
    rows: [[f32; 3]; 3],
    /// f.
    offset: [f32; 3],
    /// All margins.
    margin: f32,
}

/// A slab in each lane, in the coordinates of the other tree: `along . p + height` is within `half` of zero for all of its points.
struct Across<S: Simd> {
    along: Vector<S>,
    height: f32x8<S>,
    half: f32x8<S>,
}

/// Patches and their slabs.
struct Lanes<S: Simd> {
    patch: Patch<S>,
    across: Across<S>,
}

impl<'t> Parting<'t> {
    /// Given the ways of `b` to `a` and the reverse: such as have [images](super::eights::Image).
    pub fn new([a, b]: [&'t Tree; 2], slabs: [&'t Slabs; 2], [b_to_a, a_to_b]: &[Folded; 2]) -> Self {
        Parting { sides: [Side::new(a, slabs[0], b_to_a), Side::new(b, slabs[1], a_to_b)] }
    }

    /// Takes away those pairs of the lanes of two nodes that are apart.
    #[inline(always)]
    pub fn part<S: Simd>(&self, simd: S, node_a: usize, node_b: usize, overlaps: &mut Overlaps) {
        part!(simd => {
            let lanes = self.sides[0].lanes(simd, node_a);
            let mut hits = overlaps.hits;
            let mut rest = hits;
            while rest != 0 {
                let row = rest.trailing_zeros() as usize / WIDTH;
                let apart = self.apart::<S, 0>(simd, &lanes, Place::lane(node_b, row));
                hits &= !(u64::from(apart) << (WIDTH * row));
                rest &= !(u64::from(LANES) << (WIDTH * row));
            }
            if hits != overlaps.hits {
                (overlaps.hits, overlaps.deepest) = (hits, None);
            }
        });
    }

    /// The lanes of a node that are apart from what is at a place of the other tree, as bits; the node is of the first tree for `OF` = 0, of
    /// the second for 1.
    #[inline(always)]
    pub fn apart_from<S: Simd, const OF: usize>(&self, simd: S, node: usize, place: Place) -> u32 {
        part!(simd => self.apart::<S, OF>(simd, &self.sides[OF].lanes(simd, node), place))
    }

    #[inline(always)]
    fn apart<S: Simd, const OF: usize>(&self, simd: S, lanes: &Lanes<S>, place: Place) -> u32 {
        let one = self.sides[1 - OF].one(simd, place);
        let apart: mask32x8<S> = lanes.across.part(&one.patch) | one.across.part(&lanes.patch);
        apart.to_bitmask() as u32 & LANES
    }
}

impl<'t> Side<'t> {
    fn new(tree: &'t Tree, slabs: &'t Slabs, from: &Folded) -> Self {
        let offset = from.map.translation;
        let terms = row_sums(&from.abs).element_sum() + offset.abs().element_sum() + 1.0;
        // No entry of a normal is greater than 1 by more than it is rounded.
        let margin = MARGIN * terms + 1.1 * from.slack.element_sum() + UNDERFLOW;
        Side {
            tree,
            slabs: &slabs.eights,
            rows: rows(&from.map.matrix3),
            offset: each(offset.to_array(), |x| x as f32),
            margin: -round_down(-margin),
        }
    }

    #[inline(always)]
    fn lanes<S: Simd>(&self, simd: S, node: usize) -> Lanes<S> {
        self.with_across(simd, Patch::lanes(simd, self.tree, self.slabs, node))
    }

    #[inline(always)]
    fn one<S: Simd>(&self, simd: S, place: Place) -> Lanes<S> {
        self.with_across(simd, Patch::one(simd, self.tree, self.slabs, place))
    }

    #[inline(always)]
    fn with_across<S: Simd>(&self, simd: S, patch: Patch<S>) -> Lanes<S> {
        let normal = &patch.normal;
        let along = transposed_product(simd, &self.rows, normal);
        let offset = [splat(simd, self.offset[0]), splat(simd, self.offset[1]), splat(simd, self.offset[2])];
        let height = dot(normal, &offset) - dot(normal, &patch.center) - patch.middle;
        let half = patch.half + splat(simd, self.margin);
        Lanes { across: Across { along, height, half }, patch }
    }
}

impl<S: Simd> Across<S> {
    /// The lanes of which the slab is apart from the patch.
    #[inline(always)]
    fn part(&self, patch: &Patch<S>) -> mask32x8<S> {
        let (rest, multiple) = patch.split(&self.along);
        let height = dot(&self.along, &patch.center) + self.height + multiple * patch.middle;
        let reach = patch.reach_of_box(&rest) + multiple.abs() * patch.half;
        height.abs().simd_gt(self.half + reach)
    }
}
