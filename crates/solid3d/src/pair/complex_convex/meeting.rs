//! Which primitives meet the convex shape.

use std::ops::ControlFlow;

use fearless_simd::{Simd, f32x8};
use solid_convex::simd::{dispatch, level};
use solid_convex::{Outcome, Witness, gjk};

use super::super::Scratch;
use super::super::direct::Direct;
use super::super::gaps::Gaps;
use super::super::glance::Glance;
use super::super::row::{Row, Verdict};
use super::super::table::{PlacedComplex, PlacedConvex};
use super::details::Details;
use super::interior::Interior;
use super::sight::Sight;
use super::{CLEARLY_APART, alike, frame};
use crate::tree::{Boxes, Leaf, LeafImages, NearLeaves, Signposts, bits};

/// A walk that opens so many nodes is long: better bounds are then worth preparing.
const LONG: usize = 8;

/// Calls `found` with the primitives that meet the convex shape; `wants_any`: with whichever of them is found first, and without a point.
pub(super) fn primitives(
    complex: PlacedComplex,
    convex: PlacedConvex,
    wants_any: bool,
    scratch: &mut Scratch,
    found: &mut dyn FnMut(u32, Option<Witness>) -> ControlFlow<()>,
) -> ControlFlow<()> {
    if wants_any && let Some(sight) = &dispatch!(simd => alike::sight(simd, complex, convex)) {
        return walk(complex, convex, sight, &mut None, scratch, found);
    }
    let mut details = None;
    let sight =
        Sight::new(complex, convex, details.insert(Details::new(frame(complex, convex), convex)), wants_any);
    walk(complex, convex, &sight, &mut details, scratch, found)
}

/// What is there to begin with of the details is of the same frame as the sight.
pub(super) fn walk<'c>(
    complex: PlacedComplex,
    convex: PlacedConvex<'c>,
    sight: &Sight,
    details: &mut Option<Details<'c>>,
    scratch: &mut Scratch,
    found: &mut dyn FnMut(u32, Option<Witness>) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let Scratch { traversal, row, primitive_tests, .. } = scratch;
    row.iter_mut().for_each(Row::clear);
    let Sight { scale, query, glance } = sight;
    let mut meeting = Meeting {
        complex,
        convex,
        glance: glance.as_ref().zip(complex.0.images()),
        details,
        scale: *scale,
        opened: 0,
        gaps: None,
        row,
        primitive_tests,
        found,
        end: ControlFlow::Continue(()),
    };
    // What is clearly apart does not meet; nothing else is sought.
    let mut limit = CLEARLY_APART;
    complex.0.tree().nearest_on(level(), query, &mut limit, traversal, &mut meeting);
    meeting.end
}

/// Looks for primitives that meet the convex shape.
struct Meeting<'s, 'c> {
    complex: PlacedComplex<'s>,
    convex: PlacedConvex<'c>,
    /// What looks at images of triangles, where any that meets will do.
    glance: Option<(&'s Glance, &'s LeafImages)>,
    /// What looks at all else, made once it is wanted.
    details: &'s mut Option<Details<'c>>,
    /// Of the common frame.
    scale: f64,
    /// How many nodes were opened, and what bounds the distances of their boxes once they are many.
    opened: usize,
    gaps: Option<Gaps>,
    row: &'s mut Option<Row>,
    primitive_tests: &'s mut u64,
    found: &'s mut dyn FnMut(u32, Option<Witness>) -> ControlFlow<()>,
    /// Whether `found` broke off.
    end: ControlFlow<()>,
}

impl NearLeaves for Meeting<'_, '_> {
    const NODES_LOOKED_AT: usize = 1;

    #[inline(always)]
    fn bounds<S: Simd>(&mut self, simd: S, boxes: &Boxes) -> Option<f32x8<S>> {
        self.opened += 1;
        if self.opened == LONG {
            let Details { frame, direct, shadow, .. } =
                Details::of(self.details, self.complex, self.convex, self.scale);
            // Of what is round, the bounds are as good as they get.
            let is_round = matches!(direct, Direct::Round(_));
            let normal = self.complex.0.tree().normal();
            self.gaps = if is_round { None } else { Gaps::new(self.convex.0, direct, frame, normal) };
            if let Some(gaps) = &mut self.gaps {
                gaps.look_along(simd, shadow.axis());
            }
        }
        Some(self.gaps.as_ref()?.of_boxes(simd, boxes))
    }

    #[inline(always)]
    fn signposts(&self) -> Option<&Signposts> {
        self.glance.and_then(
            #[inline(always)]
            |(_, images)| images.signposts(),
        )
    }

    #[inline(always)]
    fn prefetch(&self, start: usize) {
        if let Some((_, images)) = self.glance {
            images.prefetch(start);
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

impl Meeting<'_, '_> {
    /// Looks at the image of a leaf; `None` when that leaves something open.
    #[inline(always)]
    fn glance<S: Simd>(&mut self, simd: S, leaf: &Leaf) -> Option<ControlFlow<()>> {
        let (glance, images) = self.glance?;
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
        let Details { direct, map, shadow, .. } =
            Details::of(self.details, self.complex, self.convex, self.scale);
        let row = self.row.get_or_insert_default();
        row.place(simd, self.complex.0, leaf, map);
        let bounds = match direct {
            Direct::Cube(cube) => &cube.bounds(),
            _ => shadow.bounds(direct),
        };
        let mut near = row.overlapping(simd, bounds);
        if near == 0 {
            return ControlFlow::Continue(());
        }
        let triangles = near & row.triangles();
        let sure = match direct {
            Direct::Round(round) => round.verdict(simd, row, triangles, CLEARLY_APART),
            Direct::Cube(cube) => cube.verdict(simd, row, triangles),
            Direct::None => Verdict { meet: 0, apart: shadow.beyond(simd, row, CLEARLY_APART) },
        };
        near &= !sure.apart;
        *self.primitive_tests += u64::from(near.count_ones());
        for lane in bits(near & sure.meet) {
            (self.found)(row.primitive(lane), None)?;
        }
        self.look_closely(simd, near & !sure.meet)
    }

    /// Looks at the primitives in some lanes one by one.
    #[inline(always)]
    fn look_closely<S: Simd>(&mut self, simd: S, mut near: u32) -> ControlFlow<()> {
        if near == 0 {
            return ControlFlow::Continue(());
        }
        let (complex, at_complex) = self.complex;
        let Details { frame, direct, shadow, interior, .. } =
            Details::of(self.details, self.complex, self.convex, self.scale);
        let row = self.row.get_or_insert_default();
        // Of a shape that is known by its support mapping.
        let interior = matches!(direct, Direct::None)
            .then(|| interior.get_or_init(|| Interior::new(self.convex.0, frame, CLEARLY_APART)));
        while let Some(lane) = bits(near).next() {
            near &= near - 1;
            let primitive = row.primitive(lane);
            if !complex.primitive_bounds(primitive).overlaps(shadow.in_complex(frame)) {
                continue;
            }
            let corner = interior.and_then(|interior| interior.corner_of(complex.points_of(primitive)));
            if let Some(corner) = corner {
                (self.found)(primitive, Some(corner))?;
                continue;
            }
            let points = complex.primitive_hull(primitive);
            match gjk::intersection(&points, at_complex, self.convex.0, self.convex.1) {
                Outcome::Separated { axis } => {
                    if interior.is_some() {
                        shadow.turn(axis);
                        if let Some(gaps) = &mut self.gaps {
                            gaps.look_along(simd, axis);
                        }
                        near &= !shadow.beyond(simd, row, CLEARLY_APART);
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
