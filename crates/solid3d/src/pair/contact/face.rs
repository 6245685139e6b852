//! The supporting face of a body: the flat or straight part of its surface that faces a direction best.

use std::f64::consts::{FRAC_1_SQRT_2, TAU};

use glam::{DVec2, DVec3};
use libm::atan2;
use smallvec::{SmallVec, smallvec};
use solid_convex::{Capsule, Cone, Cuboid, Cylinder, Line, Sphere, Support, unit_scale};

use super::map::{Map, unit};
use super::{Feature, SAME_DEPTH};
use crate::shape::{Body, Hulled};

/// Corners of the polygon that stands for a circle: what is cut off is 2 % of the radius.
pub(super) const RIM: u32 = 16;

/// A face and a direction are aligned when the sine of the angle between them is at most this: half a degree. Faces need not be:
/// a box that lands on an edge has its lower face for contacts too, with the gap at the other edge.
pub(super) const ALIGNED_SINE: f64 = 0.01;

/// A face that is turned away further than this is no longer faced: its height along the direction loses its digits.
const FACING_COSINE: f64 = 0.05;

/// The side of a capsule counts along its length up to 60 degrees.
pub(super) const SIDE_COSINE: f64 = 0.5;

/// How far beside a corner or an edge a point may be to be on it, in the unit of the pair.
const BESIDE: f64 = 1e-6;

/// A corner of a supporting face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// Space: common.
    pub point: DVec3,
    /// Its number among the vertices of its body.
    pub vertex: u32,
}

/// Most faces have no more than four.
type Corners = SmallVec<[Corner; 4]>;

/// A part of the surface: a convex polygon, a segment or a point.
#[derive(Clone, Debug)]
pub(super) struct Face {
    /// In order around it.
    pub corners: Corners,
    /// The outward unit normal of a polygon; of others a direction that they face.
    pub normal: DVec3,
    /// Its number among the faces of its body.
    pub number: u32,
    /// The cosine of the angle between the normal and the direction that was asked for.
    pub cosine: f64,
}

/// Whether a normal and a direction at an angle with this cosine are aligned.
pub(super) fn is_aligned(cosine: f64) -> bool {
    cosine >= 1.0 - 0.5 * ALIGNED_SINE * ALIGNED_SINE
}

/// Whether an edge that leads so far from a furthest point lies across the direction along which that is.
fn is_level(along: DVec3, direction: DVec3) -> bool {
    -along.dot(direction) <= ALIGNED_SINE * along.length()
}

impl Face {
    /// Whether it is a polygon that lies across the direction it was asked for.
    pub fn is_aligned(&self) -> bool {
        self.corners.len() >= 3 && is_aligned(self.cosine)
    }

    /// Whether it is not seen from its edge.
    pub fn is_faced(&self) -> bool {
        self.corners.len() < 3 || self.cosine >= FACING_COSINE
    }

    /// A body that is a segment or a point; of a segment seen from its end, that.
    fn slight(corners: Corners, direction: DVec3) -> Face {
        let mut face = Face { corners, normal: direction, number: 0, cosine: 1.0 };
        if let [from, to] = face.corners[..]
            && is_aligned((to.point - from.point).normalize_or_zero().dot(direction).abs())
        {
            face.slim(direction);
        }
        face
    }

    /// What a point within it is of.
    pub fn feature(&self) -> Feature {
        match self.corners[..] {
            [corner] => Feature::Vertex(corner.vertex),
            [from, to] => Feature::edge(from.vertex, to.vertex),
            _ => Feature::Face(self.number),
        }
    }

