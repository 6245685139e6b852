//! The contacts of the pairs of primitives of two soups, with normals that the surfaces have.
//!
//! Where the surface is flat all around a triangle it has one normal only, and no penetration depth needs to be searched for; else that
//! is corrected as [`side`](super::side) says.

use std::cell::LazyCell;
use std::ops::ControlFlow;

use fearless_simd::Simd;
use glam::{DAffine3, DVec3};
use solid_convex::Closest;
use solid_convex::simd::level;

use super::super::approach::is_solid;
use super::super::frame::Frame;
use super::super::row::{CONFIRMED, Near, Row, Rows, distances, exceed, verdict};
use super::super::triangle_triangle::Triangle;
use super::super::{Scratch, depth, table, triangle_triangle};
use super::ball::Way;
use super::difference::{self, Polytope};
use super::other::Other;
use super::places::{told, untold};
use super::side::{Corrected, Side};
use super::stars::Stars;
use super::{Meeting, Pair, Patch, SAME_DEPTH, Touch, deepest, face, leave_across};
use crate::shape::{Body, Complex};
use crate::tree::{LeafPairs, bits, pairs_on};

/// The most pairs of primitives whose contacts are told, at up to a kilobyte each. Of more, as where one of many triangles lies in the place of another, or the
/// margin is as large as both, the deepest point alone is.
const PAIRS_MAX: usize = 1 << 20;

/// Looks for pairs of primitives that meet; with a margin, those whose boxes are as near.
struct NearPairs<'s> {
    soups: [&'s Complex; 2],
    maps: &'s [DAffine3; 2],
    margin: f64,
    rows: &'s mut [Rows; 2],
    primitive_tests: &'s mut u64,
    /// With whether they are known to meet.
    found: Vec<([u32; 2], bool)>,
}

