//! A convex body in the common frame of a pair: which of its faces supports it, and how high its surface is.

use glam::DVec3;
use solid_convex::Line;

use super::super::map::Map;
use super::normal::triangle_normal;
use super::{Corner, FACING_COSINE, Face};
use crate::shape::Body;

/// How far beside a corner or an edge a point may be to be on it, in the unit of the pair.
const BESIDE: f64 = 1e-6;

/// A convex body in the common frame of a pair.
pub struct Placed<'a> {
    body: &'a Body<'a>,
    pub map: &'a Map,
    /// Its number in the shape it is of.
    pub primitive: u32,
    /// Where the corners of a primitive are; none of a shape that is one body.
    pub corners: &'a [DVec3],
    /// The unit normal of a triangle that has one, by the order of its corners.
    pub plane: Option<DVec3>,
}

impl<'a> Placed<'a> {
    /// A shape that is one body.
    pub fn new(body: &'a Body<'a>, map: &'a Map) -> Self {
        Placed { body, map, primitive: 0, corners: &[], plane: None }
    }

    /// A primitive of a complex shape, whose corners are there.
    pub fn of_primitive(body: &'a Body<'a>, primitive: u32, map: &'a Map, corners: &'a [DVec3]) -> Self {
        let plane = match *corners {
            [p, q, r] => triangle_normal([p, q, r]),
            _ => None,
        };
        Placed { body, map, primitive, corners, plane }
    }

    pub fn body(&self) -> &'a Body<'a> {
        self.body
    }

    /// Whether it touches in one point, whatever it touches.
    pub fn is_ball(&self) -> bool {
        matches!(self.body, Body::Sphere(_))
    }

    /// Whether what a face says of the heights is only true at its corners.
    fn is_round(&self) -> bool {
        !matches!(self.body, Body::Cuboid(_) | Body::Hull { .. } | Body::Simplex(_))
    }

    /// The face that faces a direction best, of those at the furthest point along it. Space of the direction: common.
    pub fn face(&self, direction: DVec3) -> Face {
        self.face_within(direction, &[])
    }

    /// The same, beside another body: of a face of many sides what a triangle may reach, if that is one, and what is furthest along the direction.
    pub fn face_beside(&self, direction: DVec3, other: &Placed) -> Face {
        self.face_within(direction, other.corners)
    }

    fn face_within(&self, direction: DVec3, reach: &[DVec3]) -> Face {
        let local = self.map.linear().transpose() * direction;
        match self.body {
            Body::Sphere(sphere) => self.ball(sphere, direction, local),
            Body::Cuboid(cuboid) => self.side_of_box(cuboid, direction, local),
            Body::Cone(cone) => self.cone(cone, direction, local),
            Body::Cylinder(cylinder) => self.cylinder(cylinder, direction, local),
            Body::Capsule(capsule) => self.capsule(capsule, direction, local),
            Body::Hull { hull, names } => self.facet(hull, *names, direction, local, reach),
            Body::Simplex(vertices) => self.simplex(vertices, direction),
        }
    }

    /// How far along `direction` the surface is at a place beside or on the face, on the side that `out` points to: `direction` or its
    /// opposite. `None` where the body is not.
    pub fn height(&self, face: &Face, at: DVec3, direction: DVec3, out: DVec3) -> Option<f64> {
        let of_face = self.height_of(face, at, direction);
        let Some([enter, leave]) = self.is_round().then(|| self.chord(at, direction)).flatten() else {
            return of_face;
        };
        // The face is in the body: at its rim, where a line may leave again at once, it is further out.
        let (along, base) = (out.dot(direction) > 0.0, at.dot(direction));
        let of_body = base + if along { leave } else { enter };
        Some(
            of_face
                .map_or(of_body, |of_face| if along { of_body.max(of_face) } else { of_body.min(of_face) }),
        )
    }

    /// The same of the face alone.
    fn height_of(&self, face: &Face, at: DVec3, direction: DVec3) -> Option<f64> {
        let height = |corner: &Corner| corner.point.dot(direction);
        match &face.corners[..] {
            [] => None,
            [corner] => {
                let off = corner.point - at;
                let beside = off - direction * off.dot(direction);
                (beside.length() <= BESIDE).then(|| height(corner))
            }
            [from, to] => {
                let across = |v: DVec3| v - direction * v.dot(direction);
                let (edge, off) = (across(to.point - from.point), across(at - from.point));
                let length_squared = edge.length_squared();
                let t =
                    if length_squared > 0.0 { (off.dot(edge) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
                let beside = off - edge * t;
                (beside.length() <= BESIDE).then(|| height(from) * (1.0 - t) + height(to) * t)
            }
            [first, ..] => {
                let slope = face.normal.dot(direction);
                (slope.abs() >= FACING_COSINE)
                    .then(|| at.dot(direction) + face.normal.dot(first.point - at) / slope)
            }
        }
    }

    /// Where a line along a direction runs through a round body, as parameters.
    fn chord(&self, at: DVec3, direction: DVec3) -> Option<[f64; 2]> {
        let inverse = self.map.inverse();
        let origin = *inverse * (at - self.map.affine.translation);
        let line = Line::new(origin, *inverse * direction)?;
        let chord = match self.body {
            Body::Sphere(sphere) => sphere.chord(&line),
            Body::Cone(cone) => cone.chord(&line),
            Body::Cylinder(cylinder) => cylinder.chord(&line),
            Body::Capsule(capsule) => capsule.chord(&line),
            Body::Cuboid(_) | Body::Hull { .. } | Body::Simplex(_) => None,
        }?;
        Some([chord.enter.t, chord.leave.t])
    }

    pub(super) fn corner(&self, local: DVec3, vertex: u32) -> Corner {
        Corner { point: self.map.point(local), vertex }
    }
}
