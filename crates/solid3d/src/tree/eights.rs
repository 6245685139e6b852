//! The eight boxes of a node against the eight of a node of another tree, all at once: the six facet axes, as in
//! [`crossing`](super::crossing), there for one box against eight.
//!
//! The eight of either node are taken to the space of the other, in `f32`: an interval on each axis there. Two boxes may overlap
//! if on no axis of either space the interval of the one is apart from the other box.
//!
//! # The margin
//!
//! u = 2^-24. F, f take boxes to the other space; a box has centre c and half extents h, of which a node gives the doubles. The ends
//! F c + f -+ |F| h are one rounding more than what `crossing` has on the axes of the single box: a product takes part in
//! six, of the row, of the doubled centre, of the product, of three sums; f in its own and three; and the difference in the
//! end is rounded once. As |c| + h <= 1 in each coordinate, that is at most 7u/(1 - 7u) (sum |F| + |f| + all that is
//! added to |F| h). [`MARGIN`] is 8u, and counts sum |F| twice. What underflows loses less than [`UNDERFLOW`].

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, mask32x8};
use glam::DVec3;
use solid_convex::simd::{each, part};

use super::crossing::{Folded, MARGIN, UNDERFLOW, row_sums, rows};
use super::lanes::{LANES, bits, lanes, splat};
use super::node::{Node, WIDTH};
use super::normal::round_down;
use super::packed::PackedBox;
use super::siblings::Deepest;

/// Up to here nothing overflows, even where an empty lane reaches 1e30; beyond it, boxes are looked at one by one.
const MAP_MAX: f64 = 1e6;

/// The way of boxes to the tree coordinates of another tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Image {
    /// F / 2, by rows, as lanes give twice the centre and the half extents; and its absolute value.
    half_rows: [[f32; 3]; 3],
    half_rows_abs: [[f32; 3]; 3],
    /// f.
    offset: [f32; 3],
    /// All margins.
    reach: [f32; 3],
}

/// Of eight boxes, the intervals on three axes: least and greatest coordinates.
#[derive(Clone, Copy)]
struct Intervals<S: Simd> {
    least: [f32x8<S>; 3],
    greatest: [f32x8<S>; 3],
}

impl Image {
    /// `None` for a map that stretches or moves by so much that single precision tells nothing.
    #[inline(always)]
    pub fn new(folded: &Folded) -> Option<Image> {
        let DVec3 { x, y, z } = folded.map.translation;
        let sums = 2.0 * row_sums(&folded.abs) + folded.map.translation.abs() + folded.slack;
        // Not a number is no number up to it either.
        if !(sums.max_element() <= MAP_MAX && sums.is_finite()) {
            return None;
        }
        let half_rows = rows(&(0.5 * folded.map.matrix3));
        let reach = folded.slack + MARGIN * sums + UNDERFLOW;
        Some(Image {
            half_rows,
            half_rows_abs: each(half_rows, |row| each(row, f32::abs)),
            offset: each([x, y, z], |x| x as f32),
            reach: each(reach.to_array(), |reach| -round_down(-reach)),
        })
    }

    /// Where the boxes of a node are.
    #[inline(always)]
    fn of<S: Simd>(&self, simd: S, node: &Node) -> Intervals<S> {
        let zero = splat(simd, 0.0);
        let mut centers = [zero; 3];
        let mut sizes = [zero; 3];
        for axis in 0..3 {
            let (min, max) = lanes(simd, node, axis);
            centers[axis] = max + min;
            sizes[axis] = max - min;
        }
        let mut intervals = Intervals { least: [zero; 3], greatest: [zero; 3] };
        for axis in 0..3 {
            let mut center = splat(simd, self.offset[axis]);
            let mut extent = splat(simd, self.reach[axis]);
            for from in 0..3 {
                center += splat(simd, self.half_rows[axis][from]) * centers[from];
                extent += splat(simd, self.half_rows_abs[axis][from]) * sizes[from];
            }
            intervals.least[axis] = center - extent;
            intervals.greatest[axis] = center + extent;
        }
        intervals
    }
}

/// Which of eight boxes and eight may overlap.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub(super) struct Overlaps {
    /// The lanes of `b` that were held against those of `a`, as bits. Others overlap none.
    pub tested: u32,
    /// The pairs that may overlap, as bits: eight for each lane of `b`, one for each of `a`.
    pub hits: u64,
    /// Which of them overlaps deepest, if that was found with them and is not yet asked for.
    pub deepest: Option<u8>,
    /// In the same order, how far those of `a` are apart from those of `b` on their own axes, below zero by how far they overlap; of
    /// lanes that were tested.
    pub gaps: [[f32; WIDTH]; WIDTH],
}

