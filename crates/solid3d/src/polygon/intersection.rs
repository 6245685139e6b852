//! Whether two polygons intersect, and in what (thesis, section 3.2).

use std::ops::ControlFlow;

use glam::DVec3;

use super::Polygon;
use super::chain::{Base, Chain};
use super::counters::Counters;
use super::overlap::{End, overlaps};
use super::pair::{Pair, Setting};
use super::section::{Role, Section};
use super::segment;
use crate::triangle_triangle;

/// What two polygons have in common.
#[derive(Clone, Debug, PartialEq)]
pub enum Intersection {
    /// Nothing.
    Apart,
    /// Segments of the line in which their planes meet, in order along it. Where the polygons only touch
    /// these may be single points.
    Segments(Vec<[DVec3; 2]>),
    /// Something, where there is no one line: they lie in one plane, a polygon has no area, or a vertex is as near the other's
    /// plane as that polygon is uneven.
    Undirected,
}

/// The thesis's new approach (section 3.2.2): both polygons are cut with each other's plane; the segments, sorted along the line
/// in which the planes meet, are searched for an overlap by Algorithm 3.1. Expected cost: O(n log n).
///
/// ```
/// use solid3d::{glam::DVec3, polygon::{self, Counters, Polygon}};
/// let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
/// let a = Polygon::new(square)?;
/// let b = Polygon::new(square.map(|p| p.zxy() + DVec3::new(0.5, 0.5, -0.5)))?;
/// let mut counters = Counters::default();
/// assert!(polygon::intersect_sorted(&a, &b, &mut counters));
/// assert_eq!(counters.edge_plane_tests, 8); // each edge once
/// # use solid3d::glam::Vec3Swizzles;
/// # Ok::<(), solid3d::polygon::PolygonError>(())
/// ```
pub fn intersect_sorted(a: &Polygon, b: &Polygon, counters: &mut Counters) -> bool {
    let pair = Pair::new(a, b);
    match pair.setting() {
        Setting::Degenerate => pair.degenerate_meet(),
        Setting::Coplanar(base) => pair.coplanar_meet(base),
        Setting::Unclear => intersect_triangulated(a, b),
        Setting::Transversal { bases, of_a, of_b } => {
            // An early exit that the straightforward approach has not.
            if is_one_sided(&of_a) || is_one_sided(&of_b) {
                counters.edge_plane_tests += (of_a.len() + of_b.len()) as u64;
                return false;
            }
            let axis = direction([a, b], bases);
            let in_a = Section::new((&pair.a, bases[0]), &of_a, Role::A, axis, counters);
            let in_b = Section::new((&pair.b, bases[1]), &of_b, Role::B, axis, counters);
            let order = |x: &_, y: &_| in_a.order_to(x, &in_b, y, counters);
            overlaps(&in_a.segments, &in_b.segments, order, |_| ControlFlow::Break(())).is_break()
        }
    }
}

/// The straightforward approach (thesis, section 3.2.1): each edge of each polygon against the other polygon. Cost: O(n^2). It
/// answers as [`intersect_sorted`] does, and holds for polygons whose edges cross, too: what is enclosed an odd number of
/// times is inside.
///
/// ```
/// use solid3d::{glam::DVec3, polygon::{self, Counters, Polygon}};
/// let a = Polygon::new([DVec3::ZERO, DVec3::X, DVec3::Y])?;
/// let b = Polygon::new([DVec3::Z, DVec3::X + DVec3::Z, DVec3::Y + DVec3::Z])?;
/// let mut counters = Counters::default();
/// assert!(!polygon::intersect_straightforward(&a, &b, &mut counters));
/// assert_eq!((counters.edge_plane_tests, counters.point_in_polygon_tests), (6, 0));
/// # Ok::<(), solid3d::polygon::PolygonError>(())
/// ```
pub fn intersect_straightforward(a: &Polygon, b: &Polygon, counters: &mut Counters) -> bool {
    let pair = Pair::new(a, b);
    match pair.setting() {
        Setting::Degenerate => pair.degenerate_meet(),
        Setting::Coplanar(base) => pair.coplanar_meet(base),
        Setting::Unclear => intersect_triangulated(a, b),
        Setting::Transversal { bases, of_a, of_b } => {
            let (a, b) = (&*pair.a, &*pair.b);
            let mut meets = |edges_of: &Chain, sides: &[f64], other, base| {
                edges_of.edges().any(|[i, j]| {
                    let ends = [edges_of.vertices[i], edges_of.vertices[j]];
                    segment::meets_polygon_given(other, base, ends, [sides[i], sides[j]], counters)
                })
            };
            meets(a, &of_a, b, bases[1]) || meets(b, &of_b, a, bases[0])
        }
    }
}