    /// Leaves of it what is furthest along a direction: an edge that is aligned, or a corner.
    pub fn slim(&mut self, direction: DVec3) {
        let height = |corner: &Corner| corner.point.dot(direction);
        let highest =
            *self.corners.iter().max_by(|x, y| height(x).total_cmp(&height(y))).expect("a face has a corner");
        let count = self.corners.len();
        let first = self.corners.iter().position(|corner| corner.vertex == highest.vertex).unwrap_or(0);
        let neighbours = [(first + 1) % count, (first + count - 1) % count].map(|i| self.corners[i]);
        let level = |corner: &&Corner| {
            corner.vertex != highest.vertex && is_level(corner.point - highest.point, direction)
        };
        let other = neighbours.iter().filter(level).max_by(|x, y| height(x).total_cmp(&height(y))).copied();
        self.corners.clear();
        self.corners.push(highest);
        self.corners.extend(other);
    }
}

/// A convex body in the common frame of a pair.
pub(super) struct Placed<'a> {
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
        let local = self.map.linear().transpose() * direction;
        match self.body {
            Body::Sphere(sphere) => self.ball(sphere, direction, local),
            Body::Cuboid(cuboid) => self.side_of_box(cuboid, direction, local),
            Body::Cone(cone) => self.cone(cone, direction, local),
            Body::Cylinder(cylinder) => self.cylinder(cylinder, direction, local),
            Body::Capsule(capsule) => self.capsule(capsule, direction, local),
            Body::Hull { hull, names } => self.facet(hull, *names, direction, local),
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

    fn corner(&self, local: DVec3, vertex: u32) -> Corner {
        Corner { point: self.map.point(local), vertex }
    }

    fn ball(&self, sphere: &Sphere, direction: DVec3, local: DVec3) -> Face {
        let corners = smallvec![self.corner(sphere.support(local), 0)];
        Face { corners, normal: direction, number: 0, cosine: 1.0 }
    }

    fn side_of_box(&self, cuboid: &Cuboid, direction: DVec3, local: DVec3) -> Face {
        let half = 0.5 * cuboid.size();
        let signs = DVec3::ONE.copysign(local);
        let (axis, normal, cosine) = match self.map.stretch() {
            // The sides of a cube are turned as its axes are.
            Some(stretch) => {
                let axis = local.abs().max_position();
                let normal = self.map.linear().col(axis) * (signs[axis] / stretch);
                (axis, normal, local[axis].abs() / stretch)
            }
            None => {
                let rows = self.map.inverse().transpose();
                let normals = [0, 1, 2].map(|axis| unit(rows.col(axis) * signs[axis]));
                let cosine = |axis: &usize| normals[*axis].dot(direction);
                let best_but = |axis: usize| {
                    let others = (0..3).filter(|&other| other != axis);
                    others.max_by(|x, y| cosine(x).total_cmp(&cosine(y))).expect("a box has three axes")
                };
                let mut axis = best_but(3);
                // As of a hull: the edge that ends on this side may lie across the direction.
                if !is_aligned(cosine(&axis))
                    && is_level(self.map.linear().col(axis) * -signs[axis], direction)
                {
                    axis = best_but(axis);
                }
                (axis, normals[axis], cosine(&axis))
            }
        };
        let sign = signs[axis];
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let way = |k: usize| self.map.linear().col(k) * half[k];
        let (center, along_i, along_j) = (self.map.affine.translation + way(axis) * sign, way(i), way(j));
        let corner = |i_is_up: bool, j_is_up: bool| {
            let signed = |way: DVec3, is_up: bool| if is_up { way } else { -way };
            Corner {
                point: center + signed(along_i, i_is_up) + signed(along_j, j_is_up),
                vertex: u32::from(sign > 0.0) << axis | u32::from(i_is_up) << i | u32::from(j_is_up) << j,
            }
        };
        let corners =
            smallvec![corner(true, true), corner(false, true), corner(false, false), corner(true, false)];
        Face { corners, normal, number: 2 * axis as u32 + u32::from(sign < 0.0), cosine }
    }

    fn cylinder(&self, cylinder: &Cylinder, direction: DVec3, local: DVec3) -> Face {
        let (radius, half) = (cylinder.radius(), 0.5 * cylinder.height());
        let y = if local.y < 0.0 { -half } else { half };
        let cap = self.map.normal(DVec3::Y * y.signum());
        let (x, z) = azimuth(local);
        let side = self.map.normal(DVec3::new(x, 0.0, z));
        let (of_cap, of_side) = (cap.dot(direction), side.dot(direction));
        if of_cap >= of_side {
            let first = if y < 0.0 { RIM } else { 0 };
            let number = u32::from(y < 0.0);
            return Face { corners: self.rim(radius, y, first, local), normal: cap, number, cosine: of_cap };
        }
        let end = |y: f64, vertex: u32| self.corner(DVec3::new(radius * x, y, radius * z), vertex);
        let corners = smallvec![end(half, 2 * RIM), end(-half, 2 * RIM + 1)];
        Face { corners, normal: side, number: 2, cosine: of_side }
    }

    fn cone(&self, cone: &Cone, direction: DVec3, local: DVec3) -> Face {
        let (radius, half) = (cone.radius(), 0.5 * cone.height());
        let base = self.map.normal(DVec3::NEG_Y);
        let (x, z) = azimuth(local);
        let largest = radius.max(cone.height());
        let (across, along) = (cone.height() / largest, radius / largest);
        let side = self.map.normal(DVec3::new(x * across, along, z * across));
        let (of_base, of_side) = (base.dot(direction), side.dot(direction));
        if of_base >= of_side {
            let corners = self.rim(radius, -half, RIM, local);
            return Face { corners, normal: base, number: 1, cosine: of_base };
        }
        let corners = smallvec![
            self.corner(DVec3::new(0.0, half, 0.0), 2 * RIM),
            self.corner(DVec3::new(radius * x, -half, radius * z), 2 * RIM + 1),
        ];
        Face { corners, normal: side, number: 2, cosine: of_side }
    }

    fn capsule(&self, capsule: &Capsule, direction: DVec3, local: DVec3) -> Face {
        let (radius, half) = (capsule.radius(), capsule.half_height());
        let (x, z) = azimuth(local);
        let side = self.map.normal(DVec3::new(x, 0.0, z));
        let cosine = side.dot(direction);
        let upper = u32::from(local.y >= 0.0);
        let mut corners: Corners = smallvec![self.corner(capsule.support(local), upper)];
        if cosine >= SIDE_COSINE {
            let far = if local.y < 0.0 { half } else { -half };
            corners.push(self.corner(DVec3::new(radius * x, far, radius * z), 1 - upper));
        }
        Face { corners, normal: side, number: 0, cosine }
    }

    /// A circle across the axis y: corners at places that stay with the body, and, where it reaches further than these, the furthest point.
    fn rim(&self, radius: f64, y: f64, first: u32, local: DVec3) -> Corners {
        let corner = |(x, z): (f64, f64), vertex| self.corner(DVec3::new(radius * x, y, radius * z), vertex);
        let mut corners: Corners = (0..RIM).map(|i| corner(on_circle(i), first + i)).collect();
        let (x, z) = azimuth(local);
        let turn = atan2(z, x) / TAU;
        let before = (turn - turn.floor()) * f64::from(RIM);
        let beside = (before - before.round()) * TAU / f64::from(RIM);
        let beyond = 0.5 * beside * beside * radius;
        if beyond * DVec2::new(local.x, local.z).length() > SAME_DEPTH {
            corners.insert((before as usize + 1).min(RIM as usize), corner((x, z), 2 * RIM + 2));
        }
        corners
    }

    fn facet(&self, hull: &Hulled, names: Option<&[u32]>, direction: DVec3, local: DVec3) -> Face {
        let (points, facets) = (hull.points(), hull.facets());
        let named = |i: u32| names.map_or(i, |names| names[i as usize]);
        let corner = |&i: &u32| self.corner(points[i as usize], named(i));
        let Some(number) = self.best_facet(hull, direction, hull.polytope().support_index(local)) else {
            return Face::slight(facets.extreme().iter().map(corner).collect(), direction);
        };
        let facet = facets.get(number);
        let normal = self.map.normal(facet.normal);
        let corners = facet.corners.iter().map(corner).collect();
        Face { corners, normal, number, cosine: normal.dot(direction) }
    }

    /// The facet of a hull that faces a direction best, of those at the furthest point; if an edge there lies across the direction, of the two beside
    /// it, as another one that ends there may face it better.
    fn best_facet(&self, hull: &Hulled, direction: DVec3, furthest: usize) -> Option<u32> {
        let facets = hull.facets();
        let cosine = |facet: u32| self.map.normal(facets.get(facet).normal).dot(direction);
        let better = |x: &u32, y: &u32| cosine(*x).total_cmp(&cosine(*y)).then(y.cmp(x));
        let there = facets.at(furthest).iter().copied();
        let Some(best) = there.clone().max_by(better) else {
            // The furthest point was flattened out of an edge.
            return (0..facets.len()).max_by(better);
        };
        if is_aligned(cosine(best)) {
            return Some(best);
        }
        let way = |end: u32| self.map.linear() * (hull.points()[end as usize] - hull.points()[furthest]);
        let ends = there.clone().map(|facet| facets.get(facet).after(furthest as u32));
        let level = ends.map(|end| (end, way(end))).filter(|&(_, way)| is_level(way, direction));
        let edge = level.max_by(|(_, x), (_, y)| x.dot(direction).total_cmp(&y.dot(direction)));
        let has_edge = |&facet: &u32| edge.is_none_or(|(end, _)| facets.get(facet).corners.contains(&end));
        there.filter(has_edge).max_by(better)
    }

    /// Both sides of a triangle are its face. One without area is a segment.
    fn simplex(&self, vertices: &[u32], direction: DVec3) -> Face {
        let corner = |i: usize| Corner { point: self.corners[i], vertex: vertices[i] };
        if let Some(normal) = self.plane {
            let corners = smallvec![corner(0), corner(1), corner(2)];
            let cosine = normal.dot(direction);
            let number = u32::from(cosine < 0.0);
            return Face { corners, normal: normal * cosine.signum(), number, cosine: cosine.abs() };
        }
        let mut corners: Corners = (0..vertices.len()).map(corner).collect();
        if let [p, q, r] = corners[..] {
            let length = |pair: &[Corner; 2]| pair[0].point.distance_squared(pair[1].point);
            let longest = [[p, q], [q, r], [p, r]].into_iter().max_by(|x, y| length(x).total_cmp(&length(y)));
            corners = longest.expect("a triangle has edges")[..].into();
        }
        corners.dedup_by(|x, y| x.point == y.point);
        Face::slight(corners, direction)
    }
}

