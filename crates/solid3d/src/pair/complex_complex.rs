//! A complex shape against another: two trees are walked together (thesis, sections 5.2.3 and 5.2.4).

use std::ops::ControlFlow;

use fearless_simd::Simd;
use glam::{DAffine3, DVec3};
use solid_convex::simd::{dispatch, each, level};
use solid_convex::{Closest, Witness, gjk};

use super::containment::{PlacedSolid, part_inside};
use super::crossing_point::{crossing_point, weighted};
use super::far;
use super::frame::Frame;
use super::leaf_pair::{LeafTest, MeetingLeaves, transposed};
use super::row::{CONFIRMED, Near, Rows, distances, exceed};
use super::scratch::PlacedPrimitive;
use super::table::PlacedComplex;
use super::triangle_triangle::Triangle;
use super::{Relation, Scratch};
use crate::bounds::Aabb;
use crate::shape::Complex;
use crate::tree::{Facing, LeafPairs, NearLeafPairs, bits, nearest_pairs_on, pairs_on};

/// Whether they intersect: as [`intersection`] says.
pub(super) fn intersects(a: PlacedComplex, b: PlacedComplex, scratch: &mut Scratch) -> bool {
    let mut found = |_: &MeetingLeaves| ControlFlow::Break(());
    meeting_leaves(&frame(a, b), a, b, true, scratch, &mut found).is_break()
        || contained(a, b, scratch).is_some()
}

pub(super) fn intersection(a: PlacedComplex, b: PlacedComplex, scratch: &mut Scratch) -> Relation {
    let mut first = None;
    let mut found = |leaves: &MeetingLeaves| {
        first = leaves.pairs().next();
        ControlFlow::Break(())
    };
    let frame = frame(a, b);
    let _ = meeting_leaves(&frame, a, b, true, scratch, &mut found);
    match first {
        Some((i, j)) => Relation::Common(common_point(a, i, b, j, &frame.common)),
        None => contained(a, b, scratch).map_or(Relation::Separated { axis: None }, Relation::Common),
    }
}

/// Calls `found` with the pairs of primitives that meet, all of them unless it breaks off. Cost: follows the number of pairs of
/// primitives whose boxes overlap.
pub(super) fn meeting_pairs(
    a: PlacedComplex,
    b: PlacedComplex,
    scratch: &mut Scratch,
    found: &mut dyn FnMut(u32, u32) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let mut found = |leaves: &MeetingLeaves| leaves.pairs().try_for_each(|(i, j)| found(i, j));
    meeting_leaves(&frame(a, b), a, b, false, scratch, &mut found)
}

/// The same by pairs of leaves in which some meet. `wants_first`: the first pair of primitives is all that is wanted of each.
pub(super) fn meeting_leaves(
    frame: &Frame,
    a: PlacedComplex,
    b: PlacedComplex,
    wants_first: bool,
    scratch: &mut Scratch,
    found: &mut dyn FnMut(&MeetingLeaves) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let Scratch { traversal, rows, primitive_tests, .. } = scratch;
    let (relative, common) = (dispatch!(_simd => frame.relative()), &frame.common);
    rows.iter_mut().for_each(Rows::clear);
    let mut meeting = Meeting { a, b, common, wants_first, rows, primitive_tests, found };
    let slabs = || Some([a.0.lasting_slabs()?, b.0.lasting_slabs()?]);
    pairs_on(level(), a.0.tree(), b.0.tree(), &relative, &slabs, traversal, &mut meeting)
}

/// Looks for primitives that meet in pairs of leaves.
struct Meeting<'s> {
    a: PlacedComplex<'s>,
    b: PlacedComplex<'s>,
    common: &'s [DAffine3; 2],
    wants_first: bool,
    rows: &'s mut [Rows; 2],
    primitive_tests: &'s mut u64,
    found: &'s mut dyn FnMut(&MeetingLeaves) -> ControlFlow<()>,
}

