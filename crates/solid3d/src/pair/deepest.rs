//! Which of many pairs of primitives is deepest. The pieces of a convex polygon are one, which the first of them stands for.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use glam::DVec3;
use smallvec::SmallVec;
use solid_convex::Penetration;
use solid_convex::epa::DEPTH_TOLERANCE;
use solid_convex::simd::{dispatch, level};

use super::complex_complex::{frame, meeting_leaves};
use super::depth::of_common;
use super::frame::Frame;
use super::leaf_pair::MeetingLeaves;
use super::row::{CONFIRMED, Row, depths};
use super::table::{PlacedComplex, PlacedConvex};
use super::{Scratch, complex_convex};
use crate::bounds::Aabb;
use crate::shape::Complex;
use crate::tree::{LEAF_SIZE, bits};

/// The deepest of several pairs of primitives, with what was found of it.
pub(super) struct Deepest<T>(Option<([u32; 2], f64, T)>);

impl<T> Default for Deepest<T> {
    fn default() -> Self {
        Deepest(None)
    }
}

impl<T> Deepest<T> {
    /// Takes a pair into account. Of equals, that of the least numbers is kept: not the first, for trees may have any order.
    pub fn take(&mut self, pair: [u32; 2], depth: f64, found: T) {
        if self.is_passed(pair, depth) {
            self.0 = Some((pair, depth, found));
        }
    }

    /// Whether a pair that is so deep takes the place of the deepest.
    fn is_passed(&self, pair: [u32; 2], depth: f64) -> bool {
        self.0
            .as_ref()
            .is_none_or(|(deepest, greatest, _)| depth > *greatest || (depth == *greatest && pair < *deepest))
    }

    /// How deep it is; below all depths, when there is none.
    fn depth(&self) -> f64 {
        self.0.as_ref().map_or(f64::NEG_INFINITY, |(_, depth, _)| *depth)
    }

    /// What was found of it.
    pub fn found(self) -> Option<T> {
        self.0.map(|(.., found)| found)
    }
}

/// The primitives of two surfaces that are deepest in each other, up to [`CONFIRMED`], of the pairs that are to be looked at.
///
/// Of triangles that is told in closed form, eight at a time; EPA is asked of what this leaves open, and of what is no triangle, where it may
/// be the deepest.
pub(super) fn deepest_pair(
    a: PlacedComplex,
    b: PlacedComplex,
    among: impl Fn([u32; 2]) -> bool,
    scratch: &mut Scratch,
) -> Option<[u32; 2]> {
    let frame = frame(a, b);
    let scale = frame.scale;
    let (mut deepest, mut looked_at) = (Deepest::default(), BTreeSet::new());
    let has_polygons = a.0.has_polygons() || b.0.has_polygons();
    let mut look = |leaves: &MeetingLeaves| {
        let ([in_a, in_b], meeting) = leaves.by_first();
        // A polygon reaches beyond the leaf that has a piece of it.
        if !has_polygons && overlap(in_a.union(), in_b.union()) < deepest.depth() {
            return ControlFlow::Continue(());
        }
        let [of_a, of_b] = [triangles(a.0, in_a), triangles(b.0, in_b)];
        let of_row = |i| (meeting >> (LEAF_SIZE * i)) as u32 & 0xff;
        for (i, lanes) in (0..LEAF_SIZE).map(|i| (i, of_row(i))).filter(|(_, lanes)| *lanes != 0) {
            let triangles = if of_a >> i & 1 == 1 { lanes & of_b } else { 0 };
            let bound = deepest.depth();
            let x = in_a.triangle(i);
            let known = dispatch!(widest level(), simd => depths(simd, &x, in_b, triangles, bound));
            for j in bits(lanes) {
                let pair = [a.0.whole(in_a.primitive(i)), b.0.whole(in_b.primitive(j))];
                let [most, least] = match triangles >> j & 1 {
                    0 => [f64::INFINITY, 0.0],
                    _ => [known.most[j].max(0.0), known.least[j]],
                };
                if !deepest.is_passed(pair, most) || !among(pair) || (has_polygons && !looked_at.insert(pair))
                {
                    continue;
                }
                let depth = if most - least <= CONFIRMED {
                    most
                } else {
                    let [of_a, of_b] = [a.0.whole_hull(pair[0]), b.0.whole_hull(pair[1])];
                    most.min(of_common((&of_a, a.1), (&of_b, b.1)).depth * scale)
                };
                deepest.take(pair, depth, pair);
            }
        }
        ControlFlow::Continue(())
    };
    let _ = meeting_leaves(&frame, a, b, false, scratch, &mut look);
    deepest.found()
}

/// The lanes of a leaf in which there are triangles that are no pieces of convex polygons.
fn triangles(complex: &Complex, leaf: &Row) -> u32 {
    let triangles = leaf.triangles();
    if !complex.has_polygons() {
        return triangles;
    }
    let pieces = bits(triangles).filter(|&i| complex.is_piece(leaf.primitive(i)));
    pieces.fold(triangles, |whole, i| whole & !(1 << i))
}