impl LeafPairs<()> for NearPairs<'_> {
    #[inline(always)]
    fn visit<S: Simd>(&mut self, simd: S, leaf_a: &[u32], leaf_b: &[u32]) -> ControlFlow<()> {
        let [rows_a, rows_b] = &mut *self.rows;
        let in_a = rows_a.place(simd, self.soups[0], leaf_a, &self.maps[0]);
        let in_b = rows_b.place(simd, self.soups[1], leaf_b, &self.maps[1]);
        for i in bits(in_a.overlapping(simd, &in_b.union().inflated(self.margin))) {
            let bounds = in_a.bounds(i);
            let near = in_b.overlapping(simd, &bounds.inflated(self.margin));
            *self.primitive_tests += u64::from(near.count_ones());
            let triangles = if in_a.triangles() >> i & 1 == 1 { near & in_b.triangles() } else { 0 };
            let sure = verdict(simd, (in_a, i), in_b, triangles);
            let apart = if self.margin == 0.0 {
                sure.apart
            } else {
                beyond(simd, self.margin, &in_a.triangle(i), in_b, triangles & !sure.meet)
            };
            for j in bits(near & !apart) {
                // Of triangles it is decided exactly, as everywhere.
                let known = triangles >> j & 1 == 1;
                let certain = (sure.meet | sure.apart) >> j & 1 == 1;
                let meet = if certain {
                    sure.meet >> j & 1 == 1
                } else {
                    known && triangle_triangle::intersect(&in_a.triangle(i), &in_b.triangle(j))
                };
                if meet || !known || self.margin > 0.0 {
                    self.found.push(([in_a.primitive(i), in_b.primitive(j)], meet));
                }
            }
        }
        if self.found.len() > PAIRS_MAX { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Of triangles in some lanes, those that are further from a triangle than a margin, certainly.
#[inline(always)]
fn beyond<S: Simd>(simd: S, margin: f64, x: &Triangle, row: &Row, lanes: u32) -> u32 {
    if lanes == 0 {
        return 0;
    }
    let Near { least, .. } = distances(simd, x, row, lanes);
    exceed(simd, &least, margin * (1.0 + CONFIRMED) + CONFIRMED) & lanes
}

/// The contacts of two soups.
pub(super) fn soup_soup(pair: &Pair, a: &Complex, b: &Complex, scratch: &mut Scratch) -> Vec<Patch> {
    let placing = pair.placing();
    let mut relative = placing.relative();
    let (margin, [in_a, in_b]) = pair.margins(&placing);
    relative.slack_in_a += in_a;
    relative.slack_in_b += in_b;
    let Scratch { traversal, rows, primitive_tests, .. } = scratch;
    rows.iter_mut().for_each(Rows::clear);
    let (soups, maps) = ([a, b], &placing.common);
    let mut near = NearPairs { soups, maps, margin, rows, primitive_tests, found: Vec::new() };
    let walk = pairs_on(level(), a.tree(), b.tree(), &relative, &|| None, traversal, &mut near);
    let mut found = near.found;
    if walk.is_break() {
        return whole(pair, scratch).or_else(|| nearest(pair, scratch)).into_iter().collect();
    }
    found.sort_unstable();
    let stars = [&Stars::new(a, &pair.maps[0], found.len()), &Stars::new(b, &pair.maps[1], found.len())];
    let soups = Soups { pair, stars };
    let mut patches: Vec<Patch> =
        found.iter().filter_map(|&(primitives, must)| soups.patch(primitives, must)).collect();
    let met: Vec<[u32; 2]> =
        found.iter().filter(|(_, must)| *must).map(|(primitives, _)| *primitives).collect();
    let places = untold([Some(a), Some(b)], &met, &told(&patches, []));
    if !places.is_empty() {
        patches.extend(places.iter().filter_map(|place| soups.deepest(place)));
        patches.sort_by_key(|patch| patch.touches[0].primitives); // stable
    }
    patches
}

/// Two soups, of which pairs of primitives are looked at one after the other.
struct Soups<'a> {
    pair: &'a Pair<'a>,
    stars: [&'a Stars<'a>; 2],
}

impl Soups<'_> {
    /// The contacts of two primitives, along a normal that the surfaces have; `None` where there are none. `must` says that they are known to meet.
    fn patch(&self, primitives: [u32; 2], must: bool) -> Option<Patch> {
        self.with_sides(primitives, must, |sides, meeting| {
            let (normal, touches) = match level_touches(self.pair, sides, must, meeting) {
                Some(found) => found,
                None => touches(self.pair, sides, &meeting()?)?,
            };
            patch_of(sides, normal, touches)
        })
    }

    /// The contacts of those of some pairs that are deepest in each other; they do not leave a solid for its inside.
    fn deepest(&self, pairs: &[[u32; 2]]) -> Option<Patch> {
        let meeting = |&primitives: &[u32; 2]| {
            self.with_sides(primitives, true, |sides, meeting| {
                let meeting = meeting().filter(|meeting| !is_inward(sides, meeting.normal))?;
                Some((primitives, meeting))
            })
        };
        let (primitives, meeting) = deepest(pairs.iter().filter_map(meeting))?;
        self.with_sides(primitives, true, |sides, _| {
            let touches = self.pair.touches(&sides[0].body, &sides[1].body, &meeting);
            patch_of(sides, meeting.normal, touches)
        })
    }

    /// What there is to say of two primitives by the surface of each, and by how they lie to each other; `None` where that is further apart than the margin.
    fn with_sides<R>(
        &self,
        [i, j]: [u32; 2],
        must: bool,
        ask: impl FnOnce([&Side; 2], &dyn Fn() -> Option<Meeting>) -> Option<R>,
    ) -> Option<R> {
        let Soups { pair, stars: [stars_a, stars_b] } = *self;
        let (hull_a, hull_b) = (stars_a.complex.primitive_hull(i), stars_b.complex.primitive_hull(j));
        let (body_a, body_b) =
            (Body::of_primitive(stars_a.complex, i), Body::of_primitive(stars_b.complex, j));
        let (corners_a, corners_b) = (stars_a.corners(i), stars_b.corners(j));
        let [map_a, map_b] = &pair.maps;
        let placed_a = face::Placed::of_primitive(&body_a, i, map_a, &corners_a);
        let placed_b = face::Placed::of_primitive(&body_b, j, map_b, &corners_b);
        let other_a = Other { primitive: i, support: &hull_a, map: map_a, corners: &corners_a, radius: 0.0 };
        let other_b = Other { primitive: j, support: &hull_b, map: map_b, corners: &corners_b, radius: 0.0 };
        let of_a = Side::new(stars_a, placed_a, other_b);
        let of_b = Side::new(stars_b, placed_b, other_a);
        let meeting = LazyCell::new(|| match must.then(|| way_of([&corners_a, &corners_b])).flatten() {
            Some(way) => Some(way.meeting(false).touching()),
            None => pair.meeting(&hull_a, &hull_b, must),
        });
        ask([&of_a, &of_b], &|| *meeting)
    }
}

