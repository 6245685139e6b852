//! A complex shape against a convex one: the tree is walked with the convex shape's box (thesis, section 6.3.4).
//!
//! What parts one primitive from the convex shape mostly parts its neighbours too. So an axis is kept, and leaves are tested
//! along it, eight primitives at a time, before GJK looks at what remains.

use std::ops::{ControlFlow, RangeInclusive};

use fearless_simd::Simd;
use glam::{DAffine3, DVec3};
use solid_convex::simd::level;
use solid_convex::{Closest, Outcome, Support, Witness, gjk};

use super::containment::PlacedSolid;
use super::frame::{Frame, ROUNDINGS, Stretch};
use super::reach::convex_bounds;
use super::row::{Near, Row, distances_of_point, exceed};
use super::table::{PlacedComplex, PlacedConvex};
use super::{Relation, Scratch};
use crate::bounds::Aabb;
use crate::shape::Complex;
use crate::tree::{Leaves, NearLeaves, bits};

/// A gap in the common frame, where the size of the data is from 1 to 2, at which GJK calls shapes separate without fail: four
/// times the one at which it does so by a cached axis.
const CLEARLY_APART: f64 = 1.0 / (1u64 << 24) as f64;

/// Vectors whose length comes out so long have squares that neither overflow nor lose digits to underflow.
const LENGTHS: RangeInclusive<f64> = 1e-145..=1e145;

/// A height along a direction is off by the slack of each coordinate, with that of the point it is measured from.
const SLACKS: f64 = 4.0;

pub(super) fn intersection(complex: PlacedComplex, convex: PlacedConvex, scratch: &mut Scratch) -> Relation {
    let mut first = None;
    let mut found = |_, witness| {
        first = Some(witness);
        ControlFlow::Break(())
    };
    let _ = meeting_primitives(complex, convex, scratch, &mut found);
    let common = first.or_else(|| {
        let (_, frame) = convex_in_complex(complex, convex);
        contained(complex.0, convex.0, &frame, scratch)
    });
    common.map_or(Relation::Separated { axis: None }, Relation::Common)
}

/// Calls `found` with the primitives that meet the convex shape, and a common point: all of them unless it breaks off.
pub(super) fn meeting_primitives(
    complex: PlacedComplex,
    convex: PlacedConvex,
    scratch: &mut Scratch,
    found: &mut dyn FnMut(u32, Witness) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let (query, frame) = convex_in_complex(complex, convex);
    let Scratch { traversal, row, primitive_tests, .. } = scratch;
    row.clear();
    let shadow = Shadow::new(convex.0, &frame, CLEARLY_APART);
    let mut meeting =
        Meeting { complex, convex, query, map: frame.common[0], shadow, row, primitive_tests, found };
    complex.0.tree().overlapping_on(level(), &query, traversal, &mut meeting)
}

/// The convex shape in the common frame.
struct Shadow<'s> {
    shape: &'s dyn Support,
    map: DAffine3,
    bounds: Aabb,
    /// What tells the primitives looked at last from the shape, pointing to them; at first none.
    axis: DVec3,
    /// The greatest coordinate of the shape along it.
    greatest: f64,
}

impl<'s> Shadow<'s> {
    /// With bounds grown by a margin.
    fn new(shape: &'s dyn Support, frame: &Frame, margin: f64) -> Self {
        let map = frame.common[1];
        let Aabb { min, max } = convex_bounds(shape, &map.matrix3);
        let bounds = Aabb::new(min + map.translation, max + map.translation).inflated(margin);
        Shadow { shape, map, bounds, axis: DVec3::ZERO, greatest: 0.0 }
    }

    /// Takes another axis.
    fn turn(&mut self, axis: DVec3) {
        (self.axis, self.greatest) = (axis, self.reach(axis));
    }

    /// How far the shape reaches along a direction.
    fn reach(&self, direction: DVec3) -> f64 {
        let furthest = self.shape.support(self.map.matrix3.transpose() * direction);
        direction.dot(self.map.transform_point3(furthest))
    }

    /// Whether the triangle in a lane is apart from the shape by a gap, along the way from a point to what is closest to it.
    #[inline(always)]
    fn parted(&self, from: DVec3, known: &Near, lane: usize, gap: f64) -> bool {
        let way = -known.axis(lane);
        known.least[lane] - (self.reach(way) - way.dot(from)) >= gap
    }

