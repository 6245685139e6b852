//! Where the surface of a body is nearest to a point, on either side of it, in the body's own space.
//!
//! A turned body is a turned profile. Cylinders and cones are figures of the half plane of the distance to the axis and the height,
//! so that each is decided by two edges.

use glam::{DAffine3, DMat3, DVec2, DVec3};
use solid_convex::gjk::{self, Balls};
use solid_convex::{FaceTowards, Polytope, Support};

use super::similarity::{Similarity, to_body, to_world};
use crate::pair::POINT;
use crate::placement::length_and_direction;
use crate::shape::Body;

/// Where a surface is nearest to a point, in the space of the surface.
pub(in crate::pair) struct Foot<V> {
    /// Negative inside.
    pub distance: f64,
    /// Outward, of length one.
    pub normal: V,
    /// Where it is.
    pub at: V,
}

/// How far a point is from the surface of a ball, box, cone, cylinder or capsule, negative inside, and the outward normal where that is nearest;
/// at an `offset` from the body's origin. No unit is sought: the size of the data must be near 1.
pub(in crate::pair) fn foot(body: &Body, at: &Similarity, offset: DVec3) -> Option<(f64, DVec3)> {
    let [x_axis, y_axis, z_axis] = at.units();
    let units = DMat3 { x_axis, y_axis, z_axis };
    let foot = of_body(body, at.stretch, to_body(&units, offset))?;
    Some((foot.distance, to_world(&units, foot.normal)))
}

/// A bound on the coordinates of a body; `None` for a primitive of a complex shape.
#[inline(always)]
pub(super) fn extent(body: &Body) -> Option<f64> {
    Some(match body {
        Body::Sphere(shape) => shape.radius(),
        Body::Cuboid(shape) => shape.size().max_element(),
        Body::Cone(shape) => shape.radius() + shape.height(),
        Body::Cylinder(shape) => shape.radius() + shape.height(),
        Body::Capsule(shape) => shape.radius() + shape.height(),
        Body::Hull { hull, .. } => hull.polytope().farthest(),
        Body::Simplex(_) => return None,
    })
}

/// Whether a point is within a radius of a body that is `stretch` times its own size; `None` where it is within a margin of that, or the planes of a
/// hull do not tell.
#[inline(always)]
pub(super) fn is_within(body: &Body, stretch: f64, p: DVec3, radius: f64, margin: f64) -> Option<bool> {
    if let Body::Hull { hull, .. } = body {
        return is_within_of_hull(hull.polytope(), p / stretch, radius / stretch, margin / stretch);
    }
    let gap = of_body(body, stretch, p)?.distance - radius;
    (gap.abs() > margin).then_some(gap < 0.0)
}

/// By the balls around it and in it, then by the face that is towards the point. In the hull's own unit.
#[inline]
fn is_within_of_hull(hull: &Polytope, point: DVec3, radius: f64, margin: f64) -> Option<bool> {
    let Balls { inner, outer } = hull.balls()?;
    let (far, near) = (outer.radius + radius + margin, inner.radius + radius - margin);
    if point.distance_squared(outer.center) > far * far {
        return Some(false);
    }
    if inner.radius > 0.0 && near > 0.0 && point.distance_squared(inner.center) < near * near {
        return Some(true);
    }
    let face = hull.face_towards(point)?;
    let gap = face.distance - radius;
    (gap > margin || (face.is_nearest && gap < -margin)).then_some(gap < 0.0)
}

/// For a body that is `stretch` times its own size.
#[inline(always)]
pub(super) fn of_body(body: &Body, stretch: f64, p: DVec3) -> Option<Foot<DVec3>> {
    let half = |height: f64| 0.5 * height * stretch;
    Some(match body {
        Body::Sphere(shape) => of_capsule(shape.radius() * stretch, 0.0, p),
        Body::Capsule(shape) => of_capsule(shape.radius() * stretch, half(shape.height()), p),
        Body::Cuboid(shape) => of_box(shape.size() * (0.5 * stretch), p),
        Body::Cylinder(shape) => {
            turned(p, |q| of_rectangle(DVec2::new(shape.radius() * stretch, half(shape.height())), q))
        }
        Body::Cone(shape) => turned(p, |q| of_cone(shape.radius() * stretch, half(shape.height()), q)),
        Body::Hull { hull, .. } => of_hull(hull.polytope(), stretch, p)?,
        Body::Simplex(_) => return None,
    })
}

/// By the face that is towards the point, where that is nearest; else by a search, of what is outside.
#[inline(always)]
fn of_hull(hull: &Polytope, stretch: f64, p: DVec3) -> Option<Foot<DVec3>> {
    /// From the origin, beside the reach of the hull: of what is round, a face is nearest to less than half of what is beyond that.
    const NEAR: f64 = 1.5;
    let point = p / stretch;
    let near = NEAR * hull.farthest();
    let is_near = point.length_squared() < near * near;
    let face = if is_near { hull.face_towards(point) } else { None };
    match face {
        Some(FaceTowards { distance, normal, is_nearest: true }) => {
            let distance = distance * stretch;
            Some(Foot { distance, normal, at: p - normal * distance })
        }
        _ => foot_by_search(hull, stretch, point),
    }
}