/// The third way, slow: all triangles of the one against all of the other, exactly. Cost: O(n^2).
///
/// ```
/// use solid3d::{glam::DVec3, polygon::{self, Polygon}};
/// let a = Polygon::new([DVec3::ZERO, DVec3::X, DVec3::Y])?;
/// assert!(polygon::intersect_triangulated(&a, &a));
/// # Ok::<(), solid3d::polygon::PolygonError>(())
/// ```
pub fn intersect_triangulated(a: &Polygon, b: &Polygon) -> bool {
    let pair = Pair::new(a, b);
    let corners = |polygon: &Polygon, vertices: &[DVec3]| -> Vec<[DVec3; 3]> {
        let triangles = polygon.triangles();
        triangles.into_iter().map(|triangle| triangle.map(|i| vertices[i as usize])).collect()
    };
    let of_b = corners(b, &pair.b.vertices);
    corners(a, &pair.a.vertices).iter().any(|x| of_b.iter().any(|y| triangle_triangle::intersect(x, y)))
}

/// What two polygons have in common, by Algorithm 3.2. Expected cost: O(n log n).
pub(super) fn intersection(a: &Polygon, b: &Polygon) -> Intersection {
    let pair = Pair::new(a, b);
    let undirected = |meet: bool| if meet { Intersection::Undirected } else { Intersection::Apart };
    match pair.setting() {
        Setting::Degenerate => undirected(pair.degenerate_meet()),
        Setting::Coplanar(base) => undirected(pair.coplanar_meet(base)),
        Setting::Unclear => undirected(intersect_triangulated(a, b)),
        Setting::Transversal { bases, of_a, of_b } => {
            if is_one_sided(&of_a) || is_one_sided(&of_b) {
                return Intersection::Apart;
            }
            let counters = &mut Counters::default();
            let axis = direction([a, b], bases);
            let in_a = Section::new((&pair.a, bases[0]), &of_a, Role::A, axis, counters);
            let in_b = Section::new((&pair.b, bases[1]), &of_b, Role::B, axis, counters);
            let mut segments = Vec::new();
            let order = |x: &_, y: &_| in_a.order_to(x, &in_b, y, counters);
            let all = overlaps(&in_a.segments, &in_b.segments, order, |ends| {
                segments.push(ends.map(|end| match end {
                    End::OfS(x) => in_a.point(x) / pair.scale,
                    End::OfT(y) => in_b.point(y) / pair.scale,
                }));
                ControlFlow::Continue(())
            });
            assert!(all.is_continue());
            if segments.is_empty() { Intersection::Apart } else { Intersection::Segments(segments) }
        }
    }
}

fn is_one_sided(sides: &[f64]) -> bool {
    sides.iter().all(|&side| side > 0.0) || sides.iter().all(|&side| side < 0.0)
}

/// About the direction of the line in which two planes meet, their normals turned as their bases are.
fn direction(polygons: [&Polygon; 2], bases: [Base; 2]) -> DVec3 {
    let normal = |i: usize| {
        let normal = polygons[i].plane().normal;
        normal * normal[bases[i].dropped].signum()
    };
    normal(0).cross(normal(1))
}