/// The unit normal of a triangle; `None` for one without area.
pub(super) fn triangle_normal([p, q, r]: [DVec3; 3]) -> Option<DVec3> {
    /// The square of twice the least area whose squares lose no digits.
    const PLAIN_MIN: f64 = 1e-200;
    let (u, v) = (q - p, r - p);
    if u.cross(v).length_squared() >= PLAIN_MIN { normal_across(u, v) } else { scaled_normal_across(u, v) }
}

/// The same in a unit of its own, where squares of its area do not vanish: the other shape may be any number of times as large.
#[cold]
fn scaled_normal_across(u: DVec3, v: DVec3) -> Option<DVec3> {
    let unit = unit_scale(u.abs().max(v.abs()).max_element());
    normal_across(u * unit, v * unit)
}

/// The unit normal of a triangle by two of its edges.
#[inline(always)]
fn normal_across(u: DVec3, v: DVec3) -> Option<DVec3> {
    /// The sine of the least angle at a corner beyond which the normal has no digits.
    const SINE_MIN: f64 = 1e-12;
    let cross = u.cross(v);
    let area = cross.length();
    let longest = u.length_squared().max(v.length_squared()).max((v - u).length_squared());
    (area > SINE_MIN * longest).then(|| cross / area)
}

/// The cosine and the sine of sixteenths of a turn.
fn on_circle(i: u32) -> (f64, f64) {
    /// Those of an eighth of half a turn.
    const COSINE: f64 = 0.923_879_532_511_286_7;
    const SINE: f64 = 0.382_683_432_365_089_8;
    let (x, z) = [(1.0, 0.0), (COSINE, SINE), (FRAC_1_SQRT_2, FRAC_1_SQRT_2), (SINE, COSINE)][i as usize % 4];
    [(x, z), (-z, x), (-x, -z), (z, -x)][i as usize / 4]
}

