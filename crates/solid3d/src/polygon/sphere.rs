//! A polygon against a sphere (thesis, section 3.3.1).

use glam::DVec3;
use solid_convex::{MAGNITUDE_MAX, unit_scale};

use super::Polygon;
use super::chain::scaled;
use super::error::{PolygonError, Result};
use super::exact::flatten;
use super::planar;

/// How far the distance of a sphere's centre from a flat polygon may be off, relative to the greatest coordinate of both:
/// about 40 roundings of 2^-53, of which each of the differences, products and the foot of the perpendicular has a few.
pub const SPHERE_ERROR: f64 = 4e-15;

/// Whether the polygon shares a point with a ball.
pub(super) fn meets(polygon: &Polygon, center: DVec3, radius: f64) -> Result<bool> {
    let argument = |argument, value: f64| match value.is_finite() && value.abs() <= MAGNITUDE_MAX {
        true => Ok(()),
        false => Err(PolygonError::Argument { argument, value }),
    };
    center.to_array().into_iter().try_for_each(|value| argument("center", value))?;
    argument("radius", if radius < 0.0 { f64::NEG_INFINITY } else { radius })
        .map_err(|_| PolygonError::Argument { argument: "radius", value: radius })?;

    // All lengths in a unit near the size of the data.
    let size = polygon.reach().max(center.abs().max_element()).max(radius);
    let scale = unit_scale(size);
    let (center, radius) = (center * scale, radius * scale);
    let plane = polygon.plane();
    let height = (plane.normal.dot(center) + plane.offset * scale).abs();

    // 1. The plane misses the ball, by more than the plane may be off.
    let doubt = plane.deviation * scale + (plane.normal_error + SPHERE_ERROR) * 4.0;
    if plane.normal != DVec3::ZERO && height > radius + doubt {
        return Ok(false);
    }
    // 2. A vertex lies in the ball.
    let vertices = &polygon.chain.vertices;
    let at = |i: usize| scaled(vertices[i], scale);
    let squared = radius * radius;
    if (0..vertices.len()).any(|i| at(i).distance_squared(center) <= squared) {
        return Ok(true);
    }
    // 3. An edge meets the ball.
    if polygon.chain.edges().any(|[i, j]| distance_squared(center, at(i), at(j)) <= squared) {
        return Ok(true);
    }
    // 4. The foot of the perpendicular from the centre, in the ball, lies in the polygon.
    let Some(base) = polygon.chain.base else { return Ok(false) };
    let foot = center - plane.normal * (plane.normal.dot(center - at(0)));
    let flat: Vec<_> = (0..vertices.len()).map(|i| flatten(base.dropped, at(i))).collect();
    Ok(height <= radius && planar::contains(&flat, flatten(base.dropped, foot)))
}

/// The squared distance of a point from a segment.
fn distance_squared(x: DVec3, p: DVec3, q: DVec3) -> f64 {
    let (along, to_x) = (q - p, x - p);
    let length_squared = along.length_squared();
    let t = if length_squared > 0.0 { (to_x.dot(along) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
    (to_x - along * t).length_squared()
}
