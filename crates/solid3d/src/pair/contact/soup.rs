//! The contacts of pairs of primitives, with normals that the surfaces have.
//!
//! A triangle in a surface is not alone: a box that slides over a floor is pushed up by each triangle under it, and by none of them aside,
//! though aside may be the shortest way off that triangle. A normal is one of the surface when the part of the triangle that it touches
//! is the highest along it of all that is around: the face always, an edge or a corner when the surface is convex there
//! and the normal between those of the faces. Any other is replaced by the normal of the triangle.

use std::ops::ControlFlow;

use glam::{DAffine3, DVec3};
use solid_convex::Support;

use super::super::table::PlacedConvex;
use super::super::{Scratch, complex_complex, complex_convex, table, triangle_triangle};
use super::{Meeting, Pair, Part, Patch, Touch, face, plane_of};
use crate::shape::{Body, Complex};
use crate::tree::pairs;
use crate::triangle_triangle::Triangle;

/// Heights along a normal that differ by less than this, in the unit of the pair, are the same.
const LEVEL: f64 = 1e-9;

/// A normal whose cosine with that of the triangle is beyond this tells the side on which the other is.
const SIDE_COSINE: f64 = 0.2;

/// A normal within this of that of the triangle is the same: the square root of the error of a depth.
const SAME_NORMAL: f64 = 1e-6;

/// The contacts of two bodies.
pub(super) fn body_body(pair: &Pair, a: &Part, b: &Part) -> Vec<Patch> {
    let (Part::Body(kind_a, of_a), Part::Body(kind_b, of_b)) = (a, b) else { return Vec::new() };
    let Some(meeting) = pair.meeting(*of_a, *of_b, false) else { return Vec::new() };
    let [map_a, map_b] = pair.frame.common;
    let (placed_a, placed_b) = (face::Placed::new(kind_a, map_a), face::Placed::new(kind_b, map_b));
    let touches = pair.touches(&placed_a, &placed_b, &meeting);
    vec![Patch { primitives: [0, 0], normal: meeting.normal, touches, is_inward: false }]
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
    let (query, _) = complex_convex::convex_in_complex((complex, placed_soup.placement), convex);
    let [map_soup, map_body] =
        if mirrored { [pair.frame.common[1], pair.frame.common[0]] } else { pair.frame.common };
    let query = query.inflated(pair.local_margin(usize::from(mirrored)));
    let body = face::Placed::new(kind, map_body);
    let center = map_body.transform_point3(support.center());
    let mut found = Vec::new();
    let Scratch { traversal, primitive_tests, .. } = scratch;
    let _ = complex.tree().overlapping(&query, traversal, |leaf| {
        found.extend(leaf.iter().filter(|&&i| complex.primitive_bounds(i).overlaps(&query)));
        ControlFlow::<()>::Continue(())
    });
    // In an order that does not depend on the tree.
    found.sort_unstable();
    *primitive_tests += found.len() as u64;
    let patch = |primitive: u32| {
        let hull = complex.primitive_hull(primitive);
        let primitive_body = Body::of_primitive(complex, primitive);
        let placed = face::Placed::new(&primitive_body, map_soup);
        let side = Side { complex, primitive, body: placed, other: center };
        let (meeting, primitives) = if mirrored {
            (pair.meeting(*support, &hull, false)?, [0, primitive])
        } else {
            (pair.meeting(&hull, *support, false)?, [primitive, 0])
        };
        let out = if mirrored { meeting.normal } else { -meeting.normal };
        let corrected = side.corrected(out);
        let touches = match corrected {
            Corrected::Kept(_) if mirrored => {
                pair.touches(&body, &side.body, &meeting.along(&corrected, 1.0))
            }
            Corrected::Kept(_) => pair.touches(&side.body, &body, &meeting.along(&corrected, -1.0)),
            Corrected::Replaced(normal) if mirrored => pair.over(&body, &side.body, normal, false),
            Corrected::Replaced(normal) => pair.over(&side.body, &body, -normal, true),
        };
        let out = corrected.normal();
        let is_inward = side.is_inward(out);
        (!touches.is_empty()).then_some(Patch {
            primitives,
            normal: if mirrored { out } else { -out },
            touches,
            is_inward,
        })
    };
    found.into_iter().filter_map(patch).collect()
}

