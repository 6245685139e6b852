//! A polygon against a box along the axes (thesis, section 3.3.2).

use glam::{DVec2, DVec3};
use solid_convex::{MAGNITUDE_MAX, unit_scale};

use super::Polygon;
use super::chain::{Base, Chain, scaled};
use super::error::{PolygonError, Result};
use super::exact::{fits, flatten, same_strict_side, turn};
use super::segment;
use crate::bounds::Aabb;

/// Whether the polygon shares a point with a box: exact for a flat polygon. An empty box meets nothing.
pub(super) fn meets(polygon: &Polygon, bounds: &Aabb) -> Result<bool> {
    let all = bounds.min.to_array().into_iter().chain(bounds.max.to_array());
    if let Some(value) = all.into_iter().find(|x| x.is_nan() || x.is_finite() && x.abs() > MAGNITUDE_MAX) {
        return Err(PolygonError::Argument { argument: "bounds", value });
    }
    if bounds.min.cmpgt(bounds.max).any() {
        return Ok(false);
    }
    // A side that is infinitely far off may as well be just behind the polygon.
    let reach = polygon.reach();
    let corner = |x: DVec3| x.map(|x| if x.is_finite() { x } else { 2.0 * reach * x.signum() });
    let bounds = Aabb::new(corner(bounds.min), corner(bounds.max));
    let box_reach = bounds.min.abs().max(bounds.max.abs());
    if polygon.fits_predicates && [bounds.min, bounds.max].into_iter().all(fits) {
        return Ok(meets_chain(&polygon.chain, &bounds));
    }
    let scale = unit_scale(reach.max(box_reach.max_element()));
    let bounds = Aabb::new(scaled(bounds.min, scale), scaled(bounds.max, scale));
    Ok(meets_chain(&polygon.chain.scaled(scale), &bounds))
}

fn meets_chain(polygon: &Chain, bounds: &Aabb) -> bool {
    // A vertex in the box; or all beyond one of its planes.
    let codes: Vec<u8> = polygon.vertices.iter().map(|&p| outcode(p, bounds)).collect();
    if codes.contains(&0) {
        return true;
    }
    if codes.iter().fold(!0, |all, code| all & code) != 0 {
        return false;
    }
    // The plane meets the box if and only if it meets one of its diagonals. That rejects most, but an uneven polygon may reach
    // out of its plane.
    let crossed = polygon.base.and_then(|base| Some((base, crossed_diagonal(polygon, base, bounds)?)));
    if crossed.is_none() && polygon.base.is_some() && polygon.is_flat() {
        return false;
    }
    // An edge meets the box.
    let edge_meets = |[i, j]: [usize; 2]| {
        codes[i] & codes[j] == 0 && line_meets(polygon.vertices[i], polygon.vertices[j], bounds)
    };
    if polygon.edges().any(edge_meets) {
        return true;
    }
    // The box meets the polygon inside, if at all; then any common point of plane and box tells.
    crossed.is_some_and(|(base, [p, q])| segment::meets_polygon(polygon, base, p, q))
}

/// A bit for each plane of the box that the point lies beyond (Cohen and Sutherland).
fn outcode(p: DVec3, bounds: &Aabb) -> u8 {
    p.cmplt(bounds.min).bitmask() as u8 | (p.cmpgt(bounds.max).bitmask() as u8) << 3
}

/// A diagonal of the box that meets the polygon's plane.
fn crossed_diagonal(polygon: &Chain, base: Base, bounds: &Aabb) -> Option<[DVec3; 2]> {
    let Aabb { min, max } = *bounds;
    // The plane lies between two opposite corners if it meets the box: those farthest along its normal.
    let diagonals = [
        [min, max],
        [DVec3::new(max.x, min.y, min.z), DVec3::new(min.x, max.y, max.z)],
        [DVec3::new(min.x, max.y, min.z), DVec3::new(max.x, min.y, max.z)],
        [DVec3::new(min.x, min.y, max.z), DVec3::new(max.x, max.y, min.z)],
    ];
    let is_crossed = |[p, q]: &[DVec3; 2]| !same_strict_side(polygon.side(base, *p), polygon.side(base, *q));
    diagonals.into_iter().find(is_crossed)
}

/// Whether a segment whose ends are not both beyond one plane of the box meets it: seen along no axis does its line pass beside
/// the box.
///
/// By signs alone, as Green and Hatch do; the thesis clips the edge (Liang and Barsky), which takes quotients. Together with the
/// outcodes these are the six axes that can separate a segment from a box.
fn line_meets(p: DVec3, q: DVec3, bounds: &Aabb) -> bool {
    (0..3).all(|dropped| {
        let [p, q, min, max] = [p, q, bounds.min, bounds.max].map(|x| flatten(dropped, x));
        let corners = [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)];
        let turns = corners.map(|corner| turn(p, q, corner));
        !(turns.iter().all(|&t| t > 0.0) || turns.iter().all(|&t| t < 0.0))
    })
}
