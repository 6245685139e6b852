//! How a ball and a triangle lie to each other, in closed form.

use glam::DVec3;

use super::super::complex_convex::{is_confirmed, nearest_to, point_at};
use super::super::triangle_triangle::Triangle;
use super::face::ALIGNED_SINE;
use super::meeting::Meeting;
use super::ring::slack;

/// A centre nearer to the triangle than this, in the unit of the pair, has a way to it with few digits.
const WAY_MIN: f64 = 1e-6;

/// Beyond the tangent of the greatest angle between what is aligned.
const ALIGNED_TANGENT: f64 = 1.001 * ALIGNED_SINE;

/// The shortest way of a body out of a triangle. Space: common.
pub(super) struct Way {
    /// A unit vector.
    pub out: DVec3,
    /// Negative for a gap.
    pub depth: f64,
    /// The point of the triangle that the body leaves last; of a ball it is the nearest to the centre.
    pub foot: DVec3,
}

impl Way {
    /// How the triangle and the body lie to each other; `mirrored` when the body is the first.
    pub fn meeting(&self, mirrored: bool) -> Meeting {
        let Way { out, depth, foot } = *self;
        let on_body = foot - out * depth;
        match mirrored {
            true => Meeting { normal: out, tilt: 0.0, depth, on_a: on_body, on_b: foot },
            false => Meeting { normal: -out, tilt: 0.0, depth, on_a: foot, on_b: on_body },
        }
    }
}

/// The way from a triangle to the centre of a ball that is not on it. `None` where rounding hides which point of a sliver is the closest, and where the
/// centre is on it. Space: common.
pub(super) fn way(triangle: &Triangle, center: DVec3, radius: f64) -> Option<Way> {
    let foot = point_at(triangle, nearest_to(center, triangle));
    let way = center - foot;
    let length = way.length();
    if length < WAY_MIN {
        return None;
    }
    is_confirmed(triangle, center, way, length).then_some(Way {
        out: way / length,
        depth: radius - length,
        foot,
    })
}

/// The way of a ball out of a triangle along a unit vector that is the triangle's unit normal or its opposite, or nearly; `tip` is the ball's furthest
/// point against it. `None` where that is beside the triangle.
pub(super) fn way_along(triangle: &Triangle, normal: DVec3, tip: DVec3, out: DVec3) -> Option<Way> {
    let depth = normal.dot(triangle[0] - tip) / normal.dot(out);
    let foot = tip + out * depth;
    is_within(triangle, normal, foot, 0.0).then_some(Way { out, depth, foot })
}

/// Whether no vector that is nearly the unit normal of a triangle, or its opposite, has a way along it of a ball out of the triangle, whatever its radius.
pub(super) fn is_beside(triangle: &Triangle, normal: DVec3, center: DVec3) -> bool {
    let height = normal.dot(triangle[0] - center);
    let aside = ALIGNED_TANGENT * height.abs();
    !is_within(triangle, normal, center + normal * height, aside)
}