/// Whether a normal, given from the second to the first, points into a solid.
fn is_inward([of_a, of_b]: [&Side; 2], normal: DVec3) -> bool {
    of_a.is_inward(-normal) || of_b.is_inward(normal)
}

fn patch_of(sides: [&Side; 2], normal: DVec3, touches: Vec<Touch>) -> Option<Patch> {
    (!touches.is_empty()).then(|| Patch { normal, touches, is_inward: is_inward(sides, normal) })
}

/// The contacts of two triangles of which one has all around it in its plane, along the normal of that, unless the other is larger; of two such along that
/// of the larger soup.
fn level_touches(
    pair: &Pair,
    sides: [&Side; 2],
    must: bool,
    meeting: &dyn Fn() -> Option<Meeting>,
) -> Option<(DVec3, Vec<Touch>)> {
    let of_first = match sides.map(Side::is_level) {
        [false, false] => return None,
        [true, true] => sides[0].is_of_larger(sides[1])?,
        [is_first, _] => is_first,
    };
    let [level, beside] = if of_first { sides } else { [sides[1], sides[0]] };
    beside.body.plane?;
    if !beside.is_level() && beside.is_wider(level) {
        return None;
    }
    if !level.is_flat() {
        // Where it ends, the surface has other normals.
        let Meeting { normal, tilt, .. } = meeting()?;
        let corrected = level.corrected(if of_first { -normal } else { normal }, tilt)?;
        if !level.is_own(corrected.normal()) {
            return None;
        }
    }
    let (normal, mut touches) = own_touches(pair, sides, of_first)?;
    // What does not meet is not in each other either, but on the other side.
    touches.retain(|touch| must || touch.depth <= SAME_DEPTH);
    // Nothing is left where the soup is beyond the plane as a whole, but not here, as what reaches around an end of the triangle.
    (!touches.is_empty()).then_some((normal, touches))
}

/// The contacts of two primitives along the normal of one, which is a triangle; `of_first` says whose.
fn own_touches(pair: &Pair, [of_a, of_b]: [&Side; 2], of_first: bool) -> Option<(DVec3, Vec<Touch>)> {
    let normal = if of_first { -of_a.own_beside(of_b)? } else { of_b.own_beside(of_a)? };
    Some((normal, pair.over(&of_a.body, &of_b.body, normal, of_first)))
}

/// The contacts of two primitives, along a normal that the surfaces have; `None` where there is none. Where one surface does not have that along which they
/// are left, it is the normal of a triangle: of the larger one, if that may be.
fn touches(pair: &Pair, [of_a, of_b]: [&Side; 2], meeting: &Meeting) -> Option<(DVec3, Vec<Touch>)> {
    let on_b = of_b.corrected(meeting.normal, meeting.tilt)?;
    let on_a = || of_a.corrected(-meeting.normal, meeting.tilt);
    let is_replaced = |on: Corrected| matches!(on, Corrected::Replaced(_));
    if is_replaced(on_b) {
        let of_first = of_a.is_wider(of_b) && on_a().is_some_and(|on_a| of_a.is_own(on_a.normal()));
        return own_touches(pair, [of_a, of_b], of_first);
    }
    let on_a = on_a()?;
    if is_replaced(on_a) {
        let of_second = of_b.is_wider(of_a) && of_b.is_own(on_b.normal());
        return own_touches(pair, [of_a, of_b], !of_second);
    }
    let (in_a, in_b) = (&of_a.body, &of_b.body);
    Some(match (on_a, on_b) {
        (_, Corrected::Adopted(normal)) => (normal, pair.across(in_a, in_b, normal)),
        (Corrected::Adopted(normal), _) => (-normal, pair.across(in_a, in_b, -normal)),
        (_, kept) => {
            let meeting = Meeting { normal: kept.normal(), ..*meeting };
            (meeting.normal, pair.touches(in_a, in_b, &meeting))
        }
    })
}