/// The placed corners of a primitive that is a triangle.
fn corners(complex: &Complex, primitive: u32, map: &DAffine3) -> Option<Triangle> {
    let corners = complex_complex::corners(complex, primitive)?;
    Some(corners.map(|corner| map.transform_point3(corner)))
}

/// The contacts of two soups.
pub(super) fn soup_soup(pair: &Pair, a: &Complex, b: &Complex, scratch: &mut Scratch) -> Vec<Patch> {
    let mut relative = pair.frame.relative;
    relative.slack_in_a += pair.local_margin(0);
    relative.slack_in_b += pair.local_margin(1);
    let [map_a, map_b] = pair.frame.common;
    let Scratch { traversal, leaves: [in_a, in_b], primitive_tests, .. } = scratch;
    let mut found: Vec<([u32; 2], bool)> = Vec::new();
    let _ = pairs(a.tree(), b.tree(), &relative, traversal, |leaf_a, leaf_b| {
        complex_complex::place(a, leaf_a, &map_a, in_a);
        complex_complex::place(b, leaf_b, &map_b, in_b);
        for x in &*in_a {
            let reached = x.bounds.inflated(pair.margin);
            for y in in_b.iter().filter(|y| reached.overlaps(&y.bounds)) {
                // Of triangles it is decided exactly, as everywhere.
                let [of_a, of_b] = [corners(a, x.primitive, &map_a), corners(b, y.primitive, &map_b)];
                let meet = of_a.zip(of_b).map(|(x, y)| triangle_triangle::intersect(&x, &y));
                if meet != Some(false) || pair.margin > 0.0 {
                    found.push(([x.primitive, y.primitive], meet == Some(true)));
                }
            }
        }
        ControlFlow::<()>::Continue(())
    });
    found.sort_unstable();
    *primitive_tests += found.len() as u64;
    let patch = |(primitives, must): ([u32; 2], bool)| {
        let [i, j] = primitives;
        let (hull_a, hull_b) = (a.primitive_hull(i), b.primitive_hull(j));
        let meeting = pair.meeting(&hull_a, &hull_b, must)?;
        let center =
            |support: &dyn Support, of: usize| pair.frame.common[of].transform_point3(support.center());
        let (body_a, body_b) = (Body::of_primitive(a, i), Body::of_primitive(b, j));
        let (placed_a, placed_b) = (face::Placed::new(&body_a, map_a), face::Placed::new(&body_b, map_b));
        let (center_a, center_b) = (center(&hull_a, 0), center(&hull_b, 1));
        let of_a = Side { complex: a, primitive: i, body: placed_a, other: center_b };
        let of_b = Side { complex: b, primitive: j, body: placed_b, other: center_a };
        let (on_a, on_b) = (of_a.corrected(-meeting.normal), of_b.corrected(meeting.normal));
        let (normal, touches) = match (on_a, on_b) {
            (_, Corrected::Replaced(normal)) => (normal, pair.over(&of_a.body, &of_b.body, normal, false)),
            (Corrected::Replaced(normal), _) => (-normal, pair.over(&of_a.body, &of_b.body, -normal, true)),
            (_, kept) => {
                let meeting = meeting.along(&kept, 1.0);
                (meeting.normal, pair.touches(&of_a.body, &of_b.body, &meeting))
            }
        };
        let is_inward = of_a.is_inward(-normal) || of_b.is_inward(normal);
        (!touches.is_empty()).then_some(Patch { primitives, normal, touches, is_inward })
    };
    found.into_iter().filter_map(patch).collect()
}