impl LeafPairs<()> for Meeting<'_> {
    fn wants_first(&self) -> bool {
        self.wants_first
    }

    #[inline(always)]
    fn visit<S: Simd>(&mut self, simd: S, leaf_a: &[u32], leaf_b: &[u32]) -> ControlFlow<()> {
        let [rows_a, rows_b] = &mut *self.rows;
        let in_a = rows_a.place(simd, self.a.0, leaf_a, &self.common[0]);
        let in_b = rows_b.place(simd, self.b.0, leaf_b, &self.common[1]);
        let of_a = in_a.overlapping(simd, in_b.union());
        let of_b = in_b.overlapping(simd, in_a.union());
        if of_a == 0 || of_b == 0 {
            return ControlFlow::Continue(());
        }
        in_a.measure(simd);
        in_b.measure(simd);
        let (in_a, in_b) = (&*in_a, &*in_b);
        // In the order of the leaf of which fewer are near: one by one, and with each the others.
        let swapped = of_b.count_ones() < of_a.count_ones();
        let [(ones, of_ones), (others, of_others)] =
            if swapped { [(in_b, of_b), (in_a, of_a)] } else { [(in_a, of_a), (in_b, of_b)] };
        let of_others = of_others & others.level_with(simd, ones);
        if of_others == 0 {
            return ControlFlow::Continue(());
        }
        let of_ones = of_ones & ones.level_with(simd, others);
        // Of those that are left, the fewer are tested one by one, unless the first in order is all that is wanted.
        let turned = !self.wants_first && of_others.count_ones() < of_ones.count_ones();
        let lanes = [(ones, of_ones), (others, of_others)];
        let [tested, against] = if turned { [lanes[1], lanes[0]] } else { lanes };
        let test =
            LeafTest { a: self.a, b: self.b, swapped: swapped != turned, wants_first: self.wants_first };
        let meeting = test.meeting(simd, tested, against, self.primitive_tests);
        let meeting = if turned { transposed(meeting) } else { meeting };
        if meeting == 0 {
            return ControlFlow::Continue(());
        }
        (self.found)(&MeetingLeaves { ones, others, swapped, meeting })
    }
}

/// A point of a part of one that is inside the other, a solid; for surfaces that do not meet.
fn contained(a: PlacedComplex, b: PlacedComplex, scratch: &mut Scratch) -> Option<Witness> {
    if !a.0.is_solid() && !b.0.is_solid() {
        return None;
    }
    let frame = frame(a, b);
    let (relative, [from_a, from_b]) = (frame.relative(), &frame.common);
    let b_in_a = PlacedSolid::new(a.0, from_a).and_then(|a| part_inside(&a, b.0, from_b, scratch));
    if let Some(on_b) = b_in_a {
        return Some(Witness { on_a: relative.b_to_a.transform_point3(on_b), on_b });
    }
    let on_a = PlacedSolid::new(b.0, from_b).and_then(|b| part_inside(&b, a.0, from_a, scratch))?;
    Some(Witness { on_a, on_b: relative.a_to_b.transform_point3(on_a) })
}

pub(super) fn closest_within(
    a: PlacedComplex,
    b: PlacedComplex,
    bound: f64,
    scratch: &mut Scratch,
) -> Option<Closest> {
    // Whether they intersect is decided as everywhere else; the distance is 0 then.
    if let Relation::Common(points) = intersection(a, b, scratch) {
        return Some(Closest { distance: 0.0, points });
    }
    let closest = match far::complex_complex(a, b) {
        Some(closest) => closest,
        None => {
            let (i, j) = closest_pair(a, b, bound, scratch)?;
            closest_of(a, i, b, j)
        }
    };
    (closest.distance <= bound).then_some(closest)
}

/// The primitives of two complex shapes that are closest to each other, up to [`CONFIRMED`]; of shapes that are farther apart
/// than a bound, `None` or some pair.
fn closest_pair(a: PlacedComplex, b: PlacedComplex, bound: f64, scratch: &mut Scratch) -> Option<(u32, u32)> {
    let frame = frame(a, b);
    // The best distance so far is kept in the common frame, as the bounds are.
    let mut best = frame.beyond(bound);
    let [of_a, of_b] = frame.stretch();
    let relative = frame.relative();
    let Frame { common, scale, .. } = frame;
    let Scratch { traversal, rows, primitive_tests, .. } = scratch;
    rows.iter_mut().for_each(Rows::clear);
    let metric = of_a.metric(&of_b);
    let mut approach = Approach {
        a,
        b,
        common: &common,
        scale,
        rows,
        primitive_tests,
        axis: DVec3::ZERO,
        answer: None,
        visits: 0,
        asks_at: VISITS_MANY.max((a.0.primitive_count() + b.0.primitive_count()) / PRIMITIVES_A_VISIT),
    };
    let facing = Facing { slabs: [a.0.slabs(), b.0.slabs()], placements: common };
    nearest_pairs_on(
        level(),
        a.0.tree(),
        b.0.tree(),
        &relative,
        &metric,
        Some(&facing),
        &mut best,
        traversal,
        &mut approach,
    );
    approach.answer
}