/// The shortest way out of two triangles that have a common point.
fn way_of(corners: [&[DVec3]; 2]) -> Option<Way> {
    let [&[p, q, r], &[x, y, z]] = corners else { return None };
    difference::way(&Polytope::triangle([p, q, r]), &Polytope::triangle([x, y, z]))
}

/// The deepest point of two shapes as wholes: of what is wholly inside a solid, or touches by so little that no pair of primitives
/// told. What is wholly inside meets no primitive.
pub(super) fn whole(pair: &Pair, scratch: &mut Scratch) -> Option<Patch> {
    let shapes = [pair.a, pair.b];
    let deepest = depth::of_deepest(shapes, |_| true, scratch);
    // A solid is as deep as its hull.
    let (primitives, found) = match deepest {
        Some(deepest) if !shapes.iter().any(is_solid) => deepest,
        _ => {
            let primitives = deepest.map(|(primitives, _)| primitives).unwrap_or_default();
            (primitives, table::penetration(pair.a, pair.b, scratch)?)
        }
    };
    Some(pair.patch_of_both(primitives, pair.placed(found.points), found.direction, found.depth))
}

/// The closest points of two shapes as wholes that are apart, within the margin.
fn nearest(pair: &Pair, scratch: &mut Scratch) -> Option<Patch> {
    let margin = pair.margin / pair.frame.scale;
    let Closest { distance, points } = table::closest_within(pair.a, pair.b, margin, scratch)?;
    let [on_a, on_b] = pair.placed(points);
    Some(pair.patch_of_both([0, 0], [on_a, on_b], (on_a - on_b).try_normalize()?, -distance))
}

impl Pair<'_> {
    /// One contact of two shapes as wholes, of a depth in the world.
    fn patch_of_both(
        &self,
        primitives: [u32; 2],
        [on_a, on_b]: [DVec3; 2],
        normal: DVec3,
        depth: f64,
    ) -> Patch {
        let (depth, features) = (depth * self.frame.scale, [super::Feature::Face(0); 2]);
        let touch = Touch { on_a, on_b, depth, primitives, features };
        Patch { normal, touches: vec![touch], is_inward: false }
    }

    /// The margin in a frame, and in the local spaces of the two.
    pub(super) fn margins(&self, placing: &Frame) -> (f64, [f64; 2]) {
        let margin = self.margin / self.frame.scale * placing.scale;
        (margin, placing.stretch().map(|stretch| margin / stretch.least))
    }

    /// The contacts along a normal, given from `b` to `a`, that may not be that of the deepest point.
    pub(super) fn across(&self, a: &face::Placed, b: &face::Placed, normal: DVec3) -> Vec<Touch> {
        let mut face_a = a.face(-normal);
        let mut face_b = b.face(normal);
        leave_across(&mut face_a, &mut face_b, normal);
        self.clipped(a, &face_a, b, &face_b, normal)
    }

    /// The contacts over a triangle along its own normal, given from `b` to `a`; `of_a` says whose it is.
    pub(super) fn over(&self, a: &face::Placed, b: &face::Placed, normal: DVec3, of_a: bool) -> Vec<Touch> {
        let mut face_a = a.face(-normal);
        let mut face_b = b.face(normal);
        let other = if of_a { &mut face_b } else { &mut face_a };
        if !other.is_faced() {
            let along = if of_a { normal } else { -normal };
            other.slim(along);
        }
        self.clipped(a, &face_a, b, &face_b, normal)
    }
}
