//! The contacts of pairs of primitives, with normals that the surfaces have.
//!
//! A triangle in a surface is not alone: a box that slides over a floor is pushed up by each triangle under it, and by none of them aside,
//! though aside may be the shortest way off that triangle. A normal is one of the surface when the part of the triangle that it touches
//! is the highest along it of all that is around: the face always, an edge or a corner when the surface is convex there
//! and the normal between those of the faces. Any other is replaced by the normal of the triangle, or by that of a face next to it that it
//! shares an edge or a corner with, as a riser with the tread above it, where the way out along that is shorter.
//!
//! Where the surface is flat all around a triangle it has one normal only, and no penetration depth needs to be searched for.

use std::ops::ControlFlow;

use fearless_simd::Simd;
use glam::{DAffine3, DVec3};
use smallvec::SmallVec;
use solid_convex::Support;
use solid_convex::simd::level;

use super::super::closed_form::Similarity;
use super::super::frame::Frame;
use super::super::reach::core;
use super::super::row::{CONFIRMED, Near, Row, Rows, distances, exceed, verdict};
use super::super::table::PlacedConvex;
use super::super::triangle_triangle::Triangle;
use super::super::{Scratch, complex_convex, table, triangle_triangle};
use super::ball::{Way, way};
use super::map::Map;
use super::{Meeting, Pair, Part, Patch, Touch, face, facing};
use crate::shape::{Body, Complex};
use crate::tree::{LeafPairs, bits, pairs_on};

/// Heights along a normal that differ by less than this, in the unit of the pair, are the same.
const LEVEL: f64 = 1e-9;

/// A normal whose cosine with that of the triangle is beyond this tells the side on which the other is.
const SIDE_COSINE: f64 = 0.2;

/// A normal within this of that of the triangle is the same: the square root of the error of a depth.
const SAME_NORMAL: f64 = 1e-6;

/// A square that lost no digits.
const SQUARE_MIN: f64 = 1e-280;

/// The contacts of two bodies.
pub(super) fn body_body(pair: &Pair, a: &Part, b: &Part) -> Vec<Patch> {
    let (Part::Body(kind_a, of_a), Part::Body(kind_b, of_b)) = (a, b) else { return Vec::new() };
    let Some(meeting) = pair.meeting_of_bodies(*of_a, *of_b) else { return Vec::new() };
    let [map_a, map_b] = &pair.maps;
    let (placed_a, placed_b) = (face::Placed::new(kind_a, 0, map_a), face::Placed::new(kind_b, 0, map_b));
    let touches = pair.touches(&placed_a, &placed_b, &meeting);
    vec![Patch { normal: meeting.normal, touches, is_inward: false }]
}