/// The boxes of a node of `a` against those of one of `b`, given the images of `b` in `a` and the reverse, and the box around those of `a`;
/// and which of them overlaps deepest, if that is wanted.
#[inline(always)]
pub(super) fn overlaps<S: Simd>(
    simd: S,
    a: &Node,
    b: &Node,
    images: &[Image; 2],
    around_a: &PackedBox,
    wants_deepest: bool,
    overlaps: &mut Overlaps,
) {
    part!(simd => overlaps_on(simd, a, b, images, around_a, wants_deepest, overlaps));
}

#[inline(always)]
fn overlaps_on<S: Simd>(
    simd: S,
    a: &Node,
    b: &Node,
    [b_in_a, a_in_b]: &[Image; 2],
    around_a: &PackedBox,
    wants_deepest: bool,
    overlaps: &mut Overlaps,
) {
    let (of_a, of_b) = (Eight::new(simd, a, a_in_b), OneByOne::new(simd, b, b_in_a));
    overlaps.tested = of_b.near(simd, around_a);
    overlaps.hits = 0;
    let mut deepest = Deepest::new(simd);
    for lane in bits(overlaps.tested) {
        let (apart, gaps) = of_a.apart(simd, &of_b, lane);
        let hits = !(apart.to_bitmask() as u32) & LANES;
        overlaps.hits |= u64::from(hits) << (WIDTH * lane);
        if wants_deepest {
            overlaps.gaps[lane] = gaps.to_array();
            deepest.take(simd, lane, !apart, gaps);
        }
    }
    overlaps.deepest = if wants_deepest { Some(deepest.place()) } else { None };
}

/// The eight boxes of a node, ready to be held against boxes of another tree.
struct Eight<S: Simd> {
    own: Intervals<S>,
    /// In the space of the other.
    image: Intervals<S>,
}

/// Eight boxes, to be taken one by one: of each, the intervals in its own space, and in the other.
struct OneByOne<'n> {
    own: &'n Node,
    least: [[f32; WIDTH]; 3],
    greatest: [[f32; WIDTH]; 3],
}

impl<S: Simd> Eight<S> {
    #[inline(always)]
    fn new(simd: S, node: &Node, image: &Image) -> Self {
        let zero = splat(simd, 0.0);
        let mut own = Intervals { least: [zero; 3], greatest: [zero; 3] };
        for axis in 0..3 {
            (own.least[axis], own.greatest[axis]) = lanes(simd, node, axis);
        }
        Eight { own, image: image.of(simd, node) }
    }

    /// The lanes that do not overlap box `lane` of the others; and how far each is apart from it on its own axes, below zero by how far it
    /// overlaps.
    #[inline(always)]
    fn apart(&self, simd: S, others: &OneByOne, lane: usize) -> (mask32x8<S>, f32x8<S>) {
        let mut gaps = [splat(simd, 0.0); 3];
        let mut other_gaps = gaps;
        for axis in 0..3 {
            let least = splat(simd, others.least[axis][lane]);
            let greatest = splat(simd, others.greatest[axis][lane]);
            gaps[axis] = (least - self.own.greatest[axis]).max(self.own.least[axis] - greatest);
            let (min, max) = (others.own.min[axis][lane], others.own.max[axis][lane]);
            let (min, max) = (splat(simd, min), splat(simd, max));
            other_gaps[axis] = (min - self.image.greatest[axis]).max(self.image.least[axis] - max);
        }
        let gap = gaps[0].max(gaps[1]).max(gaps[2]);
        let other_gap = other_gaps[0].max(other_gaps[1]).max(other_gaps[2]);
        (gap.max(other_gap).simd_gt(splat(simd, 0.0)), gap)
    }
}

impl<'n> OneByOne<'n> {
    #[inline(always)]
    fn new<S: Simd>(simd: S, node: &'n Node, image: &Image) -> Self {
        let Intervals { least: [a, b, c], greatest: [d, e, f] } = image.of(simd, node);
        OneByOne {
            own: node,
            least: [a.to_array(), b.to_array(), c.to_array()],
            greatest: [d.to_array(), e.to_array(), f.to_array()],
        }
    }

