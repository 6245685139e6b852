//! A complex shape against a convex one: the tree is walked from the convex shape, nearest first (thesis, section 6.3.4).
//!
//! Balls, capsules and boxes are held against eight triangles at a time in closed form ([`direct`](super::direct)), and what is clear
//! is not asked of GJK; where any triangle that meets will do, images of triangles come first ([`glance`](super::glance)). Of other
//! shapes, what parts one primitive mostly parts its neighbours too: so an axis is kept, and leaves are tested along it before GJK looks
//! at what remains. Where the distance is sought, [`gaps`](super::gaps) bounds that of the boxes of a node and of the images of triangles, all
//! eight at a time, and only what may be nearest is placed and measured.

use std::cell::OnceCell;
use std::ops::ControlFlow;

use fearless_simd::Simd;
use glam::{DAffine3, DVec3};
use solid_convex::simd::level;
use solid_convex::{Closest, Outcome, Support, Witness, gjk};

use super::containment::PlacedSolid;
use super::direct::{Direct, Round};
use super::frame::{Frame, ROUNDINGS, Stretch};
use super::gaps::Gaps;
use super::glance::Glance;
use super::reach::convex_bounds;
use super::row::{CONFIRMED, Near, Row, Verdict, distances_of_core, exceed};
use super::table::{PlacedComplex, PlacedConvex};
use super::{Relation, Scratch};
use crate::bounds::Aabb;
use crate::tree::{Around, Boxes, LEAF_SIZE, Leaf, LeafImages, NearLeaves, bits};

/// A gap in the common frame, where the size of the data is from 1 to 2, at which GJK calls shapes separate without fail: four
/// times the one at which it does so by a cached axis.
pub(super) const CLEARLY_APART: f64 = 1.0 / (1u64 << 24) as f64;

/// Whether they intersect: as [`intersection`] says.
pub(super) fn intersects(complex: PlacedComplex, convex: PlacedConvex, scratch: &mut Scratch) -> bool {
    let mut found = |_, _| ControlFlow::Break(());
    meeting_primitives_in(complex, convex, true, scratch, &mut found).is_break()
        || contained(complex, convex, scratch).is_some()
}

pub(super) fn intersection(complex: PlacedComplex, convex: PlacedConvex, scratch: &mut Scratch) -> Relation {
    let mut first = None;
    let mut found = |primitive, witness: Option<Witness>| {
        first = Some((primitive, witness));
        ControlFlow::Break(())
    };
    let _ = meeting_primitives(complex, convex, scratch, &mut found);
    let common = match first {
        Some((primitive, witness)) => {
            Some(witness.unwrap_or_else(|| closest_to(complex, primitive, convex).points))
        }
        None => contained(complex, convex, scratch),
    };
    common.map_or(Relation::Separated { axis: None }, Relation::Common)
}

/// Calls `found` with the primitives that meet the convex shape, and a common point where GJK was asked: all of them unless it
/// breaks off.
pub(super) fn meeting_primitives(
    complex: PlacedComplex,
    convex: PlacedConvex,
    scratch: &mut Scratch,
    found: &mut dyn FnMut(u32, Option<Witness>) -> ControlFlow<()>,
) -> ControlFlow<()> {
    meeting_primitives_in(complex, convex, false, scratch, found)
}

/// The same; `wants_any`: whichever of them is found first, and without a point.
fn meeting_primitives_in(
    complex: PlacedComplex,
    convex: PlacedConvex,
    wants_any: bool,
    scratch: &mut Scratch,
    found: &mut dyn FnMut(u32, Option<Witness>) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let frame = frame(complex, convex);
    let Scratch { traversal, row, primitive_tests, .. } = scratch;
    row.iter_mut().for_each(Row::clear);
    let direct = Direct::new(convex.0, &frame, CLEARLY_APART);
    let shadow = Shadow::new(convex.0, &frame, &direct, CLEARLY_APART);
    let map = match &direct {
        Direct::Cube(cube) => cube.map,
        _ => frame.common[0],
    };
    let around = shadow.around(&direct);
    let metric = frame.stretch_of_a().metric(&Stretch::NONE);
    let end = ControlFlow::Continue(());
    // Where all that meet are wanted, most leaves that are visited hold some.
    let glance = if wants_any {
        let glance = Glance::new(&direct, &map, CLEARLY_APART, complex.0.tree().normal());
        glance.zip(complex.0.images())
    } else {
        None
    };
    let mut meeting =
        Meeting { complex, convex, direct, map, shadow, glance, row, primitive_tests, found, end };
    // What is clearly apart does not meet; nothing else is sought.
    let mut limit = CLEARLY_APART;
    complex.0.tree().nearest_on(level(), around.as_slice(), &metric, &mut limit, traversal, &mut meeting);
    meeting.end
}

