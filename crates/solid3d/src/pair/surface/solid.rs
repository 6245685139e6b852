//! The nearest point of the surface of a solid mesh: that of the nearest triangle, with the side of the point by the winding number.

use fearless_simd::Simd;
use glam::{DAffine3, DVec3};
use solid_convex::simd::{dispatch, level};
use solid_convex::{Closest, Points, gjk};

use super::{NEAR, SignedDistance, away};
use crate::bounds::Aabb;
use crate::pair::complex_convex::{is_confirmed, nearest_to, point_at};
use crate::pair::containment::PlacedSolid;
use crate::pair::frame::{Frame, Stretch};
use crate::pair::table::{PlacedComplex, PlacedConvex};
use crate::pair::{Scratch, complex_convex};
use crate::placement::direction;
use crate::shape::Complex;
use crate::tree::{Around, Leaf, NearLeaves};
use crate::triangle_triangle::Triangle;

/// Nearer to a face, its own normal is better than the way from the nearest point, of which rounding has that part. In the common
/// frame, where the size of the data is from 1 to 2.
const NEAR_FACE: f64 = 1.0 / (1u64 << 26) as f64;

/// How far beside a triangle it is tested which side of it is outside, in parts of its size; no less than rounding moves what is there.
const BESIDE: f64 = 1e-6;

/// So far to the middle of a triangle one goes from a place on its edge, to look what is beside it alone.
const OFF_EDGE: f64 = 1.0 / 16.0;

/// For a point, which is given as a convex shape.
pub(super) fn surface_point(
    mesh: PlacedComplex,
    point: PlacedConvex,
    scratch: &mut Scratch,
) -> SignedDistance {
    let frame = complex_convex::frame(mesh, point);
    let solid = PlacedSolid::new(mesh.0, &frame.common[0]).expect("the caller saw that it is solid");
    let inside = solid.contains(frame.common[1].translation, scratch);
    let closest = complex_convex::closest_to_surface(mesh, point, &frame, f64::INFINITY, scratch);
    let Closest { distance, points } = closest.expect("a mesh has a triangle, and every distance is finite");
    if distance * frame.scale <= NEAR_FACE {
        // Twice as far: by more than the error of the distance.
        return close_by(mesh.0, &frame, (&solid, inside), 2.0 * NEAR_FACE, scratch);
    }
    let side = if inside { -1.0 } else { 1.0 };
    // Not from points of the world, whose rounding is that of their coordinates.
    let way = point.1.translation - mesh.1.translation - mesh.1.matrix3 * points.on_a;
    SignedDistance {
        distance: side * distance,
        point: mesh.1.transform_point3(points.on_a),
        normal: away(way) * side,
    }
}

/// The same for a point that may be so near to the surface, or on it, that the way to it has few digits. It is no further away than
/// `bound`, in the common frame.
fn close_by(
    mesh: &Complex,
    frame: &Frame,
    (solid, inside): (&PlacedSolid, bool),
    bound: f64,
    scratch: &mut Scratch,
) -> SignedDistance {
    let [to_common, point_to_common] = &frame.common;
    let p = point_to_common.translation;
    let local = frame.b_to_a.translation;
    let bounds = Aabb::new(local, local).inflated(frame.slack_in_a);
    let of_mesh = &frame.stretch_of_a();
    let around = Around { bounds, radius: 0.0 };
    let metric = mesh.tree().folded(&of_mesh.metric(&Stretch::NONE));
    let query = dispatch!(simd => mesh.tree().near_query(simd, None, around, metric));
    let Scratch { traversal, primitive_tests, .. } = scratch;
    let mut nearest = Nearest {
        corners: |primitive| {
            let indices = mesh.primitive(primitive);
            [0, 1, 2].map(|i| to_common.transform_point3(mesh.vertices()[indices[i] as usize]))
        },
        p,
        primitive_tests,
        found: None,
    };
    let mut best = bound;
    mesh.tree().nearest_on(level(), &query, &mut best, traversal, &mut nearest);
    let (triangle, foot) = nearest.found.expect("a mesh has a triangle, and every distance is finite");

    let from = p - foot.point;
    let side = if inside { -1.0 } else { 1.0 };
    let across = across(&triangle);
    let normal = match across {
        // The way there is no direction.
        Some(front) if foot.distance <= if foot.is_inner { NEAR_FACE } else { NEAR } => {
            let rounding = frame.rounding() * frame.scale;
            let height = front.dot(from);
            // Off the edges, a point that is clear of the face tells by its side which way is out.
            if foot.is_inner && height.abs() > 2.0 * rounding {
                front * (side * height.signum())
            } else {
                outward(solid, &triangle, &foot, front, rounding, scratch)
            }
        }
        _ => away(from) * side,
    };
    SignedDistance {
        distance: if foot.distance > 0.0 { side * foot.distance / frame.scale } else { 0.0 },
        point: frame.to_world(foot.point),
        normal,
    }
}

