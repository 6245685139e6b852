//! Which primitive is closest to the convex shape.

use fearless_simd::{Simd, f32x8};
use glam::DVec3;
use solid_convex::simd::{dispatch, each, level};
use solid_convex::{Closest, Witness, gjk};

use super::super::Scratch;
use super::super::direct::{Direct, Round};
use super::super::frame::{Frame, ROUNDINGS, Stretch};
use super::super::gaps::Gaps;
use super::super::row::{CONFIRMED, Row, distances_of_core};
use super::super::table::{PlacedComplex, PlacedConvex};
use super::shadow::Shadow;
use super::{CLEARLY_APART, ball};
use crate::tree::{Boxes, Leaf, LeafImages, NearLeaves};

/// The closest primitive, without points where these are for GJK to find; of shapes that are farther apart than a bound, `None` or some
/// primitive.
pub(super) fn closest_primitive(
    complex: PlacedComplex,
    convex: PlacedConvex,
    frame: &Frame,
    bound: f64,
    scratch: &mut Scratch,
) -> Option<(u32, Option<Closest>)> {
    let Scratch { traversal, row, primitive_tests, .. } = scratch;
    let row = row.get_or_insert_default();
    row.clear();
    let tree = complex.0.tree();
    let metric = tree.folded(&frame.stretch_of_a().metric(&Stretch::NONE));
    // The best distance so far is kept in the common frame, as the bounds are.
    let mut best = frame.beyond(bound);
    // Of a box the distance has no closed form here.
    let direct = Direct::round(convex.0, frame);
    let shadow = Shadow::new(convex.0, frame, ROUNDINGS);
    let (box_around, around) = shadow.around(&direct, frame);
    let query = dispatch!(simd => tree.near_query(simd, box_around, around, metric));
    let from = [convex.0.center(); 2];
    let mut gaps = Gaps::new(convex.0, &direct, frame, tree.normal());
    let images = complex.0.images();
    let mut approach = Approach {
        complex,
        convex,
        frame,
        direct: &direct,
        shadow,
        gaps: gaps.as_mut(),
        images,
        from,
        row,
        primitive_tests,
        answer: None,
    };
    tree.nearest_on(level(), &query, &mut best, traversal, &mut approach);
    let (primitive, closest) = approach.answer?;
    Some((primitive, closest.or_else(|| approach.in_closed_form(primitive))))
}

/// Looks for the primitive closest to the convex shape.
struct Approach<'s> {
    complex: PlacedComplex<'s>,
    convex: PlacedConvex<'s>,
    frame: &'s Frame,
    direct: &'s Direct,
    /// Its axis is from the closest point of the convex shape to that of the complex one so far.
    shadow: Shadow<'s>,
    /// What tells, by boxes and images, which primitives may be nearest.
    gaps: Option<&'s mut Gaps>,
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
    fn prefetch(&self, start: usize) {
        if let Some(images) = self.images {
            images.prefetch(start);
        }
    }

    #[inline(always)]
    fn bounds<S: Simd>(&mut self, simd: S, boxes: &Boxes) -> Option<f32x8<S>> {
        // Of what is round, those that there are are as good as they get.
        let gaps = self.gaps.as_ref().filter(|_| !matches!(self.direct, Direct::Round(_)))?;
        Some(gaps.of_boxes(simd, boxes))
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
        near &= self.row.nearer(simd, self.shadow.bounds(self.direct), *best * *best);
        if near == 0 {
            return;
        }
        match self.direct {
            Direct::Round(round) => self.look_from_core(simd, round, near, best),
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
                if gap < -CLEARLY_APART {
                    *best = 0.0;
                    self.answer = Some((self.row.primitive(lane), None));
                    return;
                }
                if gap > CLEARLY_APART && known.distance[lane] - known.least[lane] <= CONFIRMED {
                    if gap < *best {
                        *best = gap;
                        self.answer = Some((self.row.primitive(lane), None));
                        if let Some(gaps) = &mut self.gaps {
                            gaps.look_from(self.from[0]);
                            gaps.look_along(simd, -known.axis(lane));
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

    /// The closest points of a triangle and a ball, where they are clear.
    fn in_closed_form(&self, primitive: u32) -> Option<Closest> {
        let Direct::Round(round) = self.direct else { return None };
        let &[p, q, r] = self.complex.0.primitive(primitive) else { return None };
        let triangle = each([p, q, r], |vertex| self.complex.0.vertices()[vertex as usize]);
        ball::closest_points(&triangle, round, self.frame)
    }

    /// Looks at some lanes of the row from points of the shape; `is_known`: it is known already that all of them may be nearest.
    #[inline(always)]
    fn look<S: Simd>(&mut self, simd: S, mut near: u32, is_known: bool, best: &mut f64) {
        if near == 0 {
            return;
        }
        let from_convex = &self.frame.common[1];
        let [center, nearest] = each(self.from, |point| from_convex.transform_point3(point));
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
        let axis = match self.ask(lane, best) {
            Asked::Nearer(_) if *best == 0.0 => return u32::MAX,
            Asked::Nearer(Witness { on_a, on_b }) => {
                let [from_complex, from_convex] = &self.frame.common;
                self.from[1] = on_b;
                if let Some(gaps) = &mut self.gaps {
                    gaps.look_from(on_b);
                }
                from_complex.transform_point3(on_a) - from_convex.transform_point3(on_b)
            }
            Asked::Beyond(axis) => axis,
        };
        // What tells one primitive from the shape mostly tells its neighbours too.
        self.shadow.turn(axis.normalize_or_zero());
        if let Some(gaps) = &mut self.gaps {
            gaps.look_along(simd, axis);
        }
        self.shadow.beyond(simd, self.row, sought(*best))
    }

    /// Asks GJK of a lane, and takes it if it is nearer than all before.
    #[inline(always)]
    fn ask(&mut self, lane: usize, best: &mut f64) -> Asked {
        let primitive = self.row.primitive(lane);
        let points = self.complex.0.primitive_hull(primitive);
        let bound = sought(*best) / self.frame.scale;
        match gjk::closest_points_or_axis(&points, self.complex.1, self.convex.0, self.convex.1, bound) {
            Ok(closest) if closest.distance * self.frame.scale < *best => {
                *best = closest.distance * self.frame.scale;
                self.answer = Some((primitive, Some(closest)));
                Asked::Nearer(closest.points)
            }
            Ok(_) => Asked::Beyond(DVec3::ZERO),
            Err(axis) => Asked::Beyond(axis),
        }
    }
}

/// What GJK said of a primitive.
enum Asked {
    /// The closest points: it is nearer than all before.
    Nearer(Witness),
    /// It is not: along an axis from the shape to it, of any length, or zero where none is known.
    Beyond(DVec3),
}