/// The convex shape in the common frame.
struct Shadow<'s> {
    shape: &'s dyn Support,
    frame: &'s Frame,
    map: DAffine3,
    bounds: Aabb,
    /// A box around it in the space of the complex one, found when first asked for.
    in_complex: OnceCell<Aabb>,
    /// What tells the primitives looked at last from the shape, pointing to them; at first none.
    axis: DVec3,
    /// The greatest coordinate of the shape along it.
    greatest: f64,
}

impl<'s> Shadow<'s> {
    /// With bounds grown by a margin.
    fn new(shape: &'s dyn Support, frame: &'s Frame, direct: &Direct, margin: f64) -> Self {
        let map = frame.common[1];
        let bounds = match direct {
            Direct::Round(round) => round.bounds(),
            _ => {
                let Aabb { min, max } = convex_bounds(shape, &map.matrix3);
                Aabb::new(min + map.translation, max + map.translation)
            }
        };
        Shadow {
            shape,
            frame,
            map,
            bounds: bounds.inflated(margin),
            in_complex: OnceCell::new(),
            axis: DVec3::ZERO,
            greatest: 0.0,
        }
    }

    /// A box around the shape in the space of the complex one.
    fn in_complex(&self) -> &Aabb {
        self.in_complex.get_or_init(|| bounds_in_complex(self.shape, self.frame))
    }

    /// Where the shape is, in the space of the complex one.
    fn around(&self, direct: &Direct) -> Places {
        let frame = self.frame;
        let in_complex = |point: DVec3| frame.b_to_a.transform_point3(point);
        if let Direct::Round(round) = direct {
            let bounds = Aabb::of_points(round.local_ends.map(in_complex));
            let bounds = bounds.inflated(frame.slack_in_a);
            return Places::One([Around { bounds, radius: round.radius }]);
        }
        let center = self.shape.center();
        let local = in_complex(center);
        let bounds = Aabb::new(local, local).inflated(frame.slack_in_a);
        let placed = self.map.transform_point3(center);
        let furthest = (self.bounds.max - placed).max(placed - self.bounds.min);
        Places::Two([
            Around { bounds: *self.in_complex(), radius: 0.0 },
            Around { bounds, radius: furthest.length() },
        ])
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

/// Where a convex shape is.
enum Places {
    One([Around; 1]),
    Two([Around; 2]),
}

impl Places {
    fn as_slice(&self) -> &[Around] {
        match self {
            Places::One(around) => around,
            Places::Two(around) => around,
        }
    }
}

/// Looks for primitives that meet the convex shape.
struct Meeting<'s> {
    complex: PlacedComplex<'s>,
    convex: PlacedConvex<'s>,
    direct: Direct,
    /// Where primitives are placed: in the common frame, or the space of a box.
    map: DAffine3,
    shadow: Shadow<'s>,
    /// What looks at images of triangles, where any that meets will do.
    glance: Option<(Glance, &'s LeafImages)>,
    row: &'s mut Option<Row>,
    primitive_tests: &'s mut u64,
    found: &'s mut dyn FnMut(u32, Option<Witness>) -> ControlFlow<()>,
    /// Whether `found` broke off.
    end: ControlFlow<()>,
}

impl NearLeaves for Meeting<'_> {
    #[inline(always)]
    fn prefetch(&self, leaf: &Leaf) {
        if let Some((_, images)) = &self.glance {
            images.prefetch(leaf);
        }
    }

    #[inline(always)]
    fn visit<S: Simd>(&mut self, simd: S, leaf: &Leaf, limit: &mut f64) {
        self.end = self.glance(simd, leaf).unwrap_or_else(
            #[inline(always)]
            || self.look(simd, leaf.primitives),
        );
        if self.end.is_break() {
            *limit = 0.0;
        }
    }
}

impl Meeting<'_> {
    /// Looks at the image of a leaf; `None` when that leaves something open.
    #[inline(always)]
    fn glance<S: Simd>(&mut self, simd: S, leaf: &Leaf) -> Option<ControlFlow<()>> {
        let (glance, images) = self.glance.as_ref()?;
        let Verdict { meet, apart } = glance.verdict(simd, &images.of(leaf));
        let lanes = leaf.lanes();
        let first = bits(meet & lanes).next();
        if first.is_none() && apart & lanes != lanes {
            return None;
        }
        *self.primitive_tests += u64::from(lanes.count_ones());
        Some(first.map_or(ControlFlow::Continue(()), |lane| (self.found)(leaf.primitives[lane], None)))
    }

