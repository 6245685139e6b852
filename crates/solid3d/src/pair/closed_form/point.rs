//! A point and a body that its placement leaves what it is: how far the point is from the surface, on either side of it.
//!
//! A turned body is a turned profile. Cylinders and cones are figures of the half plane of the distance to the axis and the height,
//! so that each is decided by two edges.

use glam::{DAffine3, DVec2, DVec3};
use solid_convex::unit_scale;

use super::similarity::Similarity;
use crate::pair::{Placed, SurfacePoint};
use crate::placement::length_and_direction;
use crate::shape::{Body, ShapeKind};

/// Where a surface is nearest to a point, in the space of the surface.
pub(super) struct Foot<V> {
    /// Negative inside.
    pub distance: f64,
    /// Outward, of length one.
    pub normal: V,
    /// Where it is.
    pub at: V,
}

/// A point as a body sees it that its placement leaves what it is.
pub(super) struct Seen {
    /// Where the surface is nearest, in the body's own directions and the unit of the pair.
    foot: Foot<DVec3>,
    at: Similarity,
    /// World lengths times this are lengths in the unit of the pair, in which the size of the data is in [1, 2).
    pub scale: f64,
}

impl Seen {
    /// `None` for other shapes than a ball, box, cone, cylinder or capsule, and for placements that are not a rotation with a uniform scale.
    /// `radius` is that of a ball around the point, which belongs to the size of the data. World units.
    #[inline(always)] // most callers want a part of it
    pub fn new(body: Placed, point: DVec3, radius: f64) -> Option<Seen> {
        if matches!(body.shape.kind(), ShapeKind::ConvexHull) {
            return None; // before its facets are made
        }
        let DAffine3 { matrix3, translation } = body.placement;
        let body = body.shape.body()?;
        let extent = extent(&body)?;
        let at = Similarity::new(matrix3)?;
        let offset = point - *translation;
        // In a unit of length near the size of the data, so that squares neither overflow nor underflow.
        let scale = unit_scale(extent * at.stretch + radius + offset.abs().element_sum());
        let point = DVec3::from(at.units().map(|axis| axis.dot(offset * scale)));
        let foot = of_body(&body, at.stretch * scale, point)?;
        Some(Seen { foot, at, scale })
    }

    /// How far the point is from the surface, negative inside. In the unit of the pair.
    pub fn distance(&self) -> f64 {
        self.foot.distance
    }

    /// The outward normal of the surface, where it is nearest. Space: world.
    pub fn normal(&self) -> DVec3 {
        self.turned(self.foot.normal)
    }

    /// The way from the origin of the body to the nearest point of its surface. Space: world.
    pub fn to_surface(&self) -> DVec3 {
        self.turned(self.foot.at) / self.scale
    }

    /// A vector in the body's own directions as the world has it.
    fn turned(&self, v: DVec3) -> DVec3 {
        let [x, y, z] = self.at.units();
        x * v.x + y * v.y + z * v.z
    }
}

/// The point of the surface of a ball, box, cone, cylinder or capsule nearest to a point of the world; `None` for other shapes,
/// and for placements that are not a rotation with a uniform scale.
pub(crate) fn nearest_on_surface(shape: Placed, point: DVec3) -> Option<SurfacePoint> {
    let seen = Seen::new(shape, point, 0.0)?;
    let (distance, normal) = (seen.distance() / seen.scale, seen.normal());
    Some(SurfacePoint { distance, point: point - normal * distance, normal })
}

/// How far a point is from the surface of a ball, box, cone, cylinder or capsule, negative inside, and the outward normal where that is nearest;
/// at an `offset` from the body's origin. No unit is sought: the size of the data must be near 1.
pub(in crate::pair) fn foot(body: &Body, at: &Similarity, offset: DVec3) -> Option<(f64, DVec3)> {
    let [x, y, z] = at.units();
    let foot = of_body(body, at.stretch, DVec3::new(x.dot(offset), y.dot(offset), z.dot(offset)))?;
    Some((foot.distance, x * foot.normal.x + y * foot.normal.y + z * foot.normal.z))
}

/// A bound on the coordinates of a body; `None` for a hull.
#[inline(always)]
pub(super) fn extent(body: &Body) -> Option<f64> {
    Some(match body {
        Body::Sphere(shape) => shape.radius(),
        Body::Cuboid(shape) => shape.size().max_element(),
        Body::Cone(shape) => shape.radius() + shape.height(),
        Body::Cylinder(shape) => shape.radius() + shape.height(),
        Body::Capsule(shape) => shape.radius() + shape.height(),
        Body::Hull { .. } | Body::Simplex { .. } => return None,
    })
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
        Body::Hull { .. } | Body::Simplex { .. } => return None,
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