/// Looks for the closest primitives in pairs of leaves.
struct Approach<'s> {
    a: PlacedComplex<'s>,
    b: PlacedComplex<'s>,
    common: &'s [DAffine3; 2],
    scale: f64,
    rows: &'s mut [Rows; 2],
    primitive_tests: &'s mut u64,
    /// From the closest point of B to that of A so far: what is further apart along it is no nearer.
    axis: DVec3,
    answer: Option<(u32, u32)>,
    visits: usize,
    /// After so many visits it is asked whether there is anything left to find.
    asks_at: usize,
}

/// That is asked after so many pairs of leaves, or one for so many primitives, and each time that they have doubled: where all of a shape is as far
/// along a direction, the answer takes a look at all of it, as long as a few hundred visits of 10,000 triangles.
const VISITS_MANY: usize = 64;
const PRIMITIVES_A_VISIT: usize = 64;

impl Approach<'_> {
    /// Whether both shapes as wholes are as far apart, along the axis, as the closest primitives so far: then none are closer. Of faces that face each other, as of
    /// two walls, all primitives are as close, and bounds in single precision stay a little below that.
    #[inline(never)]
    fn is_least(&self, best: f64) -> bool {
        let lowest = |(complex, _): PlacedComplex, common: &DAffine3, axis: DVec3| {
            let furthest = complex.furthest(common.matrix3.transpose() * -axis);
            axis.dot(common.transform_point3(furthest))
        };
        let [from_a, from_b] = self.common;
        lowest(self.a, from_a, self.axis) + lowest(self.b, from_b, -self.axis) >= best - CONFIRMED
    }
}

impl NearLeafPairs for Approach<'_> {
    #[inline(always)]
    fn axis(&self) -> DVec3 {
        self.axis
    }

    #[inline(always)]
    fn visit<S: Simd>(&mut self, simd: S, leaf_a: &[u32], leaf_b: &[u32], best: &mut f64) {
        self.visits += 1;
        if self.visits == self.asks_at {
            if self.is_least(*best) {
                *best = 0.0;
                return;
            }
            self.asks_at *= 2;
        }
        let [rows_a, rows_b] = &mut *self.rows;
        let in_a = &*rows_a.place(simd, self.a.0, leaf_a, &self.common[0]);
        let in_b = &*rows_b.place(simd, self.b.0, leaf_b, &self.common[1]);
        let of_a = in_a.nearer(simd, in_b.union(), *best * *best);
        let of_b = in_b.nearer(simd, in_a.union(), *best * *best);
        // As where they meet: those of which fewer are near, one by one.
        let swapped = of_b.count_ones() < of_a.count_ones();
        let [(ones, of_ones), (others, of_others)] =
            if swapped { [(in_b, of_b), (in_a, of_a)] } else { [(in_a, of_a), (in_b, of_b)] };
        if of_others == 0 {
            return;
        }
        // The axis points to what of A is nearest.
        let to_ones = if swapped { -1.0 } else { 1.0 };
        let least_of_ones = ones.least_along(simd, self.axis * to_ones);
        let least_of_others = others.least_along(simd, self.axis * -to_ones);
        for i in bits(of_ones) {
            let along = exceed(simd, &least_of_others, *best - least_of_ones[i]);
            let near = others.nearer(simd, &ones.bounds(i), *best * *best) & of_others & !along;
            if near == 0 {
                continue;
            }
            *self.primitive_tests += u64::from(near.count_ones());
            let x = ones.triangle(i);
            let is_triangle = ones.triangles() >> i & 1 == 1;
            let known = if is_triangle { near & others.triangles() } else { 0 };
            let known_of = if known != 0 { distances(simd, &x, others, known) } else { Near::UNKNOWN };
            let Near { distance, least, .. } = &known_of;
            for j in bits(near) {
                let is_known = known >> j & 1 == 1;
                if is_known && least[j] >= *best {
                    continue;
                }
                let (one, other) = (ones.primitive(i), others.primitive(j));
                let pair = if swapped { (other, one) } else { (one, other) };
                if is_known && distance[j] - least[j] <= CONFIRMED {
                    if distance[j] < *best {
                        *best = distance[j];
                        self.answer = Some(pair);
                        self.axis = known_of.axis(j) * to_ones;
                    }
                } else {
                    let closest = closest_of(self.a, pair.0, self.b, pair.1);
                    if closest.distance * self.scale < *best {
                        *best = closest.distance * self.scale;
                        self.answer = Some(pair);
                        let [from_a, from_b] = self.common;
                        let on_a = from_a.transform_point3(closest.points.on_a);
                        let on_b = from_b.transform_point3(closest.points.on_b);
                        self.axis = (on_a - on_b).normalize_or_zero();
                    }
                }
            }
        }
    }
}