/// That primitive of a surface, of those to be looked at, which is deepest in a convex shape, and their penetration. EPA is asked of a primitive unless another is
/// deeper than this one can be, by an axis along which a third left the shape.
pub(super) fn deepest_primitive(
    complex: PlacedComplex,
    convex: PlacedConvex,
    among: impl Fn(u32) -> bool,
    scratch: &mut Scratch,
) -> Option<(u32, Penetration)> {
    let Frame { common: [from_complex, from_convex], scale, .. } = complex_convex::frame(complex, convex);
    let (mut axes, mut deepest) = (Axes::default(), Deepest::default());
    let (has_polygons, mut looked_at) = (complex.0.has_polygons(), BTreeSet::new());
    let mut look = |i: u32, _| {
        let i = complex.0.whole(i);
        if !among(i) || (has_polygons && !looked_at.insert(i)) {
            return ControlFlow::Continue(());
        }
        let points: SmallVec<[DVec3; 4]> =
            complex.0.points_of_whole(i).map(|point| from_complex.transform_point3(point)).collect();
        // So much may EPA be off, at most: what it says of the others would change nothing.
        if !axes.show_less(&points, deepest.depth() * (1.0 - 4.0 * DEPTH_TOLERANCE) - CONFIRMED) {
            let found = of_common((&complex.0.whole_hull(i), complex.1), convex);
            let local = from_convex.matrix3.transpose() * found.direction;
            let end = from_convex.transform_point3(convex.0.support(local));
            axes.keep(found.direction, found.direction.dot(end));
            deepest.take([i, 0], found.depth * scale, (i, found));
        }
        ControlFlow::Continue(())
    };
    let _ = complex_convex::meeting_primitives(complex, convex, scratch, &mut look);
    deepest.found()
}

/// So many axes are kept: of each, a primitive takes some 10 instructions, where EPA takes 10,000.
const AXES: usize = 16;

/// Axes along which primitives left a convex shape, and how far it reaches along each: those that were of use last come first. Space: common.
#[derive(Default)]
struct Axes {
    kept: [(DVec3, f64); AXES],
    count: usize,
}

impl Axes {
    fn keep(&mut self, axis: DVec3, reach: f64) {
        self.kept.rotate_right(1);
        self.kept[0] = (axis, reach);
        self.count = (self.count + 1).min(AXES);
    }

    /// Whether points have to move less than a distance along one of the axes to leave the shape.
    fn show_less(&mut self, points: &[DVec3], distance: f64) -> bool {
        let shows =
            |&(axis, reach): &(DVec3, f64)| points.iter().all(|point| reach - axis.dot(*point) < distance);
        let first = self.kept[..self.count].iter().position(shows);
        if let Some(first @ 1..) = first {
            self.kept[..=first].rotate_right(1);
        }
        first.is_some()
    }
}