/// The direction across the axis y, as a unit vector; x when there is none.
fn azimuth(local: DVec3) -> (f64, f64) {
    let largest = local.x.abs().max(local.z.abs());
    if largest == 0.0 {
        return (1.0, 0.0);
    }
    let (x, z) = (local.x / largest, local.z / largest);
    let length = (x * x + z * z).sqrt();
    (x / length, z / length)
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DMat3, DQuat};
    use rand::Rng;
    use solid_oracle::generate::{direction, in_cube, seeded};

    use super::*;
    use crate::shape::Shape;

    /// Law: where a box stays one, its sides are those that the inverse tells.
    #[test]
    fn sides_of_a_box_that_stays_one() {
        let mut rng = seeded(176);
        let shape = Shape::cuboid([1.2, 1.0, 0.8]).unwrap();
        let body = shape.body().unwrap();
        for case in 0..3_000 {
            let turn = DMat3::from_quat(DQuat::from_scaled_axis(in_cube(&mut rng) * 3.0));
            let mirror = DVec3::new([1.0, -1.0][case % 2], 1.0, 1.0) * rng.random_range(0.01..1.0);
            let at =
                DAffine3 { matrix3: turn * DMat3::from_diagonal(mirror), translation: in_cube(&mut rng) };
            let (quick, slow) = (Map::new(at), Map::of_any_shape(at));
            assert!(quick.stretch().is_some());
            let toward = direction(&mut rng);
            let [x, y] = [&quick, &slow].map(|map| Placed::new(&body, map).face(toward));
            assert_eq!(x.number, y.number, "{at}, {toward}");
            assert!((x.normal - y.normal).length() < 1e-14 && (x.cosine - y.cosine).abs() < 1e-14, "{at}");
            for (p, q) in x.corners.iter().zip(&y.corners) {
                assert!(p.vertex == q.vertex && (p.point - q.point).length() < 1e-14, "{at}, {toward}");
            }
        }
    }

    /// Law: the corners of a rim are those of a regular polygon, in order.
    #[test]
    fn a_rim_is_regular() {
        for i in 0..RIM {
            let angle = TAU * f64::from(i) / f64::from(RIM);
            let (x, z) = on_circle(i);
            assert!((x - angle.cos()).abs() < 1e-15 && (z - angle.sin()).abs() < 1e-15, "{i}: {x} {z}");
        }
    }

    /// A triangle may be any number of times smaller than the pair that the frame is around.
    #[test]
    fn a_triangle_of_any_size_has_a_unit_normal() {
        for exponent in (-200..=0).step_by(3) {
            let corners = [[1.0, 2.0, 3.0], [2.5, -1.0, 0.5], [-0.5, 1.5, -2.0]];
            let corners = corners.map(|p| DVec3::from_array(p) * 10f64.powi(exponent));
            let normal = triangle_normal(corners).expect("it has an area");
            assert!((normal.length() - 1.0).abs() < 1e-14, "1e{exponent}: {normal}");
            let [p, q, r] = corners.map(|corner| corner * 10f64.powi(-exponent));
            assert!(
                normal.dot(q - p).abs() < 1e-12 && normal.dot(r - p).abs() < 1e-12,
                "1e{exponent}: {normal}"
            );
        }
    }
}