/// The contacts of a soup and a body; `mirrored` when the soup is the second of the pair.
pub(super) fn soup_body(
    pair: &Pair,
    soup: &Part,
    body: &Part,
    mirrored: bool,
    scratch: &mut Scratch,
) -> Vec<Patch> {
    let (Part::Soup(complex), Part::Body(kind, support)) = (soup, body) else { return Vec::new() };
    let (placed_soup, placed_body) = if mirrored { (pair.b, pair.a) } else { (pair.a, pair.b) };
    let convex: PlacedConvex = (*support, placed_body.placement);
    let [map_a, map_b] = &pair.maps;
    let [map_soup, map_body] = if mirrored { [map_b, map_a] } else { [map_a, map_b] };
    let body = face::Placed::new(kind, 0, map_body);
    let round = core(*support).zip(Similarity::new(map_body.linear()));
    let (ends, radius) = round.map_or(([DVec3::ZERO; 2], 0.0), |((ends, radius), similarity)| {
        (ends.map(|end| map_body.point(end)), radius * similarity.stretch)
    });
    let corners = match round {
        Some(_) if ends[0] == ends[1] => &ends[..1],
        Some(_) => &ends[..],
        None => &[],
    };
    let other = Other { support: *support, map: map_body, corners, radius };
    let found = near_body(pair, (complex, placed_soup.placement), convex, mirrored, scratch);
    let patch = |primitive: u32| {
        let hull = complex.primitive_hull(primitive);
        let primitive_body = Body::of_primitive(complex, primitive);
        let placed = face::Placed::new(&primitive_body, primitive, map_soup);
        let corners = placed_corners(complex, primitive, map_soup);
        let side = Side::new(complex, placed, &corners, other);
        let over = |normal: DVec3| match mirrored {
            true => pair.over(&body, &side.body, normal, false),
            false => pair.over(&side.body, &body, -normal, true),
        };
        let (out, touches) = match side.flat() {
            Some(normal) => (normal, over(normal)),
            None => {
                let must = pair.margin == 0.0;
                let meeting = match side.meeting_of_ball(mirrored) {
                    Some(meeting) if must => meeting.touching(),
                    Some(meeting) => meeting.within(pair.margin)?,
                    None if mirrored => pair.meeting(*support, &hull, must)?,
                    None => pair.meeting(&hull, *support, must)?,
                };
                let corrected = side.corrected(if mirrored { meeting.normal } else { -meeting.normal });
                let touches = match corrected {
                    Corrected::Kept(_) if mirrored => {
                        pair.touches(&body, &side.body, &meeting.along(&corrected, 1.0))
                    }
                    Corrected::Kept(_) => pair.touches(&side.body, &body, &meeting.along(&corrected, -1.0)),
                    Corrected::Adopted(normal) if mirrored => pair.across(&body, &side.body, normal),
                    Corrected::Adopted(normal) => pair.across(&side.body, &body, -normal),
                    Corrected::Replaced(normal) => over(normal),
                };
                (corrected.normal(), touches)
            }
        };
        let is_inward = side.is_inward(out);
        let normal = if mirrored { out } else { -out };
        (!touches.is_empty()).then_some(Patch { normal, touches, is_inward })
    };
    found.into_iter().filter_map(patch).collect()
}

/// The primitives of a soup that meet a body; with a margin, those whose boxes are as near. Ascending: in an order that does not
/// depend on the tree.
fn near_body(
    pair: &Pair,
    soup: (&Complex, &DAffine3),
    body: PlacedConvex,
    mirrored: bool,
    scratch: &mut Scratch,
) -> Vec<u32> {
    let mut found = Vec::new();
    if pair.margin == 0.0 {
        let _ = complex_convex::meeting_primitives(soup, body, scratch, &mut |primitive, _| {
            found.push(primitive);
            ControlFlow::Continue(())
        });
    } else {
        let (query, _) = complex_convex::convex_in_complex(soup, body);
        let (_, margins) = pair.margins(&pair.placing());
        let query = query.inflated(margins[usize::from(mirrored)]);
        let Scratch { traversal, primitive_tests, .. } = scratch;
        let _ = soup.0.tree().overlapping(&query, traversal, |leaf| {
            found.extend(leaf.iter().filter(|&&i| soup.0.primitive_bounds(i).overlaps(&query)));
            ControlFlow::<()>::Continue(())
        });
        *primitive_tests += found.len() as u64;
    }
    found.sort_unstable();
    found
}

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
        ControlFlow::Continue(())
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
    let [map_a, map_b] = &pair.maps;
    let Scratch { traversal, rows, primitive_tests, .. } = scratch;
    rows.iter_mut().for_each(Rows::clear);
    let (soups, maps) = ([a, b], &placing.common);
    let mut near = NearPairs { soups, maps, margin, rows, primitive_tests, found: Vec::new() };
    let _ = pairs_on(level(), a.tree(), b.tree(), &relative, &|| None, traversal, &mut near);
    let mut found = near.found;
    found.sort_unstable();
    let patch = |(primitives, must): ([u32; 2], bool)| {
        let [i, j] = primitives;
        let (hull_a, hull_b) = (a.primitive_hull(i), b.primitive_hull(j));
        let meeting = pair.meeting(&hull_a, &hull_b, must)?;
        let (body_a, body_b) = (Body::of_primitive(a, i), Body::of_primitive(b, j));
        let (placed_a, placed_b) =
            (face::Placed::new(&body_a, i, map_a), face::Placed::new(&body_b, j, map_b));
        let (corners_a, corners_b) = (placed_corners(a, i, map_a), placed_corners(b, j, map_b));
        let other_a = Other { support: &hull_a, map: map_a, corners: &corners_a, radius: 0.0 };
        let other_b = Other { support: &hull_b, map: map_b, corners: &corners_b, radius: 0.0 };
        let of_a = Side::new(a, placed_a, &corners_a, other_b);
        let of_b = Side::new(b, placed_b, &corners_b, other_a);
        let (on_a, on_b) = (of_a.corrected(-meeting.normal), of_b.corrected(meeting.normal));
        let (normal, touches) = match (on_a, on_b) {
            (_, Corrected::Replaced(normal)) => (normal, pair.over(&of_a.body, &of_b.body, normal, false)),
            (Corrected::Replaced(normal), _) => (-normal, pair.over(&of_a.body, &of_b.body, -normal, true)),
            (_, Corrected::Adopted(normal)) => (normal, pair.across(&of_a.body, &of_b.body, normal)),
            (Corrected::Adopted(normal), _) => (-normal, pair.across(&of_a.body, &of_b.body, -normal)),
            (_, kept) => {
                let meeting = meeting.along(&kept, 1.0);
                (meeting.normal, pair.touches(&of_a.body, &of_b.body, &meeting))
            }
        };
        let is_inward = of_a.is_inward(-normal) || of_b.is_inward(normal);
        (!touches.is_empty()).then_some(Patch { normal, touches, is_inward })
    };
    found.into_iter().filter_map(patch).collect()
}