/// How far two boxes reach into each other: nothing in them is deeper in what is in the other.
fn overlap(a: &Aabb, b: &Aabb) -> f64 {
    (a.max - b.min).min(b.max - a.min).min_element()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair::approach::with_primitives;
    use crate::pair::depth::of_deepest;
    use crate::pair::{Placed, meeting_primitives, table};
    use crate::shape::{Class, Shape};
    use glam::{DAffine3, DQuat};
    use rand::Rng;
    use rand::rngs::StdRng;
    use rand::seq::SliceRandom;
    use solid_oracle::generate::{grid, seeded};

    /// A surface with waves, or a flat one, of which many triangles are equally deep.
    fn terrain(rng: &mut StdRng, side: u32, is_flat: bool) -> Shape {
        let phase = rng.random_range(0.0..6.0);
        let point = |i: u32| {
            let (x, y) = (f64::from(i % side), f64::from(i / side));
            let wave = if is_flat { 0.0 } else { (x * 0.7 + phase).sin() * (y * 0.9).cos() };
            DVec3::new(x, y, wave) / f64::from(side) * 2.0 - DVec3::new(1.0, 1.0, 0.0)
        };
        Shape::mesh((0..side * side).map(point).collect::<Vec<_>>(), grid(side)).unwrap()
    }

    fn placement(rng: &mut StdRng) -> DAffine3 {
        let mut number = || rng.random_range(-1.0..1.0);
        let turn = DQuat::from_xyzw(number(), number(), number(), number()).normalize();
        DAffine3::from_rotation_translation(turn, DVec3::new(number(), number(), number()) * 0.4)
    }

    /// Law: the deepest primitives are those that EPA finds deepest of all that meet, or of some of them: of a convex shape with the same bits, of two
    /// surfaces up to what confirms a depth.
    #[test]
    fn the_deepest_is_the_deepest_of_all() {
        let seed = 81;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let (mut pairs, mut meet) = (0, 0);
        for round in 0..240 {
            let is_flat = round % 2 == 0;
            let points: Vec<DVec3> = (0..20).map(|_| placement(&mut rng).translation).collect();
            let other = match round % 8 {
                0 => Shape::sphere(0.3).unwrap(),
                1 => Shape::cuboid([0.4, 0.5, 0.6]).unwrap(),
                2 => Shape::convex_hull(&points).unwrap(),
                3 => Shape::cylinder(0.2, 0.5).unwrap(),
                4 => Shape::capsule(0.1, 0.5).unwrap(),
                _ => terrain(&mut rng, 12, is_flat),
            };
            let surface = terrain(&mut rng, 16, is_flat);
            let places = [placement(&mut rng), placement(&mut rng)];
            // In one place every triangle lies on one, or meets its neighbours; turned by next to nothing, edges are nearly parallel.
            let turned = DAffine3::from_axis_angle(places[1].matrix3.x_axis, 10f64.powi(-6 - round / 16 % 8));
            let (other, places) = match round % 16 {
                7 => (&surface, [places[0]; 2]),
                15 => (&surface, [places[0], turned * places[0]]),
                _ => (&other, places),
            };
            let a = Placed { shape: &surface, placement: &places[0] };
            let b = Placed { shape: other, placement: &places[1] };
            let scratch = &mut Scratch::default();
            let (mut slow, mut slow_of_some, mut some) = (Deepest::default(), Deepest::default(), Vec::new());
            let _ = meeting_primitives(a, b, scratch, &mut |i, j| {
                let found = with_primitives([a, b], [i, j], of_common);
                slow.take([i, j], found.depth, found);
                if (i + j) % 3 == 0 {
                    slow_of_some.take([i, j], found.depth, found);
                    some.push([i, j]);
                }
                meet += 1;
                ControlFlow::Continue(())
            });
            some.sort_unstable();
            let fast = table::penetration(a, b, scratch);
            let is_among = |pair| some.binary_search(&pair).is_ok();
            let fast_of_some = of_deepest([a, b], is_among, scratch).map(|(_, found)| found);
            for (fast, slow) in [(fast, slow), (fast_of_some, slow_of_some)] {
                let slow = slow.found();
                if matches!(other.class(), Class::Convex(_)) {
                    assert_eq!(fast, slow, "round {round}");
                } else {
                    let depths = [fast, slow].map(|found| found.map_or(-1.0, |found| found.depth));
                    assert!((depths[0] - depths[1]).abs() < 1e-12, "round {round}: {depths:?}");
                }
            }
            pairs += usize::from(fast.is_some());
        }
        println!("{pairs} of 240 pairs meet, in {meet} pairs of primitives");
        assert!(pairs > 120 && meet > 10_000);
    }

    /// Law: of primitives that are equally deep those of the least numbers are told, whatever the order of the tree: in a box, and in another surface.
    #[test]
    fn of_equals_the_least_numbers_are_told() {
        let seed = 82;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let (mut equals, cases) = (0, 60);
        for case in 0..cases {
            // All coordinates are multiples of 1/64: what is equal is so to the bit.
            let side = 9;
            let vertices: Vec<DVec3> = (0..side * side)
                .map(|i| DVec3::new(f64::from(i % side), f64::from(i / side), 0.0) * 0.25)
                .collect();
            let mut triangles = grid(side);
            triangles.shuffle(&mut rng);
            let ground = Shape::mesh(vertices, triangles).unwrap();
            let lift = DVec3::Z * f64::from(rng.random_range(0..3)) / 16.0;
            let other = if case % 2 == 0 {
                Shape::cuboid([1.0, 1.0, 0.25]).unwrap()
            } else {
                // Teeth that end in the middle of triangles of the ground.
                let tooth = |i: u32| {
                    let tip =
                        DVec3::new(f64::from(i % 4), f64::from(i / 4), -0.75) * 0.25 + DVec3::splat(0.0625);
                    [tip, tip + DVec3::new(0.125, 0.0, 1.0), tip + DVec3::new(0.0, 0.125, 1.0)]
                };
                let mut teeth: Vec<u32> = (0..16).collect();
                teeth.shuffle(&mut rng);
                let triangles: Vec<[u32; 3]> = (0..16).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
                Shape::mesh(teeth.into_iter().flat_map(tooth).collect::<Vec<_>>(), triangles).unwrap()
            };
            let at_other = DAffine3::from_translation(DVec3::new(0.5, 0.5, -0.0625) + lift);
            let mut pair = [
                Placed { shape: &ground, placement: &DAffine3::IDENTITY },
                Placed { shape: &other, placement: &at_other },
            ];
            if case % 4 > 1 {
                pair.reverse();
            }
            let scratch = &mut Scratch::default();
            let mut all = Vec::new();
            let _ = meeting_primitives(pair[0], pair[1], scratch, &mut |i, j| {
                all.push((with_primitives(pair, [i, j], of_common).depth, [i, j]));
                ControlFlow::Continue(())
            });
            let greatest = all.iter().map(|(depth, _)| *depth).fold(0.0, f64::max);
            let deepest: Vec<_> =
                all.iter().filter(|(depth, _)| *depth == greatest).map(|(_, pair)| *pair).collect();
            let found = of_deepest(pair, |_| true, scratch).map(|(pair, _)| pair);
            assert_eq!(found, deepest.iter().min().copied(), "case {case}: {all:?}");
            equals += usize::from(deepest.len() > 4);
        }
        println!("in {equals} of {cases} cases more than four are equally deep");
        assert!(10 * equals > 7 * cases);
    }
}