    #[inline(always)]
    fn look<S: Simd>(&mut self, simd: S, leaf: &[u32]) -> ControlFlow<()> {
        let (complex, at_complex) = self.complex;
        let row = self.row.get_or_insert_default();
        row.place(simd, complex, leaf, &self.map);
        let bounds = match &self.direct {
            Direct::Cube(cube) => &cube.bounds(),
            _ => &self.shadow.bounds,
        };
        let mut near = row.overlapping(simd, bounds);
        if near == 0 {
            return ControlFlow::Continue(());
        }
        let triangles = near & row.triangles();
        let sure = match &self.direct {
            Direct::Round(round) => round.verdict(simd, row, triangles, CLEARLY_APART),
            Direct::Cube(cube) => cube.verdict(simd, row, triangles),
            Direct::None => Verdict { meet: 0, apart: self.shadow.beyond(simd, row, CLEARLY_APART) },
        };
        near &= !sure.apart;
        *self.primitive_tests += u64::from(near.count_ones());
        for lane in bits(near & sure.meet) {
            (self.found)(row.primitive(lane), None)?;
        }
        near &= !sure.meet;
        while let Some(lane) = bits(near).next() {
            near &= near - 1;
            let primitive = row.primitive(lane);
            if !complex.primitive_bounds(primitive).overlaps(self.shadow.in_complex()) {
                continue;
            }
            let points = complex.primitive_hull(primitive);
            match gjk::intersection(&points, at_complex, self.convex.0, self.convex.1) {
                Outcome::Separated { axis } => {
                    if matches!(self.direct, Direct::None) {
                        self.shadow.turn(axis);
                        near &= !self.shadow.beyond(simd, row, CLEARLY_APART);
                    }
                }
                Outcome::Touching(witness) | Outcome::Intersecting(witness) => {
                    (self.found)(primitive, Some(witness))?;
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
    if let Some(points) = contained(complex, convex, scratch) {
        return Some(Closest { distance: 0.0, points });
    }
    let frame = frame(complex, convex);
    let Scratch { traversal, row, primitive_tests, .. } = scratch;
    let row = row.get_or_insert_default();
    row.clear();
    let metric = frame.stretch_of_a().metric(&Stretch::NONE);
    // The best distance so far is kept in the common frame, as the bounds are.
    let mut best = frame.beyond(bound);
    // Of a box the distance has no closed form here.
    let direct = Direct::round(convex.0, &frame);
    let shadow = Shadow::new(convex.0, &frame, &direct, ROUNDINGS);
    let around = shadow.around(&direct);
    let from = [convex.0.center(); 2];
    let gaps = Gaps::new(convex.0, &direct, &frame, complex.0.tree().normal());
    let images = complex.0.images();
    let mut approach = Approach {
        complex,
        convex,
        frame: &frame,
        direct,
        shadow,
        gaps,
        images,
        from,
        row,
        primitive_tests,
        answer: None,
    };
    complex.0.tree().nearest_on(level(), around.as_slice(), &metric, &mut best, traversal, &mut approach);
    let (primitive, closest) = approach.answer?;
    let mut closest = closest.unwrap_or_else(|| closest_to(complex, primitive, convex));
    // Of primitives as near as each other, another may be the one that touches.
    let may_touch = closest.distance > 0.0 && closest.distance * frame.scale <= 2.0 * gjk::TOUCHING_ERROR;
    if may_touch && intersects(complex, convex, scratch) {
        closest.distance = 0.0;
    }
    (closest.distance <= bound).then_some(closest)
}

/// The closest points of a primitive and the convex shape.
fn closest_to(complex: PlacedComplex, primitive: u32, convex: PlacedConvex) -> Closest {
    gjk::closest_points(&complex.0.primitive_hull(primitive), complex.1, convex.0, convex.1)
}

/// Looks for the primitive closest to the convex shape.
struct Approach<'s> {
    complex: PlacedComplex<'s>,
    convex: PlacedConvex<'s>,
    frame: &'s Frame,
    direct: Direct,
    /// Its axis is from the closest point of the convex shape to that of the complex one so far.
    shadow: Shadow<'s>,
    /// What tells, by boxes and images, which primitives may be nearest.
    gaps: Option<Gaps>,
    images: Option<&'s LeafImages>,
    /// Points of the convex shape, in its space, from which to look: the way to what is closest to one of them is a direction
    /// along which the shapes may be far apart. The first is its centre, the second one near to the closest so far.
    from: [DVec3; 2],
    row: &'s mut Row,
    primitive_tests: &'s mut u64,
    /// The closest primitive so far; without points where the distance has a closed form.
    answer: Option<(u32, Option<Closest>)>,
}

impl NearLeaves for Approach<'_> {
    #[inline(always)]
    fn prefetch(&self, leaf: &Leaf) {
        if let Some(images) = self.images {
            images.prefetch(leaf);
        }
    }

    #[inline(always)]
    fn raise<S: Simd>(&self, simd: S, boxes: &Boxes, bounds: &mut [f64; LEAF_SIZE]) {
        if let Some(gaps) = self.gaps.as_ref().filter(|_| !matches!(self.direct, Direct::Round(_))) {
            gaps.raise(simd, boxes, bounds);
        }
    }

    #[inline(always)]
    fn visit<S: Simd>(&mut self, simd: S, leaf: &Leaf, best: &mut f64) {
        let (mut near, mut is_known) = (leaf.lanes(), false);
        if let (Some(gaps), Some(images)) = (&self.gaps, self.images) {
            near = gaps.prospects(simd, &images.of(leaf), near, *best + CLEARLY_APART, CLEARLY_APART);
            is_known = true;
            if near == 0 {
                return;
            }
        }
        self.row.place(simd, self.complex.0, leaf.primitives, &self.frame.common[0]);
        near &= self.row.nearer(simd, &self.shadow.bounds, *best * *best);
        if near == 0 {
            return;
        }
        match self.direct {
            Direct::Round(round) => self.look_from_core(simd, &round, near, best),
            _ => {
                let near = near & !self.shadow.beyond(simd, self.row, sought(*best));
                self.look(simd, near, is_known, best);
            }
        }
    }
}

/// The distance within which a nearer primitive is sought: one that is nearer by no more than [`CONFIRMED`] is not, since primitives that
/// share their closest point are many; but where the shapes may touch, every one.
fn sought(best: f64) -> f64 {
    if best > CLEARLY_APART { best - CONFIRMED } else { best }
}

impl Approach<'_> {
    /// Looks at some lanes of the row from the core of a round shape.
    #[inline(always)]
    fn look_from_core<S: Simd>(&mut self, simd: S, round: &Round, mut near: u32, best: &mut f64) {
        let known = round.distances(simd, self.row, near);
        *self.primitive_tests += u64::from(near.count_ones());
        while let Some(lane) = known.nearest(near) {
            near &= !(1 << lane);
            if self.row.triangles() >> lane & 1 == 1 {
                if known.least[lane] - round.radius >= sought(*best) {
                    continue;
                }
                let gap = known.distance[lane] - round.radius;
                if gap > CLEARLY_APART && known.distance[lane] - known.least[lane] <= CONFIRMED {
                    if gap < *best {
                        *best = gap;
                        self.answer = Some((self.row.primitive(lane), None));
                        if let Some(gaps) = &mut self.gaps {
                            gaps.turn(simd, self.from[0], -known.axis(lane));
                        }
                    }
                    continue;
                }
            }
            self.ask(lane, best);
            if *best == 0.0 {
                return;
            }
        }
    }

    /// Looks at some lanes of the row from points of the shape; `is_known`: it is known already that all of them may be nearest.
    #[inline(always)]
    fn look<S: Simd>(&mut self, simd: S, mut near: u32, is_known: bool, best: &mut f64) {
        if near == 0 {
            return;
        }
        let from_convex = &self.frame.common[1];
        let [center, nearest] = self.from.map(|point| from_convex.transform_point3(point));
        let of_center = distances_of_core(simd, &[center], self.row, near);
        let mut of_nearest = None;
        while let Some(lane) = of_center.nearest(near) {
            let left = near;
            near &= !(1 << lane);
            if !is_known && self.row.triangles() >> lane & 1 == 1 {
                if self.shadow.parted(center, &of_center, lane, sought(*best)) {
                    continue;
                }
                let row = &*self.row;
                if nearest != center {
                    let known = of_nearest.get_or_insert_with(
                        #[inline(always)]
                        || distances_of_core(simd, &[nearest], row, left),
                    );
                    if self.shadow.parted(nearest, known, lane, sought(*best)) {
                        continue;
                    }
                }
            }
            *self.primitive_tests += 1;
            near &= !self.improve(simd, lane, best);
        }
    }

    /// Asks GJK of a lane; the lanes that are then known not to be nearer, as bits.
    #[inline(always)]
    fn improve<S: Simd>(&mut self, simd: S, lane: usize, best: &mut f64) -> u32 {
        let Some(points) = self.ask(lane, best) else { return 0 };
        if *best == 0.0 {
            return u32::MAX;
        }
        let [from_complex, from_convex] = &self.frame.common;
        let way = from_complex.transform_point3(points.on_a) - from_convex.transform_point3(points.on_b);
        self.shadow.turn(way.normalize_or_zero());
        self.from[1] = points.on_b;
        if let Some(gaps) = &mut self.gaps {
            gaps.turn(simd, points.on_b, way);
        }
        self.shadow.beyond(simd, self.row, sought(*best))
    }

    /// Asks GJK of a lane: the closest points, if they are nearer than all before.
    #[inline(always)]
    fn ask(&mut self, lane: usize, best: &mut f64) -> Option<Witness> {
        let primitive = self.row.primitive(lane);
        let points = self.complex.0.primitive_hull(primitive);
        let bound = sought(*best) / self.frame.scale;
        let closest =
            gjk::closest_points_within(&points, self.complex.1, self.convex.0, self.convex.1, bound)?;
        let distance = closest.distance * self.frame.scale;
        (distance < *best).then(|| {
            *best = distance;
            self.answer = Some((primitive, Some(closest)));
            closest.points
        })
    }
}

/// The centre of the convex shape, when it is in a solid. (A part of the solid inside the convex shape meets it.)
fn contained(
    (complex, at_complex): PlacedComplex,
    convex: PlacedConvex,
    scratch: &mut Scratch,
) -> Option<Witness> {
    if !complex.is_solid() {
        return None;
    }
    let frame = frame((complex, at_complex), convex);
    let [from_complex, from_convex] = &frame.common;
    let (solid, center) = (PlacedSolid::new(complex, from_complex)?, convex.0.center());
    let inside = solid.contains(from_convex.transform_point3(center), scratch);
    inside.then(|| Witness { on_a: frame.b_to_a.transform_point3(center), on_b: center })
}

fn frame(complex: PlacedComplex, convex: PlacedConvex) -> Frame {
    Frame::new(complex.1, complex.0.reach(), convex.1, convex.0.reach())
}

/// A box around the convex shape in the space of the complex one, grown by the error of the map.
pub(super) fn convex_in_complex(complex: PlacedComplex, convex: PlacedConvex) -> (Aabb, Frame) {
    let frame = frame(complex, convex);
    (bounds_in_complex(convex.0, &frame), frame)
}

fn bounds_in_complex(convex: &dyn Support, frame: &Frame) -> Aabb {
    let map = frame.b_to_a;
    let bounds = convex_bounds(convex, &map.matrix3);
    Aabb::new(bounds.min + map.translation, bounds.max + map.translation).inflated(frame.slack_in_a)
}
