//! Which primitives meet the convex shape.

use std::cell::OnceCell;
use std::ops::ControlFlow;

use fearless_simd::Simd;
use glam::DAffine3;
use solid_convex::simd::level;
use solid_convex::{Outcome, Witness, gjk};

use super::super::Scratch;
use super::super::direct::Direct;
use super::super::frame::{Frame, Stretch};
use super::super::gaps::Gaps;
use super::super::glance::Glance;
use super::super::row::{Row, Verdict};
use super::super::table::{PlacedComplex, PlacedConvex};
use super::interior::Interior;
use super::shadow::Shadow;
use super::{CLEARLY_APART, frame};
use crate::tree::{Boxes, LEAF_SIZE, Leaf, LeafImages, NearLeaves, bits};

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
    let frame = frame(complex, convex);
    let Scratch { traversal, row, primitive_tests, .. } = scratch;
    row.iter_mut().for_each(Row::clear);
    let direct = Direct::new(convex.0, &frame, CLEARLY_APART);
    let shadow = Shadow::new(convex.0, &frame, CLEARLY_APART);
    let map = match &direct {
        Direct::Cube(cube) => cube.map,
        _ => frame.common[0],
    };
    let around = shadow.around(&direct);
    let metric = frame.stretch_of_a().metric(&Stretch::NONE);
    let end = ControlFlow::Continue(());
    // Where all that meet are wanted, most leaves that are visited hold some.
    let (to_common, normal) = (&frame.common[1], complex.0.tree().normal());
    let glance =
        wants_any.then(|| Glance::new(&direct, convex.0, to_common, &map, CLEARLY_APART, normal)).flatten();
    let glance = glance.as_ref().zip(complex.0.images());
    let mut meeting = Meeting {
        complex,
        convex,
        frame: &frame,
        direct: &direct,
        map,
        shadow,
        interior: OnceCell::new(),
        glance,
        opened: 0,
        gaps: None,
        row,
        primitive_tests,
        found,
        end,
    };
    // What is clearly apart does not meet; nothing else is sought.
    let mut limit = CLEARLY_APART;
    complex.0.tree().nearest_on(level(), around.as_slice(), &metric, &mut limit, traversal, &mut meeting);
    meeting.end
}

/// Looks for primitives that meet the convex shape.
struct Meeting<'s> {
    complex: PlacedComplex<'s>,
    convex: PlacedConvex<'s>,
    frame: &'s Frame,
    direct: &'s Direct,
    /// Where primitives are placed: in the common frame, or the space of a box.
    map: DAffine3,
    shadow: Shadow<'s>,
    /// What finds corners in the shape, once a primitive is looked at by itself.
    interior: OnceCell<Interior<'s>>,
    /// What looks at images of triangles, where any that meets will do.
    glance: Option<(&'s Glance, &'s LeafImages)>,
    /// How many nodes were opened, and what bounds the distances of their boxes once they are many.
    opened: usize,
    gaps: Option<Gaps>,
    row: &'s mut Option<Row>,
    primitive_tests: &'s mut u64,
    found: &'s mut dyn FnMut(u32, Option<Witness>) -> ControlFlow<()>,
    /// Whether `found` broke off.
    end: ControlFlow<()>,
}

impl NearLeaves for Meeting<'_> {
    const NODES_LOOKED_AT: usize = 1;

    #[inline(always)]
    fn raise<S: Simd>(&mut self, simd: S, boxes: &Boxes, bounds: &mut [f64; LEAF_SIZE]) {
        self.opened += 1;
        // Of what is round, the bounds are as good as they get.
        if self.opened == LONG && !matches!(self.direct, Direct::Round(_)) {
            self.gaps = Gaps::new(self.convex.0, self.direct, self.frame, self.complex.0.tree().normal());
            if let Some(gaps) = &mut self.gaps {
                gaps.look_along(simd, self.shadow.axis());
            }
        }
        if let Some(gaps) = &self.gaps {
            gaps.raise(simd, boxes, bounds);
        }
    }

    #[inline(always)]
    fn prefetch(&self, leaf: &Leaf) {
        if let Some((_, images)) = self.glance {
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
        let row = self.row.get_or_insert_default();
        row.place(simd, self.complex.0, leaf, &self.map);
        let bounds = match self.direct {
            Direct::Cube(cube) => &cube.bounds(),
            _ => self.shadow.bounds(self.direct),
        };
        let mut near = row.overlapping(simd, bounds);
        if near == 0 {
            return ControlFlow::Continue(());
        }
        let triangles = near & row.triangles();
        let sure = match self.direct {
            Direct::Round(round) => round.verdict(simd, row, triangles, CLEARLY_APART),
            Direct::Cube(cube) => cube.verdict(simd, row, triangles),
            Direct::None => Verdict { meet: 0, apart: self.shadow.beyond(simd, row, CLEARLY_APART) },
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
        let row = self.row.get_or_insert_default();
        // Of a shape that is known by its support mapping.
        let interior = matches!(self.direct, Direct::None)
            .then(|| self.interior.get_or_init(|| Interior::new(self.convex.0, self.frame, CLEARLY_APART)));
        while let Some(lane) = bits(near).next() {
            near &= near - 1;
            let primitive = row.primitive(lane);
            if !complex.primitive_bounds(primitive).overlaps(self.shadow.in_complex()) {
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
                        self.shadow.turn(axis);
                        if let Some(gaps) = &mut self.gaps {
                            gaps.look_along(simd, axis);
                        }
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