pub(super) fn frame(a: PlacedComplex, b: PlacedComplex) -> Frame {
    dispatch!(_simd => Frame::new(a.1, a.0.reach(), b.1, b.0.reach()))
}

/// The boxes of the primitives of a leaf in the common frame.
pub(super) fn place(complex: &Complex, leaf: &[u32], map: &DAffine3, placed: &mut Vec<PlacedPrimitive>) {
    placed.clear();
    placed.extend(leaf.iter().map(|&primitive| {
        let bounds = Aabb::of_points(complex.points_of(primitive).map(|point| map.transform_point3(point)));
        PlacedPrimitive { primitive, bounds }
    }));
}

/// A common point of two primitives that meet.
fn common_point(a: PlacedComplex, i: u32, b: PlacedComplex, j: u32, common: &[DAffine3; 2]) -> Witness {
    let (Some(x), Some(y)) = (corners(a.0, i), corners(b.0, j)) else {
        return closest_of(a, i, b, j).points;
    };
    let [from_a, from_b] = common;
    let placed_x = each(x, |corner| from_a.transform_point3(corner));
    let placed_y = each(y, |corner| from_b.transform_point3(corner));
    match crossing_point(&placed_x, &placed_y) {
        Some([of_x, of_y]) => Witness { on_a: weighted(&x, &of_x), on_b: weighted(&y, &of_y) },
        None => closest_of(a, i, b, j).points,
    }
}

/// The corners of a primitive that is a triangle.
pub(super) fn corners(complex: &Complex, primitive: u32) -> Option<Triangle> {
    match *complex.primitive(primitive) {
        [i, j, k] => Some([i, j, k].map(|index| complex.vertices()[index as usize])),
        _ => None,
    }
}

fn closest_of(a: PlacedComplex, i: u32, b: PlacedComplex, j: u32) -> Closest {
    gjk::closest_points(&a.0.primitive_hull(i), a.1, &b.0.primitive_hull(j), b.1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Shape;
    use crate::pair::{Placed, closest};
    use rand::Rng;
    use solid_oracle::generate::{grid, seeded};

    /// Law: of two flat meshes that face each other, of which all triangles are as close, few pairs of leaves are looked at, however far apart they are.
    #[test]
    fn faces_that_face_each_other_are_soon_told() {
        const SIDE: u32 = 40;
        let mut rng = seeded(2130);
        let corner = |i: u32| DVec3::new(f64::from(i % SIDE), 0.0, f64::from(i / SIDE)) / f64::from(SIDE);
        let plate = Shape::mesh((0..SIDE * SIDE).map(corner).collect::<Vec<_>>(), grid(SIDE)).unwrap();
        let mut most = 0;
        for case in 0..60 {
            let gap = 10f64.powi(case % 6 - 3);
            let turned = DAffine3::from_axis_angle(DVec3::ONE.normalize(), rng.random_range(0.0..3.0));
            let [x, z, angle] = [0; 3].map(|_| rng.random_range(-0.2..0.2));
            let above =
                turned * DAffine3::from_translation(DVec3::new(x, gap, z)) * DAffine3::from_rotation_y(angle);
            let [low, high] = [&turned, &above].map(|placement| Placed { shape: &plate, placement });
            let mut scratch = Scratch::default();
            let found = closest(low, high, &mut scratch).distance;
            assert!((found - gap).abs() < 1e-12 * (2.0 + gap), "case {case}: {found} {gap}");
            most = most.max(scratch.traversal.counters.leaf_visits);
        }
        // Of three thousand triangles each.
        assert!(most <= 130, "{most}");
    }
}