/// `None` inside, and so near to the surface that what is rounded on the way from there would show at the other end of the hull.
#[inline(never)]
fn foot_by_search(hull: &Polytope, stretch: f64, point: DVec3) -> Option<Foot<DVec3>> {
    /// Beside how far the hull and the point are from the origin.
    const NEAR: f64 = 0.1;
    let at = DAffine3::from_translation(point);
    let found = gjk::quickly_closest(hull, &DAffine3::IDENTITY, &POINT, &at)?;
    let size = hull.farthest() + point.abs().max_element();
    let (length, normal) = length_and_direction(point - found.point_on_a)?;
    (length > NEAR * size).then(|| Foot {
        distance: found.distance * stretch,
        normal,
        at: found.point_on_a * stretch,
    })
}

#[inline(always)]
fn of_capsule(radius: f64, half_height: f64, p: DVec3) -> Foot<DVec3> {
    let core = DVec3::Y * p.y.clamp(-half_height, half_height);
    let (length, normal) = polar(p - core, DVec3::X);
    Foot { distance: length - radius, normal, at: core + normal * radius }
}

#[inline(always)]
fn of_box(half: DVec3, p: DVec3) -> Foot<DVec3> {
    let beyond = p.abs() - half;
    if beyond.max_element() > 0.0 {
        let (distance, normal) = polar(beyond.max(DVec3::ZERO), DVec3::X);
        return Foot { distance, normal: normal.copysign(p), at: p.clamp(-half, half) };
    }
    let axis = beyond.max_position();
    let mut at = p;
    at[axis] = half[axis].copysign(p[axis]);
    Foot { distance: beyond[axis], normal: DVec3::AXES[axis] * 1f64.copysign(p[axis]), at }
}

/// Of a body that turns about the axis y, by what its profile is nearest to.
#[inline(always)]
fn turned(p: DVec3, profile: impl Fn(DVec2) -> Foot<DVec2>) -> Foot<DVec3> {
    let (radius, outward) = polar(DVec3::new(p.x, 0.0, p.z), DVec3::X);
    let Foot { distance, normal, at } = profile(DVec2::new(radius, p.y));
    let turned = |q: DVec2| outward * q.x + DVec3::Y * q.y;
    Foot { distance, normal: turned(normal), at: turned(at) }
}

/// The profile of a cylinder: symmetric, up to the corner `half`.
#[inline(always)]
fn of_rectangle(half: DVec2, p: DVec2) -> Foot<DVec2> {
    let beyond = p.abs() - half;
    let up = 1f64.copysign(p.y);
    if beyond.x > 0.0 && beyond.y > 0.0 {
        let (distance, normal) = polar(DVec3::new(beyond.x, beyond.y * up, 0.0), DVec3::X);
        Foot { distance, normal: normal.truncate(), at: DVec2::new(half.x, half.y * up) }
    } else if beyond.x >= beyond.y {
        Foot { distance: beyond.x, normal: DVec2::X, at: DVec2::new(half.x, p.y) }
    } else {
        Foot { distance: beyond.y, normal: DVec2::Y * up, at: DVec2::new(p.x, half.y * up) }
    }
}

/// The profile of a cone: the base at `-half_height`, the apex above.
#[inline(always)]
fn of_cone(radius: f64, half_height: f64, p: DVec2) -> Foot<DVec2> {
    let (apex, rim) = (DVec2::new(0.0, half_height), DVec2::new(radius, -half_height));
    let (length, side) = polar(DVec3::new(2.0 * half_height, radius, 0.0), DVec3::X);
    let side = side.truncate();
    let (beyond_side, below) = (side.dot(p - apex), -half_height - p.y);
    // How far down the side the foot is.
    let down = DVec2::new(side.y, -side.x).dot(p - apex);
    let inside = beyond_side <= 0.0 && below <= 0.0;
    let over_side = beyond_side > 0.0 && (0.0..=length).contains(&down);
    let under_base = below > 0.0 && p.x <= radius;
    if over_side || (inside && beyond_side >= below) {
        Foot { distance: beyond_side, normal: side, at: p - side * beyond_side }
    } else if under_base || inside {
        Foot { distance: below, normal: DVec2::NEG_Y, at: DVec2::new(p.x, -half_height) }
    } else {
        let corner = if down < 0.0 { apex } else { rim };
        let (distance, normal) = polar((p - corner).extend(0.0), DVec3::X);
        Foot { distance, normal: normal.truncate(), at: corner }
    }
}

/// The length of a vector and its direction, which for zero is another.
#[inline(always)]
fn polar(v: DVec3, of_zero: DVec3) -> (f64, DVec3) {
    length_and_direction(v).unwrap_or((0.0, of_zero))
}