/// The deepest point of two shapes as wholes: of what is wholly inside a solid, or touches by so little that no pair of primitives
/// told.
pub(super) fn whole(pair: &Pair, scratch: &mut Scratch) -> Option<Patch> {
    let found = table::penetration(pair.a, pair.b, scratch)?;
    let [from_a, from_b] = &pair.maps;
    let touch = Touch {
        on_a: from_a.point(found.points.on_a),
        on_b: from_b.point(found.points.on_b),
        depth: found.depth * pair.frame.scale,
        primitives: [0, 0],
        features: [super::Feature::Face(0); 2],
    };
    Some(Patch { normal: found.direction, touches: vec![touch], is_inward: false })
}

impl Pair<'_> {
    /// The margin in a frame, and in the local spaces of the two.
    fn margins(&self, placing: &Frame) -> (f64, [f64; 2]) {
        let margin = self.margin / self.frame.scale * placing.scale;
        (margin, placing.stretch().map(|stretch| margin / stretch.least))
    }

    /// The contacts along a normal, given from `b` to `a`, that may not be that of the deepest point.
    fn across(&self, a: &face::Placed, b: &face::Placed, normal: DVec3) -> Vec<Touch> {
        let (face_a, face_b) = facing(a, b, normal);
        self.clipped(a, &face_a, b, &face_b, normal)
    }

    /// The contacts over a triangle along its own normal, given from `b` to `a`; `of_a` says whose it is.
    fn over(&self, a: &face::Placed, b: &face::Placed, normal: DVec3, of_a: bool) -> Vec<Touch> {
        let (mut face_a, mut face_b) = (a.face(-normal), b.face(normal));
        let other = if of_a { &mut face_b } else { &mut face_a };
        if !other.is_faced() {
            let along = if of_a { normal } else { -normal };
            *other = other.clone().slim(along);
        }
        self.clipped(a, &face_a, b, &face_b, normal)
    }
}

impl Meeting {
    /// Of what is known to have a common point.
    fn touching(self) -> Meeting {
        Meeting { depth: self.depth.max(0.0), ..self }
    }

    /// `None` for what is further apart than a margin.
    fn within(self, margin: f64) -> Option<Meeting> {
        (self.depth >= -margin).then_some(self)
    }

    /// The same with the normal as it was corrected; `sign` is that of the side it was corrected on.
    fn along(&self, corrected: &Corrected, sign: f64) -> Meeting {
        Meeting { normal: corrected.normal() * sign, ..*self }
    }
}

/// What a primitive is in contact with, in the common frame.
#[derive(Clone, Copy)]
struct Other<'a> {
    support: &'a dyn Support,
    map: &'a Map,
    /// Of a primitive, where its corners are, of what is round the ends of its core, which of a ball are one; none of others.
    corners: &'a [DVec3],
    /// How far it reaches around these.
    radius: f64,
}