/// Whether a point of the plane of a triangle is in it, or outside by no more than a length and what is on an edge.
fn is_within(triangle: &Triangle, normal: DVec3, point: DVec3, aside: f64) -> bool {
    let [p, q, r] = *triangle;
    let (pq, pr) = (q - p, r - p);
    let slack = slack(pq.length_squared().max(pr.length_squared()), normal.dot(pq.cross(pr))) + aside;
    [(p, pq), (q, r - q), (r, -pr)].into_iter().all(|(from, edge)| {
        let height = normal.dot(edge.cross(point - from));
        height >= 0.0 || height >= -slack * edge.length()
    })
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;
    use rand::Rng;
    use solid_convex::{Points, Sphere, epa, gjk};
    use solid_oracle::generate::{in_cube, seeded};

    use super::super::ways::support;
    use super::super::{Pair, face};
    use super::*;
    use crate::pair::Placed;
    use crate::shape::{Body, Class, Shape};

    /// Law: where there is an answer it is that of EPA, or of GJK where they are apart; slivers among the triangles. Few are left open but slivers.
    #[test]
    fn the_way_is_that_of_the_searches() {
        let mut rng = seeded(150);
        let (mut meeting, mut open) = (0, 0);
        for case in 0..6_000 {
            let [p, q, r] = [(); 3].map(|()| in_cube(&mut rng));
            let triangle = if case % 4 == 0 { [p, q, p.lerp(q, 0.3) + 1e-7 * r] } else { [p, q, r] };
            let (center, radius) = (in_cube(&mut rng), rng.random_range(0.01..1.4));
            let Some(Way { out, depth, foot }) = way(&triangle, center, radius) else {
                open += usize::from(case % 4 != 0);
                continue;
            };
            let (ball, corners) =
                (Sphere::new(radius).expect("it has a size"), Points::new(&triangle).expect("points"));
            let (at, here) = (DAffine3::from_translation(center), DAffine3::IDENTITY);
            let context = format!("case {case}: {triangle:?}, {center}, {radius}");
            assert!(
                (out.length() - 1.0).abs() < 1e-14
                    && (foot + out * (radius - depth) - center).length() < 1e-14
            );
            if depth > 1e-9 {
                meeting += 1;
                let found = epa::penetration(&ball, &at, &corners, &here).expect("they meet");
                assert!((found.depth - depth).abs() < 1e-11, "{context}: {found:?}, {depth}");
                assert!((found.points.on_b - foot).length() < 1e-5, "{context}: {found:?}, {foot}");
            } else if depth < -1e-9 {
                let found = gjk::closest_points(&ball, &at, &corners, &here);
                assert!((found.distance + depth).abs() < 1e-11, "{context}: {found:?}, {depth}");
            }
        }
        assert!((2_000..5_000).contains(&meeting) && open < 10, "{meeting} meet, {open} open");
    }

    /// Law: along the normal of a triangle, or nearly, a ball has the contact that clipping gives, and none where it is beside; small triangles and large
    /// ones, balls that are over an edge or a corner, and tilts up to what is aligned.
    #[test]
    fn a_ball_over_a_triangle_is_clipped() {
        let mut rng = seeded(174);
        let [mut over, mut near, mut beside] = [0; 3];
        for case in 0..6_000 {
            let extent = [1.0, 0.1, 1e-3][case % 3];
            let triangle = [(); 3].map(|()| in_cube(&mut rng) * extent);
            let Some(normal) = face::triangle_normal(triangle) else { continue };
            let mesh = Shape::mesh(triangle.to_vec(), vec![[0, 1, 2]]).unwrap();
            let ball = Shape::sphere(rng.random_range(0.01..1.0)).unwrap();
            let weights = DVec3::new(rng.random(), rng.random(), rng.random()) + rng.random_range(-0.1..0.1);
            let on = triangle[0].lerp(triangle[1], weights.x).lerp(triangle[2], weights.y);
            let center = on + normal * rng.random_range(-1.0..1.0) + in_cube(&mut rng) * 0.01;
            let (here, at) = (DAffine3::IDENTITY, DAffine3::from_translation(center));
            let (a, b) = (Placed { shape: &mesh, placement: &here }, Placed { shape: &ball, placement: &at });
            let pair = Pair::new(a, b, 10.0);
            let (Class::Complex(complex), Some(body)) = (mesh.class(), ball.body()) else {
                unreachable!("a mesh and a body")
            };
            let primitive = Body::of_primitive(complex, 0);
            let corners = triangle.map(|corner| pair.maps[0].point(corner));
            let placed = face::Placed::of_primitive(&primitive, 0, &pair.maps[0], &corners);
            let round = face::Placed::new(&body, &pair.maps[1]);
            let is_beside = is_beside(&corners, normal, round.map.point(DVec3::ZERO));
            for tilt in [0.0, rng.random_range(0.0..0.01), 0.00999] {
                let aside = normal.cross(in_cube(&mut rng)).normalize() * tilt;
                let out = (normal + aside).normalize() * [1.0, -1.0][case / 3 % 2];
                let context = format!("case {case}: {triangle:?}, {ball:?}, {center}, {out}");
                let clipped = pair.across(&placed, &round, -out);
                let tip = round.map.point(support(&ball).support(-out));
                let Some(way) = way_along(&corners, normal, tip, out) else {
                    assert!(clipped.is_empty(), "{context}: {clipped:?}");
                    *(if is_beside { &mut beside } else { &mut near }) += 1;
                    continue;
                };
                let ([touch], meeting) = (&clipped[..], way.meeting(false)) else {
                    panic!("{context}: {clipped:?}")
                };
                assert!(!is_beside, "{context}");
                let Meeting { depth, on_a, on_b, .. } = meeting;
                let off = [touch.depth - depth, (touch.on_a - on_a).length(), (touch.on_b - on_b).length()];
                assert!(off.iter().all(|off| off.abs() < 1e-13), "{context}: {off:?}");
                over += 1;
            }
        }
        assert!(over > 3_000 && near > 100 && beside > 3_000, "{over} over, {near} near, {beside} beside");
    }
}