/// The front of a triangle, or its opposite, whichever leads out of the solid at a place on it; where that does not tell, in the middle. Positions
/// are off by a rounding.
fn outward(
    solid: &PlacedSolid,
    triangle: &Triangle,
    foot: &Foot,
    front: DVec3,
    rounding: f64,
    scratch: &mut Scratch,
) -> DVec3 {
    let [a, b, c] = *triangle;
    let size = (b - a).abs().max((c - a).abs()).max_element();
    let middle = (a + b + c) / 3.0;
    let place = if foot.is_inner { foot.point } else { foot.point.lerp(middle, OFF_EDGE) };
    let way = (BESIDE * size).max(rounding);
    let mut told = |place: DVec3| {
        let [over, under] = [front, -front].map(|normal| !solid.contains(place + normal * way, scratch));
        (over != under).then_some(if over { front } else { -front })
    };
    // Where both sides are inside, as where parts overlap, the front.
    told(place).or_else(|| told(middle)).unwrap_or(front)
}

/// The front of a triangle; `None` for one without.
fn across([a, b, c]: &Triangle) -> Option<DVec3> {
    let (u, v) = (*b - *a, *c - *a);
    let largest = u.abs().max(v.abs()).max_element();
    if largest == 0.0 {
        return None;
    }
    // Of any length: that of a sliver has a square below the least number.
    direction((u / largest).cross(v / largest))
}

/// Looks for the triangle nearest to a point.
struct Nearest<'s, C> {
    /// The corners of a triangle in the common frame.
    corners: C,
    p: DVec3,
    primitive_tests: &'s mut u64,
    found: Option<(Triangle, Foot)>,
}

impl<C: Fn(u32) -> Triangle> NearLeaves for Nearest<'_, C> {
    #[inline(always)]
    fn visit<S: Simd>(&mut self, _: S, leaf: &Leaf, best: &mut f64) {
        for &primitive in leaf.primitives {
            *self.primitive_tests += 1;
            let triangle = (self.corners)(primitive);
            let foot = Foot::of(&triangle, self.p);
            if foot.distance < *best {
                *best = foot.distance;
                self.found = Some((triangle, foot));
            }
        }
    }
}

/// The point of a triangle nearest to another.
#[derive(Clone, Copy)]
struct Foot {
    distance: f64,
    point: DVec3,
    /// Whether it is off the edges.
    is_inner: bool,
}