impl Other<'_> {
    fn center(&self) -> DVec3 {
        self.map.point(self.support.center())
    }

    /// The least and the greatest height along a direction, times the length of that.
    fn extremes(&self, direction: DVec3) -> [f64; 2] {
        if !self.corners.is_empty() {
            let [low, high] = extremes(self.corners, direction);
            let around = if self.radius > 0.0 { self.radius * direction.length() } else { 0.0 };
            return [low - around, high + around];
        }
        let local = self.map.linear().transpose() * direction;
        [-local, local].map(|local| direction.dot(self.map.point(self.support.support(local))))
    }
}

/// The corners of a primitive where it is placed.
fn placed_corners(complex: &Complex, primitive: u32, map: &Map) -> SmallVec<[DVec3; 4]> {
    complex.points_of(primitive).map(|point| map.point(point)).collect()
}

/// The least and the greatest height of points along a direction.
fn extremes(points: &[DVec3], direction: DVec3) -> [f64; 2] {
    let heights = points.iter().map(|point| direction.dot(*point));
    heights
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], height| [low.min(height), high.max(height)])
}

/// A primitive of a soup, and what it is in contact with.
struct Side<'a> {
    complex: &'a Complex,
    body: face::Placed<'a>,
    /// Space: common.
    corners: &'a [DVec3],
    other: Other<'a>,
    /// The normal of the primitive when it is a triangle, by its order.
    plane: Option<DVec3>,
    /// 1 when the normal of the triangle points out of a solid, -1 when into it, 0 when there is none.
    orientation: f64,
}

/// A normal out of a primitive.
#[derive(Clone, Copy)]
enum Corrected {
    /// One that the surface has.
    Kept(DVec3),
    /// That of a face next to it, in place of another.
    Adopted(DVec3),
    /// That of the triangle, in place of another.
    Replaced(DVec3),
}

impl Corrected {
    fn normal(&self) -> DVec3 {
        match *self {
            Corrected::Kept(normal) | Corrected::Adopted(normal) | Corrected::Replaced(normal) => normal,
        }
    }
}

impl<'a> Side<'a> {
    fn new(complex: &'a Complex, body: face::Placed<'a>, corners: &'a [DVec3], other: Other<'a>) -> Self {
        let plane = match *corners {
            [p, q, r] => face::triangle_normal([p, q, r]),
            _ => None,
        };
        let turned = body.map.linear().determinant().signum();
        let orientation = if complex.is_solid() { complex.topology().orientation() * turned } else { 0.0 };
        Side { complex, body, corners, other, plane, orientation }
    }

    /// How a triangle and a ball lie to each other, where that is known in closed form.
    fn meeting_of_ball(&self, mirrored: bool) -> Option<Meeting> {
        let (&[p, q, r], &[center]) = (self.corners, self.other.corners) else { return None };
        let Way { out, depth, foot } = way(&[p, q, r], center, self.other.radius)?;
        let on_ball = center - out * self.other.radius;
        Some(match mirrored {
            true => Meeting { normal: out, depth, on_a: on_ball, on_b: foot },
            false => Meeting { normal: -out, depth, on_a: foot, on_b: on_ball },
        })
    }

    /// The normal, if the surface has it where it is touched; else that of the triangle.
    fn corrected(&self, out: DVec3) -> Corrected {
        let Some(normal) = self.plane else { return Corrected::Kept(out) };
        let cosine = normal.dot(out);
        if cosine.abs() > 1.0 - 0.5 * SAME_NORMAL * SAME_NORMAL {
            return Corrected::Kept(normal * cosine.signum());
        }
        if self.is_of_the_surface(out) {
            return Corrected::Kept(out);
        }
        let side = if self.orientation != 0.0 {
            self.orientation
        } else if cosine.abs() > SIDE_COSINE {
            cosine
        } else {
            normal.dot(self.other.center() - self.corners[0])
        };
        let own = normal * side.signum();
        self.shorter_around(own).map_or(Corrected::Replaced(own), Corrected::Adopted)
    }