    /// The lanes that are further along the axis than the shape, by a gap, as bits.
    #[inline(always)]
    fn beyond<S: Simd>(&self, simd: S, row: &Row, gap: f64) -> u32 {
        exceed(simd, &row.least_along(simd, self.axis), self.greatest + gap)
    }
}

/// Looks for primitives that meet the convex shape.
struct Meeting<'s> {
    complex: PlacedComplex<'s>,
    convex: PlacedConvex<'s>,
    query: Aabb,
    map: DAffine3,
    shadow: Shadow<'s>,
    row: &'s mut Row,
    primitive_tests: &'s mut u64,
    found: &'s mut dyn FnMut(u32, Witness) -> ControlFlow<()>,
}

impl Leaves<()> for Meeting<'_> {
    #[inline(always)]
    fn visit<S: Simd>(&mut self, simd: S, leaf: &[u32]) -> ControlFlow<()> {
        let (complex, at_complex) = self.complex;
        self.row.place(simd, complex, leaf, &self.map);
        let mut near = self.row.overlapping(simd, &self.shadow.bounds);
        if near != 0 {
            near &= !self.shadow.beyond(simd, self.row, CLEARLY_APART);
        }
        while let Some(lane) = bits(near).next() {
            near &= near - 1;
            let primitive = self.row.primitive(lane);
            if !complex.primitive_bounds(primitive).overlaps(&self.query) {
                continue;
            }
            *self.primitive_tests += 1;
            let points = complex.primitive_hull(primitive);
            match gjk::intersection(&points, at_complex, self.convex.0, self.convex.1) {
                Outcome::Separated { axis } => {
                    self.shadow.turn(axis);
                    near &= !self.shadow.beyond(simd, self.row, CLEARLY_APART);
                }
                Outcome::Touching(witness) | Outcome::Intersecting(witness) => {
                    (self.found)(primitive, witness)?;
                }
            }
        }
        ControlFlow::Continue(())
    }
}

pub(super) fn closest_within(
    complex: PlacedComplex,
    convex: PlacedConvex,
    bound: f64,
    scratch: &mut Scratch,
) -> Option<Closest> {
    let (query, frame) = convex_in_complex(complex, convex);
    if let Some(points) = contained(complex.0, convex.0, &frame, scratch) {
        return Some(Closest { distance: 0.0, points });
    }
    let Scratch { traversal, row, primitive_tests, .. } = scratch;
    row.clear();
    let [of_complex, _] = &frame.stretch;
    let metric = of_complex.metric(&Stretch::NONE);
    // The best distance so far is kept in the common frame, as the bounds are.
    let mut best = frame.beyond(bound);
    let shadow = Shadow::new(convex.0, &frame, ROUNDINGS);
    let from = [convex.0.center(); 2];
    let mut approach =
        Approach { complex, convex, frame: &frame, shadow, from, row, primitive_tests, answer: None };
    complex.0.tree().nearest_on(level(), &query, &metric, &mut best, traversal, &mut approach);
    approach.answer.filter(|closest| closest.distance <= bound)
}

/// Looks for the primitive closest to the convex shape.
struct Approach<'s> {
    complex: PlacedComplex<'s>,
    convex: PlacedConvex<'s>,
    frame: &'s Frame,
    /// Its axis is from the closest point of the convex shape to that of the complex one so far.
    shadow: Shadow<'s>,
    /// Points of the convex shape, in its space, from which to look: the way to what is closest to one of them is a direction
    /// along which the shapes may be far apart. The first is its centre, the second one near to the closest so far.
    from: [DVec3; 2],
    row: &'s mut Row,
    primitive_tests: &'s mut u64,
    answer: Option<Closest>,
}

impl Approach<'_> {
    /// How far apart, in the common frame, the convex shape and a local box are at least, along the way from a point of the
    /// shape to the box. Below zero they may meet; infinitely so when the point is in the box.
    #[inline(always)]
    fn gap(&self, from: DVec3, bounds: &Aabb) -> f64 {
        let Frame { relative, stretch: [of_complex, _], .. } = self.frame;
        let point = relative.b_to_a.transform_point3(from);
        let way = point.clamp(bounds.min, bounds.max) - point;
        let length = way.length();
        if !LENGTHS.contains(&length) {
            return f64::NEG_INFINITY; // in the box, or nothing is known
        }
        let furthest = self.convex.0.support(relative.b_to_a.matrix3.transpose() * way);
        // Relative to the point, so that little is cancelled.
        let reach = way.dot(relative.b_to_a.matrix3 * (furthest - from)) / length;
        (length - reach - SLACKS * relative.slack_in_a) * of_complex.least
    }
}