    /// Those that may overlap a box of the other tree, as bits.
    #[inline(always)]
    fn near<S: Simd>(&self, simd: S, bounds: &PackedBox) -> u32 {
        let (min, max) = (bounds.min(), bounds.max());
        let mut gap = splat(simd, f32::NEG_INFINITY);
        for axis in 0..3 {
            let below = f32x8::load_array_ref(simd, &self.least[axis]) - splat(simd, max[axis]);
            let above = splat(simd, min[axis]) - f32x8::load_array_ref(simd, &self.greatest[axis]);
            gap = gap.max(below.max(above));
        }
        !(gap.simd_gt(splat(simd, 0.0)).to_bitmask() as u32) & LANES
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Aabb;
    use crate::tree::normal::Normal;
    use crate::tree::tests::scenes::{affine, point, random_boxes, relative, rng};
    use solid_convex::simd::{alike, dispatch};

    /// Law: boxes with a point in common are never told apart, under maps of any size; what is clearly apart mostly is, empty lanes
    /// are, and every level of instructions gives the same bits.
    #[test]
    fn boxes_with_a_common_point_are_kept() {
        let mut rng = rng(51);
        let unit = Normal::of(&Aabb::new(DVec3::splat(-2.0), DVec3::splat(2.0)));
        let (mut hits, mut pairs, mut common) = (0, 0, 0);
        for round in 0..2000 {
            let size = [1.0, 1.0, 0.3, 3.0, 1e-3, 1e3][round % 6];
            let map = affine(&mut rng, size, 0.3);
            let boxes = [(); 2].map(|()| random_boxes(&mut rng, 8, 1.3));
            let used = [1 + round % 8, 1 + round / 8 % 8];
            let mut nodes = [Node::EMPTY; 2];
            for (node, (boxes, used)) in nodes.iter_mut().zip(boxes.iter().zip(used)) {
                for (lane, bounds) in boxes.iter().take(used).enumerate() {
                    node.set_lane(lane, &unit.pack(bounds));
                }
            }
            let relative = relative(map, 2.0, 2.0);
            let of_b = Folded::new(&relative.b_to_a, relative.slack_in_a, &unit, &unit);
            let of_a = Folded::new(&relative.a_to_b, relative.slack_in_b, &unit, &unit);
            let images = [of_b, of_a].map(|folded| Image::new(&folded).expect("the map is of moderate size"));
            let [a, b] = &nodes;
            let found = alike(|level| {
                dispatch!(widest level, simd => {
                    let [mut found, mut unordered] = [Overlaps::default(); 2];
                    overlaps(simd, a, b, &images, &a.union(), true, &mut found);
                    overlaps(simd, a, b, &images, &a.union(), false, &mut unordered);
                    assert_eq!((unordered.hits, unordered.deepest), (found.hits, None));
                    if found.hits != 0 {
                        let sought = Overlaps { deepest: None, ..found }.take_deepest(simd);
                        assert_eq!(found.deepest.map(usize::from), Some(sought), "round {round}");
                    }
                    found
                })
            });
            for (j, hit) in found.hits.to_le_bytes().map(u32::from).into_iter().enumerate() {
                assert!(found.tested >> j & 1 == 1 || hit == 0);
                assert!(hit >> used[0] == 0 && (j < used[1] || hit == 0), "an empty lane is kept");
                for i in 0..used[0] {
                    if j < used[1] {
                        // Of the box that is smaller in the space of a, a point that may be in the other.
                        let (box_a, box_b) = (&boxes[0][i], &boxes[1][j]);
                        let within =
                            |bounds: &Aabb, p: DVec3| bounds.min.cmple(p).all() && p.cmple(bounds.max).all();
                        let (p, q) = (point(&mut rng, 1.0), point(&mut rng, 1.0));
                        let (p, q) = (
                            box_a.center() + p * box_a.half_extents(),
                            box_b.center() + q * box_b.half_extents(),
                        );
                        let meet = within(box_b, relative.a_to_b.transform_point3(p))
                            || within(box_a, relative.b_to_a.transform_point3(q));
                        assert!(!meet || hit >> i & 1 == 1, "round {round}: lanes {i} and {j} meet");
                        common += usize::from(meet);
                        pairs += 1;
                        hits += usize::from(hit >> i & 1 == 1);
                    }
                }
            }
        }
        println!("{hits} of {pairs} pairs may overlap, {common} have the point in common");
        assert!(10 * hits > 3 * pairs && 10 * hits < 7 * pairs && 10 * common > pairs);
    }

    /// Maps for which single precision tells nothing are refused, those that are no numbers too.
    #[test]
    fn extreme_maps_are_refused() {
        let unit = Normal::of(&Aabb::new(DVec3::splat(-1.0), DVec3::ONE));
        for (size, away, taken) in [
            (1.0, 1.0, true),
            (1e5, 1.0, true),
            (1e7, 1.0, false),
            (1.0, 1e7, false),
            (f64::NAN, 0.0, false),
            (1e-300, 0.0, true),
        ] {
            let map = glam::DAffine3 {
                matrix3: glam::DMat3::from_diagonal(DVec3::new(1.0, 1.0, size)),
                translation: DVec3::X * away,
            };
            assert_eq!(Image::new(&Folded::new(&map, 0.0, &unit, &unit)).is_some(), taken, "{size} {away}");
        }
    }
}