    /// The normal of a triangle with a flat surface around it, to the side on which the way out is shorter.
    fn flat(&self) -> Option<DVec3> {
        let corners = self.complex.primitive(self.body.primitive);
        let normal = self.complex.topology().is_flat(corners).then_some(self.plane)??;
        let [depth, opposite] = self.depths(normal);
        Some(if depth <= opposite { normal } else { -normal })
    }

    /// The normal of a face next to the primitive that the surface has at the primitive, too, when the way out along it is shorter
    /// than along the primitive's own: that of the shortest.
    fn shorter_around(&self, own: DVec3) -> Option<DVec3> {
        let topology = self.complex.topology();
        let (mut least, mut best) = (self.depths(own)[0] - LEVEL, None);
        let corners: SmallVec<[u32; 4]> =
            self.complex.primitive(self.body.primitive).iter().map(|&i| topology.welded(i)).collect();
        for (i, &corner) in corners.iter().enumerate() {
            for &neighbour in topology.around(corner) {
                let &[p, q, r] = self.complex.primitive(neighbour) else { continue };
                let is_at = |corner: &u32| [p, q, r].iter().any(|&i| topology.welded(i) == *corner);
                if corners[..i].iter().any(is_at) {
                    continue;
                }
                let triangle = self.placed([p, q, r]);
                if !self.may_be_shorter(&triangle, least) {
                    continue;
                }
                let Some(normal) = face::triangle_normal(triangle) else { continue };
                if normal.dot(own).abs() > 1.0 - 0.5 * SAME_NORMAL * SAME_NORMAL {
                    continue;
                }
                for (sign, depth) in [1.0, -1.0].into_iter().zip(self.depths(normal)) {
                    let is_outward = self.orientation * sign >= 0.0;
                    if is_outward && depth < least && self.is_of_the_surface(normal * sign) {
                        (least, best) = (depth, Some(normal * sign));
                    }
                }
            }
        }
        best
    }

    /// Whether the way out along the normal of a triangle may be shorter than a length: a quick look, with the slack
    /// that takes.
    fn may_be_shorter(&self, [p, q, r]: &Triangle, length: f64) -> bool {
        let across = (*q - *p).cross(*r - *p);
        let square = across.length_squared();
        let limit = (length + 2.0 * LEVEL) * square.sqrt();
        let [depth, opposite] = self.depths(across);
        square < SQUARE_MIN || depth.min(opposite) <= limit
    }

    /// How far the other reaches back behind what of the primitive is furthest along a normal, and along its opposite; along a vector of any
    /// length, times that.
    fn depths(&self, out: DVec3) -> [f64; 2] {
        let [low, high] = extremes(self.corners, out);
        let [behind, beyond] = self.other.extremes(out);
        [high - behind, beyond - low]
    }

    /// Where vertices of the soup are.
    fn placed(&self, [p, q, r]: [u32; 3]) -> Triangle {
        let at = |i: u32| self.body.map.point(self.complex.vertices()[i as usize]);
        [at(p), at(q), at(r)]
    }

    /// Whether a normal points into a solid.
    fn is_inward(&self, out: DVec3) -> bool {
        let points_in = |normal: DVec3| self.orientation * normal.dot(out) < -SAME_NORMAL;
        self.orientation != 0.0 && self.plane.is_some_and(points_in)
    }

    /// Whether nothing around what is furthest along a normal, of the primitive, is further.
    fn is_of_the_surface(&self, out: DVec3) -> bool {
        let (complex, topology) = (self.complex, self.complex.topology());
        let local = self.body.map.linear().transpose() * out;
        let height = |vertex: u32| local.dot(complex.vertices()[vertex as usize]);
        let corners = complex.primitive(self.body.primitive);
        let highest = corners.iter().map(|&i| height(i)).fold(f64::NEG_INFINITY, f64::max);
        let mut touched = corners.iter().copied().filter(|&i| height(i) >= highest - LEVEL);
        let Some(first) = touched.next() else { return true };
        let others: Vec<u32> = touched.map(|i| topology.welded(i)).collect();
        topology.around(first).iter().all(|&neighbour| {
            let around = complex.primitive(neighbour);
            let shares = |vertex: &u32| around.iter().any(|&i| topology.welded(i) == *vertex);
            !others.iter().all(shares) || around.iter().all(|&i| height(i) <= highest + LEVEL)
        })
    }
}