impl NearLeaves for Approach<'_> {
    #[inline(always)]
    fn raise(&self, bounds: &Aabb, bound: f64, best: f64) -> f64 {
        let [center, nearest] = self.from;
        let gap = self.gap(center, bounds);
        if bound == 0.0 && gap <= 0.0 {
            return gap;
        }
        let raised = if gap > bound { gap } else { bound };
        if raised >= best || nearest == center { raised } else { raised.max(self.gap(nearest, bounds)) }
    }

    #[inline(always)]
    fn visit<S: Simd>(&mut self, simd: S, leaf: &[u32], best: &mut f64) {
        let (complex, at_complex) = self.complex;
        let [from_complex, from_convex] = &self.frame.common;
        self.row.place(simd, complex, leaf, from_complex);
        let mut near = self.row.nearer(simd, &self.shadow.bounds, *best * *best);
        if near != 0 {
            near &= !self.shadow.beyond(simd, self.row, *best);
        }
        if near == 0 {
            return;
        }
        let [center, nearest] = self.from.map(|point| from_convex.transform_point3(point));
        let of_center = distances_of_point(simd, center, self.row);
        let mut of_nearest = None;
        while let Some(lane) = of_center.nearest(near) {
            near &= !(1 << lane);
            if self.row.triangles() >> lane & 1 == 1 {
                if self.shadow.parted(center, &of_center, lane, *best) {
                    continue;
                }
                let row = &*self.row;
                if nearest != center {
                    let known = of_nearest.get_or_insert_with(
                        #[inline(always)]
                        || distances_of_point(simd, nearest, row),
                    );
                    if self.shadow.parted(nearest, known, lane, *best) {
                        continue;
                    }
                }
            }
            *self.primitive_tests += 1;
            let points = complex.primitive_hull(self.row.primitive(lane));
            let closest = gjk::closest_points(&points, at_complex, self.convex.0, self.convex.1);
            let distance = closest.distance * self.frame.scale;
            if distance < *best {
                *best = distance;
                let on_complex = from_complex.transform_point3(closest.points.on_a);
                let on_convex = from_convex.transform_point3(closest.points.on_b);
                let axis = (on_complex - on_convex).normalize_or_zero();
                self.shadow.turn(axis);
                // Of what is round, a point of the core: of a ball this is the centre, which tells all.
                let shape = self.convex.0;
                self.from[1] = if shape.core_radius() > 0.0 {
                    shape.core_support(from_convex.matrix3.transpose() * axis)
                } else {
                    closest.points.on_b
                };
                self.answer = Some(closest);
                if distance == 0.0 {
                    return;
                }
                near &= !self.shadow.beyond(simd, self.row, *best);
            }
        }
    }
}

/// The centre of the convex shape, when it is in a solid. (A part of the solid inside the convex shape meets it.)
fn contained(
    complex: &Complex,
    convex: &dyn Support,
    frame: &Frame,
    scratch: &mut Scratch,
) -> Option<Witness> {
    let [from_complex, from_convex] = &frame.common;
    let (solid, center) = (PlacedSolid::new(complex, from_complex)?, convex.center());
    let inside = solid.contains(from_convex.transform_point3(center), scratch);
    inside.then(|| Witness { on_a: frame.relative.b_to_a.transform_point3(center), on_b: center })
}

/// A box around the convex shape in the space of the complex one, grown by the error of the map.
pub(super) fn convex_in_complex(complex: PlacedComplex, convex: PlacedConvex) -> (Aabb, Frame) {
    let frame = Frame::new(complex.1, complex.0.reach(), convex.1, convex.0.reach());
    let map = frame.relative.b_to_a;
    let bounds = convex_bounds(convex.0, &map.matrix3);
    let query = Aabb::new(bounds.min + map.translation, bounds.max + map.translation);
    (query.inflated(frame.relative.slack_in_a), frame)
}