/// The deepest point of two shapes as wholes: of what is wholly inside a solid, or touches by so little that no pair of primitives
/// told.
pub(super) fn whole(pair: &Pair, scratch: &mut Scratch) -> Option<Patch> {
    let found = table::penetration(pair.a, pair.b, scratch)?;
    let [from_a, from_b] = &pair.frame.common;
    let touch = Touch {
        on_a: from_a.transform_point3(found.points.on_a),
        on_b: from_b.transform_point3(found.points.on_b),
        depth: found.depth * pair.frame.scale,
        features: [super::Feature::Face(0); 2],
    };
    Some(Patch { primitives: [0, 0], normal: found.direction, touches: vec![touch], is_inward: false })
}

impl Pair<'_> {
    /// The margin in the local space of one of the two.
    fn local_margin(&self, of: usize) -> f64 {
        self.margin / self.frame.stretch[of].least
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
    /// The same with the normal as it was corrected; `sign` is that of the side it was corrected on.
    fn along(&self, corrected: &Corrected, sign: f64) -> Meeting {
        Meeting { normal: corrected.normal() * sign, ..*self }
    }
}

/// A primitive of a soup, and where the other is.
struct Side<'a> {
    complex: &'a Complex,
    primitive: u32,
    body: face::Placed<'a>,
    /// The middle of the other. Space: common.
    other: DVec3,
}

/// A normal out of a primitive.
#[derive(Clone, Copy)]
enum Corrected {
    /// One that the surface has.
    Kept(DVec3),
    /// That of the triangle, in place of another.
    Replaced(DVec3),
}

impl Corrected {
    fn normal(&self) -> DVec3 {
        match *self {
            Corrected::Kept(normal) | Corrected::Replaced(normal) => normal,
        }
    }
}

impl Side<'_> {
    /// The normal, if the surface has it where it is touched; else that of the triangle.
    fn corrected(&self, out: DVec3) -> Corrected {
        let Some(normal) = self.plane() else { return Corrected::Kept(out) };
        let cosine = normal.dot(out);
        if cosine.abs() > 1.0 - 0.5 * SAME_NORMAL * SAME_NORMAL {
            return Corrected::Kept(normal * cosine.signum());
        }
        if self.is_of_the_surface(out) {
            return Corrected::Kept(out);
        }
        let first = self.complex.primitive(self.primitive)[0];
        let corner = self.body.map.transform_point3(self.complex.vertices()[first as usize]);
        let side = if self.orientation() != 0.0 {
            self.orientation()
        } else if cosine.abs() > SIDE_COSINE {
            cosine
        } else {
            normal.dot(self.other - corner)
        };
        Corrected::Replaced(normal * side.signum())
    }

    /// The normal of a triangle, by its order.
    fn plane(&self) -> Option<DVec3> {
        let &[i, j, k] = self.complex.primitive(self.primitive) else { return None };
        plane_of(&self.body.map, [i, j, k].map(|i| self.complex.vertices()[i as usize]))
    }

    /// 1 when the normal of the triangle points out of a solid, -1 when into it, 0 when there is none.
    fn orientation(&self) -> f64 {
        let turned = self.body.map.matrix3.determinant().signum();
        if self.complex.is_solid() { self.complex.topology().orientation() * turned } else { 0.0 }
    }

    /// Whether a normal points into a solid.
    fn is_inward(&self, out: DVec3) -> bool {
        let orientation = self.orientation();
        orientation != 0.0 && self.plane().is_some_and(|normal| orientation * normal.dot(out) < -SAME_NORMAL)
    }

    /// Whether nothing around what is furthest along a normal, of the primitive, is further.
    fn is_of_the_surface(&self, out: DVec3) -> bool {
        let (complex, topology) = (self.complex, self.complex.topology());
        let local = self.body.map.matrix3.transpose() * out;
        let height = |vertex: u32| local.dot(complex.vertices()[vertex as usize]);
        let corners = complex.primitive(self.primitive);
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