impl Foot {
    /// By a point that stands on the triangle, not by its normal, which rounding tilts where it is thin; where the plane across the way
    /// does not confirm that, as may be of slivers, by GJK.
    fn of(triangle: &Triangle, p: DVec3) -> Foot {
        let [s, t] = nearest_to(p, triangle);
        let point = point_at(triangle, [s, t]);
        let way = p - point;
        let distance = way.length();
        let is_inner = s > 0.0 && t > 0.0 && s + t < 1.0;
        if distance == 0.0 || is_confirmed(triangle, p, way, distance) {
            return Foot { distance, point, is_inner };
        }
        let points = Points::new(triangle).expect("a triangle has corners");
        let (here, at) = (DAffine3::IDENTITY, DAffine3::from_translation(p));
        let one = Points::new(&[DVec3::ZERO]).expect("there is a point");
        let closest = gjk::closest_points(&points, &here, &one, &at);
        Foot { distance: closest.distance, point: closest.points.on_a, is_inner }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use glam::{DMat3, DQuat};
    use rand::Rng;
    use solid_convex::Polytope;
    use solid_convex::gjk::TOUCHING_ERROR;
    use solid_oracle::generate::{in_cube, seeded};

    use super::*;
    use crate::shape::{Class, Shape};

    /// A closed, wavy tube around the axis y, of 800 triangles.
    fn ring() -> Shape {
        let (around, across) = (40, 10);
        let corner = |i: u32, j: u32| {
            let (alpha, beta) =
                (f64::from(i) * TAU / f64::from(around), f64::from(j) * TAU / f64::from(across));
            let radius = 1.0 + (0.3 + 0.05 * (5.0 * alpha).sin()) * beta.cos();
            DVec3::new(radius * alpha.cos(), 0.3 * beta.sin(), radius * alpha.sin())
        };
        let vertices: Vec<DVec3> = (0..around * across).map(|k| corner(k / across, k % across)).collect();
        let at = |i: u32, j: u32| i % around * across + j % across;
        let cell = |k: u32| {
            let (i, j) = (k / across, k % across);
            [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
        };
        let triangles: Vec<[u32; 3]> = (0..around * across).flat_map(cell).collect();
        Shape::mesh(vertices, triangles).unwrap().into_solid().unwrap()
    }

    /// Law: the surface is as near, on the same side, as where each triangle is asked: far from it, near it, and on it.
    #[test]
    fn the_nearest_place_is_that_of_all_triangles() {
        let mut rng = seeded(152);
        let ring = ring();
        let Class::Complex(mesh) = ring.class() else { panic!("a mesh is complex") };
        let vertices = ring.vertices().unwrap();
        let one = Polytope::new(vec![DVec3::ZERO]).unwrap();
        let (mut inside, cases) = (0, 3000);
        for case in 0..cases {
            let size = 10f64.powi([0, 6, -6][case % 3]);
            let linear = DMat3::from_cols(in_cube(&mut rng), in_cube(&mut rng), in_cube(&mut rng)) * size;
            let at = DAffine3 { matrix3: linear, translation: in_cube(&mut rng) * size };
            let near = vertices[rng.random_range(0..vertices.len())];
            let local = match case % 4 {
                0 => near + in_cube(&mut rng) * 10f64.powi(-rng.random_range(6..14)),
                _ => near + in_cube(&mut rng) * 0.4,
            };
            let point = DAffine3::from_translation(at.transform_point3(local));
            let scratch = &mut Scratch::default();
            let quick = surface_point((mesh, &at), (&one, &point), scratch);
            let frame = Frame::new(&at, mesh.reach(), &point, DVec3::ZERO);
            let solid = PlacedSolid::new(mesh, &frame.common[0]).unwrap();
            let is_inside = solid.contains(frame.common[1].translation, scratch);
            let slow = close_by(mesh, &frame, (&solid, is_inside), f64::INFINITY, scratch);
            inside += usize::from(slow.distance < 0.0);
            let off = (quick.distance - slow.distance).abs() * frame.scale;
            assert!(off <= 1e-14, "case {case}: {quick:?}, {slow:?}");
            let between = (point.translation - quick.point).length() * frame.scale;
            assert!((between - quick.distance.abs() * frame.scale).abs() <= 4e-14, "case {case}: {quick:?}");
            // Of places as near as each other it may be another.
            let apart = (quick.point - slow.point).length() * frame.scale;
            assert!(
                apart > 1e-7 || (quick.normal - slow.normal).length() < 1e-6,
                "case {case}: {quick:?}, {slow:?}"
            );
        }
        assert!((cases / 4..cases * 3 / 4).contains(&inside), "{inside} of {cases} are inside");
    }

    /// Law: the surface of a solid needle, stretched up to a hundred million times, is as far from a point on it or all but on it as the
    /// closest points of the two, which touch up to an error of the size of the data: less than 2 here.
    #[test]
    fn a_needle_is_as_far_as_its_closest_point() {
        let mut rng = seeded(153);
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let one = Polytope::new(vec![DVec3::ZERO]).unwrap();
        let scratch = &mut Scratch::default();
        let (mut apart, cases) = (0, 4000);
        for case in 0..cases {
            let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| p + in_cube(&mut rng) * 0.3);
            let needle = Shape::mesh(corners.to_vec(), faces).unwrap().into_solid().unwrap();
            let Class::Complex(mesh) = needle.class() else { panic!("a mesh is complex") };
            let stretch = DMat3::from_diagonal(DVec3::new(1.0, 10f64.powi([4, 8][case % 2]), 1.0));
            let turn = DMat3::from_quat(DQuat::from_scaled_axis(in_cube(&mut rng) * 3.0));
            let at = DAffine3 { matrix3: turn * stretch, translation: in_cube(&mut rng) };
            let edge = corners[case % 4].lerp(corners[(case + 1) % 4], 0.5);
            let off = in_cube(&mut rng) * [0.0, 1e-9, 1e-13, 1.0][case / 4 % 4];
            let point = DAffine3::from_translation(at.transform_point3(edge) + off);
            let found = surface_point((mesh, &at), (&one, &point), scratch);
            let frame = complex_convex::frame((mesh, &at), (&one, &point));
            let nearest = complex_convex::closest_to_surface(
                (mesh, &at),
                (&one, &point),
                &frame,
                f64::INFINITY,
                scratch,
            );
            let distance = nearest.unwrap().distance;
            let error = (found.distance.abs() - distance).abs() * frame.scale;
            assert!(error <= 2.0 * TOUCHING_ERROR, "case {case}: {found:?} is off by {error:e}");
            apart += usize::from(distance > 0.0);
        }
        println!("{apart} of {cases} are off the surface");
        assert!(apart > cases / 4);
    }
}
